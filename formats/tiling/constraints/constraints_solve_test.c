/* Every kind of constraint from its text to the assignment: that it holds there, and is named where it cannot. */
#include <string.h>

#include "formats/mesh/surface_read.h"
#include "formats/tiling/constraints/constraints_file.h"
#include "libcore/base/check.h"
#include "libcore/tiling/solve/explain.h"

enum { PLAIN, KNOB, EVEN, STAR, TILES, COLUMNS = 4, ROWS = 3, GRID = COLUMNS * ROWS };

static const MesoEngine engines[3] = {MESO_ENGINE_AUTO, MESO_ENGINE_WFC, MESO_ENGINE_EXACT};

/* a has a cross-section, b has none; the plain tile bends two strands, the even one crosses them, the star joins
 * them. */
static MesoInterface interfaces[2] = {{.name = "a", .section_count = 1}, {.name = "b"}};
static MesoSection sections[1] = {{.name = "s"}};
static MesoSweep sweeps[9] = {{.from_side = 0, .to_side = 1}, {.from_side = 2, .to_side = 3},
                              {.from_side = 1, .to_side = 2}, {.from_side = 2, .to_side = 3},
                              {.from_side = 0, .to_side = 2}, {.from_side = 1, .to_side = 3},
                              {.from_side = 0, .to_side = 1}, {.from_side = 0, .to_side = 2},
                              {.from_side = 0, .to_side = 3}};
static MesoTile tiles[TILES] = {
    [PLAIN] = {.name = "plain", .side_count = 4, .labels = {1, 1, -1, -1}, .rotation = true, .sweep_count = 2},
    [KNOB] = {.name = "knob", .side_count = 4, .labels = {2, 1, -1, -1}, .rotation = true, .flip_x = true,
              .sweep_begin = 2, .sweep_count = 2},
    [EVEN] = {.name = "even", .side_count = 4, .labels = {1, 1, -1, -1}, .sweep_begin = 4, .sweep_count = 2},
    [STAR] = {.name = "star", .side_count = 4, .labels = {1, 1, -1, -1}, .sweep_begin = 6, .sweep_count = 3},
};

typedef struct Case {
    MesoArena arena;
    MesoError error;
    MesoTileSet set;
    MesoVariantSet variants;
    MesoQuadSurface surface;
    MesoSlotGraph graph;
    MesoBoundary boundary;
    MesoConstraints constraints;
    MesoSolveResult result;
} Case;

/*
 * OBJ: slots 0 to 11 by rows of four, upwards, and a strip of two slots apart, 12 and 13.
 *
 *      8  9 10 11      object "top" from row 1 on, material "moss" in row 2; vertices to the left
 *      4  5  6  7      of x = 2, and there, are red
 *      0  1  2  3      side 0 is below; groups "left" (columns 0, 1) and "right", "strip" apart from them   12 13
 */
static const char *obj_text(MesoArena *arena)
{
    static const uint32_t right[2] = {2, 3};
    const char *text = "";
    for (uint32_t v = 0; v < 20; v++)
        text = meso_arena_print(arena, NULL, "%sv %u %u 0 %d 0 0\n", text, v % 5, v / 5, v % 5 <= 2);
    for (uint32_t v = 0; v < 6; v++)
        text = meso_arena_print(arena, NULL, "%sv %u %u 0 0 0 0\n", text, 9 + v % 3, v / 3);
    for (uint32_t s = 0; s < GRID; s++) {
        uint32_t x = s % COLUMNS, y = s / COLUMNS, first = 5 * y + x + 1;
        text = meso_arena_print(arena, NULL, "%so %s\nusemtl %s\ng %s\nf %u %u %u %u\n", text, y ? "top" : "foot",
                                y == 2 ? "moss" : "bark", x >= right[0] ? "right" : "left", first, first + 1, first + 6,
                                first + 5);
    }
    return meso_arena_print(arena, NULL, "%so strip\nusemtl bark\ng strip\nf 21 22 25 24\nf 22 23 26 25\n", text);
}

