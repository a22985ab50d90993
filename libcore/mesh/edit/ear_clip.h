/* Polygons cut into triangles. */
#ifndef MESO_EAR_CLIP_H
#define MESO_EAR_CLIP_H

#include "libcore/mesh/polygon_mesh.h"

/*
 * Cuts every face with more than three sides into triangles of its own corners: quads along the shorter of the
 * diagonals that lie inside, others by clipping ears (Meisters, "Polygons have ears", 1975), both in the plane across
 * the face's area vector, onto which non-planar faces are projected. Faces that cross themselves are cut too, in some
 * way. Triangles come face by face. O(corners), and for a face with more than four sides also O(its sides times those
 * of its corners that are not convex). MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_mesh_cut_faces(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, MesoError *error);

#endif
