/* Lists of seeds, as --seeds takes them: "1-10,20,30-40x3", and the products that they make. */
#ifndef MESO_SEED_LIST_H
#define MESO_SEED_LIST_H

#include <stdbool.h>
#include <stdint.h>

#include "cmd/common/tool.h"

/* Lines are kept until the end, a few hundred bytes each. */
enum { MESO_MOST_SEEDS = 10000000 };

typedef struct MesoSeedRange {
    uint64_t first;
    uint32_t count;
    uint32_t attempts;          /* 0: not given */
    uint32_t begin;             /* seeds of the list that are less */
} MesoSeedRange;

typedef struct MesoSeedList {
    MesoSeedRange *ranges;      /* [range_count] ascending, without a seed twice */
    uint32_t range_count;
    uint32_t seed_count;
} MesoSeedList;

/*
 * Parts with commas between, in any order, each A, A-B, AxK or A-BxK: the seeds from A to B, with
 * K attempts. MESO_ERR_USAGE names the part that is none of these, and a seed that two parts name.
 */
MesoStatus meso_seed_list_parse(MesoSeedList *list, MesoArena *arena, const char *text, MesoError *error);

/* Range of the list that `seed` is in, or NULL. O(log(ranges)). */
const MesoSeedRange *meso_seed_list_find(const MesoSeedList *list, uint64_t seed);

/* Its place among the seeds of the list, ascending. The seed must be in it. */
uint32_t meso_seed_list_index(const MesoSeedList *list, uint64_t seed);

/* ---- files, one a seed: "out-%d.slots" ---- */

/* One %d, any number of %%, and no other %. */
bool meso_seed_path_is_pattern(const char *text);

/* The name for a seed, in `arena`; NULL when memory is out. */
char *meso_seed_path(const char *pattern, uint64_t seed, MesoArena *arena, MesoError *error);

/* ---- runs ---- */

/*
 * Calls `run` for one seed after the other until one fails. Each has a report of its own, which the tool's gets a list
 * of, "seeds"; what `run` changes of the tool's output and provenance, and allocates in its arena, is taken back after.
 */
MesoStatus meso_seed_runs(MesoTool *tool, const MesoSeedList *list, MesoStatus (*run)(void *context, uint64_t seed),
                          void *context);

/*
 * What the product of a seed says of how it came to be: the command with --seed for --seeds, and `changes` [count],
 * of which those without a name are left out; at most 4. MESO_ERR_MEMORY.
 */
MesoStatus meso_seed_provenance(MesoTool *tool, uint64_t seed, const MesoOptionChange *changes, uint32_t count);

#endif
