/* Every field of a pattern's file, its defaults, and what is said of wrong ones. */
#include "formats/decor/pattern_file.h"

#include <math.h>
#include <string.h>

#include "libcore/base/check.h"

typedef struct Case {
    MesoArena arena;
    MesoError error;
    MesoPattern pattern;
} Case;

static Case c;

static const char two_points[] = "x,y,z\n1,2,3\n4,5,6\n";

/* "two.csv" is there, other files are not. */
static const MesoInput *open_file(void *context, const char *name, MesoError *error)
{
    static MesoInput input;
    (void)context;
    if (strcmp(name, "two.csv") != 0) {
        meso_fail(error, MESO_ERR_INPUT, "cannot open '%s'", name);
        return NULL;
    }
    meso_input_wrap(&input, "two.csv", two_points, strlen(two_points));
    return &input;
}

static MesoStatus read_text(const char *text)
{
    const MesoJsonFiles files = {NULL, open_file};
    MesoInput input;
    meso_input_wrap(&input, "p.json", text, strlen(text));
    return meso_pattern_read(&c.pattern, &c.arena, &input, &files, &c.error);
}

/* With two materials; `content` are keys of the file. */
static MesoStatus read(const char *content)
{
    return read_text(meso_arena_print(&c.arena, NULL, "{\"format\": \"meso-pattern\", \"version\": 1, \"materials\": "
                                      "{\"white\": \"#fff\", \"blue\": \"#0000ff\"}, %s}", content));
}

/* The one step of this text. */
static const MesoStep *step(const char *text)
{
    if (read(meso_arena_print(&c.arena, NULL, "\"steps\": [%s]", text)) != MESO_OK) {
        fprintf(stderr, "%s\n%s\n", text, c.error.message);
        CHECK(false);
    }
    CHECK(c.pattern.step_count == 1);
    return &c.pattern.steps[0];
}

static void expect_message(MesoStatus status, const char *message)
{
    if (status != MESO_ERR_INPUT || strcmp(c.error.message, message) != 0) {
        fprintf(stderr, "status %d: %s\n", status, status ? c.error.message : "");
        fprintf(stderr, "expected: %s\n", message);
        CHECK(false);
    }
}

/* A step that is wrong: the message behind "p.json: steps[0]". */
static void refuse(const char *text, const char *message)
{
    char whole[512];
    snprintf(whole, sizeof whole, "p.json: steps[0]%s", message);
    expect_message(read(meso_arena_print(&c.arena, NULL, "\"steps\": [%s]", text)), whole);
}

static bool is(const char *text, const char *expected) { return text && strcmp(text, expected) == 0; }
static bool near(float a, float b) { return fabsf(a - b) < 1e-6f; }
static bool is_range(MesoRange range, float low, float high) { return range.low == low && range.high == high; }

/* ---- the file ---- */

static void test_file(void)
{
    expect_message(read_text("{"), "p.json:1:1: string or '}' expected near end of file");
    expect_message(read_text("{\"format\": \"meso-tiles\", \"version\": 1}"),
                   "p.json: is a 'meso-tiles' file; a 'meso-pattern' file is needed here");
    CHECK(read_text("{\"format\": \"meso-pattern\", \"version\": 2}") == MESO_ERR_INPUT);
    expect_message(read_text("{\"format\": \"meso-pattern\", \"version\": 1}"), "p.json: steps: missing");
    expect_message(read("\"steps\": []"), "p.json: steps: 0 items; from 1 to 65536 are possible");
    expect_message(read("\"stops\": []"), "p.json: unknown key \"stops\"; there are \"format\", \"version\", \"provenance\", "
                   "\"materials\", \"macros\", \"macro_files\", \"steps\"");
    CHECK(read("\"provenance\": 1, \"comment\": 2, \"$schema\": 3, \"extras\": 4, \"steps\": [{\"paint\": \"white\"}]") == MESO_OK);
    CHECK(is(c.pattern.steps[0].place, "steps[0]"));
}

static void expect_material(uint32_t number, const char *name, float r, float g, float b, float roughness, float metallic)
{
    const MesoMaterial *m = &c.pattern.materials[number];
    CHECK(number < c.pattern.material_count && is(c.pattern.material_names[number], name));
    CHECK(near(m->albedo[0], r) && near(m->albedo[1], g) && near(m->albedo[2], b));
    CHECK(near(m->roughness, roughness) && near(m->metallic, metallic));
}

static MesoStatus read_materials(const char *materials)
{
    return read_text(meso_arena_print(&c.arena, NULL, "{\"format\": \"meso-pattern\", \"version\": 1, \"materials\": %s, "
                                      "\"steps\": [{\"contour\": {}}]}", materials));
}

