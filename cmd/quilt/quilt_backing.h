/* The surface beside the quilt on it, in one scene. */
#ifndef MESO_QUILT_BACKING_H
#define MESO_QUILT_BACKING_H

#include "libcore/mesh/polygon_mesh.h"
#include "libcore/scene/scene.h"

/*
 * Adds the mesh's bodies, with its materials, to the scene of a quilt (quilt_scene.h). In each channel of ids they are one
 * more than all others. Its arrays come to lie in `arena`. MESO_ERR_INPUT, MESO_ERR_LIMIT as of meso_scene_of_mesh(),
 * MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_add_backing(MesoScene *scene, MesoArena *arena, const MesoPolygonMesh *mesh, MesoError *error);

#endif
