#include "cmd/solve/solve_each.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cmd/common/seed_list.h"
#include "formats/file/output.h"
#include "formats/tiling/result/slots_file.h"

/*
 * The command that writes the assignment of this seed alone, whatever shard it is of: with
 * --seed, the attempts where --seeds gave them, and what else was given.
 */
static char *single_command(const MesoSeedEach *each, uint64_t seed, const char *path, MesoArena *arena,
                            MesoError *error)
{
    char number[32], attempts[32];
    snprintf(number, sizeof number, "%" PRIu64, seed);
    uint32_t most = meso_seed_list_find(each->list, seed)->attempts;
    snprintf(attempts, sizeof attempts, "%" PRIu32, most);
    const MesoOptionChange changes[] = {
        {"seeds", NULL}, {"each", NULL}, {"resume", NULL}, {"best", NULL}, {"seed", number}, {"output", path},
        {most ? "attempts" : NULL, attempts}, {NULL, NULL},
    };
    return meso_tool_command(each->tool, changes, arena, error);
}

/* Of the assignment of this seed alone; NULL when memory is out. */
static const MesoProvenance *single_provenance(const MesoSeedEach *each, uint64_t seed, const char *path,
                                               MesoArena *arena, MesoError *error)
{
    MesoProvenance *provenance = MESO_NEW(arena, MesoProvenance, 1, error);
    if (!provenance)
        return NULL;
    *provenance = each->tool->provenance;
    provenance->seed = seed;
    provenance->command_line = single_command(each, seed, path, arena, error);
    return provenance->command_line ? provenance : NULL;
}

MesoStatus meso_each_write_to(const MesoSeedEach *each, uint64_t seed, const MesoAssignment *assignment,
                              const char *path, MesoArena *arena, MesoError *error)
{
    const MesoSeedProblem *p = each->problem;
    const MesoProvenance *provenance = single_provenance(each, seed, path, arena, error);
    MesoOutput *output = NULL;
    MesoStatus status = provenance ? meso_output_open(&output, path, error) : MESO_ERR_MEMORY;
    if (!status)
        status = meso_slots_write(assignment, p->tiling->set, p->surface->quarters, p->surface->over,
                                  p->tiles_hash, p->surface->hash, provenance, output, error);
    return meso_output_finish(output, status, error);
}

MesoStatus meso_each_write(const MesoSeedEach *each, uint64_t seed, const MesoAssignment *assignment, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    const char *path = meso_seed_path(each->pattern, seed, &arena, error);
    MesoStatus status = path ? meso_each_write_to(each, seed, assignment, path, &arena, error) : MESO_ERR_MEMORY;
    meso_arena_release(&arena);
    return status;
}

/* Whether the file is, to the last byte that tells of it, what would be written for this line. */
static bool is_assignment(const MesoSeedEach *each, const MesoSeedLine *line, const MesoSlotsFile *slots,
                          const char *provenance)
{
    const MesoSeedProblem *p = each->problem;
    uint64_t hash[2];
    meso_assignment_hash(hash, &slots->assignment);
    return memcmp(hash, line->assignment, sizeof hash) == 0 && strcmp(slots->provenance, provenance) == 0 &&
           memcmp(slots->tiles_hash, p->tiles_hash, sizeof slots->tiles_hash) == 0 &&
           memcmp(slots->surface_hash, p->surface->hash, sizeof slots->surface_hash) == 0;
}

/* The problem of the line holds what else the file depends on: a whole file is all that is to be asked for. */
MesoStatus meso_each_find(bool *there, const MesoSeedEach *each, const MesoSeedLine *line, MesoArena *arena,
                          MesoError *error)
{
    MesoInput input;
    MesoSlotsFile slots;
    const char *path = meso_seed_path(each->pattern, line->seed, arena, error);
    *there = false;
    if (!path)
        return MESO_ERR_MEMORY;
    if (access(path, F_OK) != 0 || meso_input_open(&input, path, NULL))
        return MESO_OK;
    MesoStatus status = meso_slots_read(&slots, arena, &input, NULL);
    meso_input_close(&input);
    if (status)
        return status == MESO_ERR_MEMORY ? meso_fail(error, status, "out of memory for '%s'", path) : MESO_OK;
    const MesoProvenance *provenance = single_provenance(each, line->seed, path, arena, error);
    const char *text = provenance ? meso_provenance_text(provenance, arena, error) : NULL;
    *there = text && is_assignment(each, line, &slots, text);
    return text ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- paths ---- */

typedef struct SeedKey {
    MesoFileKey key;
    uint64_t seed;
} SeedKey;

static int compare_keys(const void *a, const void *b)
{
    int order = memcmp(&((const SeedKey *)a)->key, &((const SeedKey *)b)->key, sizeof(MesoFileKey));
    return order ? order : ((const SeedKey *)a)->seed < ((const SeedKey *)b)->seed ? -1 : 1;
}

/* `keys` [count] are in order: files of two seeds that are one file are neighbours. */
static MesoStatus refuse_twins(const MesoSeedEach *each, const SeedKey *keys, uint32_t count, MesoError *error)
{
    for (uint32_t i = 1; i < count; i++)
        if (memcmp(&keys[i - 1].key, &keys[i].key, sizeof keys[i].key) == 0)
            return meso_fail(error, MESO_ERR_USAGE, "--each '%s' names one file for the seeds %" PRIu64 " and %" PRIu64
                             ", and one would be lost: name another file", each->pattern, keys[i - 1].seed,
                             keys[i].seed);
    return MESO_OK;
}

static MesoStatus add_keys(const MesoSeedEach *each, const MesoSeedRange *range, SeedKey *keys, uint32_t *used,
                           MesoError *error)
{
    MesoTool *tool = each->tool;
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < range->count && !status; i++) {
        MesoArenaMark before = meso_arena_mark(&tool->arena);
        const char *path = meso_seed_path(each->pattern, range->first + i, &tool->arena, error);
        if (!path)
            return MESO_ERR_MEMORY;
        keys[*used].seed = range->first + i;
        *used += meso_path_key(&keys[*used].key, path, true);
        status = meso_tool_check_output(tool, "--each", path);
        meso_arena_rewind(&tool->arena, before);
    }
    return status;
}

MesoStatus meso_each_check_paths(const MesoSeedEach *each, MesoError *error)
{
    MesoArena *arena = &each->tool->arena;
    const MesoSeedList *list = each->list;
    MesoStatus status = MESO_OK;
    uint32_t used = 0;
    MesoArenaMark mark = meso_arena_mark(arena);
    SeedKey *keys = MESO_NEW(arena, SeedKey, list->seed_count, error);
    if (!keys)
        return MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < list->range_count && !status; r++)
        status = add_keys(each, &list->ranges[r], keys, &used, error);
    qsort(keys, used, sizeof *keys, compare_keys);
    if (!status)
        status = refuse_twins(each, keys, used, error);
    meso_arena_rewind(arena, mark);
    return status;
}
