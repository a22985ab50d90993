/* A part of a scene: some of its sweeps and bodies, and where they lie in the whole. */
#ifndef MESO_SELECTION_H
#define MESO_SELECTION_H

#include "libcore/scene/parts.h"

/* Parts of the selection that lie next to each other in the whole. */
typedef struct MesoSelectedRun {
    uint32_t part, part_count;          /* the first, by its number in the whole */
    uint64_t vertex, vertex_count;      /* the first of its vertices, likewise */
    uint64_t face, face_count;
} MesoSelectedRun;

typedef struct MesoSelection {
    MesoScene scene;                    /* the whole's arrays, but for `kinds`, `sweeps` and `placed` */
    uint32_t run_count;
    MesoSelectedRun *runs;              /* [run_count] in order */
    uint32_t part_count;                /* of the whole, as what follows */
    uint64_t vertex_count, face_count;
} MesoSelection;

/* What is selected: parts that have an id of [low, high] in the first channel; or, of `shard_count` > 0 shares of all
 * parts with about as many vertices each, share `shard`, from 0 on. */
typedef struct MesoSelectionRule {
    uint32_t low, high;
    uint32_t shard, shard_count;
} MesoSelectionRule;

/*
 * Parts keep their order, so that their vertices and faces are those of the whole. O(parts). MESO_ERR_INPUT where
 * nothing is selected, MESO_ERR_MEMORY.
 */
MesoStatus meso_selection_make(MesoSelection *selection, MesoArena *arena, const MesoSceneParts *whole,
                               const MesoSelectionRule *rule, MesoError *error);

#endif
