/* Reports: what is written reads back, by name; what is wrong is named. */
#include "formats/tiling/result/report_file.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/tiling/fixture/solve_fixture.h"
#include "libcore/tiling/solve/explain.h"

static char *text_of(const json_t *json)
{
    char *text = json_dumps(json, JSON_COMPACT);
    CHECK(text);
    return text;
}

static MesoStatus read_text(MesoReport *report, MesoArena *arena, const char *text, size_t size,
                            const MesoTileSet *set, MesoError *error)
{
    MesoInput input;
    meso_input_wrap(&input, "r.json", text, size);
    return meso_report_read(report, arena, &input, set, error);
}

/* A row of three slots whose middle has no tile (see solve_test.c), as text. */
static char *unsolvable_report(MesoArena *arena, MesoTileSet *set, MesoSolveResult *result)
{
    static const int32_t labels[2][4] = {{2, 1, 3, 1}, {3, 1, 1, 1}};
    MesoError error;
    MesoVariantSet variants;
    *set = fixture_set(arena, 3, 2, labels, false, false, false);
    set->interfaces[2].border_only = true;
    MesoSlotGraph graph = fixture_grid(arena, 3, 1, false, false, false);
    *result = fixture_solve(arena, set, &graph, 0, 5);
    CHECK(result->verdict == MESO_VERDICT_UNSOLVABLE);
    CHECK(meso_variant_set_build(&variants, arena, set, &error) == MESO_OK);

    MesoProvenance provenance = {.tool = "meso-solve", .command_line = "meso-solve x"};
    json_t *content = json_object();
    CHECK(meso_report_fill(content, result, &(MesoTilingProblem){set, &variants, &graph, NULL}, &error) == MESO_OK);
    json_t *json = meso_report_to_json(content, &provenance);
    CHECK(json);
    char *text = text_of(json);
    json_decref(json);
    json_decref(content);
    return text;
}

static void test_text(void)
{
    static const char *const expected =
        "{\"format\":\"meso-report\",\"version\":1,\"tool\":\"meso-solve\",\"verdict\":\"unsolvable\","
        "\"decided_by\":\"propagation\",\"attempts\":0,\"observations\":0,\"jumps\":0,\"repairs\":0,\"slots\":3,\"variants\":2,\"dead_end_total\":1,"
        "\"dead_ends\":[{\"slot\":1,\"attempt\":0,\"initial\":true,\"sides\":["
        "{\"border\":false,\"labels\":[\"a'\"]},"
        "{\"border\":true,\"labels\":[\"a\",\"a'\",\"b\",\"b'\",\"c\",\"c'\"]},"
        "{\"border\":false,\"labels\":[\"b'\"]},"
        "{\"border\":true,\"labels\":[\"a\",\"a'\",\"b\",\"b'\",\"c\",\"c'\"]}]}],"
        "\"provenance\":";
    MesoArena arena;
    MesoTileSet set;
    MesoSolveResult result;
    meso_arena_init(&arena);
    char *text = unsolvable_report(&arena, &set, &result);
    CHECK(strncmp(text, expected, strlen(expected)) == 0);
    free(text);
    meso_arena_release(&arena);
}