/* PLY: the same without the strip; faces have their row as "part", vertices their x as "heat". */
static const char *ply_text(MesoArena *arena)
{
    const char *text = "ply\nformat ascii 1.0\nelement vertex 20\nproperty float x\nproperty float y\nproperty float z\n"
                       "property float heat\nelement face 12\nproperty list uchar int vertex_indices\n"
                       "property int part\nend_header\n";
    for (uint32_t v = 0; v < 20; v++)
        text = meso_arena_print(arena, NULL, "%s%u %u 0 %u\n", text, v % 5, v / 5, v % 5);
    for (uint32_t s = 0; s < GRID; s++) {
        uint32_t first = 5 * (s / COLUMNS) + s % COLUMNS;
        text = meso_arena_print(arena, NULL, "%s4 %u %u %u %u %u\n", text, first, first + 1, first + 6, first + 5,
                                s / COLUMNS);
    }
    return text;
}

static void begin(Case *c, bool ply)
{
    MesoInput input;
    memset(c, 0, sizeof *c);
    meso_arena_init(&c->arena);
    c->set = (MesoTileSet){.interface_count = 2, .interfaces = interfaces, .tile_count = TILES, .tiles = tiles,
                           .section_count = 1, .sections = sections, .sweep_count = 9, .sweeps = sweeps};
    CHECK(meso_variant_set_build(&c->variants, &c->arena, &c->set, NULL) == MESO_OK);
    CHECK(c->variants.count == 4 + 8 + 1 + 1);
    const char *text = ply ? ply_text(&c->arena) : obj_text(&c->arena);
    meso_input_wrap(&input, ply ? "s.ply" : "s.obj", text, strlen(text));
    CHECK(meso_quad_surface_read(&c->surface, &c->arena, &input, 1, &c->error) == MESO_OK);
    c->graph = c->surface.graph;
    CHECK(meso_boundary_build(&c->boundary, &c->arena, &c->surface.mesh, &c->graph, NULL) == MESO_OK);
    CHECK(c->boundary.loop_count == (ply ? 1 : 2));
}

static void solve(Case *c, const char *content, MesoEngine engine, uint64_t seed)
{
    const MesoConstraintScope scope = {&c->set, &c->variants, &c->graph, &c->boundary, &c->surface.surface.mesh};
    const MesoSolveOptions options = {.seed = seed, .engine = engine, .max_attempts = 20, .max_dead_ends = 5};
    const char *text = meso_arena_print(&c->arena, NULL, "{\"format\": \"meso-constraints\", \"version\": 1, %s}",
                                        content);
    MesoInput input;
    meso_input_wrap(&input, "c.json", text, strlen(text));
    if (meso_constraints_read(&c->constraints, &c->arena, &input, &scope, &c->error) ||
        meso_solve(&c->result, &c->arena, &(MesoTilingProblem){&c->set, &c->variants, &c->graph, &c->constraints},
                   &options, &c->error) ||
        meso_explain(&c->result, &c->arena, &(MesoTilingProblem){&c->set, &c->variants, &c->graph, &c->constraints},
                     options.seed, &c->error)) {
        fprintf(stderr, "%s: %s\n", content, c->error.message);
        CHECK(false);
    }
}

/* ---- what holds ---- */

static int32_t shown(const Case *c, uint32_t slot, uint32_t side)
{
    const MesoAssignment *assignment = &c->result.assignment;
    return meso_tile_label(&tiles[assignment->tile[slot]], assignment->transform[slot], side);
}

static bool stands(const Case *c, uint32_t slot, uint32_t tile)
{
    return c->result.assignment.tile[slot] == tile;
}

static uint32_t uses(const Case *c, uint32_t tile)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < c->graph.slot_count; s++)
        count += stands(c, s, tile);
    return count;
}