static void test_materials(void)
{
    CHECK(read_materials("{\"z\": \"#Ff0080\", \"a\": [0.25, 0.5, 1], \"comment\": \"#08f\", "
                         "\"gold\": {\"color\": \"#fff\", \"roughness\": 0.1, \"metallic\": 1}, \"d\": {}}") == MESO_OK);
    CHECK(c.pattern.material_count == 5);
    expect_material(0, "z", 1, 0, 0.21586052f, 0.5f, 0);
    expect_material(1, "a", 0.25f, 0.5f, 1, 0.5f, 0);
    expect_material(2, "comment", 0, 0.24620134f, 1, 0.5f, 0);
    expect_material(3, "gold", 1, 1, 1, 0.1f, 1);
    expect_material(4, "d", 0.6f, 0.6f, 0.6f, 0.5f, 0);
    for (int empty = 0; empty < 2; empty++) {
        CHECK(read_text(empty ? "{\"format\": \"meso-pattern\", \"version\": 1, \"materials\": {}, \"steps\": [{\"paint\": \"plain\"}]}"
                              : "{\"format\": \"meso-pattern\", \"version\": 1, \"steps\": [{\"paint\": \"plain\"}]}") == MESO_OK);
        CHECK(c.pattern.material_count == 1);
        expect_material(0, "plain", 0.6f, 0.6f, 0.6f, 0.5f, 0);
    }
    expect_message(read_materials("{\"a\": \"red\"}"), "p.json: materials.a: 'red' is no colour; \"#rrggbb\" is");
    expect_message(read_materials("{\"a\": \"#12345\"}"), "p.json: materials.a: '#12345' is no colour; \"#rrggbb\" is");
    expect_message(read_materials("{\"a\": \"#12345g\"}"), "p.json: materials.a: '#12345g' is no colour; \"#rrggbb\" is");
    expect_message(read_materials("{\"a\": [0, 1]}"), "p.json: materials.a: 2 items; 3 are needed");
    expect_message(read_materials("{\"a\": [0, 1, 2]}"), "p.json: materials.a[2]: 2; it must be from 0 to 1");
    expect_message(read_materials("{\"a\": 7}"),
                   "p.json: materials.a: a colour is needed here, \"#rrggbb\" or three numbers from 0 to 1");
    expect_message(read_materials("{\"a\": {\"colour\": \"#fff\"}}"),
                   "p.json: materials.a: unknown key \"colour\"; there are \"color\", \"roughness\", \"metallic\"");
    expect_message(read_materials("{\"a\": {\"roughness\": -0.5}}"), "p.json: materials.a.roughness: -0.5; it must be from 0 to 1");
    expect_message(read_materials("{\"\": {}}"), "p.json: materials.: a name of 0 characters; from 1 to 200 are possible");
    expect_message(read_materials("[]"), "p.json: materials: an object is needed here, not an array");
}

/* ---- which regions ---- */

static const MesoSelector *on(const char *text)
{
    return &step(meso_arena_print(&c.arena, NULL, "{\"paint\": \"blue\", \"on\": %s}", text))->on;
}

static void refuse_on(const char *text, const char *message)
{
    refuse(meso_arena_print(&c.arena, NULL, "{\"paint\": \"blue\", \"on\": %s}", text), message);
}

static void test_selector(void)
{
    const MesoSelector *s = on("{}");
    CHECK(!s->path && s->tag_count == 0 && s->level == MESO_SELECT_DEFAULT && !s->has_point && s->colors == 0 && s->share == 1);
    CHECK(s->every == 1 && s->from == 0 && s->largest == 0 && is_range(s->borders, -INFINITY, INFINITY));
    CHECK(is(on("\"body/*/**\"")->path, "body/*/**") && is(on("\".\"")->path, "."));
    CHECK(is(on("{\"path\": \"rim.0/band\", \"level\": \"nodes\"}")->path, "rim.0/band"));
    CHECK(on("{\"level\": \"nodes\"}")->level == MESO_SELECT_NODES && on("{\"level\": \"leaves\"}")->level == MESO_SELECT_LEAVES);
    s = on("{\"tag\": \"dot\"}");
    CHECK(s->tag_count == 1 && is(s->tags[0], "dot"));
    s = on("{\"tag\": [\"surface\", \"background\"]}");
    CHECK(s->tag_count == 2 && is(s->tags[0], "surface") && is(s->tags[1], "background"));
    s = on("{\"borders\": 1, \"corners\": [3, 5], \"aspect\": [null, 2], \"area\": [0.5, null], \"area_share\": [null, null]}");
    CHECK(is_range(s->borders, 1, 1) && is_range(s->corners, 3, 5) && is_range(s->aspect, -INFINITY, 2));
    CHECK(is_range(s->area, 0.5f, INFINITY) && is_range(s->area_share, -INFINITY, INFINITY));
    s = on("{\"point\": [1, -2, 3.5], \"colors\": 4, \"color\": 3, \"share\": 0.25, \"every\": 3, \"from\": 2, \"largest\": 7}");
    CHECK(s->has_point && s->point.x == 1 && s->point.y == -2 && s->point.z == 3.5f && s->colors == 4 && s->color == 3);
    CHECK(s->share == 0.25f && s->every == 3 && s->from == 2 && s->largest == 7);
    s = on("{\"checkered\": 1}");
    CHECK(s->colors == 2 && s->color == 1);
    CHECK(on("{\"colors\": 3}")->colors == 3);
}

