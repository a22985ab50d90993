#include "formats/tiling/result/report_file.h"

#include <stdlib.h>
#include <string.h>

#include "formats/json/json_field.h"
#include "formats/json/json_text.h"
#include "libcore/base/bits.h"
#include "libcore/tiling/tile/tile_names.h"

static const char *const verdict_names[] = {
    [MESO_VERDICT_SOLVED] = "solved",
    [MESO_VERDICT_UNSOLVABLE] = "unsolvable",
    [MESO_VERDICT_GAVE_UP] = "gave-up",
};

static const char *const decider_names[] = {
    [MESO_DECIDER_PROPAGATION] = "propagation",
    [MESO_DECIDER_SEARCH] = "search",
    [MESO_DECIDER_COUNTING] = "counting",
    [MESO_DECIDER_PARITY] = "parity",
    [MESO_DECIDER_PROBING] = "probing",
    [MESO_DECIDER_EXACT] = "exact",
    [MESO_DECIDER_ATTEMPTS] = "attempts",
    [MESO_DECIDER_CONFLICTS] = "conflicts",
    [MESO_DECIDER_STOP] = "stop",
};

static const char *const budget_names[] = {
    [MESO_BUDGET_ATTEMPTS] = "attempts",
    [MESO_BUDGET_OBSERVATIONS] = "observations",
    [MESO_BUDGET_CONFLICTS] = "conflicts",
    [MESO_BUDGET_CUTS] = "cuts",
    [MESO_BUDGET_COUNTED] = "counted",
    [MESO_BUDGET_FORMULA] = "formula",
    [MESO_BUDGET_TIME] = "time",
};

enum { VERDICT_COUNT = sizeof verdict_names / sizeof *verdict_names };

/* Words of labels for all dead ends: 1 GiB. */
static const uint64_t label_words_limit = (uint64_t)1 << 27;

const char *meso_verdict_name(MesoVerdict verdict)
{
    return verdict_names[verdict];
}

bool meso_verdict_parse(const char *name, MesoVerdict *verdict)
{
    for (uint32_t v = 0; v < VERDICT_COUNT; v++)
        if (strcmp(name, verdict_names[v]) == 0) {
            *verdict = (MesoVerdict)v;
            return true;
        }
    return false;
}

const char *meso_decider_name(MesoDecider decider)
{
    return decider_names[decider];
}

/* --- writing --- */

static json_t *write_labels(const uint64_t *labels, const MesoTileSet *set)
{
    json_t *array = json_array();
    int failed = array == NULL;
    for (uint32_t code = 0; code < 2 * set->interface_count && !failed; code++)
        if (meso_bits_test(labels, code))
            failed |= json_array_append_new(array, json_sprintf("%s%s", set->interfaces[code / 2].name,
                                                                meso_code_mark(code)));
    if (!failed)
        return array;
    json_decref(array);
    return NULL;
}

static json_t *write_dead_end(const MesoDeadEnd *end, const MesoTileSet *set)
{
    json_t *sides = json_array();
    int failed = sides == NULL;
    for (uint32_t k = 0; k < 4 && !failed; k++)
        failed |= json_array_append_new(sides, json_pack("{sbso}", "border", end->border[k], "labels",
                                                         write_labels(end->labels[k], set)));
    if (!failed)
        return json_pack("{sIsIsbso}", "slot", (json_int_t)end->slot, "attempt", (json_int_t)end->attempt,
                         "initial", end->initial, "sides", sides);
    json_decref(sides);
    return NULL;
}

static json_t *write_dead_ends(const MesoSolveResult *result, const MesoTileSet *set)
{
    json_t *array = json_array();
    int failed = array == NULL;
    for (uint32_t d = 0; d < result->dead_end_count && !failed; d++)
        failed |= json_array_append_new(array, write_dead_end(&result->dead_ends[d], set));
    if (!failed)
        return array;
    json_decref(array);
    return NULL;
}

json_t *meso_report_histogram(const MesoAssignment *assignment, const MesoTileSet *set)
{
    json_t *object = json_object();
    uint32_t *counts = calloc(set->tile_count + (size_t)1, sizeof *counts);
    int failed = !object || !counts;
    for (uint32_t s = 0; s < assignment->slot_count && !failed; s++)
        counts[assignment->tile[s]]++;
    for (uint32_t t = 0; t < set->tile_count && !failed; t++)
        if (!set->tiles[t].ignored)
            failed |= json_object_set_new(object, set->tiles[t].name, json_integer(counts[t]));
    free(counts);
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}

/* `array` with `name` at its end; NULL when memory is out, or was. */
static json_t *append_name(json_t *array, const char *name)
{
    if (array && json_array_append_new(array, meso_json_string(name)) == 0)
        return array;
    json_decref(array);
    return NULL;
}

