#include "cmd/common/seed_list.h"

#include <assert.h>
#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/tiling/result/seed_lines.h"

/* Digits at `*text`, which goes past them; false where there are none, or too large a number. */
static bool take_number(const char **text, uint64_t most, uint64_t *number)
{
    *number = 0;
    if (!isdigit((unsigned char)**text))
        return false;
    for (; isdigit((unsigned char)**text); ++*text) {
        uint64_t digit = (uint64_t)(**text - '0');
        if (*number > (most - digit) / 10)
            return false;
        *number = 10 * *number + digit;
    }
    return true;
}

/* One part at `text`, which ends at a comma or with the text. */
static MesoStatus parse_range(MesoSeedRange *range, const char *text, MesoError *error)
{
    const char *at = text;
    uint64_t last, attempts = 0;
    bool good = take_number(&at, MESO_SEED_LIMIT, &range->first);
    last = range->first;
    if (good && *at == '-')
        good = at++ && take_number(&at, MESO_SEED_LIMIT, &last);
    if (good && *at == 'x')
        good = at++ && take_number(&at, 1000000000, &attempts) && attempts > 0;
    int length = (int)strcspn(text, ",");
    if (!good || at != text + length || last < range->first)
        return meso_fail(error, MESO_ERR_USAGE, "--seeds: '%.*s' is not A, A-B or A-BxK, with seeds from A to B and K "
                         "attempts each, like 1-1000x2 (several have commas between)", length, text);
    if (last - range->first >= MESO_MOST_SEEDS)
        return meso_fail(error, MESO_ERR_USAGE, "--seeds: %.*s are over %d seeds; do them in parts", length, text,
                         MESO_MOST_SEEDS);
    range->count = (uint32_t)(last - range->first) + 1;
    range->attempts = (uint32_t)attempts;
    return MESO_OK;
}

static int compare_ranges(const void *a, const void *b)
{
    uint64_t first = ((const MesoSeedRange *)a)->first, second = ((const MesoSeedRange *)b)->first;
    return (first > second) - (first < second);
}

static MesoStatus number_ranges(MesoSeedList *list, MesoError *error)
{
    for (uint32_t i = 0; i < list->range_count; i++) {
        MesoSeedRange *range = &list->ranges[i];
        const MesoSeedRange *before = i ? range - 1 : NULL;
        if (before && range->first - before->first < before->count)
            return meso_fail(error, MESO_ERR_USAGE, "--seeds: seed %" PRIu64 " is named twice", range->first);
        if (range->count > MESO_MOST_SEEDS - list->seed_count)
            return meso_fail(error, MESO_ERR_USAGE, "--seeds: over %d seeds; do them in parts", MESO_MOST_SEEDS);
        range->begin = list->seed_count;
        list->seed_count += range->count;
    }
    return MESO_OK;
}

MesoStatus meso_seed_list_parse(MesoSeedList *list, MesoArena *arena, const char *text, MesoError *error)
{
    size_t room = 1;
    for (const char *c = text; *c; c++)
        room += *c == ',';
    *list = (MesoSeedList){.ranges = MESO_NEW(arena, MesoSeedRange, room, error)};
    if (!list->ranges)
        return MESO_ERR_MEMORY;
    for (; list->range_count < room; text += strcspn(text, ",") + 1) {
        MesoStatus status = parse_range(&list->ranges[list->range_count++], text, error);
        if (status)
            return status;
    }
    qsort(list->ranges, list->range_count, sizeof *list->ranges, compare_ranges);
    return number_ranges(list, error);
}

const MesoSeedRange *meso_seed_list_find(const MesoSeedList *list, uint64_t seed)
{
    uint32_t low = 0, high = list->range_count;     /* the last range that begins at or below `seed` is before `high` */
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (list->ranges[middle].first <= seed)
            low = middle + 1;
        else
            high = middle;
    }
    const MesoSeedRange *range = low ? &list->ranges[low - 1] : NULL;
    return range && seed - range->first < range->count ? range : NULL;
}

uint32_t meso_seed_list_index(const MesoSeedList *list, uint64_t seed)
{
    const MesoSeedRange *range = meso_seed_list_find(list, seed);
    assert(range);
    return range->begin + (uint32_t)(seed - range->first);
}

bool meso_seed_path_is_pattern(const char *text)
{
    int seeds = 0;
    for (; *text; text++)
        if (*text == '%') {
            text++;
            seeds += *text == 'd';
            if (*text != 'd' && *text != '%')
                return false;
        }
    return seeds == 1;
}

char *meso_seed_path(const char *pattern, uint64_t seed, MesoArena *arena, MesoError *error)
{
    char *path = meso_arena_copy_text(arena, "", error);
    for (const char *next; path && *pattern; pattern = next) {
        next = pattern + strcspn(pattern, "%");
        path = meso_arena_print(arena, error, "%s%.*s", path, (int)(next - pattern), pattern);
        if (!*next)
            break;
        if (path && next[1] == 'd')
            path = meso_arena_print(arena, error, "%s%" PRIu64, path, seed);
        else if (path)
            path = meso_arena_print(arena, error, "%s%%", path);
        next += 2;
    }
    return path;
}

/* ---- runs ---- */

MesoStatus meso_seed_runs(MesoTool *tool, const MesoSeedList *list, MesoStatus (*run)(void *context, uint64_t seed),
                          void *context)
{
    const MesoProvenance provenance = tool->provenance;
    const char *output = tool->output;
    json_t *whole = tool->report, *seeds = json_array();
    MesoStatus status = MESO_OK;
    for (uint32_t r = 0; r < list->range_count && !status; r++)
        for (uint32_t i = 0; i < list->ranges[r].count && !status; i++) {
            uint64_t seed = list->ranges[r].first + i;
            MesoArenaMark mark = meso_arena_mark(&tool->arena);
            tool->report = json_object();
            json_object_set_new(tool->report, "seed", json_integer((json_int_t)seed));
            status = run(context, seed);
            json_array_append_new(seeds, tool->report);
            tool->report = whole;
            tool->output = output;
            meso_arena_rewind(&tool->arena, mark);
        }
    tool->provenance = provenance;
    json_object_set_new(whole, "seeds", seeds);
    return status;
}

MesoStatus meso_seed_provenance(MesoTool *tool, uint64_t seed, const MesoOptionChange *changes, uint32_t count)
{
    char number[32];
    snprintf(number, sizeof number, "%" PRIu64, seed);
    MesoOptionChange all[7] = {{"seeds", NULL}, {"seed", number}};
    assert(count <= 4);
    for (uint32_t i = 0, n = 2; i < count; i++)
        if (changes[i].name)
            all[n++] = changes[i];
    tool->provenance.seed = seed;
    tool->provenance.command_line = meso_tool_command(tool, all, &tool->arena, &tool->error);
    return tool->provenance.command_line ? MESO_OK : MESO_ERR_MEMORY;
}
