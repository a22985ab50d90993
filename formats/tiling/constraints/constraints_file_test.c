#include "formats/tiling/constraints/constraints_file.h"

#include <math.h>
#include <string.h>

#include "formats/mesh/surface_read.h"
#include "libcore/base/check.h"
#include "libcore/tiling/solve/solve.h"

/*
 *     6---7---8      faces 0 (left bottom), 1, then 2 (left top), 3
 *     | 2 | 3 |
 *     3---4---5
 *     | 0 | 1 |
 *     0---1---2
 */
static const char surface_text[] =
    "o sheet\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 2 0 0 0 0 1\nv 0 1 0 1 0 0\nv 1 1 0 1 0 0\nv 2 1 0 0 0 1\n"
    "v 0 2 0 1 0 0\nv 1 2 0 1 0 0\nv 2 2 0 0 0 1\n"
    "g left bottom\nusemtl red paint\nf 1 2 5 4\ng right bottom\nf 2 3 6 5\n"
    "usemtl blue\ng left top\nf 4 5 8 7\ng right top\nf 5 6 9 8\n";

static const char ply_text[] =
    "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty float heat\nelement face 2\nproperty list uchar int vertex_indices\n"
    "property int part\nend_header\n"
    "0 0 0 255 0\n1 0 0 255 1\n2 0 0 0 5\n0 1 0 255 2\n1 1 0 255 1\n2 1 0 0 5\n4 0 1 4 3 7\n4 1 2 5 4 -2\n";

typedef struct Case {
    MesoArena arena;
    MesoError error;
    MesoTileSet set;
    MesoVariantSet variants;
    MesoQuadSurface surface;
    MesoSlotGraph graph;
    MesoBoundary boundary;
    MesoConstraintScope scope;
    MesoConstraints constraints;
} Case;

static MesoInterface interfaces[3] = {{.name = "a"}, {.name = "b"}, {.name = "edge", .border_only = true}};
static MesoTile tiles[4] = {
    {.name = "plain", .side_count = 4, .labels = {1, 1, -1, -1}},
    {.name = "knob", .side_count = 4, .labels = {1, 2, -1, -1}, .rotation = true},
    {.name = "old", .side_count = 4, .labels = {1, 1, -1, -1}, .ignored = true},
    {.name = "even", .side_count = 4, .labels = {1, 1, 1, 1}, .rotation = true},
};

static void begin(Case *c, const char *path, const char *text)
{
    MesoInput input;
    memset(c, 0, sizeof *c);
    meso_arena_init(&c->arena);
    c->set = (MesoTileSet){.interface_count = 3, .interfaces = interfaces, .tile_count = 4, .tiles = tiles};
    CHECK(meso_variant_set_build(&c->variants, &c->arena, &c->set, NULL) == MESO_OK);
    CHECK(c->variants.count == 6);
    meso_input_wrap(&input, path, text, strlen(text));
    CHECK(meso_quad_surface_read(&c->surface, &c->arena, &input, 1, &c->error) == MESO_OK);
    c->graph = c->surface.graph;
    CHECK(meso_boundary_build(&c->boundary, &c->arena, &c->surface.mesh, &c->graph, NULL) == MESO_OK);
    c->scope = (MesoConstraintScope){&c->set, &c->variants, &c->graph, &c->boundary, &c->surface.surface.mesh};
}

static MesoStatus read_text(Case *c, const char *text)
{
    MesoInput input;
    meso_input_wrap(&input, "c.json", text, strlen(text));
    return meso_constraints_read(&c->constraints, &c->arena, &input, &c->scope, &c->error);
}

static MesoStatus read(Case *c, const char *content)
{
    const char *text = meso_arena_print(&c->arena, NULL, "{\"format\": \"meso-constraints\", \"version\": 1%s%s}",
                                        *content ? ", " : "", content);
    return read_text(c, text);
}

static void expect(Case *c, const char *content, const char *message)
{
    CHECK(read(c, content) == MESO_ERR_INPUT);
    if (!strstr(c->error.message, message)) {
        fprintf(stderr, "message: %s\n", c->error.message);
        CHECK(strstr(c->error.message, message));
    }
}