static void test_wrong_selectors(void)
{
    refuse_on("7", ".on: a path or an object is needed here");
    refuse_on("\"\"", ".on: empty");
    refuse_on("\"a//b\"", ".on: 'a//b' has an empty name; names have one '/' between them");
    refuse_on("{\"path\": \"/a\"}", ".on.path: '/a' has an empty name; names have one '/' between them");
    refuse_on("\"ban*/b\"", ".on: 'ban*' is no name; '*' is any region, '**' any number of them");
    refuse_on("\"a/***\"", ".on: '***' is no name; '*' is any region, '**' any number of them");
    refuse_on("{\"tag\": \"dots\"}", ".on.tag: no tag 'dots'; did you mean 'dot'?");
    refuse_on("{\"tag\": [\"dot\", 1]}", ".on.tag[1]: a tag is needed here, one of \"surface\", \"band\", \"inside\", \"dot\", "
              "\"background\", \"stripe\", \"cell\"");
    refuse_on("{\"tag\": []}", ".on.tag: 0 items; from 1 to 64 are possible");
    refuse_on("{\"level\": \"node\"}", ".on.level: no level 'node'; did you mean 'nodes'?");
    refuse_on("{\"borders\": [2, 1]}", ".on.borders: the lower end is above the upper one");
    refuse_on("{\"borders\": [2]}", ".on.borders: 1 items; 2 are needed");
    refuse_on("{\"borders\": \"2\"}", ".on.borders: a number or a range, [lowest, highest], is needed here");
    refuse_on("{\"area\": [0, 1e300]}", ".on.area[1]: 1e+300 is too large a number");
    refuse_on("{\"point\": [1, 2]}", ".on.point: 2 items; 3 are needed");
    refuse_on("{\"color\": 1}", ".on: \"color\" goes with \"colors\", how many there are");
    refuse_on("{\"colors\": 2, \"color\": 2}", ".on.color: 2; it must be from 0 to 1");
    refuse_on("{\"checkered\": 0, \"colors\": 2}", ".on: either \"checkered\" or \"colors\" and \"color\" is possible");
    refuse_on("{\"share\": 1.5}", ".on.share: 1.5; it must be from 0 to 1");
    refuse_on("{\"every\": 0}", ".on.every: 0; it must be from 1 to 4294967295");
    CHECK(read("\"steps\": [{\"paint\": \"blue\", \"on\": {\"tags\": \"dot\"}}]") == MESO_ERR_INPUT);
    CHECK(strstr(c.error.message, "steps[0].on: unknown key \"tags\"; there are \"path\", \"tag\""));
}

/* ---- seeds ---- */

static const MesoSeedSet *seeds(const char *text)
{
    return &step(meso_arena_print(&c.arena, NULL, "{\"contour\": {\"dist\": %s}}", text))->field.from;
}

static const MesoSeedSpec *seed(const char *text)
{
    const MesoSeedSet *set = seeds(text);
    CHECK(set->count == 1);
    return &set->specs[0];
}

static void refuse_seed(const char *text, const char *message)
{
    refuse(meso_arena_print(&c.arena, NULL, "{\"contour\": {\"dist\": %s}}", text), message);
}

static void test_seeds(void)
{
    CHECK(seed("\"borders\"")->kind == MESO_SEED_BORDERS && seed("\"outer\"")->kind == MESO_SEED_OUTER);
    CHECK(seed("\"inner\"")->kind == MESO_SEED_INNER);
    const MesoSeedSpec *s = seed("{\"loop\": 2}");
    CHECK(s->kind == MESO_SEED_LOOP && s->loop == 2);
    s = seed("{\"side\": [3, 1], \"loop\": 1}");
    CHECK(s->kind == MESO_SEED_SIDE && s->loop == 1 && s->corners[0] == 3 && s->corners[1] == 1);
    CHECK(seed("{\"side\": [0, 1]}")->loop == 0);
    s = seed("{\"point\": [1, 2, 3]}");
    CHECK(s->kind == MESO_SEED_POINT && s->point.x == 1 && s->point.y == 2 && s->point.z == 3);
    s = seed("{\"face\": 12, \"weights\": [1, 1, 2]}");
    CHECK(s->kind == MESO_SEED_FACE && s->face == 12 && s->weight[0] == 0.25f && s->weight[1] == 0.25f && s->weight[2] == 0.5f);
    CHECK(near(seed("{\"face\": 0}")->weight[0], 1 / 3.f));
    s = seed("{\"along\": \"inner\", \"count\": 5}");
    CHECK(s->kind == MESO_SEED_ALONG && s->of == MESO_SEED_INNER && s->count == 5 && s->spacing == 0 && !s->relative);
    s = seed("{\"along\": {\"side\": [1, 2], \"loop\": 3}, \"spacing\": 0.5}");
    CHECK(s->of == MESO_SEED_SIDE && s->loop == 3 && s->corners[1] == 2 && s->count == 0 && s->spacing == 0.5f && s->relative);
    CHECK(!seed("{\"along\": {\"loop\": 3}, \"spacing\": 0.5, \"unit\": \"scene\"}")->relative);
    s = seed("{\"poisson\": 40}");
    CHECK(s->kind == MESO_SEED_POISSON && s->count == 40 && s->spacing == 0 && s->from_border && !s->on_border);
    s = seed("{\"poisson\": {\"count\": 3, \"radius\": 2, \"unit\": \"scene\", \"on\": \"region\", \"start\": \"any\"}}");
    CHECK(s->count == 3 && s->spacing == 2 && !s->relative && !s->from_border && !s->on_border);
    CHECK(s->border_slack == 0);
    s = seed("{\"poisson\": {\"count\": 3, \"border\": 0.25}}");
    CHECK(s->from_border && s->border_slack == 0.75f);
    s = seed("{\"poisson\": {\"radius\": 0.1, \"on\": \"border\"}}");
    CHECK(s->count == 0 && s->relative && s->on_border && !s->from_border);
}

