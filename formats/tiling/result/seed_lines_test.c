/* Lines of a sweep over seeds: round trip, shards in any order, every wrong line. */
#include <stdio.h>
#include <string.h>

#include "formats/tiling/result/seed_lines.h"
#include "libcore/tiling/fixture/solve_fixture.h"

static MesoArena arena;
static const uint64_t problem[2] = {0x0123456789abcdef, 0xfedcba9876543210};

#define PROBLEM "\"problem\":\"0123456789abcdeffedcba9876543210\"}"
#define LINE_7 "{\"seed\":7,\"verdict\":\"gave-up\",\"attempts\":2,\"observations\":3,\"dead_ends\":2," PROBLEM
#define LINE_9 "{\"seed\":9,\"verdict\":\"unsolvable\",\"attempts\":0,\"observations\":0,\"dead_ends\":1," PROBLEM

static MesoSeedLine *read(const char *text, uint32_t expected)
{
    MesoSeedLine *lines;
    uint32_t count;
    MesoInput input;
    MesoError error;
    meso_input_wrap(&input, "file", text, strlen(text));
    if (meso_seed_lines_read(&lines, &count, &arena, &input, &problem, 1, &error) != MESO_OK)
        fprintf(stderr, "%s\n", error.message);
    CHECK(meso_seed_lines_read(&lines, &count, &arena, &input, &problem, 1, &error) == MESO_OK && count == expected);
    return lines;
}

static void expect_failure(const char *text, const char *message)
{
    MesoSeedLine *lines;
    uint32_t count;
    MesoInput input;
    MesoError error;
    meso_input_wrap(&input, "file", text, strlen(text));
    CHECK(meso_seed_lines_read(&lines, &count, &arena, &input, &problem, 1, &error) == MESO_ERR_INPUT);
    if (!strstr(error.message, message))
        fprintf(stderr, "%s\n", error.message);
    CHECK(strstr(error.message, message) != NULL);
}

static void test_round_trip(void)
{
    static const int32_t labels[2][4] = {{1, 1, 1, 1}, {1, 1, 1, 1}};
    uint32_t tiles[5] = {1, 0, 1, 1, 0};
    MesoTransform transforms[5] = {0, 1, 2, 3, 7};
    MesoTileSet set = fixture_set(&arena, 1, 2, labels, true, true, false);
    MesoSolveResult result = {.verdict = MESO_VERDICT_SOLVED, .decider = MESO_DECIDER_SEARCH, .attempts = 3,
                              .observations = 5000000000, .assignment = {5, tiles, transforms}, .dead_end_total = 2};
    MesoSeedLine line;
    MesoError error;
    char text[1000];
    MesoSlotGraph graph = fixture_graph(&arena, 5);
    CHECK(meso_seed_line_make(&line, &arena, MESO_SEED_LIMIT, problem, &result, &set, &graph, &error) == MESO_OK);
    CHECK(strcmp(line.text, "{\"seed\":9223372036854775807,\"verdict\":\"solved\",\"decider\":\"search\",\"attempts\":3,"
                 "\"observations\":5000000000,\"dead_ends\":2,\"tiles\":{\"t0\":2,\"t1\":3},"
                 "\"strands\":{\"count\":0,\"loops\":0,\"cyclic\":0,\"sweeps\":0,\"shortest\":0,\"longest\":0,\"lengths\":[]},"
                 "\"assignment\":\"a1c22c02265f0cf20e121b869d23b163\"," PROBLEM) == 0);
    snprintf(text, sizeof text, "%s\n", line.text);
    MesoSeedLine *back = read(text, 1);
    CHECK(back->seed == MESO_SEED_LIMIT && back->verdict == MESO_VERDICT_SOLVED && back->attempts == 3);
    CHECK(back->observations == 5000000000 && back->tile_squares == 13 && line.tile_squares == 13);
    CHECK(memcmp(back->assignment, line.assignment, sizeof line.assignment) == 0);
    CHECK(strcmp(back->text, line.text) == 0);

    /* The hash is of every slot. */
    uint64_t hash[2];
    transforms[4] = 6;
    meso_assignment_hash(hash, &result.assignment);
    CHECK(memcmp(hash, line.assignment, sizeof hash) != 0);
}

