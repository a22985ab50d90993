/* A surface extended beyond its borders, so that what grows over it does not end there. */
#ifndef MESO_BASE_BORDER_H
#define MESO_BASE_BORDER_H

#include "libcore/quilt/base/base_refine.h"

/*
 * Adds strips of triangles beyond each border, in layers no thicker than `edge`, along the outward conormals: straight
 * on in the surface. Around convex corners they fan out; towards the inside of a hole points that come too near to
 * each other become one, and a hole that is all filled is closed. Strips of different borders, or of two sides of one,
 * may lie over each other in space. New triangles have the triangle of the original at whose border they were put, and
 * weights of its corners outside of 0 to 1.
 *
 * depths   [at least the vertices that come out]: distance beyond the border, of new vertices, to `arena`; those before
 *          have 0
 *
 * Triangles turned against the surface are given up by pulling points back, where possible. O(border length * reach /
 * edge^2). MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_base_extend(MesoBaseMesh *base, float **depths, MesoArena *arena, const MesoTriangulation *original,
                            float edge, float reach, MesoError *error);

#endif