static MesoStrandStatistics strands(const Case *c)
{
    MesoStrandStatistics statistics;
    CHECK(meso_strands_count(&statistics, &c->result.assignment, &c->set, &c->graph, NULL) == MESO_OK);
    return statistics;
}

static bool knob_stands(const Case *c)
{
    return stands(c, 5, KNOB);
}

static bool knob_is_turned(const Case *c)
{
    return stands(c, 5, KNOB) && c->result.assignment.transform[5] % 4 == 3;
}

static bool knob_is_mirrored(const Case *c)
{
    return stands(c, 5, KNOB) && meso_transform_flips(c->result.assignment.transform[5]);
}

static bool knob_is_both(const Case *c)
{
    return stands(c, 5, KNOB) && c->result.assignment.transform[5] == meso_transform_make(true, false, 1);
}

static bool b_shows(const Case *c)
{
    return shown(c, 6, 0) == 2 || shown(c, 6, 1) == 2 || shown(c, 6, 2) == 2 || shown(c, 6, 3) == 2;
}

static bool flipped_b_shows_to_the_right(const Case *c)
{
    return shown(c, 6, 1) == -2;
}

static bool b_shows_to_the_left(const Case *c)
{
    return shown(c, 4, 3) == 2 && shown(c, 8, 3) == 2;
}

/* On the sides without neighbour from slot `first` on. */
static bool border_shows_a(const Case *c, uint32_t first)
{
    bool all = true;
    for (uint32_t h = 4 * first; h < 4 * c->graph.slot_count; h++)
        all = all && (c->graph.twin[h] != MESO_NO_INDEX || meso_label_interface(shown(c, h / 4, h % 4)) == 0);
    return all;
}

static bool strip_shows_a(const Case *c)    /* whose border is loop 1 */
{
    return border_shows_a(c, GRID);
}

static bool borders_show_a(const Case *c)
{
    return border_shows_a(c, 0);
}

static bool two_to_three_knobs(const Case *c)
{
    return uses(c, KNOB) >= 2 && uses(c, KNOB) <= 3;
}

static bool five_even_or_star(const Case *c)
{
    return uses(c, EVEN) + uses(c, STAR) == 5;
}

static bool shares_of_14(const Case *c)     /* 0.5 and 0.6: 7 and 8 */
{
    return uses(c, PLAIN) + uses(c, STAR) >= 7 && uses(c, PLAIN) + uses(c, STAR) <= 8;
}

static bool no_loops(const Case *c)
{
    return strands(c).loop_count == 0;
}

static bool no_cycles(const Case *c)
{
    return strands(c).cyclic_count == 0;
}

static bool short_strands(const Case *c)
{
    return strands(c).longest <= 4;
}

static bool one_strand_a_piece(const Case *c)
{
    return strands(c).strand_count == 2;
}