/* The one restriction has these places, and allows these bits. */
static void expect_places(Case *c, const char *content, bool sided, uint32_t count, const uint32_t *places,
                          uint64_t allowed)
{
    if (read(c, content) != MESO_OK)
        fprintf(stderr, "message: %s\n", c->error.message);
    CHECK(c->constraints.restriction_count == 1);
    const MesoRestriction *restriction = &c->constraints.restrictions[0];
    CHECK(restriction->sided == sided && restriction->place_count == count && restriction->allowed[0] == allowed);
    for (uint32_t i = 0; i < count; i++)
        CHECK(restriction->places[i] == places[i]);
}

/* Variants: plain 0, knob 1 to 4 by their turn, even 5. */
static void test_pins(Case *c)
{
    static const uint32_t two[1] = {2}, left[2] = {0, 2}, side[1] = {9};
    expect_places(c, "\"pins\": [{\"slot\": 2, \"tile\": \"knob\"}]", false, 1, two, 0x1e);
    CHECK(strcmp(c->constraints.restrictions[0].name, "pins[0]") == 0);
    expect_places(c, "\"pins\": [{\"name\": \"x\", \"slot\": 2, \"tile\": \"knob\", \"turn\": 3}]", false, 1, two,
                  0x10);
    CHECK(strcmp(c->constraints.restrictions[0].name, "pins[0] 'x'") == 0);
    /* The four turns of a tile that shows the same under each are one variant. */
    expect_places(c, "\"pins\": [{\"slot\": 2, \"tile\": \"even\", \"turn\": 3}]", false, 1, two, 0x20);
    expect_places(c, "\"pins\": [{\"slot\": 2, \"interface\": \"b\"}]", false, 1, two, 0x1e);
    expect_places(c, "\"pins\": [{\"slot\": 2, \"side\": 1, \"interface\": \"a'\"}]", true, 1, side, 2);
    expect_places(c, "\"pins\": [{\"where\": {\"group\": \"left\"}, \"tile\": \"plain\"}]", false, 2, left, 1);
    expect(c, "\"pins\": [{\"slot\": 4, \"tile\": \"knob\"}]", "pins[0].slot: 4; it must be from 0 to 3");
    expect(c, "\"pins\": [{\"slot\": 1, \"tile\": \"kn\"}]", "pins[0].tile: unknown tile 'kn'");
    expect(c, "\"pins\": [{\"slot\": 1, \"tile\": \"old\"}]", "marked as ignored");
    expect(c, "\"pins\": [{\"slot\": 1, \"tile\": \"plain\", \"turn\": 1}]", "does not allow this transform");
    expect(c, "\"pins\": [{\"slot\": 1, \"interface\": \"c\"}]", "unknown interface 'c'");
    expect(c, "\"pins\": [{\"slot\": 1}]", "either \"tile\" or \"interface\" is needed");
    expect(c, "\"pins\": [{\"tile\": \"plain\"}]", "either \"slot\" or \"where\" is needed");
    expect(c, "\"pins\": [{\"slot\": 1, \"tile\": \"plain\", \"side\": 1}]", "\"side\" goes with \"interface\"");
    expect(c, "\"pins\": [{\"slot\": 1, \"tile\": \"plain\", \"colour\": 1}]", "unknown key \"colour\"");
}

static void test_places(Case *c)
{
    static const uint32_t all[4] = {0, 1, 2, 3}, top[2] = {2, 3}, red[2] = {0, 2}, one[1] = {3}, spans[3] = {3, 0, 1};
    expect_places(c, "\"regions\": [{\"where\": {}, \"tiles\": [\"plain\"]}]", false, 4, all, 1);
    expect_places(c, "\"regions\": [{\"where\": {\"object\": \"sheet\"}, \"tiles\": [\"plain\"]}]", false, 4, all, 1);
    expect_places(c, "\"regions\": [{\"where\": {\"material\": \"blue\"}, \"tiles\": [\"plain\", \"even\"]}]", false, 2,
                  top, 0x21);
    expect_places(c, "\"regions\": [{\"where\": {\"property\": \"red\", \"range\": [0.6, 1]}, \"tiles\": [\"plain\"]}]",
                  false, 2, red, 1);
    expect_places(c, "\"regions\": [{\"where\": {\"property\": \"blue\", \"value\": 0.5, \"group\": \"top\"},"
                  " \"tiles\": [\"plain\"]}]", false, 1, one, 1);
    expect_places(c, "\"regions\": [{\"where\": {\"slots\": [3, [0, 1]]}, \"tiles\": [\"plain\"]}]", false, 3, spans,
                  1);
    expect(c, "\"regions\": [{\"where\": {\"material\": \"red\"}, \"tiles\": [\"plain\"]}]", "no material 'red'");
    expect(c, "\"regions\": [{\"where\": {\"group\": \"middle\"}, \"tiles\": [\"plain\"]}]", "no group 'middle'");
    expect(c, "\"regions\": [{\"where\": {\"property\": \"heat\", \"value\": 1}, \"tiles\": [\"plain\"]}]",
           "no property 'heat'");
    expect(c, "\"regions\": [{\"where\": {\"property\": \"red\"}, \"tiles\": [\"plain\"]}]",
           "either \"value\" or \"range\"");
    expect(c, "\"regions\": [{\"where\": {\"property\": \"red\", \"value\": 0.3}, \"tiles\": [\"plain\"]}]",
           "selects no slot");
    expect(c, "\"regions\": [{\"where\": {\"slots\": [[2, 1]]}, \"tiles\": [\"plain\"]}]", "behind the last");
    expect(c, "\"regions\": [{\"where\": {}}]", "\"tiles\" or \"weights\" is needed");
    expect(c, "\"regions\": [{\"tiles\": [\"plain\"]}]", "regions[0].where: missing");
}

