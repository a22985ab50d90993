/* The surface itself, shown below what lies on it. */
#ifndef MESO_SCENE_BACKDROP_H
#define MESO_SCENE_BACKDROP_H

#include "libcore/mesh/polygon_mesh.h"
#include "libcore/scene/scene.h"

/*
 * Adds a mesh to a scene of bodies.
 *
 * material  what it is made of (material_text.h), or "own": the mesh's own materials and colours
 *
 * In each channel it has an id of its own, the last, by the name "surface" where ids have names. Its arrays come to lie
 * in the arena. MESO_ERR_INPUT where the text is no material, and as of meso_scene_of_mesh(); MESO_ERR_LIMIT over
 * 2^16 - 1 materials; MESO_ERR_MEMORY.
 */
MesoStatus meso_scene_add_backdrop(MesoScene *scene, MesoArena *arena, const MesoPolygonMesh *mesh,
                                   const char *material, MesoError *error);

/* What is wrong with the value of a tool's --surface: MESO_ERR_USAGE; NULL is right. */
MesoStatus meso_scene_check_backdrop(const char *material, MesoError *error);

#endif