static json_t *write_core(const MesoConflictCore *core, const MesoTileSet *set, const MesoConstraints *constraints)
{
    json_t *slots = json_array(), *tiles = json_array(), *rules = json_array(), *names = json_array();
    int failed = slots == NULL;
    for (uint32_t i = 0; i < core->slot_count && !failed; i++)
        failed |= json_array_append_new(slots, json_integer(core->slots[i]));
    for (uint32_t i = 0; i < core->tile_count; i++)
        tiles = append_name(tiles, set->tiles[core->tiles[i]].name);
    for (uint32_t i = 0; i < core->rule_count; i++)
        if (i == 0 || core->rules[i].interface != core->rules[i - 1].interface)
            rules = append_name(rules, set->interfaces[core->rules[i].interface].name);
    for (uint32_t i = 0; i < core->constraint_count; i++)
        names = append_name(names, meso_constraint_name(constraints, core->constraints[i]));
    if (!failed && tiles && rules && names)
        return json_pack("{sbsosososo}", "minimal", core->minimal, "slots", slots, "tiles", tiles, "border_rules",
                         rules, "constraints", names);
    json_decref(slots);
    json_decref(tiles);
    json_decref(rules);
    json_decref(names);
    return NULL;
}

static json_t *write_hot_spots(const MesoSolveResult *result)
{
    json_t *array = json_array();
    int failed = array == NULL;
    for (uint32_t i = 0; i < result->hot_spot_count && !failed; i++)
        failed |= json_array_append_new(array, json_pack("{sIsI}", "slot", (json_int_t)result->hot_spots[i].slot,
                                                         "dead_ends", (json_int_t)result->hot_spots[i].dead_ends));
    if (!failed)
        return array;
    json_decref(array);
    return NULL;
}

/* What ended the work, and how far it came. */
static int write_limit(json_t *object, const MesoSolveResult *result)
{
    int failed = json_object_set_new(object, "budget", json_string(budget_names[result->budget]));
    failed |= json_object_set_new(object, "decided_at_best", json_integer(result->decided_most));
    if (result->conflict_limit)
        failed |= json_object_set_new(object, "conflicts", json_integer((json_int_t)result->conflicts));
    return failed;
}

MesoStatus meso_report_fill(json_t *object, const MesoSolveResult *result, const MesoTilingProblem *problem,
                            MesoError *error)
{
    const MesoTileSet *set = problem->set;
    int failed = json_object_set_new(object, "verdict", json_string(meso_verdict_name(result->verdict)));
    if (*result->reason)
        failed |= json_object_set_new(object, "reason", meso_json_string(result->reason));
    failed |= json_object_set_new(object, "decided_by", json_string(meso_decider_name(result->decider)));
    if (result->core.found)
        failed |= json_object_set_new(object, "core", write_core(&result->core, set, problem->constraints));
    if (result->verdict == MESO_VERDICT_GAVE_UP)
        failed |= write_limit(object, result);
    if (result->hot_spot_count > 0)
        failed |= json_object_set_new(object, "hot_spots", write_hot_spots(result));
    failed |= json_object_set_new(object, "attempts", json_integer(result->attempts));
    failed |= json_object_set_new(object, "observations", json_integer((json_int_t)result->observations));
    failed |= json_object_set_new(object, "jumps", json_integer((json_int_t)result->jumps));
    failed |= json_object_set_new(object, "repairs", json_integer((json_int_t)result->repairs));
    failed |= json_object_set_new(object, "slots", json_integer(problem->graph->slot_count));
    failed |= json_object_set_new(object, "variants", json_integer(problem->variants->count));
    if (result->verdict == MESO_VERDICT_SOLVED)
        failed |= json_object_set_new(object, "tiles", meso_report_histogram(&result->assignment, set));
    failed |= json_object_set_new(object, "dead_end_total",
                                  json_integer((json_int_t)result->dead_end_total));
    failed |= json_object_set_new(object, "dead_ends", write_dead_ends(result, set));
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for the report") : MESO_OK;
}

json_t *meso_report_strands(const MesoStrandStatistics *statistics)
{
    json_t *lengths = json_array();
    int failed = lengths == NULL;
    uint32_t count = MESO_STRAND_BUCKETS;
    while (count > 0 && statistics->lengths[count - 1] == 0)
        count--;
    for (uint32_t b = 0; b < count && !failed; b++)
        failed |= json_array_append_new(lengths, json_integer((json_int_t)statistics->lengths[b]));
    if (!failed)
        return json_pack("{sIsIsIsIsIsIso}", "count", (json_int_t)statistics->strand_count,
                         "loops", (json_int_t)statistics->loop_count,
                         "cyclic", (json_int_t)statistics->cyclic_count,
                         "sweeps", (json_int_t)statistics->link_count,
                         "shortest", (json_int_t)statistics->shortest,
                         "longest", (json_int_t)statistics->longest, "lengths", lengths);
    json_decref(lengths);
    return NULL;
}