static void test_round_trip(void)
{
    MesoArena arena;
    MesoError error;
    MesoTileSet set;
    MesoSolveResult result;
    MesoReport report;
    meso_arena_init(&arena);
    char *text = unsolvable_report(&arena, &set, &result);

    CHECK(read_text(&report, &arena, text, strlen(text), &set, &error) == MESO_OK);
    CHECK(report.verdict == MESO_VERDICT_UNSOLVABLE && report.attempts == 0);
    CHECK(report.slot_count == 3 && report.variant_count == 2 && report.observations == 0);
    CHECK(report.dead_end_count == 1 && report.dead_end_total == 1);
    CHECK(report.dead_ends[0].slot == 1 && report.dead_ends[0].initial);
    for (uint32_t k = 0; k < 4; k++) {
        CHECK(report.dead_ends[0].border[k] == result.dead_ends[0].border[k]);
        CHECK(report.dead_ends[0].labels[k][0] == result.dead_ends[0].labels[k][0]);
    }

    /* Another order of the interfaces: names count. */
    MesoInterface swapped = set.interfaces[0];
    set.interfaces[0] = set.interfaces[2];
    set.interfaces[2] = swapped;
    CHECK(read_text(&report, &arena, text, strlen(text), &set, &error) == MESO_OK);
    CHECK(report.dead_ends[0].labels[0][0] == (uint64_t)1 << 5);

    set.interface_count = 2;
    CHECK(read_text(&report, &arena, text, strlen(text), &set, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "r.json: dead_ends[0].sides[0].labels[0]: unknown interface 'a'"));

    /* Every truncation is noticed. */
    set.interface_count = 3;
    for (size_t size = 0; size < strlen(text); size++)
        CHECK(read_text(&report, &arena, text, size, &set, &error) == MESO_ERR_INPUT);
    free(text);
    meso_arena_release(&arena);
}

static void test_solved(void)
{
    static const int32_t labels[2][4] = {{1, 1, -1, -1}, {1, 2, -1, -1}};
    MesoArena arena;
    MesoError error;
    MesoReport report;
    MesoVariantSet variants;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 2, labels, false, false, false);
    MesoSlotGraph graph = fixture_grid(&arena, 4, 3, true, true, false);
    MesoSolveResult result = fixture_solve(&arena, &set, &graph, 0, 1);
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
    MesoProvenance provenance = {.tool = "meso-solve", .command_line = "meso-solve x"};
    json_t *content = json_object();
    CHECK(meso_report_fill(content, &result, &(MesoTilingProblem){&set, &variants, &graph, NULL}, &error) == MESO_OK);
    json_t *tiles = json_object_get(content, "tiles");
    CHECK(json_object_size(tiles) == 2);
    CHECK(json_integer_value(json_object_get(tiles, "t0")) == 12);
    CHECK(json_integer_value(json_object_get(tiles, "t1")) == 0);
    json_t *json = meso_report_to_json(content, &provenance);
    char *text = text_of(json);
    CHECK(read_text(&report, &arena, text, strlen(text), &set, &error) == MESO_OK);
    CHECK(report.verdict == MESO_VERDICT_SOLVED && report.dead_end_count == 0);
    free(text);
    json_decref(json);
    json_decref(content);
    meso_arena_release(&arena);
}

/* Text of the report of a solve, which reads back. */
static char *solve_to_text(MesoArena *arena, const MesoTileSet *set, const MesoSlotGraph *graph,
                           const MesoConstraints *constraints, const MesoSolveOptions *options)
{
    MesoError error;
    MesoVariantSet variants;
    MesoSolveResult result;
    MesoReport report;
    MesoProvenance provenance = {.tool = "meso-solve", .command_line = "meso-solve x"};
    json_t *content = json_object();
    CHECK(meso_variant_set_build(&variants, arena, set, &error) == MESO_OK);
    const MesoTilingProblem problem = {set, &variants, graph, constraints};
    CHECK(meso_solve(&result, arena, &problem, options, &error) == MESO_OK);
    CHECK(meso_explain(&result, arena, &problem, options->seed, &error) == MESO_OK);
    CHECK(meso_report_fill(content, &result, &problem, &error) == MESO_OK);
    json_t *json = meso_report_to_json(content, &provenance);
    CHECK(json);
    char *text = text_of(json);
    json_decref(json);
    json_decref(content);
    CHECK(read_text(&report, arena, text, strlen(text), set, &error) == MESO_OK);
    CHECK(report.verdict == result.verdict && report.dead_end_total == result.dead_end_total);
    return text;
}