static void test_unions(void)
{
    const MesoSeedSet *set = seeds("[\"outer\", {\"points\": [[1, 1, 1], [2, 2, 2]]}, {\"file\": \"two.csv\"}, {\"loop\": 1}]");
    CHECK(set->count == 6 && set->specs[0].kind == MESO_SEED_OUTER && set->specs[5].kind == MESO_SEED_LOOP);
    CHECK(set->specs[2].kind == MESO_SEED_POINT && set->specs[2].point.x == 2 && set->specs[4].point.z == 6);
    CHECK(seeds("{\"points\": [[1, 2, 3]]}")->specs[0].point.y == 2 && seeds("{\"file\": \"two.csv\"}")->count == 2);
    CHECK(read("\"steps\": [{\"contour\": {\"dist\": {\"file\": \"two.csv\"}}}, {\"voronoi\": {\"file\": \"two.csv\"}}]") == MESO_OK);
    CHECK(c.pattern.steps[1].field.from.count == 2);
}

static void test_wrong_seeds(void)
{
    refuse_seed("\"outre\"", ".contour.dist: no seed 'outre'; did you mean 'outer'?");
    refuse_seed("\"\"", ".contour.dist: no seed ''; there are \"borders\", \"outer\", \"inner\"");
    refuse_seed("1", ".contour.dist: a seed is needed here: \"borders\", \"outer\", \"inner\" or an object");
    refuse_seed("[]", ".contour.dist: 0 items; from 1 to 1048576 are possible");
    refuse_seed("[\"outer\", [\"inner\"]]", ".contour.dist[1]: a seed is needed here: \"borders\", \"outer\", \"inner\" or an object");
    refuse_seed("{\"pont\": [1, 2, 3]}", ".contour.dist: no seed 'pont'; did you mean 'point'?");
    refuse_seed("{}", ".contour.dist: a seed is needed here: \"borders\", \"outer\", \"inner\" or an object with one of "
                "\"side\", \"loop\", \"point\", \"points\", \"face\", \"along\", \"poisson\", \"file\"");
    refuse_seed("{\"loop\": -1}", ".contour.dist.loop: -1; it must be from 0 to 4294967294");
    refuse_seed("{\"loop\": 1, \"point\": [0, 0, 0]}", ".contour.dist: unknown key \"point\"; there are \"loop\"");
    refuse_seed("{\"side\": [1]}", ".contour.dist.side: 1 items; 2 are needed");
    refuse_seed("{\"point\": [1, 2, \"3\"]}", ".contour.dist.point[2]: a number is needed here, not a string");
    refuse_seed("{\"points\": []}", ".contour.dist.points: 0 items; from 1 to 1048576 are possible");
    refuse_seed("{\"face\": 1.5}", ".contour.dist.face: a whole number is needed here, not a number");
    refuse_seed("{\"face\": 1, \"weights\": [1, 1, -1]}", ".contour.dist.weights: weights must not be negative, nor all 0");
    refuse_seed("{\"face\": 1, \"weights\": [0, 0, 0]}", ".contour.dist.weights: weights must not be negative, nor all 0");
    refuse_seed("{\"along\": \"outer\"}", ".contour.dist: either \"count\" or \"spacing\" is needed");
    refuse_seed("{\"along\": \"outer\", \"count\": 1, \"spacing\": 1}", ".contour.dist: either \"count\" or \"spacing\" is needed");
    refuse_seed("{\"along\": {\"face\": 1}, \"count\": 1}", ".contour.dist.along: a border is needed here: \"borders\", \"outer\", "
                "\"inner\", {\"loop\": N} or {\"side\": [A, B]}");
    refuse_seed("{\"along\": \"outer\", \"count\": 1, \"unit\": \"size\"}", ".contour.dist: \"unit\" goes with \"spacing\"");
    refuse_seed("{\"along\": \"outer\", \"spacing\": 0}", ".contour.dist.spacing: 0; it must be above 0");
    refuse_seed("{\"along\": \"outer\", \"spacing\": 1, \"unit\": \"share\"}", ".contour.dist.unit: no unit 'share'; there are "
                "\"scene\", \"size\"");
    refuse_seed("{\"poisson\": {}}", ".contour.dist.poisson: \"count\" or \"radius\" is needed");
    refuse_seed("{\"poisson\": {\"count\": 2, \"border\": 1.5}}", ".contour.dist.poisson.border: 1.5; it must be from 0 to 1");
    refuse_seed("{\"poisson\": {\"count\": 2, \"border\": 0.5, \"start\": \"any\"}}",
                ".contour.dist.poisson.border: only samples that start at the border keep away from it");
    refuse_seed("{\"points\": [[0, 1e18, 0], [0, 0, -1e19]]}",
                ".contour.dist.points[1]: -1e+19 lies beyond the largest coordinate, 1e+18");
    refuse_seed("{\"poisson\": 0}", ".contour.dist.poisson: 0; it must be from 1 to 1048576");
    refuse_seed("{\"poisson\": 2, \"radius\": 1}", ".contour.dist: unknown key \"radius\"; there are \"poisson\"");
    refuse_seed("{\"poisson\": {\"count\": 2, \"on\": \"border\", \"start\": \"border\"}}",
                ".contour.dist.poisson.start: samples of the border cannot start away from it; \"any\" is possible");
    refuse_seed("{\"file\": \"none.csv\"}", ".contour.dist.file: cannot open 'none.csv'");
}