static void test_shards(void)
{
    MesoSeedLine *lines = read(LINE_9 "\n\n \r\n" LINE_7 "\r\n" LINE_9 "\n{\"seed\":1,\"ver", 2);
    CHECK(lines[0].seed == 7 && lines[1].seed == 9 && strcmp(lines[0].text, LINE_7) == 0);
    CHECK(lines[0].verdict == MESO_VERDICT_GAVE_UP && lines[1].verdict == MESO_VERDICT_UNSOLVABLE);
    read(LINE_9, 0);
    expect_failure(LINE_9 "\n{\"seed\":1,\"ver\n", "file:2:");
    expect_failure("{\"seed\":7,\"verdict\":\"gave-up\",\"attempts\":1,\"observations\":3,\"dead_ends\":2," PROBLEM "\n"
                   LINE_7 "\n", "file: seed 7 has two lines that differ");
}

/* As text would end there, nothing but its bytes tells it from the line without. */
static void test_zero_byte(void)
{
    static const char lines[] = LINE_9 "\n{\"seed\":7\0,\"verdict\":\"gave-up\",\"attempts\":1,\"observations\":3," PROBLEM "\n";
    MesoInput input;
    MesoError error;
    MesoSeedLine *read_back;
    uint32_t count;
    meso_input_wrap(&input, "file", lines, sizeof lines - 1);
    CHECK(meso_seed_lines_read(&read_back, &count, &arena, &input, &problem, 1, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "file:2:10: a zero byte, which is not text") == 0);
}

static void test_wrong_lines(void)
{
    expect_failure("[]\n", "file:1: an object is needed");
    expect_failure("\n{}\n", "file:2: seed:");
    expect_failure("{\"seed\":-1}\n", "seed: -1; it must be from 0");
    expect_failure("{\"seed\":1,\"attempts\":1,\"observations\":1," PROBLEM "\n", "file:1: verdict:");
    expect_failure("{\"seed\":1,\"verdict\":\"so\",\"attempts\":1,\"observations\":1," PROBLEM "\n",
                   "file:1: verdict: no verdict that is known");
    expect_failure("{\"seed\":1,\"verdict\":\"solved\",\"attempts\":1,\"observations\":1," PROBLEM "\n",
                   "file:1: assignment:");
    expect_failure("{\"seed\":1,\"verdict\":\"gave-up\",\"attempts\":1,\"observations\":1,\"problem\":\"01\"}\n",
                   "file:1: problem: 32 hexadecimal digits are needed");
    expect_failure("{\"seed\":1,\"verdict\":\"gave-up\",\"attempts\":1,\"observations\":1,"
                   "\"problem\":\"0123456789abcdeffedcba9876543211\"}\n", "file:1: problem: the line is of another problem");
}

/* Other inputs, another orientation, other options: another problem; the file's order is the same as none. */
static void test_problems(void)
{
    MesoProvenance provenance = {.input_count = 1, .inputs = {{.role = "tiles", .hash = {1, 2}}}};
    uint8_t quarters[300] = {0};
    uint64_t plain[2], other[2];
    meso_seed_problem(plain, &provenance, NULL, 300, "attempts=1");
    meso_seed_problem(other, &provenance, quarters, 300, "attempts=1");
    CHECK(memcmp(plain, other, sizeof plain) == 0);
    quarters[299] = 1;
    meso_seed_problem(other, &provenance, quarters, 300, "attempts=1");
    CHECK(memcmp(plain, other, sizeof plain) != 0);
    meso_seed_problem(other, &provenance, NULL, 300, "attempts=2");
    CHECK(memcmp(plain, other, sizeof plain) != 0);
    provenance.inputs[0].hash[1] = 3;
    meso_seed_problem(other, &provenance, NULL, 300, "attempts=1");
    CHECK(memcmp(plain, other, sizeof plain) != 0);
}

int main(void)
{
    meso_arena_init(&arena);
    test_round_trip();
    test_shards();
    test_zero_byte();
    test_wrong_lines();
    test_problems();
    meso_arena_release(&arena);
    return 0;
}
