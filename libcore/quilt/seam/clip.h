/*
 * Clip: a triangle mesh cut where a function on its vertices is zero, and the
 * positive side kept. The function is linear in each triangle, so that each
 * crossed edge has one point, both of its triangles meet there, and the new
 * border is made of loops. Two meshes that are cut by the same curtain (a
 * function of the place in the plane alone) end along it both.
 */
#ifndef MESO_CLIP_H
#define MESO_CLIP_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef struct MesoClip {
    uint32_t kept_count, made_count;
    uint32_t *vertices;         /* [kept_count] vertices of the mesh, ascending */
    uint32_t *ends;             /* [2 * made_count] the crossed edge: its positive end, then the other */
    float *shares;              /* [made_count] of the way from the positive end, inside (0,1) */
    uint32_t triangle_count;
    uint32_t *corners;          /* [3 * triangle_count] kept vertices, then made ones */
    uint32_t *origins;          /* [triangle_count] triangle of the mesh */
    uint32_t loop_count, open_count;
    uint32_t *loop_begin;       /* [loop_count + 1] into loops; the first open_count run from border to border */
    uint32_t *loops;            /* made vertices, counted from kept_count; the kept side lies to the left */
} MesoClip;

/*
 * Keeps what is positive of `triangle_count` triangles over `values` [vertex_count]. Manifold, oriented meshes give
 * manifold, oriented ones; each closed loop bounds one hole. What is zero counts as negative; points are kept a
 * hundredth of an edge away from its ends. To `arena`. O(vertices + triangles). MESO_ERR_INPUT where three triangles
 * meet in a crossed edge, or neighbours are wound against each other; MESO_ERR_MEMORY.
 */
MesoStatus meso_clip_positive(MesoClip *clip, MesoArena *arena, const float *values, uint32_t vertex_count,
                              const uint32_t *corners, uint32_t triangle_count, MesoError *error);

/*
 * Keeps the triangles of which all three vertices are positive, so that nothing is cut but along edges. Made vertices
 * stand for those along the border: one for each fan of kept triangles there, each at its vertex (both ends are that, the
 * share is 0); such vertices are not among the kept ones. Border edges that the mesh had before are in no loop. Manifold,
 * oriented meshes give manifold, oriented ones. To `arena`. O(vertices + triangles). MESO_ERR_INPUT where triangles at
 * the border are wound against each other or three meet in an edge; MESO_ERR_MEMORY.
 */
MesoStatus meso_clip_whole(MesoClip *clip, MesoArena *arena, const float *values, uint32_t vertex_count,
                           const uint32_t *corners, uint32_t triangle_count, MesoError *error);

/* Positions of kept and made vertices [kept_count + made_count], from those of the mesh. */
void meso_clip_positions(MesoVec3 *to, const MesoClip *clip, const MesoVec3 *positions);

#endif