/* The limit is for all steps together. */
static void test_many_seeds(void)
{
    enum { ITEMS = MESO_PATTERN_SEEDS / 2 + 1, SIZE = 8 };
    char *list = MESO_NEW(&c.arena, char, SIZE * (size_t)ITEMS + 1, NULL);
    for (uint32_t i = 0; i < ITEMS; i++)
        memcpy(list + SIZE * (size_t)i, ",\"outer\"", SIZE);
    char *text = meso_arena_print(&c.arena, NULL, "\"steps\": [{\"voronoi\": [%s]}, {\"voronoi\": [%s]}]", list + 1, list + 1);
    expect_message(read(text), "p.json: steps[1].voronoi: too many seeds: over 1048576 in the whole pattern");
}

/* ---- fields and levels ---- */

static const MesoStep *contour(const char *text)
{
    return step(meso_arena_print(&c.arena, NULL, "{\"contour\": {%s}}", text));
}

static void refuse_contour(const char *text, const char *message)
{
    refuse(meso_arena_print(&c.arena, NULL, "{\"contour\": {%s}}", text), message);
}

static void test_fields(void)
{
    const MesoFieldSpec *f = &contour("")->field;
    CHECK(!f->blend && f->from.count == 1 && f->from.specs[0].kind == MESO_SEED_BORDERS && f->noise.of == MESO_NOISE_NONE);
    f = &contour("\"blend\": [\"inner\", [\"outer\", {\"loop\": 1}]], \"noise\": {}")->field;
    CHECK(f->blend && f->from.count == 1 && f->to.count == 2 && f->to.specs[0].kind == MESO_SEED_OUTER);
    CHECK(f->noise.of == MESO_NOISE_OF_METRIC && f->noise.gain == 0.02f && f->noise.frequency == 8 && f->noise.relative);
    f = &contour("\"noise\": {\"of\": \"field\", \"gain\": 2, \"frequency\": 0.5, \"unit\": \"scene\", \"seed\": 9007199254740993}")->field;
    CHECK(f->noise.of == MESO_NOISE_OF_FIELD && f->noise.gain == 2 && f->noise.frequency == 0.5f && !f->noise.relative);
    CHECK(f->noise.seed == 9007199254740993);
    refuse_contour("\"dist\": \"outer\", \"blend\": [\"outer\", \"inner\"]", ".contour: either \"dist\" or \"blend\" is possible");
    refuse_contour("\"blend\": [\"outer\"]", ".contour.blend: 1 items; 2 are needed");
    refuse_contour("\"noise\": {\"gain\": -1}", ".contour.noise.gain: -1; it must be 0 or more");
    refuse_contour("\"noise\": {\"frequency\": 0}", ".contour.noise.frequency: 0; it must be above 0");
    refuse_contour("\"noise\": {\"of\": \"fields\"}", ".contour.noise.of: no kind of noise 'fields'; did you mean 'field'?");
    refuse_contour("\"noise\": {\"seed\": -1}", ".contour.noise.seed: -1; it must be from 0 to 9223372036854775807");
    refuse_contour("\"lines\": 4", ".contour: unknown key \"lines\"; there are \"dist\", \"blend\", \"noise\", \"at\", \"count\", "
                   "\"every\", \"unit\"");
}

static void test_levels(void)
{
    const MesoLevels *l = &contour("")->levels;
    CHECK(l->value_count == 1 && l->values[0] == 0.5f && l->unit == MESO_LEVEL_SHARE && l->count == 0 && l->every == 0);
    l = &contour("\"at\": [0.25, 3], \"unit\": \"scene\"")->levels;
    CHECK(l->value_count == 2 && l->values[0] == 0.25f && l->values[1] == 3 && l->unit == MESO_LEVEL_SCENE);
    l = &contour("\"blend\": [\"inner\", \"outer\"], \"count\": 5")->levels;
    CHECK(l->count == 5 && l->value_count == 0 && l->unit == MESO_LEVEL_SCENE);
    CHECK(contour("\"blend\": [\"inner\", \"outer\"], \"at\": 0.1, \"unit\": \"share\"")->levels.unit == MESO_LEVEL_SHARE);
    l = &contour("\"every\": 0.125, \"unit\": \"size\"")->levels;
    CHECK(l->every == 0.125f && l->unit == MESO_LEVEL_SIZE && l->value_count == 0);
    refuse_contour("\"at\": 0.5, \"count\": 2", ".contour: one of \"at\", \"count\" and \"every\" is possible");
    refuse_contour("\"at\": 1", ".contour.at: 1; it must be between 0 and 1");
    refuse_contour("\"at\": 0, \"unit\": \"scene\"", ".contour.at: 0; it must be above 0");
    refuse_contour("\"at\": [0.5, 0.5]", ".contour.at[1]: 0.5; levels must ascend, and the one before is 0.5");
    refuse_contour("\"at\": []", ".contour.at: 0 items; from 1 to 65536 are possible");
    refuse_contour("\"count\": 0", ".contour.count: 0; it must be from 1 to 65536");
    refuse_contour("\"every\": 0", ".contour.every: 0; it must be between 0 and 1");
    refuse_contour("\"count\": 2, \"unit\": \"size\"", ".contour.unit: it goes with \"at\" and \"every\"");
    refuse_contour("\"at\": 0.2, \"unit\": \"sice\"", ".contour.unit: no unit 'sice'; did you mean 'size'?");
    refuse_contour("\"blend\": [\"inner\", \"outer\"], \"at\": 0.2, \"unit\": \"size\"",
                   ".contour.unit: a blend is no length; \"share\" is possible");
}