/* PLY: values of faces as they are, of vertices as means, bytes of colours as fractions. */
static void test_ply(void)
{
    static const uint32_t zero[1] = {0}, one[1] = {1};
    Case c;
    begin(&c, "s.ply", ply_text);
    CHECK(c.surface.surface.mesh.attribute_count == 3);
    expect_places(&c, "\"regions\": [{\"where\": {\"property\": \"part\", \"value\": -2}, \"tiles\": [\"plain\"]}]",
                  false, 1, one, 1);
    expect_places(&c, "\"regions\": [{\"where\": {\"property\": \"heat\", \"value\": 1}, \"tiles\": [\"plain\"]}]",
                  false, 1, zero, 1);
    expect_places(&c, "\"regions\": [{\"where\": {\"property\": \"red\", \"value\": 0.5}, \"tiles\": [\"plain\"]}]",
                  false, 1, one, 1);
    meso_arena_release(&c.arena);
}

static uint64_t weight(const Case *c, uint32_t slot, uint32_t variant)
{
    return meso_weight_at(&c->constraints.weights, slot, variant);
}

static void test_weights(Case *c)
{
    CHECK(read(c, "") == MESO_OK && c->constraints.weights.table_count == 0);
    CHECK(read(c, "\"weights\": {\"knob\": 4}") == MESO_OK);
    CHECK(c->constraints.weights.table_count == 1 && !c->constraints.weights.slot_table);
    CHECK(weight(c, 3, 0) == 840 && weight(c, 3, 1) == 840);
    /* Later regions speak last; slots that two regions share have a table of their own. */
    CHECK(read(c, "\"weights\": {\"knob\": 4}, \"regions\": ["
               "{\"where\": {\"group\": \"left\"}, \"weights\": {\"plain\": 2}},"
               "{\"where\": {\"group\": \"top\"}, \"weights\": {\"plain\": 3, \"even\": 0}}]") == MESO_OK);
    const MesoWeights *weights = &c->constraints.weights;
    static const uint64_t plain[4] = {1, 1, 3, 3}, left_plain[4] = {2, 1, 3, 3}, even[4] = {1, 1, 0, 0};
    CHECK(weights->table_count == 4 && c->constraints.restriction_count == 0);
    for (uint32_t s = 0; s < 4; s++)
        CHECK(weight(c, s, 0) == 840 * (s == 0 ? left_plain[s] : plain[s]) && weight(c, s, 5) == 840 * even[s] &&
              weight(c, s, 1) == 840);
    expect(c, "\"weights\": {\"knob\": -1}", "weights.knob: -1; it must be from 0 to 1000000");
    expect(c, "\"weights\": {\"nob\": 1}", "unknown tile 'nob'");
    expect(c, "\"weights\": {\"knob\": 1e6, \"plain\": 1000000.5}",
           "weights.plain: 1000000.5; it must be from 0 to 1000000");
    expect(c, "\"weights\": {\"knob\": -0.001}", "weights.knob: -0.001; it must be from 0 to 1000000");
    expect(c, "\"weights\": {\"knob\": 0.0001}", "weights.knob: 0.0001; a weight has at most three decimals");
    expect(c, "\"weights\": {\"knob\": 999999.9995}", "weights.knob: 999999.9995; a weight has at most three decimals");
    expect(c, "\"weights\": {\"knob\": \"much\"}", "weights.knob: a number, or an object with a ramp, is needed");
}

