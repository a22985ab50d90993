#include "formats/tiling/result/seed_lines.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "formats/json/json_field.h"
#include "formats/json/json_text.h"
#include "formats/tiling/result/report_file.h"

/* ---- hashes ---- */

/* Hash of `hash` and the hash of the data, 16 bytes each. */
static void fold(uint64_t hash[2], const void *data, size_t size)
{
    XXH128_hash_t own = XXH3_128bits(data, size);
    const uint64_t both[4] = {hash[0], hash[1], own.high64, own.low64};
    XXH128_hash_t folded = XXH3_128bits(both, sizeof both);
    hash[0] = folded.high64;
    hash[1] = folded.low64;
}

static bool turns_any(const uint8_t *quarters, uint32_t slot_count)
{
    for (uint32_t s = 0; quarters && s < slot_count; s++)
        if (quarters[s])
            return true;
    return false;
}

void meso_seed_problem(uint64_t problem[2], const MesoProvenance *provenance, const uint8_t *quarters,
                       uint32_t slot_count, const char *options)
{
    problem[0] = problem[1] = 0;
    for (uint32_t i = 0; i < provenance->input_count; i++) {
        fold(problem, provenance->inputs[i].role, strlen(provenance->inputs[i].role));
        fold(problem, provenance->inputs[i].hash, sizeof provenance->inputs[i].hash);
    }
    /* The file's order is the same problem, asked for or not. */
    if (turns_any(quarters, slot_count))
        fold(problem, quarters, slot_count);
    fold(problem, options, strlen(options));
}

void meso_assignment_hash(uint64_t hash[2], const MesoAssignment *assignment)
{
    hash[0] = hash[1] = 0;
    fold(hash, assignment->tile, assignment->slot_count * sizeof *assignment->tile);
    fold(hash, assignment->transform, assignment->slot_count * sizeof *assignment->transform);
}

static json_t *hash_json(const uint64_t hash[2])
{
    return json_sprintf("%016" PRIx64 "%016" PRIx64, hash[0], hash[1]);
}

/* ---- writing ---- */

static void add_square(MesoSeedLine *line, uint64_t count)
{
    line->tile_squares += count * count;
}

static int put_assignment(json_t *object, MesoSeedLine *line, const MesoAssignment *assignment, const MesoTileSet *set,
                          const MesoStrandStatistics *strands)
{
    json_t *tiles = meso_report_histogram(assignment, set), *count;
    const char *name;
    meso_assignment_hash(line->assignment, assignment);
    json_object_foreach(tiles, name, count)
        add_square(line, (uint64_t)json_integer_value(count));
    int failed = json_object_set_new(object, "tiles", tiles);
    failed |= json_object_set_new(object, "strands", meso_report_strands(strands));
    line->strand_count = strands->strand_count;
    line->loop_count = strands->loop_count;
    return failed | json_object_set_new(object, "assignment", hash_json(line->assignment));
}

