/* Strands: sweeps that go on into each other, found by where they end. */
#ifndef MESO_SWEEP_STRANDS_H
#define MESO_SWEEP_STRANDS_H

#include "libcore/base/arena.h"
#include "libcore/scene/scene.h"

/* A sweep of a strand; `reversed` where the strand runs from its end to its start. */
typedef struct MesoStrandPiece {
    uint32_t sweep;
    bool reversed;
} MesoStrandPiece;

typedef struct MesoStrands {
    uint32_t count;
    uint32_t *begin;            /* [count + 1] */
    MesoStrandPiece *pieces;    /* [sweeps of the scene] strand by strand, along each */
    uint32_t *of_sweep;         /* [sweeps of the scene] */
    bool *closed;               /* [count] whether the last piece goes on into the first */
    float *length;              /* [count] of the trajectories, in scene units; a cap's is 0 */
} MesoStrands;

/*
 * Two ends of sweeps belong together where they are at the same place, to the bit, and of one material; of
 * several, those that are as wide as each other. A cap is an end, and so a piece of the strand that it closes.
 * Strands are in the order of their first sweeps, and begin at an open end or a cap; closed ones begin with their
 * first sweep. O(sweeps log sweeps + columns). MESO_ERR_MEMORY.
 */
MesoStatus meso_strands_find(MesoStrands *strands, MesoArena *arena, const MesoScene *scene, MesoError *error);

/* The mean distance of a kind's profile from its trajectory at its start or its end, in scene units, of instances of
 * size 1. O(columns). */
float meso_strand_radius(const MesoScene *scene, const MesoSweptKind *kind, bool at_end);

#endif
