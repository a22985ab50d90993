/* Quads that were written as two triangles, put together again. */
#ifndef MESO_TRIANGLE_PAIRS_H
#define MESO_TRIANGLE_PAIRS_H

#include "libcore/mesh/polygon_mesh.h"

/* How far the second triangle may be bent out of the plane of the first: the sine of the angle between them. Quads of
 * subdivided and sculpted surfaces are not planar either; half a right angle is no quad any more. */
#define MESO_PAIR_BEND 0.5

/*
 * Exporters write a quad a b c d as the triangles a b c and a c d, or another way round, one after the other. Faces
 * 2 i and 2 i + 1 become quad i where they have one edge in common, along which they run opposite ways, where the angle
 * between them is at most asin(MESO_PAIR_BEND), and where the quad is convex: in the plane across its area vector, it
 * turns left at every corner. The quad begins with the first corner of the first triangle. Attributes of faces are
 * those of the first triangle; of corners, at both ends of the edge, too. O(faces).
 *
 * MESO_ERR_INPUT names the first face, counted from 1, that is no part of such a pair, and why; its number from 0 goes
 * to `face`, which may be NULL, or MESO_NO_INDEX. All faces are pairs, or none is made.
 */
MesoStatus meso_mesh_pair_triangles(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                                    uint32_t *face, MesoError *error);

#endif
