/* A quilt as a scene: one body for each element, or for each material that an element has. */
#ifndef MESO_QUILT_SCENE_H
#define MESO_QUILT_SCENE_H

#include "libcore/quilt/embed/quilt_lay.h"
#include "libcore/scene/scene.h"

/*
 * What a scene shows of a quilt that lies at `positions` [vertex_count], of meso_quilt_lay(), with the materials and
 * texture coordinates of the swatch. Channels: "element", by the quilt; "patch", which has placed the first of its
 * triangles; "swatch", the element of the swatch.
 *
 * Normals are smooth, but not across edges of the swatch (quilt_normals.h). A vertex comes once for each of its normals
 * and texture coordinates. Of the swatch positions, corners, twins, materials, looks, names and texture coordinates are
 * read.
 *
 * To `arena`; the scene points to nothing else but the names. O(vertices + triangles); the same for any number of
 * threads (0: all cores). MESO_ERR_LIMIT beyond 2^32 corners, MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_scene(MesoScene *scene, MesoArena *arena, const MesoQuilt *quilt, const MesoSwatch *swatch,
                            const MesoVec3 *positions, uint32_t thread_count, MesoError *error);

/*
 * The same of a quilt over its base as that is now, by meso_quilt_lay(). The thickness of the scene is that of the
 * layer.
 */
MesoStatus meso_quilt_show(MesoScene *scene, MesoArena *arena, const MesoQuilt *quilt, const MesoSwatch *swatch,
                           const MesoTriangulation *base, MesoQuiltEmbedding embedding, uint32_t thread_count,
                           MesoError *error);

#endif