/* Names of constraints are unique: each has its number in its list. */
static json_t *write_constraints(const MesoSolveResult *result, const MesoTilingProblem *problem)
{
    const MesoConstraints *constraints = problem->constraints;
    json_t *violations = json_object(), *object = json_object();
    int failed = !violations || !object;
    for (uint32_t i = 0; i < meso_constraint_count(constraints) && result->violations && !failed; i++)
        if (result->violations[i])
            failed |= json_object_set_new(violations, meso_constraint_name(constraints, i),
                                          json_integer((json_int_t)result->violations[i]));
    failed |= json_object_set_new(object, "backtracks", json_integer((json_int_t)result->backtracks));
    failed |= json_object_set_new(object, "violations", violations);
    if (!failed && constraints->keep && result->verdict == MESO_VERDICT_SOLVED) {
        uint32_t wanted = 0, slots = result->assignment.slot_count;
        for (uint32_t s = 0; s < slots; s++)
            wanted += constraints->keep[s] != MESO_NO_INDEX;
        uint32_t changed = meso_constraints_changed(constraints, &result->assignment, problem->variants);
        failed |= json_object_set_new(object, "kept", json_integer(wanted - changed));
        failed |= json_object_set_new(object, "changed", json_integer(slots - wanted + changed));
        failed |= json_object_set_new(object, "fewest", json_boolean(result->changes_fewest));
    }
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}

MesoStatus meso_report_fill_control(json_t *object, const MesoSolveResult *result, const MesoTilingProblem *problem,
                                    MesoError *error)
{
    int failed = 0;
    if (problem->constraints)
        failed |= json_object_set_new(object, "constraints", write_constraints(result, problem));
    if (result->verdict == MESO_VERDICT_SOLVED) {
        MesoStrandStatistics statistics;
        MesoStatus status = meso_strands_count(&statistics, &result->assignment, problem->set, problem->graph, error);
        if (status)
            return status;
        failed |= json_object_set_new(object, "strands", meso_report_strands(&statistics));
    }
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for the report") : MESO_OK;
}

json_t *meso_report_to_json(const json_t *content, const MesoProvenance *provenance)
{
    json_t *root = json_object();
    int failed = json_object_set_new(root, "format", json_string("meso-report"));
    failed |= json_object_set_new(root, "version", json_integer(MESO_REPORT_VERSION));
    failed |= json_object_set_new(root, "tool", json_string(provenance->tool));
    /* Jansson takes no const here, and changes but the count of references. */
    failed |= json_object_update(root, (json_t *)(uintptr_t)content);
    failed |= json_object_set_new(root, "provenance", meso_provenance_json(provenance));
    if (!failed)
        return root;
    json_decref(root);
    return NULL;
}

/* --- reading --- */

typedef struct Binder {
    MesoTileNames names;
    uint32_t label_words;
    uint64_t *labels;               /* [4 * label_words] of the next dead end */
} Binder;

static void read_label(const Binder *binder, const MesoJsonField *field, uint64_t *labels)
{
    if (!json_is_string(field->value)) {
        meso_json_wrong(field, "the name of an interface is needed, like \"a\" or \"a'\"");
        return;
    }
    const char *text = json_string_value(field->value);
    size_t length = json_string_length(field->value);
    int32_t label = meso_label_find(&binder->names.interfaces, text, length);
    if (!label)
        meso_json_wrong(field, "unknown interface '%.80s'; the tile set has no such one", text);
    else
        meso_bits_set(labels, meso_label_code(label));
}

static void read_side(const Binder *binder, const MesoJsonField *field, MesoDeadEnd *end, uint32_t side)
{
    MesoJsonField border = meso_json_key(field, "border"), labels = meso_json_key(field, "labels");
    meso_json_object(field, NULL);
    meso_json_require(&border);
    meso_json_require(&labels);
    end->border[side] = meso_json_bool(&border, false);
    end->labels[side] = binder->labels + (size_t)side * binder->label_words;
    uint32_t count = meso_json_count(&labels, 0, UINT32_MAX);
    for (uint32_t i = 0; i < count && meso_json_good(field); i++) {
        MesoJsonField label = meso_json_item(&labels, i);
        read_label(binder, &label, end->labels[side]);
    }
}

static uint64_t read_number(const MesoJsonField *object, const char *key, int64_t high)
{
    MesoJsonField field = meso_json_key(object, key);
    meso_json_require(&field);
    return (uint64_t)meso_json_whole(&field, 0, high, 0);
}

