/* Every field of a file of details, its defaults, and what is said of wrong ones. */
#include "formats/replicate/details_file.h"

#include <math.h>

#include "libcore/base/check.h"
#include "libcore/base/index.h"

typedef struct Case {
    MesoArena arena;
    MesoError error;
    MesoDetailsFile details;
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
    meso_input_wrap(&input, "d.json", text, strlen(text));
    return meso_details_read(&c.details, &c.arena, &input, &files, &c.error);
}

static MesoStatus read(const char *kinds, const char *details)
{
    return read_text(meso_arena_print(&c.arena, NULL, "{\"format\": \"meso-details\", \"version\": 1, \"materials\": "
                                      "{\"white\": \"#fff\", \"blue\": {\"color\": \"#0000ff\", \"metallic\": 1}}, "
                                      "\"kinds\": {%s}, \"details\": [%s]}", kinds, details));
}

static void expect_good(MesoStatus status)
{
    if (status)
        fprintf(stderr, "%s\n", c.error.message);
    CHECK(status == MESO_OK);
}

static const MesoDetailKind *kind(const char *text)
{
    expect_good(read(meso_arena_print(&c.arena, NULL, "\"k\": %s", text), "{\"poisson\": 1}"));
    CHECK(c.details.kind_count == 1);
    return &c.details.kinds[0];
}

static const MesoDetailDistribution *distribution(const char *text)
{
    expect_good(read("\"spine\": {\"mesh\": \"spine.obj\"}, \"pore\": {\"hole\": {}}", text));
    CHECK(c.details.distribution_count == 1);
    return &c.details.distributions[0];
}

static void expect_message(MesoStatus status, const char *message)
{
    CHECK(status == MESO_ERR_INPUT);
    CHECK_TEXT(c.error.message, message);
}

static void bad_kind(const char *text, const char *message)
{
    expect_message(read(meso_arena_print(&c.arena, NULL, "\"k\": %s", text), "{\"poisson\": 1}"), message);
}

static void bad(const char *text, const char *message)
{
    expect_message(read("\"spine\": {\"mesh\": \"spine.obj\"}, \"pore\": {\"hole\": {}}", text), message);
}

static void test_kinds(void)
{
    const MesoDetailKind *k = kind("{\"mesh\": \"spine.obj\"}");
    CHECK_TEXT(k->name, "k");
    CHECK_TEXT(k->file, "spine.obj");
    CHECK(k->geometry == MESO_DETAIL_MESH && k->length == 0 && k->lift == 0 && !k->own_material);
    CHECK(c.details.material_count == 2 && c.details.materials[1].metallic == 1);
    CHECK_TEXT(c.details.material_names[1], "blue");
    k = kind("{\"mesh\": \"spine.obj\", \"length\": 2, \"lift\": -0.5, \"upright\": true, \"material\": \"blue\"}");
    CHECK(k->upright && k->length == 2 && k->lift == -0.5f && k->own_material && k->material == 1);
    k = kind("{\"bump\": {}}");
    CHECK(k->geometry == MESO_DETAIL_BUMP && k->profile == MESO_BUMP_GAUSS && k->height == 0.25f);
    CHECK_TEXT(k->file, "");
    k = kind("{\"bump\": {\"profile\": \"ring\", \"height\": -1}, \"comment\": \"a crater\"}");
    CHECK(k->profile == MESO_BUMP_RING && k->height == -1);
    k = kind("{\"bump\": {\"image\": \"star.png\"}}");
    CHECK(k->profile == MESO_BUMP_IMAGE);
    CHECK_TEXT(k->file, "star.png");
    CHECK(kind("{\"hole\": {}}")->geometry == MESO_DETAIL_HOLE);

    bad_kind("{}", "d.json: kinds.k: one of \"mesh\", \"bump\" and \"hole\" is needed");
    bad_kind("{\"hole\": {}, \"bump\": {}}", "d.json: kinds.k: one of \"mesh\", \"bump\" and \"hole\" is needed");
    bad_kind("3", "d.json: kinds.k: an object is needed here, not a number");
    bad_kind("{\"mesh\": \"\"}", "d.json: kinds.k.mesh: empty");
    bad_kind("{\"mesh\": \"a\", \"size\": 1}",
             "d.json: kinds.k: unknown key \"size\"; there are \"mesh\", \"length\", \"lift\", \"upright\", "
             "\"material\"");
    bad_kind("{\"mesh\": \"a\", \"material\": \"blu\"}",
             "d.json: kinds.k.material: no material 'blu'; did you mean 'blue'?");
    bad_kind("{\"bump\": {\"profile\": \"gaus\"}}",
             "d.json: kinds.k.bump.profile: no profile 'gaus'; did you mean 'gauss'?");
    bad_kind("{\"bump\": {\"profile\": \"image\"}}", "d.json: kinds.k.bump.image: missing");
    bad_kind("{\"bump\": {\"profile\": \"ring\", \"image\": \"a.png\"}}",
             "d.json: kinds.k.bump.image: it goes with \"profile\": \"image\"");
    bad_kind("{\"bump\": {\"height\": 11}}", "d.json: kinds.k.bump.height: 11; it must be from -10 to 10");
    bad_kind("{\"hole\": {\"size\": 1}}", "d.json: kinds.k.hole: unknown key \"size\"; there are ");
    expect_message(read("", "{\"poisson\": 1}"), "d.json: kinds: 0 of them; from 1 to 1024 are possible");
}