/* ---- steps ---- */

static void test_operators(void)
{
    const MesoStep *s = step("{\"contour\": {}}");
    CHECK(s->kind == MESO_STEP_CONTOUR && s->after_count == 0 && !s->on.path);
    s = step("{\"stream\": {\"blend\": [\"inner\", \"outer\"], \"lines\": 24}}");
    CHECK(s->kind == MESO_STEP_STREAM && s->line_count == 24 && s->field.blend && step("{\"stream\": {}}")->line_count == 12);
    s = step("{\"voronoi\": [{\"poisson\": 4}, {\"point\": [0, 0, 0]}]}");
    CHECK(s->kind == MESO_STEP_VORONOI && s->field.from.count == 2 && s->field.noise.of == MESO_NOISE_NONE);
    s = step("{\"voronoi\": {\"dist\": {\"poisson\": 4}, \"noise\": {}}}");
    CHECK(s->field.from.specs[0].count == 4 && s->field.noise.of == MESO_NOISE_OF_METRIC);
    s = step("{\"polyline\": {\"points\": [[0, 1, 2], {\"face\": 3}, {\"point\": [4, 5, 6]}, {\"file\": \"two.csv\"}], \"closed\": true}}");
    CHECK(s->kind == MESO_STEP_POLYLINE && s->closed && s->point_count == 5 && s->points[1].kind == MESO_SEED_FACE);
    CHECK(s->points[0].point.z == 2 && s->points[4].point.x == 4 && !step("{\"polyline\": {\"points\": [[0, 0, 0], [1, 1, 1]]}}")->closed);
    refuse("{\"stream\": {\"lines\": 0}}", ".stream.lines: 0; it must be from 1 to 65536");
    refuse("{\"stream\": {\"at\": 0.1}}", ".stream: unknown key \"at\"; there are \"dist\", \"blend\", \"noise\", \"lines\"");
    refuse("{\"voronoi\": {}}", ".voronoi.dist: missing");
    refuse("{\"voronoi\": {\"poison\": 3}}", ".voronoi: unknown key \"poison\"; there are \"dist\", \"noise\"");
    refuse("{\"polyline\": {\"points\": [[0, 0, 0]]}}", ".polyline.points: 1 points; 2 or more are needed");
    refuse("{\"polyline\": {\"points\": [[0, 0, 0], [1, 1, 1]], \"closed\": true}}",
           ".polyline.points: 2 points; 3 or more are needed");
    refuse("{\"polyline\": {\"points\": [[0, 0, 0], \"outer\"]}}", ".polyline.points[1]: a point is needed here: [x, y, z], "
           "{\"point\": ...}, {\"face\": ...} or {\"file\": ...}");
    refuse("{\"polyline\": {}}", ".polyline.points: missing");
    refuse("{\"polyline\": [[0, 0, 0]]}", ".polyline: an object is needed here, not an array");
}

static void test_step_keys(void)
{
    refuse("7", ": an object is needed here, not a number");
    refuse("{}", ": a step does something; there are \"contour\", \"stream\", \"voronoi\", \"polyline\", \"paint\", \"displace\", "
           "\"macro\", \"steps\" and \"grow\"");
    refuse("{\"on\": \"a\", \"countour\": {}}", ": no step 'countour'; did you mean 'contour'?");
    refuse("{\"contour\": {}, \"stream\": {}}", ": unknown key \"stream\"; there are \"contour\", \"on\", \"paint\", \"displace\", "
           "\"names\"");
    refuse("{\"paint\": \"blue\", \"displace\": 1}", ": unknown key \"displace\"; there are \"paint\", \"on\"");
    refuse("{\"displace\": 1, \"names\": \"x\"}", ": unknown key \"names\"; there are \"displace\", \"on\"");
    refuse("{\"steps\": [{\"paint\": \"blue\"}], \"paint\": \"blue\"}", ": unknown key \"paint\"; there are \"steps\", \"on\"");
    refuse("{\"contour\": 1}", ".contour: an object is needed here, not a number");
    CHECK(step("{\"paint\": \"blue\", \"comment\": \"why\"}")->kind == MESO_STEP_PAINT);
}