/* One weight with decimals, and all count in thousandths; whole numbers stay what they are, however written. */
static void test_decimals(Case *c)
{
    CHECK(read(c, "\"weights\": {\"knob\": 4.0, \"even\": 1e6}") == MESO_OK);
    CHECK(weight(c, 0, 0) == 840 && weight(c, 0, 1) == 840 && weight(c, 0, 5) == 840000000);
    CHECK(read(c, "\"weights\": {\"knob\": 0.004, \"even\": 999999.999}") == MESO_OK);
    CHECK(weight(c, 0, 0) == 840000 && weight(c, 0, 1) == 840 && weight(c, 0, 5) == 839999999160);
    CHECK(read(c, "\"weights\": {\"knob\": 3, \"even\": {\"property\": \"red\", \"stops\": [[0.5, 0.25], [1, 2]]}}") == MESO_OK);
    CHECK(weight(c, 0, 1) == 630000 && weight(c, 0, 5) == 1680000 && weight(c, 1, 5) == 210000);
}

/* Vertex colours: red is 1, 0.5, 1, 0.5 in the slots, blue what is left of 1. */
static void test_ramps(Case *c)
{
    static const uint64_t whole[4] = {1200, 600, 1200, 600};
    CHECK(read(c, "\"weights\": {\"even\": {\"property\": \"red\", \"stops\": [[0.5, 600], [1, 1200]]}}") == MESO_OK);
    CHECK(c->constraints.weights.table_count == 1 && !c->constraints.weights.slot_table);
    for (uint32_t s = 0; s < 4; s++)
        CHECK(weight(c, s, 5) == 840 * whole[s] && weight(c, s, 0) == 840);
    /* A region's ramp, beside and over those of the file; the four turns of the knob share. */
    CHECK(read(c, "\"weights\": {\"even\": {\"property\": \"red\", \"stops\": [[0, 0], [1, 1]]}, \"plain\":"
               " {\"property\": \"blue\", \"stops\": [[-1, 7], [0, 3], [1, 0]]}}, \"regions\": ["
               "{\"where\": {\"group\": \"top\"}, \"weights\": {\"knob\":"
               " {\"property\": \"blue\", \"stops\": [[0.2, 0], [0.3, 9]]}}},"
               "{\"where\": {\"slots\": [3]}, \"weights\": {\"even\": 4}}]") == MESO_OK);
    static const uint64_t even[4] = {840, 420, 840, 3360}, plain[4] = {2520, 1260, 2520, 1260},
                          knob[4] = {210, 210, 0, 9 * 210};
    CHECK(c->constraints.weights.table_count == 3);
    for (uint32_t s = 0; s < 4; s++)
        CHECK(weight(c, s, 5) == even[s] && weight(c, s, 0) == plain[s] && weight(c, s, 2) == knob[s]);
}

#define RAMP(property, stops) "\"weights\": {\"even\": {\"property\": \"" property "\", \"stops\": " stops "}}"

static void test_wrong_ramps(Case *c)
{
    expect(c, RAMP("heat", "[[0, 1], [1, 2]]"), "weights.even.property: the surface has no property 'heat'");
    expect(c, RAMP("red", "[[0, 1], [1, 1000001]]"), "weights.even.stops[1][1]: 1000001; it must be from 0 to 1000000");
    expect(c, RAMP("red", "[[0, -1], [1, 1]]"), "weights.even.stops[0][1]: -1; it must be from 0 to 1000000");
    expect(c, RAMP("red", "[[0, 0.0005], [1, 1]]"),
           "weights.even.stops[0][1]: 0.0005; a weight has at most three decimals");
    expect(c, RAMP("red", "[[0, \"some\"], [1, 1]]"), "weights.even.stops[0][1]: a whole number is needed");
    expect(c, RAMP("red", "[[0, 1], [0, 2]]"), "weights.even.stops[1][0]: 0 does not lie above 0; stops are listed by");
    expect(c, RAMP("red", "[[0, 1], [2, 2], [1, 3]]"), "weights.even.stops[2][0]: 1 does not lie above 2");
    expect(c, RAMP("red", "[[0, 1]]"), "weights.even.stops: 1 items; from 2 to 1024 are possible");
    expect(c, RAMP("red", "[[0, 1], 7]"), "weights.even.stops[1]: an array is needed");
    expect(c, RAMP("red", "[[0, 1], [1]]"), "weights.even.stops[1]: 1 items; 2 are needed");
    expect(c, RAMP("red", "[[\"low\", 1], [1, 1]]"), "weights.even.stops[0][0]: a number is needed");
    expect(c, "\"weights\": {\"even\": {\"property\": \"red\"}}", "weights.even.stops: missing");
    expect(c, "\"weights\": {\"even\": {\"stops\": [[0, 1], [1, 2]]}}", "weights.even.property: missing");
    expect(c, "\"weights\": {\"even\": {\"property\": \"red\", \"from\": 1}}", "unknown key \"from\"");
    expect(c, "\"weights\": {\"odd\": {\"property\": \"red\", \"stops\": [[0, 1], [1, 2]]}}", "unknown tile 'odd'");
    expect(c, "\"regions\": [{\"where\": {}, " RAMP("height", "[[0, 1], [1, 2]]") "}]",
           "regions[0].weights.even.property: the surface has no property 'height'");
}

