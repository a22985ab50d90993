/* The surface itself, shown below what grows on it. */
#ifndef MESO_GROW_BACKDROP_H
#define MESO_GROW_BACKDROP_H

#include "cmd/common/tool.h"
#include "libcore/mesh/polygon_mesh.h"
#include "libcore/scene/scene.h"

/*
 * Adds a mesh to a scene of bodies, made of the material that `text` says (grow_material.h). In each channel it has an
 * id of its own, the last, by the name "surface" where ids have names. MESO_ERR_USAGE where the text is no material.
 */
MesoStatus meso_grow_backdrop(MesoScene *scene, MesoTool *tool, const MesoPolygonMesh *mesh, const char *text);

#endif