static void test_paint(void)
{
    const MesoStep *s = step("{\"paint\": \"blue\"}");
    const MesoAfterSplit *a = s->after;
    CHECK(s->after_count == 1 && a->painted && !a->displaced && a->by == MESO_PAINT_ALL && a->material_count == 1 && a->materials[0] == 1);
    a = step("{\"paint\": [\"blue\", \"white\"]}")->after;
    CHECK(a->by == MESO_PAINT_CYCLE && a->material_count == 2 && a->materials[0] == 1 && a->materials[1] == 0);
    CHECK(step("{\"paint\": {\"by\": \"random\", \"materials\": [\"blue\", \"white\"]}}")->after->by == MESO_PAINT_RANDOM);
    CHECK(step("{\"paint\": {\"by\": \"ramp\", \"materials\": [\"blue\", \"white\"]}}")->after->by == MESO_PAINT_RAMP);
    CHECK(step("{\"paint\": {\"by\": \"all\", \"materials\": [\"blue\", \"white\"]}}")->after->by == MESO_PAINT_ALL);
    CHECK(step("{\"paint\": {\"materials\": \"white\"}}")->after->by == MESO_PAINT_ALL);
    refuse("{\"paint\": \"bleu\"}", ".paint: no material 'bleu'; did you mean 'blue'?");
    refuse("{\"paint\": \"green\"}", ".paint: no material 'green'; there are \"white\", \"blue\"");
    refuse("{\"paint\": 1}", ".paint: the name of a material is needed here");
    refuse("{\"paint\": []}", ".paint: 0 items; from 1 to 65536 are possible");
    refuse("{\"paint\": {\"band\": \"blue\"}}", ".paint: unknown key \"band\"; there are \"by\", \"materials\"");
    refuse("{\"paint\": {\"by\": \"ramp\"}}", ".paint.materials: missing");
    refuse("{\"paint\": {\"by\": \"ramp\", \"materials\": [\"blue\"]}}", ".paint.materials: a ramp is between two materials or more");
    refuse("{\"paint\": {\"by\": \"ramps\", \"materials\": [\"blue\"]}}", ".paint.by: no way to paint 'ramps'; did you mean 'ramp'?");
}

static void test_displace(void)
{
    const MesoStep *s = step("{\"displace\": -0.25}");
    const MesoDisplacement *d = &s->after->displacement;
    CHECK(s->kind == MESO_STEP_DISPLACE && s->after_count == 1 && s->after->displaced && !s->after->painted);
    CHECK(d->height == -0.25f && d->relative && d->bias == 0.5f && d->gain == 0.5f && d->jitter == 0);
    d = &step("{\"displace\": {\"height\": 2, \"unit\": \"scene\", \"bias\": 0.75, \"gain\": 0.25, \"jitter\": 1}}")->after->displacement;
    CHECK(d->height == 2 && !d->relative && d->bias == 0.75f && d->gain == 0.25f && d->jitter == 1);
    refuse("{\"displace\": {}}", ".displace.height: missing");
    refuse("{\"displace\": {\"height\": 1, \"bias\": 0}}", ".displace.bias: 0; it must be between 0 and 1");
    refuse("{\"displace\": {\"height\": 1, \"gain\": 1}}", ".displace.gain: 1; it must be between 0 and 1");
    refuse("{\"displace\": {\"height\": 1, \"jitter\": 2}}", ".displace.jitter: 2; it must be from 0 to 1");
    refuse("{\"displace\": {\"height\": 1, \"unit\": \"size\"}}", ".displace.unit: no unit 'size'; there are \"scene\", \"share\"");
    refuse("{\"displace\": \"high\"}", ".displace: an object is needed here, not a string");
}

static const MesoAfterSplit *after(const char *text, uint32_t count)
{
    const MesoStep *s = step(meso_arena_print(&c.arena, NULL, "{\"contour\": {}, %s}", text));
    CHECK(s->after_count == count);
    return s->after;
}

static void test_after_split(void)
{
    const MesoAfterSplit *a = after("\"paint\": \"blue\"", 1);
    CHECK(!a->tag && !a->name && a->painted && !a->displaced);
    a = after("\"paint\": {\"dot\": \"blue\"}", 1);
    CHECK(is(a->tag, "dot") && a->painted && a->materials[0] == 1);
    /* Where tags differ, each has one entry, with what is said of all others. */
    a = after("\"paint\": {\"*\": \"white\", \"inside\": \"blue\"}, \"displace\": {\"band\": 1}, \"names\": {\"band\": \"rim\"}", 5);
    CHECK(is(a[0].tag, "band") && is(a[0].name, "rim") && a[0].displaced && a[0].displacement.height == 1);
    CHECK(a[0].painted && a[0].materials[0] == 0);
    CHECK(is(a[1].tag, "inside") && a[1].materials[0] == 1 && !a[1].displaced && !a[1].name);
    CHECK(is(a[2].tag, "dot") && is(a[4].tag, "stripe") && a[4].materials[0] == 0 && !a[4].displaced && !a[4].name);
    a = after("\"paint\": {\"dot\": \"blue\"}, \"names\": \"all\"", 5);
    CHECK(!a[0].painted && is(a[0].name, "all") && a[2].painted && is(a[2].name, "all"));
    a = after("\"names\": \"petal\", \"displace\": {\"height\": 0.5}", 1);
    CHECK(!a->tag && is(a->name, "petal") && a->displacement.height == 0.5f);
    after("\"paint\": {}, \"names\": {\"comment\": 1}", 0);
    CHECK(is(step("{\"polyline\": {\"points\": [[0, 0, 0], [1, 1, 1], [2, 2, 2]], \"closed\": true}, \"names\": {\"inside\": \"a\"}}")
                 ->after->tag, "inside"));
    refuse("{\"contour\": {}, \"paint\": {\"bnad\": \"blue\"}}", ".paint: no tag 'bnad'; did you mean 'band'?");
    refuse("{\"stream\": {}, \"paint\": {\"band\": \"blue\"}}", ".paint: no tag 'band'; there are \"stripe\"");
    refuse("{\"voronoi\": \"borders\", \"paint\": {\"dot\": \"blue\"}}", ".paint: no tag 'dot'; there are \"cell\"");
    refuse("{\"contour\": {}, \"paint\": {\"dot\": \"bleu\"}}", ".paint.dot: no material 'bleu'; did you mean 'blue'?");
    refuse("{\"contour\": {}, \"names\": {\"dot\": \"a/b\"}}", ".names.dot: 'a/b' is no name: '/', '*' and '.' are for paths");
    refuse("{\"contour\": {}, \"names\": \"\"}", ".names: empty");
    refuse("{\"contour\": {}, \"names\": 1}", ".names: a string is needed here, not a number");
    refuse("{\"contour\": {}, \"displace\": {\"dot\": {\"hight\": 1}}}",
           ".displace.dot: unknown key \"hight\"; there are \"height\", \"unit\", \"bias\", \"gain\", \"jitter\"");
}