MesoStatus meso_seed_line_make(MesoSeedLine *line, MesoArena *arena, uint64_t seed, const uint64_t problem[2],
                               const MesoSolveResult *result, const MesoTileSet *set, const MesoSlotGraph *graph,
                               MesoError *error)
{
    MesoStrandStatistics strands;
    bool solved = result->verdict == MESO_VERDICT_SOLVED;
    MesoStatus status = solved ? meso_strands_count(&strands, &result->assignment, set, graph, error) : MESO_OK;
    if (status)
        return status;
    *line = (MesoSeedLine){.seed = seed, .verdict = result->verdict, .attempts = result->attempts,
                           .observations = result->observations, .problem = {problem[0], problem[1]}};
    json_t *object = json_pack("{sIsssssIsIsI}", "seed", (json_int_t)seed, "verdict", meso_verdict_name(line->verdict),
                               "decider", meso_decider_name(result->decider), "attempts", (json_int_t)line->attempts, "observations", (json_int_t)line->observations,
                               "dead_ends", (json_int_t)result->dead_end_total);
    int failed = object == NULL;
    if (solved)
        failed |= put_assignment(object, line, &result->assignment, set, &strands);
    failed |= json_object_set_new(object, "problem", hash_json(problem));
    char *text = failed ? NULL : json_dumps(object, JSON_COMPACT);
    json_decref(object);
    if (!text)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the line of seed %" PRIu64, seed);
    line->text = meso_arena_copy_text(arena, text, error);
    free(text);
    return line->text ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- reading ---- */

static void read_hash(uint64_t hash[2], const MesoJsonField *field)
{
    meso_json_require(field);
    if (!meso_json_good(field))
        return;
    const char *text = meso_json_text(field);
    if (strlen(text) != 32 || strspn(text, "0123456789abcdef") != 32) {
        meso_json_wrong(field, "32 hexadecimal digits are needed");
        return;
    }
    char high[17] = "";
    memcpy(high, text, 16);
    hash[0] = strtoull(high, NULL, 16);
    hash[1] = strtoull(text + 16, NULL, 16);
}

static uint64_t read_count(const MesoJsonField *object, const char *key, int64_t high)
{
    MesoJsonField field = meso_json_key(object, key);
    meso_json_require(&field);
    return (uint64_t)meso_json_whole(&field, 0, high, 0);
}

static void read_assignment(MesoSeedLine *line, const MesoJsonField *root)
{
    MesoJsonField hash = meso_json_key(root, "assignment"), tiles = meso_json_key(root, "tiles");
    MesoJsonField strands = meso_json_key(root, "strands");
    void *iterator;
    read_hash(line->assignment, &hash);
    meso_json_object(&strands, NULL);
    line->strand_count = read_count(&strands, "count", INT64_MAX);
    line->loop_count = read_count(&strands, "loops", INT64_MAX);
    meso_json_require(&tiles);
    if (!meso_json_good(root) || !meso_json_object(&tiles, NULL))
        return;
    json_t *counts = json_object_get(root->value, "tiles");
    for (iterator = json_object_iter(counts); iterator; iterator = json_object_iter_next(counts, iterator)) {
        MesoJsonField count = meso_json_key(&tiles, json_object_iter_key(iterator));
        add_square(line, (uint64_t)meso_json_whole(&count, 0, UINT32_MAX, 0));
    }
}

/* The problems whose lines are taken. */
typedef struct Problems {
    const uint64_t (*hashes)[2];
    uint32_t count;             /* 0: all */
} Problems;

static bool is_among(const Problems *problems, const uint64_t problem[2])
{
    for (uint32_t i = 0; i < problems->count; i++)
        if (problems->hashes[i][0] == problem[0] && problems->hashes[i][1] == problem[1])
            return true;
    return problems->count == 0;
}

static void read_fields(MesoSeedLine *line, const MesoJsonField *root, const Problems *problems)
{
    MesoJsonField verdict = meso_json_key(root, "verdict"), of = meso_json_key(root, "problem");
    meso_json_object(root, NULL);
    line->seed = read_count(root, "seed", INT64_MAX);
    line->attempts = (uint32_t)read_count(root, "attempts", UINT32_MAX);
    line->observations = read_count(root, "observations", INT64_MAX);
    meso_json_require(&verdict);
    if (meso_json_good(root) && !meso_verdict_parse(meso_json_text(&verdict), &line->verdict))
        meso_json_wrong(&verdict, "no verdict that is known");
    if (meso_json_good(root) && line->verdict == MESO_VERDICT_SOLVED)
        read_assignment(line, root);
    read_hash(line->problem, &of);
    if (meso_json_good(root) && !is_among(problems, line->problem))
        meso_json_wrong(&of, "the line is of another problem: of other inputs or options");
}

static MesoStatus read_line(MesoSeedLine *line, MesoArena *arena, const char *text, size_t size, const char *path,
                            uint64_t number, const Problems *problems, MesoError *error)
{
    json_t *json;
    char place[400];
    *line = (MesoSeedLine){0};
    snprintf(place, sizeof place, "%.360s:%" PRIu64, path, number);
    MesoStatus status = meso_json_parse_line(&json, path, number, text, size, error);
    if (status)
        return status;
    MesoJsonReader reader = {.path = place, .arena = arena, .error = error};
    MesoJsonField root = meso_json_root(&reader, json);
    read_fields(line, &root, problems);
    json_decref(json);
    if (reader.status)
        return reader.status;
    char *copy = MESO_NEW(arena, char, size + 1, error);
    if (!copy)
        return MESO_ERR_MEMORY;
    memcpy(copy, text, size);
    line->text = copy;
    return MESO_OK;
}

static int compare_lines(const void *a, const void *b)
{
    const MesoSeedLine *first = a, *second = b;
    if (first->seed != second->seed)
        return first->seed < second->seed ? -1 : 1;
    return strcmp(first->text, second->text);
}

static MesoStatus unite(MesoSeedLine *lines, uint32_t *count, const char *path, MesoError *error)
{
    uint32_t kept = 0;
    qsort(lines, *count, sizeof *lines, compare_lines);
    for (uint32_t i = 0; i < *count; i++) {
        if (kept && lines[kept - 1].seed == lines[i].seed) {
            if (strcmp(lines[kept - 1].text, lines[i].text) != 0)
                return meso_fail(error, MESO_ERR_INPUT, "%s: seed %" PRIu64 " has two lines that differ", path,
                                 lines[i].seed);
            continue;
        }
        lines[kept++] = lines[i];
    }
    *count = kept;
    return MESO_OK;
}

static bool is_blank(const char *text, size_t size)
{
    size_t i = 0;
    while (i < size && strchr(" \t\r", text[i]) && text[i])
        i++;
    return i == size;
}

MesoStatus meso_seed_lines_read(MesoSeedLine **lines, uint32_t *count, MesoArena *arena, const MesoInput *input,
                                const uint64_t (*problems)[2], uint32_t problem_count, MesoError *error)
{
    const Problems taken = {problems, problem_count};
    const char *text = (const char *)input->data, *end = text + input->size;
    uint64_t room = 0, number = 0;
    for (const char *c = text; c < end && (c = memchr(c, '\n', (size_t)(end - c))); c++)
        room++;
    *count = 0;
    if (room > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "%s: more than %u lines", input->path, UINT32_MAX);
    *lines = MESO_NEW(arena, MesoSeedLine, room, error);
    if (!*lines)
        return MESO_ERR_MEMORY;
    for (const char *stop; text < end && (stop = memchr(text, '\n', (size_t)(end - text))); text = stop + 1) {
        size_t size = (size_t)(stop - text);
        while (size && text[size - 1] == '\r')
            size--;
        number++;
        if (is_blank(text, size))
            continue;
        MesoStatus status = read_line(&(*lines)[(*count)++], arena, text, size, input->path, number, &taken, error);
        if (status)
            return status;
    }
    return unite(*lines, count, input->path, error);
}