/* What cannot hold together is there by name: 'c' on inner sides; a pin that leaves no tile. */
static void test_core(void)
{
    static const int32_t labels[2][4] = {{2, 1, 3, 1}, {3, 1, 1, 1}}, loose[2][4] = {{1, 1, -1, -1}, {1, 1, -1, 2}};
    static const uint32_t places[1] = {4};
    static const uint64_t t1[1] = {2};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 2, labels, false, false, false);
    set.interfaces[2].border_only = true;
    MesoSlotGraph graph = fixture_grid(&arena, 3, 1, false, false, false);
    MesoSolveOptions options = {.max_attempts = 5, .max_dead_ends = 5};
    char *text = solve_to_text(&arena, &set, &graph, NULL, &options);
    CHECK(strstr(text, "\"reason\":\"no tile fits slot 1, where interface 'c' may lie on a border only\""));
    CHECK(strstr(text, "\"core\":{\"minimal\":true,\"slots\":[1],\"tiles\":[],\"border_rules\":[\"c\"],"
                       "\"constraints\":[]}"));
    free(text);

    set = fixture_set(&arena, 2, 2, loose, false, false, false);
    graph = fixture_grid(&arena, 3, 3, false, false, false);
    const MesoRestriction pin = {.name = "pins[0] 'knob'", .place_count = 1, .places = places, .allowed = t1};
    const MesoConstraints constraints = {.restriction_count = 1, .restrictions = &pin};
    text = solve_to_text(&arena, &set, &graph, &constraints, &options);
    CHECK(strstr(text, "\"core\":{\"minimal\":true,\"slots\":[1,4],\"tiles\":[\"t0\",\"t1\"],\"border_rules\":[],"
                       "\"constraints\":[\"pins[0] 'knob'\"]}"));
    CHECK(strstr(text, "no tiles fit together on slots 1 and 4, with pins[0] 'knob': only 't1' fits slot 4; each of "
                       "these is needed"));
    free(text);
    meso_arena_release(&arena);
}

/* Ten slots, those with most dead ends first. */
static void check_hot_spots(const char *text)
{
    json_t *json = json_loads(text, 0, NULL), *spots = json_object_get(json, "hot_spots");
    json_int_t last = INT64_MAX;
    CHECK(json_array_size(spots) == MESO_SOLVE_HOT_SPOTS);
    for (size_t i = 0; i < MESO_SOLVE_HOT_SPOTS; i++) {
        json_t *spot = json_array_get(spots, i);
        json_int_t count = json_integer_value(json_object_get(spot, "dead_ends"));
        CHECK(count >= 1 && count <= last && json_integer_value(json_object_get(spot, "slot")) < 25);
        last = count;
    }
    json_decref(json);
}

static bool always(void *context)
{
    (void)context;
    return true;
}

/* Each of 25 tiles shows a or a' once, so that one finds no partner: the search alone cannot know. */
static void test_gave_up(void)
{
    static const int32_t labels[2][4] = {{1, 2, 2, -2}, {-1, 2, 2, -2}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 2, labels, true, true, false);
    MesoSlotGraph graph = fixture_grid(&arena, 5, 5, true, true, false);
    MesoSolveOptions options = {.engine = MESO_ENGINE_WFC, .max_attempts = 3, .max_dead_ends = 5};
    char *text = solve_to_text(&arena, &set, &graph, NULL, &options);
    CHECK(strstr(text, "\"reason\":\"the search made its 3 attempts; at best ") &&
          strstr(text, " dead ends were at slot "));
    CHECK(strstr(text, "\"budget\":\"attempts\",\"decided_at_best\":") && !strstr(text, "\"conflicts\""));
    check_hot_spots(text);
    free(text);

    options.max_observations = 2;
    text = solve_to_text(&arena, &set, &graph, NULL, &options);
    CHECK(strstr(text, "the search made its 2 observations; at best ") && strstr(text, "\"budget\":\"observations\""));
    free(text);

    options.max_observations = 0;
    options.stop = always;
    text = solve_to_text(&arena, &set, &graph, NULL, &options);
    CHECK(strstr(text, "the time was over; at best ") && strstr(text, "\"budget\":\"time\""));
    free(text);
    meso_arena_release(&arena);
}

