/*
 * What walks over a triangulation read: one record a triangle, of a cache line.
 * It holds shapes alone, no places: how a triangle lies over each of its sides.
 * Unfolding one triangle beyond another is a product of complex numbers then,
 * and errors are relative to a side's length, however far the walk has come.
 *
 * Points and directions lie in the frame of a triangle: x along its longest
 * side, y to its left, as meso_frame() has it; the origin is where that side
 * begins.
 */
#ifndef MESO_WALK_GROUND_H
#define MESO_WALK_GROUND_H

#include "libcore/base/arena.h"
#include "libcore/field/triangle_frames.h"

typedef struct MesoWalkFace {
    uint32_t twins[3];      /* half-edges across, or MESO_NO_INDEX where walks end */
    uint32_t marks;         /* bit k: what is across side k is wound against this; from bit 3: the frame's side */
    MesoComplex apexes[3];  /* third corner, where side k goes from 0 to 1; 0 where the side has no length */
} MesoWalkFace;

_Static_assert(sizeof(MesoWalkFace) == 64, "one cache line");

typedef struct MesoWalkGround {
    uint32_t triangle_count;
    MesoWalkFace *faces;    /* [triangle_count] */
    double *lengths;        /* [triangle_count] of the longest side */
} MesoWalkGround;

/*
 * domain  NULL: all of the mesh; walks that begin in it end where it does
 *
 * O(triangles), on `thread_count` threads (0: all cores); the same for any number of them. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_walk_ground_build(MesoWalkGround *ground, MesoArena *arena, const MesoTriangulation *mesh,
                                  const MesoDomain *domain, uint32_t thread_count, MesoError *error);

/* ---- triangles in their frames ---- */

static inline uint32_t meso_next_side(uint32_t side)
{
    return side == 2 ? 0 : side + 1;
}

static inline uint32_t meso_previous_side(uint32_t side)
{
    return side == 0 ? 2 : side - 1;
}

/* The side that the frame's x axis lies along. */
static inline uint32_t meso_walk_base(const MesoWalkFace *face)
{
    return face->marks >> 3;
}

static inline bool meso_walk_turns(const MesoWalkFace *face, uint32_t side)
{
    return face->marks >> side & 1;
}

static inline void meso_walk_corners(const MesoWalkGround *ground, uint32_t triangle, MesoComplex corners[3])
{
    const MesoWalkFace *face = &ground->faces[triangle];
    uint32_t base = meso_walk_base(face);
    double length = ground->lengths[triangle];
    corners[base] = (MesoComplex){0, 0};
    corners[meso_next_side(base)] = (MesoComplex){length, 0};
    corners[meso_previous_side(base)] = (MesoComplex){length * face->apexes[base].re, length * face->apexes[base].im};
}

static inline MesoComplex meso_walk_point(const MesoComplex corners[3], const double weight[3])
{
    return (MesoComplex){weight[0] * corners[0].re + weight[1] * corners[1].re + weight[2] * corners[2].re,
                         weight[0] * corners[0].im + weight[1] * corners[1].im + weight[2] * corners[2].im};
}

/* Where a side leads, of length 1. */
static inline MesoComplex meso_walk_side(const MesoWalkFace *face, uint32_t side)
{
    uint32_t base = meso_walk_base(face);
    MesoComplex apex = face->apexes[base];
    if (side == base)
        return (MesoComplex){1, 0};
    bool next = side == meso_next_side(base);
    return meso_complex_unit(next ? (MesoComplex){apex.re - 1, apex.im} : (MesoComplex){-apex.re, -apex.im});
}

/*
 * A direction across a side, in the frame of the triangle there: parallel transport. Where that is wound the other way,
 * left is right from then on.
 */
static inline MesoComplex meso_walk_across(const MesoWalkGround *ground, uint32_t triangle, uint32_t side,
                                           MesoComplex direction)
{
    const MesoWalkFace *face = &ground->faces[triangle];
    uint32_t twin = face->twins[side];
    MesoComplex along = meso_complex_times(direction, meso_complex_conjugate(meso_walk_side(face, side)));
    /* half-edges that face each other run against each other, but where windings differ */
    MesoComplex there = {meso_walk_turns(face, side) ? along.re : -along.re, -along.im};
    return meso_complex_times(there, meso_walk_side(&ground->faces[twin / 3], twin % 3));
}

#endif