static void test_points(void)
{
    const MesoDetailDistribution *d = distribution("{\"points\": [[1, 2, 3], {\"at\": [4, 5, 6], \"size\": 0.5, "
                                                   "\"aspect\": 2, \"kind\": \"pore\", \"heading\": [0, 0, 2]}]}");
    CHECK(d->source == MESO_DETAILS_AT_POINTS && d->point_count == 2);
    CHECK(d->points[0].position.z == 3 && isnan(d->points[0].size) && isnan(d->points[0].aspect));
    CHECK(d->points[0].kind == MESO_NO_INDEX && !d->points[0].headed);
    CHECK(d->points[1].position.x == 4 && d->points[1].size == 0.5f && d->points[1].aspect == 2);
    CHECK(d->points[1].kind == 1 && d->points[1].headed && d->points[1].direction.z == 2);
    d = distribution("{\"points\": {\"file\": \"two.csv\"}}");
    CHECK(d->point_count == 2 && d->points[1].position.y == 5 && isnan(d->points[1].size));

    bad("{\"points\": []}", "d.json: details[0].points: 0 items; from 1 to 16777216 are possible");
    bad("{\"points\": [3]}",
        "d.json: details[0].points[0]: a point is needed here: [x, y, z], or {\"at\": [x, y, z], ...}");
    bad("{\"points\": [{}]}", "d.json: details[0].points[0].at: missing");
    bad("{\"points\": [[1, 2]]}", "d.json: details[0].points[0]: 2 items; 3 are needed");
    bad("{\"points\": [[1, 2, 2e18]]}",
        "d.json: details[0].points[0]: 2e+18 lies beyond the largest coordinate, 1e+18");
    bad("{\"points\": [{\"at\": [0, 0, 0], \"heading\": [0, 0, 0]}]}",
        "d.json: details[0].points[0].heading: [0, 0, 0] is no direction");
    bad("{\"points\": {\"file\": \"three.csv\"}}", "d.json: details[0].points.file: cannot open 'three.csv'");
}

static void test_sources(void)
{
    const MesoDetailDistribution *d = distribution("{\"poisson\": {\"count\": 500}}");
    CHECK(d->source == MESO_DETAILS_POISSON && d->count == 500 && d->radius == 0);
    CHECK(!d->density.given && !d->sized && d->size[0] == 1 && d->size[1] == 1 && d->aspect[0] == 1);
    CHECK(d->heading.source == MESO_HEADING_RANDOM && d->shares[0] == 1 && d->shares[1] == 0);
    CHECK(distribution("{\"poisson\": 0.25}")->radius == 0.25f);
    CHECK(distribution("{\"poisson\": {\"radius\": 0.5}}")->radius == 0.5f);
    d = distribution("{\"scatter\": {\"count\": 30}}");
    CHECK(d->source == MESO_DETAILS_SCATTERED && d->count == 30 && distribution("{\"scatter\": 7}")->count == 7);
    d = distribution("{\"scene\": \"vase.meso\"}");
    CHECK(d->source == MESO_DETAILS_OF_SCENE && !d->channel && d->heading.source == MESO_HEADING_SCENE);
    CHECK_TEXT(d->scene, "vase.meso");
    CHECK_TEXT(distribution("{\"scene\": {\"file\": \"vase.meso\", \"channel\": \"terminal\"}}")->channel, "terminal");

    bad("{}", "d.json: details[0]: one of \"points\", \"poisson\", \"scatter\" and \"scene\" is needed");
    bad("{\"poisson\": 1, \"scene\": \"a\"}",
        "d.json: details[0]: one of \"points\", \"poisson\", \"scatter\" and \"scene\" is needed");
    bad("{\"poisson\": {}}", "d.json: details[0].poisson: either \"radius\" or \"count\" is needed");
    bad("{\"poisson\": 0}", "d.json: details[0].poisson: 0; it must be between 0 and 1e+18");
    bad("{\"scatter\": {}}", "d.json: details[0].scatter: \"count\" is needed");
    bad("{\"scatter\": 0}", "d.json: details[0].scatter: 0; it must be from 1 to 16777216");
    bad("{\"scene\": {}}", "d.json: details[0].scene.file: missing");
    bad("{\"poison\": 1}", "d.json: details[0]: unknown key \"poison\"; there are \"points\", \"poisson\", "
        "\"scatter\", \"scene\", \"density\", \"size\", \"size_map\", \"aspect\", \"heading\", \"kind\"");
}