/* A torus that the exact engine does not solve at the first conflicts. */
static void test_conflicts(void)
{
    static const int32_t labels[3][4] = {{1, 2, -1, -2}, {1, 2, 2, -1}, {1, 1, 2, 2}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 3, labels, true, true, false);
    MesoSlotGraph graph = fixture_grid(&arena, 30, 30, true, true, false);
    const MesoSolveOptions options = {.engine = MESO_ENGINE_EXACT, .max_attempts = 1, .max_conflicts = 5};
    char *text = solve_to_text(&arena, &set, &graph, NULL, &options);
    CHECK(strstr(text, "\"reason\":\"the exact engine met its 5 conflicts\""));
    CHECK(strstr(text, "\"budget\":\"conflicts\"") && strstr(text, "\"conflicts\":"));
    free(text);
    meso_arena_release(&arena);
}

static void expect_wrong(const char *text, const char *message)
{
    static const int32_t labels[1][4] = {{1, 1, 1, 1}};
    MesoArena arena;
    MesoError error = {0};
    MesoReport report;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 1, 1, labels, false, false, false);
    CHECK(read_text(&report, &arena, text, strlen(text), &set, &error) == MESO_ERR_INPUT);
    if (!strstr(error.message, message)) {
        fprintf(stderr, "expected '%s' in: %s\n", message, error.message);
        exit(1);
    }
    meso_arena_release(&arena);
}

#define HEAD "{\"format\":\"meso-report\",\"version\":1,"
#define COUNTS "\"attempts\":1,\"observations\":2,\"slots\":3,\"variants\":4,\"dead_end_total\":5,"

static void test_wrong(void)
{
    expect_wrong("[]", "r.json");
    expect_wrong("{\"format\":\"meso-tiles\",\"version\":1}", "meso-tiles");
    expect_wrong("{\"format\":\"meso-report\",\"version\":2}", "version");
    expect_wrong(HEAD "\"tool\":\"meso-map\"}", "not a report of a solver");
    expect_wrong(HEAD COUNTS "\"dead_ends\":[],\"verdict\":\"maybe\"}", "verdict: \"maybe\"");
    expect_wrong(HEAD "\"verdict\":\"solved\"}", "attempts: missing");
    expect_wrong(HEAD COUNTS "\"verdict\":\"solved\"}", "dead_ends: missing");
    expect_wrong(HEAD COUNTS "\"verdict\":\"solved\",\"dead_ends\":[1]}", "dead_ends[0]: an object");
    expect_wrong(HEAD COUNTS "\"verdict\":\"solved\",\"dead_ends\":[{\"slot\":0,\"attempt\":1,"
                 "\"initial\":false,\"sides\":[]}]}", "dead_ends[0].sides: 0 items; 4 are needed");
    expect_wrong(HEAD COUNTS "\"verdict\":\"solved\",\"dead_ends\":[{\"slot\":-1,\"attempt\":1,"
                 "\"initial\":false,\"sides\":[]}]}", "dead_ends[0].slot: -1");
    expect_wrong(HEAD COUNTS "\"verdict\":\"solved\",\"dead_ends\":[{\"slot\":0,\"attempt\":1,"
                 "\"initial\":false,\"sides\":[{\"border\":true,\"labels\":[\"aa\"]},0,0,0]}]}",
                 "labels[0]: unknown interface 'aa'");
    expect_wrong(HEAD COUNTS "\"verdict\":\"solved\",\"dead_ends\":[{\"slot\":0,\"attempt\":1,"
                 "\"initial\":false,\"sides\":[{\"border\":true,\"labels\":[7]},0,0,0]}]}",
                 "the name of an interface is needed");
}

int main(void)
{
    test_text();
    test_round_trip();
    test_solved();
    test_core();
    test_gave_up();
    test_conflicts();
    test_wrong();
    return 0;
}