/* Properties of vertices and faces; what is not a number has no place on a ramp. */
static void test_ply_ramps(void)
{
    Case c;
    begin(&c, "s.ply", ply_text);
    CHECK(read(&c, RAMP("heat", "[[1, 1], [4, 10]]")) == MESO_OK);
    CHECK(weight(&c, 0, 5) == 840 && weight(&c, 1, 5) == 7 * 840);     /* 1 and 3 */
    CHECK(read(&c, RAMP("part", "[[0, 1], [8, 9]]")) == MESO_OK);
    CHECK(weight(&c, 0, 5) == 8 * 840 && weight(&c, 1, 5) == 840);     /* 7 and -2 */
    uint32_t component;
    const MesoAttribute *part = meso_polygon_number(&c.surface.surface.mesh, "part", &component);
    double spoilt[2] = {7, NAN};
    MesoAttribute changed = *part;
    changed.scalar = MESO_SCALAR_DOUBLE;
    changed.values = spoilt;
    *(MesoAttribute *)part = changed;
    expect(&c, RAMP("part", "[[0, 1], [8, 9]]"), "weights.even.property: 'part' of slot 1 is not a number");
    CHECK(read(&c, "\"regions\": [{\"where\": {\"slots\": [0]}, " RAMP("part", "[[0, 1], [8, 9]]") "}]") == MESO_OK);
    CHECK(weight(&c, 0, 5) == 8 * 840 && weight(&c, 1, 5) == 840);
    spoilt[0] = -INFINITY;
    CHECK(read(&c, "\"regions\": [{\"where\": {\"slots\": [0]}, " RAMP("part", "[[0, 3], [8, 9]]") "}]") == MESO_OK);
    CHECK(weight(&c, 0, 5) == 3 * 840);
    meso_arena_release(&c.arena);
}

static void test_borders(Case *c)
{
    static const uint32_t loop[8] = {0, 4, 5, 13, 14, 10, 11, 3};
    expect_places(c, "\"borders\": [{\"loop\": 0, \"interfaces\": [\"edge\", \"b'\"]}]", true, 8, loop,
                  1 << 3 | 1 << 4);
    expect_places(c, "\"borders\": [{\"loop\": \"all\", \"interfaces\": [\"a\"]}]", true, 8, loop, 1);
    expect(c, "\"borders\": [{\"loop\": 1, \"interfaces\": [\"a\"]}]", "borders[0].loop: 1; it must be from 0 to 0");
    expect(c, "\"borders\": [{\"loop\": \"some\", \"interfaces\": [\"a\"]}]", "or \"all\", is needed");
    expect(c, "\"borders\": [{\"loop\": 0, \"interfaces\": []}]", "0 items");
    expect(c, "\"borders\": [{\"loop\": 0}]", "borders[0].interfaces: missing");
}

