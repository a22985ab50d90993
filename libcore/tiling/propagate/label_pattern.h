/*
 * Patterns: what the variants of a state show to the neighbours. Variants that
 * show the same labels on the inner sides of their slot are one pattern, unless
 * a constraint tells them apart.
 */
#ifndef MESO_LABEL_PATTERN_H
#define MESO_LABEL_PATTERN_H

#include "libcore/tiling/propagate/propagate.h"

/* The code of a side that no neighbour sees. */
#define MESO_LABEL_PATTERN_BORDER UINT32_MAX

typedef struct MesoLabelPatternList {
    uint32_t index;             /* among the lists of its table */
    uint32_t count;
    uint32_t *codes;            /* [4 * count] label codes, MESO_LABEL_PATTERN_BORDER on borders */
    uint32_t *begin;            /* [count + 1] into variants */
    uint32_t *variants;         /* by pattern, ascending within */
} MesoLabelPatternList;

typedef struct MesoLabelPatternTable {
    const MesoPropagation *propagation;
    const uint32_t *group;      /* [variants] equal where variants may be one pattern; NULL: all are */
    MesoArena *arena;
    uint32_t list_count;
    MesoLabelPatternList **lists;    /* [16 * states] by state and sides on the border; NULL: not met yet */
} MesoLabelPatternTable;

/* Sides of `slot` without neighbour, as bits. */
uint32_t meso_slot_border_sides(const MesoSlotGraph *graph, uint32_t slot);

/*
 * Prepares the patterns of the initial states of `propagation`, which must not
 * change while the table is in use. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_label_pattern_table_init(MesoLabelPatternTable *table, MesoArena *arena,
                                   const MesoPropagation *propagation, const uint32_t *group,
                                   MesoError *error);

/* Patterns of a slot's initial state; NULL when memory is out. O(1) where a like slot was met before. */
const MesoLabelPatternList *meso_label_pattern_list(MesoLabelPatternTable *table, uint32_t slot, MesoError *error);

#endif
