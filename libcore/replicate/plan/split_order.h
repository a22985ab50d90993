/*
 * The order in which triangles of the web are split: the largest first, for what their corners have at rest. That alone
 * would leave no gaps where a distribution has some; so each triangle has a tolerance, drawn by its corners from those
 * that there are at rest, to a power that grows while edges are more even than at rest.
 */
#ifndef MESO_SPLIT_ORDER_H
#define MESO_SPLIT_ORDER_H

#include "libcore/replicate/plan/replicate_work.h"

typedef struct MesoSplitCandidate {
    float excess;
    uint32_t triangle;
} MesoSplitCandidate;

typedef struct MesoSplitOrder {
    MesoReplication *r;
    MesoSplitCandidate *heap;
    uint32_t count, room;
} MesoSplitOrder;

/* Of the web at rest, whose originals are known. MESO_ERR_MEMORY alone. */
MesoStatus meso_tolerance_build(MesoTolerance *tolerance, MesoReplication *r, MesoError *error);

/* By how even edges are now. */
void meso_tolerance_adapt(MesoTolerance *tolerance, const MesoWeb *web);

/* Triangles in blocks in which details are due; `due` in all. The order is in the arena. MESO_ERR_MEMORY alone. */
MesoStatus meso_split_order(MesoSplitOrder *order, MesoArena *arena, MesoReplication *r, uint32_t due,
                            MesoError *error);

/* A triangle that is new, or another by now. */
void meso_split_push(MesoSplitOrder *order, uint32_t triangle);

/* The next one in whose block a detail is due; a corner of it is a detail, or more. False where there is none. */
bool meso_split_pop(MesoSplitOrder *order, uint32_t *triangle);

/* By a corner that is a detail. */
static inline uint32_t meso_block_of(const MesoReplication *r, uint32_t triangle)
{
    const uint32_t *c = r->web.corners + 3 * (size_t)triangle, fixed = r->web.fixed_count;
    return r->blocks[(c[0] >= fixed ? c[0] : c[1] >= fixed ? c[1] : c[2]) - fixed];
}

#endif
