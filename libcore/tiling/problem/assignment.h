/* Assignment: a tile and a transform for each slot (MesoGen, section 3.2). */
#ifndef MESO_ASSIGNMENT_H
#define MESO_ASSIGNMENT_H

#include "libcore/mesh/slot_graph.h"
#include "libcore/tiling/tile/variant.h"

typedef struct MesoAssignment {
    uint32_t slot_count;
    uint32_t *tile;             /* [slot_count] */
    MesoTransform *transform;   /* [slot_count] */
} MesoAssignment;

/*
 * Checks an assignment by itself, without any solver code: as many slots as
 * `graph` has, for each a tile in range, not ignored, under a transform that it
 * allows; opposite labels across every edge; border rules. MESO_ERR_INPUT names
 * the first slot and side (counted from 0) that breaks a rule. O(slot_count).
 */
MesoStatus meso_assignment_check(const MesoAssignment *assignment, const MesoTileSet *set,
                                 const MesoSlotGraph *graph, MesoError *error);

#endif