static void test_grow(void)
{
    const MesoStep *s = step("{\"grow\": {\"rules\": [{\"macro\": \"cells\"}]}, \"on\": \"body\"}");
    const MesoGrowth *g = &s->growth;
    CHECK(s->kind == MESO_STEP_GROW && is(s->on.path, "body") && g->rule_count == 1 && g->depth == 3 && g->smallest == 0.001f);
    CHECK(g->grouping == MESO_GROUP_TYPE && g->cycle == 2 && g->rest == 0 && g->rules[0].weight == 1 && g->rules[0].most == 0);
    CHECK(g->rules[0].where.tag_count == 0 && is_range(g->rules[0].where.corners, -INFINITY, INFINITY));
    g = &step("{\"grow\": {\"depth\": 5, \"smallest\": 0.5, \"group\": \"cyclic\", \"cycle\": 3, \"rest\": 0.5, \"rules\": ["
              "{\"on\": {\"tag\": \"cell\", \"borders\": 1, \"area_share\": [0.1, null]}, \"macro\": \"outline\", \"width\": 0.1, "
              "\"weight\": 2, \"most\": 4}, {\"macro\": \"cells\", \"weight\": 0}]}}")->growth;
    CHECK(g->rule_count == 2 && g->depth == 5 && g->smallest == 0.5f && g->grouping == MESO_GROUP_CYCLIC && g->cycle == 3);
    CHECK(g->rest == 0.5f && g->rules[0].weight == 2 && g->rules[0].most == 4 && g->rules[1].weight == 0);
    CHECK(is(g->rules[0].where.tags[0], "cell") && is_range(g->rules[0].where.borders, 1, 1));
    CHECK(is(g->rules[0].macro.name, "outline") && g->rules[0].macro.steps[0].levels.values[0] == 0.1f);
    CHECK(is(g->rules[0].macro.steps[0].place, "steps[0].grow.rules[0].macro outline.steps[0]"));
    refuse("{\"grow\": {}}", ".grow.rules: missing");
    refuse("{\"grow\": {\"rules\": []}}", ".grow.rules: 0 items; from 1 to 1024 are possible");
    refuse("{\"grow\": {\"rules\": [{}]}}", ".grow.rules[0].macro: missing");
    refuse("{\"grow\": {\"rules\": [{\"macro\": \"cell\"}]}}", ".grow.rules[0].macro: no macro 'cell'; did you mean 'cells'?");
    refuse("{\"grow\": {\"rules\": [{\"macro\": \"cells\", \"on\": 1}]}}",
           ".grow.rules[0].on: a path or an object is needed here");
    CHECK(is(step("{\"grow\": {\"rules\": [{\"macro\": \"cells\", \"on\": \"**/dot\"}]}}")->growth.rules[0].where.path, "**/dot"));
    refuse("{\"grow\": {\"rules\": [{\"macro\": \"cells\", \"on\": {\"every\": 2}}]}}", ".grow.rules[0].on: unknown key \"every\"; "
           "there are \"path\", \"tag\", \"borders\", \"corners\", \"aspect\", \"area\", \"area_share\"");
    refuse("{\"grow\": {\"rules\": [{\"macro\": \"cells\", \"weight\": -1}]}}", ".grow.rules[0].weight: -1; it must be 0 or more");
    refuse("{\"grow\": {\"rules\": [{\"macro\": \"cells\", \"weight\": 0}]}}", ".grow: no rule has a weight above 0");
    refuse("{\"grow\": {\"rules\": [{\"macro\": \"cells\"}], \"cycle\": 2}}", ".grow.cycle: it goes with \"group\": \"cyclic\"");
    refuse("{\"grow\": {\"rules\": [{\"macro\": \"cells\"}], \"group\": \"shapes\"}}", ".grow.group: no grouping 'shapes'; did you mean "
           "'shape'?");
    refuse("{\"grow\": {\"rules\": [{\"macro\": \"cells\"}], \"depth\": 65}}", ".grow.depth: 65; it must be from 1 to 64");
}

int main(void)
{
    meso_arena_init(&c.arena);
    test_file();
    test_materials();
    test_selector();
    test_wrong_selectors();
    test_seeds();
    test_unions();
    test_wrong_seeds();
    test_many_seeds();
    test_fields();
    test_levels();
    test_operators();
    test_step_keys();
    test_paint();
    test_displace();
    test_after_split();
    test_grow();
    meso_arena_release(&c.arena);
}