static void test_quotas(Case *c)
{
    CHECK(read(c, "\"quotas\": [{\"tile\": \"knob\", \"most\": 3}, {\"tiles\": [\"plain\", \"even\"], \"least_share\": 0.3,"
               " \"most_share\": 0.75, \"name\": \"calm\"}]") == MESO_OK);
    const MesoQuota *quotas = c->constraints.quotas;
    CHECK(c->constraints.quota_count == 2);
    CHECK(quotas[0].least == 0 && quotas[0].most == 3 && quotas[0].variants[0] == 0x1e);
    CHECK(quotas[1].least == 2 && quotas[1].most == 3 && quotas[1].variants[0] == 0x21);
    CHECK(strcmp(quotas[1].name, "quotas[1] 'calm'") == 0);
    expect(c, "\"quotas\": [{\"tile\": \"knob\", \"least\": 3, \"most\": 2}]", "exclude each other");
    expect(c, "\"quotas\": [{\"tile\": \"knob\", \"most\": 3, \"most_share\": 0.5}]", "exclude each other");
    expect(c, "\"quotas\": [{\"tile\": \"knob\", \"most_share\": 1.5}]", "a share is from 0 to 1");
    expect(c, "\"quotas\": [{\"most\": 2}]", "either \"tile\" or \"tiles\"");
}

static void test_strands(Case *c)
{
    MesoStrandRule rule = {0};
    CHECK(read(c, "\"strands\": {\"no_loops\": true, \"max_length\": 9}") == MESO_OK);
    CHECK(c->constraints.strands.no_loops && c->constraints.strands.max_length == 9);
    expect(c, "\"strands\": {\"max_length\": 0}", "from 1 to");
    CHECK(meso_strand_rule_parse(&rule, "connected,max-length=4294967295", &c->error) == MESO_OK);
    CHECK(rule.connected && !rule.acyclic && rule.max_length == UINT32_MAX);
    static const char *const wrong[] = {"", "loops", "max-length", "max-length=", "max-length=0", "acyclic,",
                                        "max-length=4294967296", "max-length=1x", "max-length=99999999999"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        CHECK(meso_strand_rule_parse(&rule, wrong[i], &c->error) == MESO_ERR_USAGE);
}

/* Notes in every object that has keys of its own. */
static void test_notes(Case *c)
{
    CHECK(read(c, "\"$schema\": \"meso-constraints.schema.json\", \"comment\": [\"why\"], \"extras\": {\"a\": 1}, "
                  "\"pins\": [{\"slot\": 1, \"tile\": \"plain\", \"comment\": \"here\"}], "
                  "\"regions\": [{\"where\": {\"slots\": [0], \"extras\": 1}, \"tiles\": [\"plain\"], \"comment\": 0}], "
                  "\"quotas\": [{\"tile\": \"knob\", \"most\": 1, \"comment\": null}], "
                  "\"strands\": {\"no_loops\": true, \"$schema\": 1}") == MESO_OK);
    CHECK(c->constraints.restriction_count == 2 && c->constraints.quota_count == 1 && c->constraints.strands.no_loops);
    expect(c, "\"strands\": {\"Comment\": 1}", "unknown key \"Comment\"");
}

static void test_files(Case *c)
{
    CHECK(read_text(c, "{\"format\": \"meso-tiles\", \"version\": 1}") == MESO_ERR_INPUT);
    CHECK(read_text(c, "{\"format\": \"meso-constraints\", \"version\": 2}") == MESO_ERR_INPUT);
    expect(c, "\"pin\": []", "unknown key \"pin\"");
    expect(c, "\"pins\": {}", "an array is needed");
    static const char whole[] = "{\"format\": \"meso-constraints\", \"version\": 1, \"pins\": [{\"slot\": 2, \"tile\": \"knob\"}]}";
    for (size_t size = 0; size + 1 < sizeof whole; size++) {
        MesoInput input;
        meso_input_wrap(&input, "c.json", whole, size);
        CHECK(meso_constraints_read(&c->constraints, &c->arena, &input, &c->scope, &c->error) == MESO_ERR_INPUT);
    }
}

int main(void)
{
    Case c;
    begin(&c, "s.obj", surface_text);
    const MesoPolygonMesh *mesh = &c.surface.surface.mesh;
    CHECK(meso_polygon_attribute(mesh, "group")->entry_count == 4 &&
          meso_polygon_attribute(mesh, "material")->entry_count == 2);
    test_pins(&c);
    test_places(&c);
    test_weights(&c);
    test_decimals(&c);
    test_ramps(&c);
    test_wrong_ramps(&c);
    test_borders(&c);
    test_quotas(&c);
    test_strands(&c);
    test_notes(&c);
    test_files(&c);
    meso_arena_release(&c.arena);
    test_ply();
    test_ply_ramps();
    return 0;
}
