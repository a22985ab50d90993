/* A polygon mesh as a scene, so that any mesh can be drawn and written again. */
#ifndef MESO_SCENE_OF_MESH_H
#define MESO_SCENE_OF_MESH_H

#include "libcore/mesh/polygon_mesh.h"
#include "libcore/scene/scene.h"

/*
 * Bodies of a checked mesh, one for each material and set of ids, in that order; faces keep the file's order
 * within a body, and so do vertices.
 *
 * Faces of more than four sides are cut into the fan around their first corner. A vertex is split where its
 * corners differ in normals, texture coordinates, colours, material or ids; one without faces is left out.
 * Attributes by their names (attribute.h), from corners, vertices or, but for normals, faces:
 *
 *     normal      made unit length; where there is none, the sum of the areas' vectors around the vertex, or
 *                 +Z where that vanishes
 *     uv          its first two numbers
 *     color       as MesoMeshColor; whole numbers of 8 and 16 bits stand for [0, 1], normalized or not
 *     material    names, or numbers, which become names
 *     albedo, roughness, metallic     of faces: what a material looks like, by its first face. Without them all look the
 *                 same, white where the mesh has colours
 *     slot, tile, strand, region, element, detail     whole numbers of faces, or names: channels of ids, at most
 *                 MESO_ID_CHANNELS of them
 *
 * Everything is copied to `arena`; bytes of names that are not UTF-8 become '?'. MESO_ERR_INPUT for negative ids; MESO_ERR_LIMIT for over 2^16 - 1 materials.
 * O(corners + faces log faces).
 */
MesoStatus meso_scene_of_mesh(MesoScene *scene, MesoArena *arena, const MesoPolygonMesh *mesh, MesoError *error);

#endif
