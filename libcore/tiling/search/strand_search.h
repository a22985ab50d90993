/*
 * A rule on strands during a search: slots are added as they come to a single
 * variant, and taken back in the opposite order. A violation shows as early as
 * the slots so far prove it: no later slot can mend it.
 */
#ifndef MESO_STRAND_SEARCH_H
#define MESO_STRAND_SEARCH_H

#include "libcore/tiling/problem/strand_forest.h"
#include "libcore/tiling/propagate/propagate.h"

/* A sweep of a variant, between joints of its slot: 4 is the top, 5 the bottom. */
typedef struct MesoVariantLink {
    uint8_t side[2];
    uint32_t section[2];        /* counted within their interfaces */
} MesoVariantLink;

typedef struct MesoStrandUndo {
    MesoStrandStep step;        /* `a` is MESO_NO_INDEX for what is not a link */
    uint32_t value;             /* slot added, joint opened or closed, strand finished */
    uint8_t kind;
} MesoStrandUndo;

typedef struct MesoStrandSearch {
    MesoStrandRule rule;
    const MesoSlotGraph *graph;
    const MesoVariantSet *variants;
    const MesoTileSet *set;
    MesoArena *arena;
    uint32_t *link_begin;       /* [variant_count + 1] */
    MesoVariantLink *links;
    uint32_t stride;            /* joints an edge has room for */
    uint32_t *edge;             /* [4 * slot_count] number of the half-edge's edge */
    uint32_t shell_begin;       /* joints of tops and bottoms, where tiles have any */
    MesoStrandForest forest;
    uint8_t *added;             /* [slot_count] */
    uint32_t *component;        /* [slot_count] piece of the surface */
    uint32_t *strand_count;     /* [pieces] strands so far */
    uint32_t *finished_count;   /* [pieces] of them, those that can grow no more */
    uint8_t *finished;          /* [joints] at the root of such a strand */
    MesoStrandUndo *trail;
    size_t trail_count, trail_capacity;
} MesoStrandSearch;

/* Nothing added. Lives in `arena`. MESO_ERR_MEMORY, or MESO_ERR_LIMIT for 2^32 - 1 joints and more. */
MesoStatus meso_strand_search_init(MesoStrandSearch *search, MesoArena *arena, const MesoStrandRule *rule,
                                   const MesoTileSet *set, const MesoVariantSet *variants,
                                   const MesoSlotGraph *graph, MesoError *error);

/*
 * Adds `slot`, not yet added, with `variant`. `*kept` becomes false where the
 * rule is violated, and stays as it is otherwise; the slot is added in any
 * case. MESO_ERR_MEMORY alone. O(sweeps * log(joints)).
 */
MesoStatus meso_strand_search_add(MesoStrandSearch *search, uint32_t slot, uint32_t variant,
                                  bool *kept, MesoError *error);

/* Back to when the trail had `mark` entries: an earlier `trail_count`. */
void meso_strand_search_undo(MesoStrandSearch *search, size_t mark);

/* Whether slots that the initial fixed point leaves one variant violate the rule of `constraints`. */
MesoStatus meso_strand_search_disproves(bool *disproved, MesoArena *arena, const MesoPropagation *propagation,
                                        const MesoVariantSet *variants,
                                        const MesoConstraints *constraints, MesoError *error);

/* Adds all slots that the initial fixed point leaves one variant. */
MesoStatus meso_strand_search_add_initial(MesoStrandSearch *search, const MesoPropagation *propagation,
                                          bool *kept, MesoError *error);

#endif