static void test_holds(void)
{
    static const struct {
        const char *content;
        bool (*holds)(const Case *c);
        bool may_give_up;       /* the exact engine, which cuts off one unconnected assignment after the other */
    } rows[] = {
        {"\"pins\": [{\"slot\": 5, \"tile\": \"knob\"}]", knob_stands, false},
        {"\"pins\": [{\"slot\": 5, \"tile\": \"knob\", \"turn\": 3}]", knob_is_turned, false},
        {"\"pins\": [{\"slot\": 5, \"tile\": \"knob\", \"flip\": true}]", knob_is_mirrored, false},
        {"\"pins\": [{\"slot\": 5, \"tile\": \"knob\", \"flip\": true, \"turn\": 1}]", knob_is_both, false},
        {"\"pins\": [{\"slot\": 6, \"interface\": \"b\"}]", b_shows, false},
        {"\"pins\": [{\"slot\": 6, \"interface\": \"b'\", \"side\": 1}]", flipped_b_shows_to_the_right, false},
        {"\"pins\": [{\"where\": {\"slots\": [4, 8]}, \"interface\": \"b\", \"side\": 3}]", b_shows_to_the_left, false},
        {"\"borders\": [{\"loop\": 1, \"interfaces\": [\"a\", \"a'\"]}]", strip_shows_a, false},
        {"\"borders\": [{\"loop\": \"all\", \"interfaces\": [\"a\", \"a'\"]}]", borders_show_a, false},
        {"\"quotas\": [{\"tile\": \"knob\", \"least\": 2, \"most\": 3}]", two_to_three_knobs, false},
        {"\"quotas\": [{\"tiles\": [\"even\", \"star\"], \"least\": 5, \"most\": 5}]", five_even_or_star, false},
        {"\"quotas\": [{\"tiles\": [\"plain\", \"star\"], \"least_share\": 0.5, \"most_share\": 0.6}]", shares_of_14,
         false},
        {"\"strands\": {\"no_loops\": true}", no_loops, false},
        {"\"strands\": {\"acyclic\": true}", no_cycles, false},
        {"\"strands\": {\"max_length\": 4}", short_strands, false},
        {"\"strands\": {\"connected\": true}", one_strand_a_piece, true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (uint32_t e = 0; e < 3; e++)
            for (uint64_t seed = 0; seed < 4; seed++) {
                Case c;
                begin(&c, false);
                solve(&c, rows[i].content, engines[e], seed);
                bool gave_up = rows[i].may_give_up && engines[e] == MESO_ENGINE_EXACT &&
                               c.result.verdict == MESO_VERDICT_GAVE_UP;
                if (!gave_up && (c.result.verdict != MESO_VERDICT_SOLVED || !rows[i].holds(&c))) {
                    fprintf(stderr, "%s: engine %u: %s\n", rows[i].content, engines[e], c.result.reason);
                    CHECK(false);
                }
                meso_arena_release(&c.arena);
            }
}

/* Places, as a bit set of slots: there the tiles that are allowed, and elsewhere others too. */
static void test_places(void)
{
    static const struct {
        const char *where;
        bool ply;
        uint32_t slots;
    } rows[] = {
        {"\"group\": \"left\"", false, 0x333},
        {"\"object\": \"top\"", false, 0xff0},
        {"\"material\": \"moss\"", false, 0xf00},
        {"\"property\": \"red\", \"range\": [0.4, 1]", false, 0x777},
        {"\"slots\": [0, [6, 8], 13]", false, 0x21c1},
        {"\"slots\": [[0, 7]], \"group\": \"right\"", false, 0x0cc},
        {"\"property\": \"part\", \"value\": 1", true, 0x0f0},
        {"\"property\": \"heat\", \"range\": [1.5, 2.5]", true, 0x666},
    };
    static const char *const rules[3] = {"\"regions\": [{\"where\": {%s}, \"tiles\": [\"even\", \"star\"]}]",
                                         "\"pins\": [{\"where\": {%s}, \"tile\": \"even\"}]",
                                         "\"regions\": [{\"where\": {%s}, \"weights\": {\"plain\": 0, \"knob\": 0}},"
                                         " {\"where\": {%s}, \"tiles\": [\"even\", \"star\"]}]"};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (uint32_t e = 0; e < 9; e++) {
            uint32_t others = 0;
            Case c;
            begin(&c, rows[i].ply);
            const char *content = meso_arena_print(&c.arena, NULL, rules[e / 3], rows[i].where, rows[i].where);
            for (uint64_t seed = 0; seed < 4; seed++) {
                solve(&c, content, engines[e % 3], seed);
                CHECK(c.result.verdict == MESO_VERDICT_SOLVED);
                for (uint32_t s = 0; s < c.graph.slot_count; s++) {
                    bool allowed = stands(&c, s, EVEN) || (e / 3 != 1 && stands(&c, s, STAR));
                    CHECK(allowed || !(rows[i].slots >> s & 1));
                    others |= (uint32_t)!allowed << s;
                }
            }
            CHECK(others != 0);
            meso_arena_release(&c.arena);
        }
}

/* ---- what cannot hold ---- */

#define EVEN_AT_6 "{\"slot\": 6, \"tile\": \"even\"}"
#define KNOB_AT_5 "{\"slot\": 5, \"tile\": \"knob\"}"

/* A region that is `where`, and a knob that is pinned to one of its slots. */
#define REGION(where, slot) "\"pins\": [" EVEN_AT_6 ", {\"slot\": " slot ", \"tile\": \"knob\"}], \"regions\": [" \
    "{\"where\": {\"slots\": [1]}, \"tiles\": [\"plain\", \"even\"]}, {\"name\": \"calm\", \"where\": {" where "}," \
    " \"tiles\": [\"plain\", \"even\"]}]"
#define REGION_FAILS "pins[1] and regions[1] 'calm' cannot hold together"

/* Four plain tiles that make a ring about the corner that slots 0, 1, 4 and 5 share. */
#define RING "\"pins\": [{\"slot\": 0, \"tile\": \"plain\", \"turn\": 1}, {\"slot\": 1, \"tile\": \"plain\", \"turn\": 0}," \
    " {\"slot\": 5, \"tile\": \"plain\", \"turn\": 3}, {\"slot\": 4, \"tile\": \"plain\", \"turn\": 2}, {\"slot\": 11, \"tile\": \"even\"}]"
#define RING_FAILS "pins[0], pins[1], pins[2], pins[3] and the rule on strands cannot hold together"

#define EVEN_STRIP "\"regions\": [{\"where\": {\"group\": \"strip\"}, \"tiles\": [\"even\"]}]"

/* Whether `reason` says `expected`, before its proof or the slots, or names the same constraints with slots. */
static bool blames(const char *reason, const char *expected)
{
    char with[256];
    size_t size = strlen(expected);
    if (strncmp(reason, expected, size) == 0 &&
        (!reason[size] || reason[size] == ':' || strncmp(reason + size, " on ", 4) == 0))
        return true;
    int names = (int)(strstr(expected, " cannot hold") - expected);
    size = (size_t)snprintf(with, sizeof with, ", with %.*s", names, expected);
    const char *found = strstr(reason, with);
    return found && strchr(":;", found[size]);
}

static void test_contradictions(void)
{
    static const struct {
        const char *content, *reason;
        bool ply;
        bool tried;             /* proved by going through all cases: the search alone gives up */
    } rows[] = {
        /* The knob shows b below in its own position, and to the right after a turn. */
        {"\"pins\": [{\"slot\": 5, \"tile\": \"knob\", \"turn\": 0, \"flip\": false}, {\"slot\": 1, \"tile\": \"even\"}, "
         EVEN_AT_6 "]", "pins[0] and pins[1] cannot hold together", false, false},
        {"\"pins\": [{\"slot\": 5, \"tile\": \"knob\", \"turn\": 1, \"flip\": false}, {\"slot\": 4, \"tile\": \"even\"}, "
         EVEN_AT_6 "]", "pins[0] and pins[2] cannot hold together", false, false},
        {"\"pins\": [{\"slot\": 5, \"tile\": \"knob\", \"flip\": true}, {\"slot\": 5, \"interface\": \"b\"}]",
         "pins[0] and pins[1] cannot hold together", false, false},
        {"\"pins\": [{\"slot\": 6, \"interface\": \"b\"}, {\"slot\": 5, \"tile\": \"even\"}, " EVEN_AT_6 "]",
         "pins[0] and pins[2] cannot hold together", false, false},
        {"\"pins\": [{\"name\": \"x\", \"slot\": 5, \"interface\": \"b\", \"side\": 1}, " EVEN_AT_6 "]",
         "pins[0] 'x' and pins[1] cannot hold together", false, false},
        {"\"pins\": [" EVEN_AT_6 ", {\"where\": {\"group\": \"left\"}, \"tile\": \"star\"}, " KNOB_AT_5 "]",
         "pins[1] and pins[2] cannot hold together", false, false},
        {REGION("\"group\": \"left\"", "9"), REGION_FAILS, false, false},
        {REGION("\"object\": \"top\"", "7"), REGION_FAILS, false, false},
        {REGION("\"material\": \"moss\"", "10"), REGION_FAILS, false, false},
        {REGION("\"property\": \"red\", \"range\": [0.4, 1]", "8"), REGION_FAILS, false, false},
        {REGION("\"slots\": [[2, 4]]", "3"), REGION_FAILS, false, false},
        {REGION("\"property\": \"part\", \"value\": 2", "11"), REGION_FAILS, true, false},
        {REGION("\"property\": \"heat\", \"range\": [3, 4]", "7"), REGION_FAILS, true, false},
        {"\"borders\": [{\"loop\": 1, \"interfaces\": [\"a\", \"a'\"]}, {\"name\": \"rim\", \"loop\": 0, \"interfaces\":"
         " [\"a\", \"a'\"]}], \"pins\": [" EVEN_AT_6 ", {\"slot\": 3, \"interface\": \"b\", \"side\": 1}]",
         "pins[1] and borders[1] 'rim' cannot hold together", false, false},
        {"\"borders\": [{\"loop\": 0, \"interfaces\": [\"b\"]}]", "borders[0] cannot hold", false, false},
        {"\"quotas\": [{\"tile\": \"even\", \"most\": 9}, {\"tile\": \"knob\", \"most\": 0}], \"pins\": [" EVEN_AT_6 ", "
         KNOB_AT_5 "]", "pins[1] and quotas[1] cannot hold together", false, false},
        {"\"quotas\": [{\"name\": \"calm\", \"tiles\": [\"plain\", \"star\"], \"least\": 14}], \"pins\": [" EVEN_AT_6 "]",
         "pins[0] and quotas[0] 'calm' cannot hold together", false, false},
        {"\"quotas\": [{\"tile\": \"even\", \"least_share\": 0.5}, {\"tiles\": [\"star\", \"plain\"], \"least_share\": 0.6}]",
         "quotas[0] and quotas[1] cannot hold together", false, true},
        {"\"quotas\": [{\"tile\": \"even\", \"most_share\": 0.1}], \"regions\": [{\"where\": {\"group\": \"left\"},"
         " \"tiles\": [\"even\"]}]", "regions[0] and quotas[0] cannot hold together", false, false},
        {RING ", \"strands\": {\"no_loops\": true}", RING_FAILS, false, false},
        {RING ", \"strands\": {\"acyclic\": true}", RING_FAILS, false, false},
        {RING ", \"strands\": {\"max_length\": 3}", RING_FAILS, false, false},
        /* Of the plain tile in the corner, one strand is cut off from all others. */
        {RING ", \"strands\": {\"connected\": true}", "pins[0] and the rule on strands cannot hold together", false,
         false},
        {EVEN_STRIP ", \"strands\": {\"connected\": true}", "regions[0] and the rule on strands cannot hold together",
         false, false},
        {EVEN_STRIP ", \"strands\": {\"max_length\": 1}", "regions[0] and the rule on strands cannot hold together",
         false, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (uint32_t e = 0; e < 3; e++) {
            Case c;
            begin(&c, rows[i].ply);
            solve(&c, rows[i].content, engines[e], 7);
            const char *reason = c.result.reason;
            bool gave_up = rows[i].tried && engines[e] == MESO_ENGINE_WFC &&
                           c.result.verdict == MESO_VERDICT_GAVE_UP && strstr(reason, "quotas[0] stood in the way");
            if (!gave_up && (c.result.verdict != MESO_VERDICT_UNSOLVABLE || !blames(reason, rows[i].reason))) {
                fprintf(stderr, "%s: engine %u, verdict %u: %s\n", rows[i].content, engines[e], c.result.verdict,
                        reason);
                CHECK(false);
            }
            meso_arena_release(&c.arena);
        }
}

int main(void)
{
    test_holds();
    test_places();
    test_contradictions();
    return 0;
}