static void test_looks(void)
{
    const MesoDetailDistribution *d = distribution(
        "{\"poisson\": 1, \"density\": {\"attribute\": \"damp\", \"channel\": 2, \"low\": 1, \"high\": 0}, "
        "\"size\": [0.5, 2], \"size_map\": {\"image\": \"size.png\"}, \"aspect\": 0.5, "
        "\"heading\": {\"attribute\": \"flow\", \"spread\": 90}, \"kind\": {\"pore\": 3, \"spine\": 1}}");
    CHECK(d->density.given && !d->density.image && d->density.channel == 2 && d->density.low == 1);
    CHECK_TEXT(d->density.attribute, "damp");
    CHECK(d->sized && d->size[0] == 0.5f && d->size[1] == 2 && d->aspect[0] == 0.5f && d->aspect[1] == 0.5f);
    CHECK(d->size_map.given && !d->size_map.attribute && d->size_map.low == 0 && d->size_map.high == 1);
    CHECK_TEXT(d->size_map.image, "size.png");
    CHECK(d->heading.source == MESO_HEADING_ATTRIBUTE && fabsf(d->heading.spread - 1.5707964f) < 1e-6f);
    CHECK_TEXT(d->heading.attribute, "flow");
    CHECK(d->shares[0] == 0.25f && d->shares[1] == 0.75f);
    d = distribution("{\"poisson\": 1, \"heading\": [0, 1, 0], \"kind\": \"pore\"}");
    CHECK(d->heading.source == MESO_HEADING_DIRECTION && d->heading.direction.y == 1 && d->shares[1] == 1);
    CHECK(distribution("{\"scene\": \"a\", \"heading\": \"random\"}")->heading.source == MESO_HEADING_RANDOM);

    bad("{\"poisson\": 1, \"size\": [2, 1]}", "d.json: details[0].size: from 2 to 1 is no range");
    bad("{\"poisson\": 1, \"size\": 0}", "d.json: details[0].size: 0; it must be between 0 and 1e+18");
    bad("{\"poisson\": 1, \"size_map\": {\"image\": \"a\"}}",
        "d.json: details[0].size_map: it goes from one size to another: \"size\": [low, high] is needed");
    bad("{\"poisson\": 1, \"density\": {}}",
        "d.json: details[0].density: either \"attribute\" or \"image\" is needed");
    bad("{\"poisson\": 1, \"density\": {\"image\": \"a\", \"low\": 1}}",
        "d.json: details[0].density: \"low\" and \"high\" are the same, 1");
    bad("{\"poisson\": 1, \"heading\": \"scene\"}",
        "d.json: details[0].heading: \"scene\" goes with details of a scene");
    bad("{\"poisson\": 1, \"heading\": \"randm\"}",
        "d.json: details[0].heading: no heading 'randm'; did you mean 'random'?");
    bad("{\"poisson\": 1, \"heading\": {}}",
        "d.json: details[0].heading: either \"direction\" or \"attribute\" is needed");
    bad("{\"poisson\": 1, \"kind\": \"spin\"}", "d.json: details[0].kind: no kind 'spin'; did you mean 'spine'?");
    bad("{\"poisson\": 1, \"kind\": {\"pores\": 1}}",
        "d.json: details[0].kind: no kind 'pores'; did you mean 'pore'?");
    bad("{\"poisson\": 1, \"kind\": {\"pore\": 0}}", "d.json: details[0].kind: no kind has a share above 0");
}

static void test_whole(void)
{
    expect_good(read_text("{\"format\": \"meso-details\", \"version\": 1, \"kinds\": {\"a\": {\"hole\": {}}}, "
                          "\"details\": [{\"poisson\": 1}, {\"poisson\": 2}]}"));
    CHECK(c.details.distribution_count == 2 && c.details.material_count == 1);
    CHECK_TEXT(c.details.material_names[0], "plain");
    expect_message(read_text("{\"format\": \"meso-details\", \"version\": 1, \"kinds\": {\"a\": {\"hole\": {}}}}"),
                   "d.json: details: missing");
    expect_message(read_text("{\"format\": \"meso-details\", \"version\": 1, \"kinds\": {\"a\": {\"bump\": {}, "
                             "\"material\": \"a\"}}, \"details\": [{\"poisson\": 1}]}"),
                   "d.json: kinds.a.material: there are no \"materials\"");
    expect_message(read_text("{\"format\": \"meso-details\", \"version\": 1, \"kinds\": [], \"details\": []}"),
                   "d.json: kinds: an object is needed here, not an array");
    CHECK(read_text("{\"format\": \"meso-details\", \"version\": 2}") == MESO_ERR_INPUT);
    CHECK(read_text("{\"format\": \"meso-details\", \"version\": 1,}") == MESO_ERR_INPUT);
    MesoInput input;
    static const char other[] = "{\"format\": \"meso-details\", \"version\": 1, \"kinds\": {\"a\": {\"hole\": {}}}, "
                                "\"details\": [{\"points\": {\"file\": \"two.csv\"}}]}";
    meso_input_wrap(&input, "d.json", other, strlen(other));
    expect_message(meso_details_read(&c.details, &c.arena, &input, NULL, &c.error),
                   "d.json: details[0].points.file: other files cannot be read here");
}

int main(void)
{
    meso_arena_init(&c.arena);
    test_kinds();
    test_points();
    test_sources();
    test_looks();
    test_whole();
    meso_arena_release(&c.arena);
    return 0;
}