static void read_dead_end(Binder *binder, const MesoJsonField *field, MesoDeadEnd *end)
{
    MesoJsonField initial = meso_json_key(field, "initial"), sides = meso_json_key(field, "sides");
    meso_json_object(field, NULL);
    meso_json_require(&initial);
    end->slot = (uint32_t)read_number(field, "slot", UINT32_MAX);
    end->attempt = (uint32_t)read_number(field, "attempt", UINT32_MAX);
    end->initial = meso_json_bool(&initial, false);
    if (meso_json_good(field) && meso_json_count(&sides, 4, 4) != 4)
        meso_json_wrong(&sides, "4 sides are needed");
    for (uint32_t k = 0; k < 4 && meso_json_good(field); k++) {
        MesoJsonField side = meso_json_item(&sides, k);
        read_side(binder, &side, end, k);
    }
    binder->labels += 4 * (size_t)binder->label_words;
}

static MesoStatus read_dead_ends(MesoReport *report, MesoJsonReader *reader, const MesoTileSet *set,
                                 const MesoJsonField *root)
{
    MesoJsonField ends = meso_json_key(root, "dead_ends");
    meso_json_require(&ends);
    uint32_t count = meso_json_count(&ends, 0, UINT32_MAX);
    Binder binder = {.label_words = meso_bits_words(2 * set->interface_count)};
    if (reader->status || meso_tile_names_init(&binder.names, reader->arena, set, reader->error))
        return reader->status ? reader->status : MESO_ERR_MEMORY;
    uint64_t words = 4 * (uint64_t)binder.label_words * count;
    if (words > label_words_limit)
        return meso_fail(reader->error, MESO_ERR_LIMIT, "%s: too many dead ends for so many interfaces: "
                         "%u, %u", reader->path, count, set->interface_count);

    report->dead_ends = MESO_NEW(reader->arena, MesoDeadEnd, count, reader->error);
    binder.labels = MESO_NEW(reader->arena, uint64_t, words, reader->error);
    if (!report->dead_ends || !binder.labels)
        return MESO_ERR_MEMORY;
    report->dead_end_count = count;
    for (uint32_t d = 0; d < count && !reader->status; d++) {
        MesoJsonField end = meso_json_item(&ends, d);
        read_dead_end(&binder, &end, &report->dead_ends[d]);
    }
    return reader->status;
}

static void read_verdict(MesoReport *report, const MesoJsonField *root)
{
    MesoJsonField field = meso_json_key(root, "verdict");
    if (!field.value) {
        meso_json_wrong(root, "no verdict: not a report of a solver");
        return;
    }
    const char *name = meso_json_text(&field);
    if (!meso_verdict_parse(name, &report->verdict))
        meso_json_wrong(&field, "\"%.40s\"; \"solved\", \"unsolvable\" and \"gave-up\" are possible", name);
}

/* The tile set among the inputs in the provenance, where there is one. */
static void read_tiles_hash(MesoReport *report, const json_t *root)
{
    size_t index;
    json_t *input;
    json_array_foreach(json_object_get(json_object_get(root, "provenance"), "inputs"), index, input) {
        const char *role = json_string_value(json_object_get(input, "role"));
        const char *hash = json_string_value(json_object_get(input, "xxh3_128"));
        if (role && hash && strcmp(role, "tiles") == 0 && strlen(hash) < sizeof report->tiles_hash) {
            strcpy(report->tiles_hash, hash);
            return;
        }
    }
}

MesoStatus meso_report_read(MesoReport *report, MesoArena *arena, const MesoInput *input,
                            const MesoTileSet *set, MesoError *error)
{
    json_t *json;
    *report = (MesoReport){0};
    MesoStatus status = meso_json_parse(&json, input, error);
    if (!status)
        status = meso_json_check_format(json, input->path, "meso-report", MESO_REPORT_VERSION, error);
    if (!status) {
        MesoJsonReader reader = {.path = input->path, .arena = arena, .error = error};
        MesoJsonField root = meso_json_root(&reader, json);
        read_tiles_hash(report, json);
        read_verdict(report, &root);
        report->attempts = (uint32_t)read_number(&root, "attempts", UINT32_MAX);
        report->observations = read_number(&root, "observations", INT64_MAX);
        report->slot_count = (uint32_t)read_number(&root, "slots", UINT32_MAX);
        report->variant_count = (uint32_t)read_number(&root, "variants", UINT32_MAX);
        report->dead_end_total = read_number(&root, "dead_end_total", INT64_MAX);
        status = read_dead_ends(report, &reader, set, &root);
    }
    json_decref(json);
    return status;
}
