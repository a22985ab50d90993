/* What images, attributes, regions and files become, and what is said of those that are none. */
#include "cmd/grow/grow_contexts.h"

#include <math.h>

#include "formats/file/test_folder.h"
#include "formats/mesh/mesh_read.h"
#include "libcore/base/check.h"
#include "libcore/growth/language/grammar_read.h"

/* A sheet of two squares, four triangles, in z = 0 from (0,0) to (2,1). */
static const char surface_ply[] =
    "ply\nformat ascii 1.0\ncomment region 0 left\ncomment region 1 right/inner.0\n"
    "element vertex 6\nproperty float x\nproperty float y\nproperty float z\nproperty float damp\n"
    "property float s\nproperty float t\n"
    "element face 4\nproperty list uchar int vertex_indices\nproperty ushort region\nproperty float groomx\n"
    "property float groomy\nproperty float groomz\nend_header\n"
    "0 0 0 0 0 0\n1 0 0 1 0.5 0\n2 0 0 2 1 0\n0 1 0 10 0 1\n1 1 0 11 0.5 1\n2 1 0 12 1 1\n"
    "3 0 1 4 0 1 0 0\n3 0 4 3 0 1 0 0\n3 1 2 5 1 0 2 0\n3 1 5 4 1 0 2 0\n";

static TestFolder folder;

typedef struct Bench {
    MesoTool tool;
    const char *operands[2];
    MesoPolygonMesh polygons;
    MesoSurface surface;
    MesoTriangulation mesh;
    MesoGrowthGround ground;
    MesoGrammar grammar;
    MesoGrowthContexts contexts;
    MesoGrowthPlaces places;
} Bench;

static void bench_init(Bench *b, const char *ply)
{
    MesoInput input;
    *b = (Bench){.operands = {"a.grammar", "b.ply"}, .tool = {.quiet = true, .threads = 1, .seed = 5}};
    b->tool.operands = b->operands;
    meso_arena_init(&b->tool.arena);
    meso_input_wrap(&input, "b.ply", ply, strlen(ply));
    CHECK(meso_polygon_mesh_read(&b->polygons, &b->tool.arena, &input, 1, &b->tool.error) == MESO_OK);
    CHECK(meso_surface_build(&b->surface, &b->tool.arena, &b->polygons, 1, NULL) == MESO_OK);
    CHECK(meso_triangulation_init(&b->mesh, &b->surface, 0, 0, NULL) == MESO_OK);
    CHECK(meso_growth_ground_build(&b->ground, &b->tool.arena, &b->mesh, (MesoVec3){0, 1, 0}, 1, NULL) == MESO_OK);
}

static void bench_release(Bench *b)
{
    meso_triangulation_release(&b->mesh);
    meso_arena_release(&b->tool.arena);
}

static MesoStatus make(Bench *b, const char *declarations)
{
    const char *text = meso_arena_print(&b->tool.arena, NULL, "meso-grow 1\nunit m\n%s\n", declarations);
    MesoStatus status = meso_grammar_read(&b->grammar, &b->tool.arena, "a.grammar", text, strlen(text),
                                          &(MesoGrammarOptions){0}, &b->tool.error);
    if (status) {
        fprintf(stderr, "%s\n", b->tool.error.message);
        exit(1);
    }
    return meso_grow_contexts(&b->contexts, &b->places, &b->tool, &b->grammar, &b->polygons, &b->ground,
                              folder.path);
}

#define SEED "\nseed A() on vertices rule A() -> stop"

static void must(Bench *b, const char *declarations)
{
    if (make(b, declarations)) {
        fprintf(stderr, "%s\n", b->tool.error.message);
        exit(1);
    }
}

static void must_not(Bench *b, const char *declarations, const char *message)
{
    CHECK(make(b, declarations) == MESO_ERR_INPUT);
    if (!strstr(b->tool.error.message, message)) {
        fprintf(stderr, "'%s' is not '%s'\n", b->tool.error.message, message);
        exit(1);
    }
}

/* In triangle `t`, at the point with these weights. */
static double at(const Bench *b, uint32_t map, uint32_t t, double w0, double w1)
{
    return meso_growth_map_at(&b->contexts, map, t, (const double[]){w0, w1, 1 - w0 - w1});
}

static void test_attributes(Bench *b)
{
    must(b, "map damp = attribute(\"damp\") map v = attribute(\"uv\", component: 1) map gx = attribute(\"groomx\")\n"
         "field groom = attribute(\"groom\")\nseed A() on vertices face -groom rule A() -> stop");
    CHECK(at(b, 0, 0, 1, 0) == 0 && at(b, 0, 0, 0, 1) == 1 && at(b, 0, 0, 0.5, 0.25) == 3);
    CHECK(at(b, 1, 2, 0, 0) == 1 && at(b, 2, 1, 0.3, 0.3) == 1 && at(b, 2, 3, 0.3, 0.3) == 0);
    CHECK(b->contexts.fields[0].vectors[3].y == 6 && !b->contexts.fields[0].reversed && b->contexts.fields[1].reversed);
    must_not(b, "map d = attribute(\"dam\")" SEED,
             "a.grammar:3: map 'd': the surface has no attribute 'dam'; is 'damp' meant?");
    must_not(b, "\nmap d = attribute(\"qqqqq\")" SEED, "a.grammar:4: map 'd': the surface has no attribute 'qqqqq'");
    must_not(b, "map d = attribute(\"uv\", component: 2)" SEED, "'uv' has components from 0 to 1, and none '2'");
    must_not(b, "map d = attribute(\"region\")" SEED, "'region' of the surface holds names");
    must_not(b, "field d = attribute(\"damp\")" SEED,
             "field 'd': the surface has no attribute of three numbers, 'damp'");
}

static void test_regions(Bench *b)
{
    must(b, "map a = region(\"left\") map b = region(\"right\") map c = region(\"right/inner\")" SEED);
    for (uint32_t t = 0; t < 4; t++)
        for (uint32_t map = 0; map < 3; map++)
            CHECK(at(b, map, t, 0.3, 0.3) == (map == 0 ? t < 2 : t >= 2));
    must_not(b, "map a = region(\"lft\")" SEED,
             "a.grammar:3: map 'a': no face of the surface is in a region 'lft'; is 'left' meant?");
    test_file_write(test_path(&folder, "other.ply"), surface_ply, sizeof surface_ply - 1);
    must(b, "map a = region(\"right\", \"other.ply\")" SEED);
    for (uint32_t t = 0; t < 4; t++)
        CHECK(at(b, 0, t, 0.3, 0.3) == (t >= 2));
    must_not(b, "map a = region(\"top\", \"other.ply\")" SEED, "no face of other.ply is in a region 'top'");
    must_not(b, "map a = region(\"top\", \"none.ply\")" SEED, "none.ply");
}

static void test_distances(Bench *b)
{
    static const char points[] = "0 0 1\n2, 1, 0\n", lines[] = "v 0 0 0\nv 0 1 0\nv 2 0 9\nv 2 1 9\nl 1 2\nl 3/1 4/2\n";
    test_file_write(test_path(&folder, "p.csv"), points, sizeof points - 1);
    test_file_write(test_path(&folder, "c.obj"), lines, sizeof lines - 1);
    must(b, "map e = border map p = points(\"p.csv\") map c = curve(\"c.obj\")\nseed A() on points(\"p.csv\")\n"
         "seed A() on curve(\"c.obj\", 25 cm)\nseed A() on at(1 m, 0.5 m, 3 m) rule A() -> stop");
    for (uint32_t v = 0; v < 6; v++) {
        MesoVec3 p = b->mesh.positions[v];
        double to_points = fmin(hypot((double)p.x, (double)p.y), hypot((double)p.x - 2, (double)p.y - 1));
        CHECK(b->contexts.maps[0].values[v] == 0);
        CHECK(fabs((double)b->contexts.maps[1].values[v] - to_points) < 1e-6);
        CHECK(fabs((double)b->contexts.maps[2].values[v] - fmin((double)p.x, 2 - (double)p.x)) < 1e-6);
    }
    CHECK(b->places.count == 6 && b->places.begin[1] == 2 && b->places.begin[2] == 6 && b->places.begin[3] == 6);
    CHECK(b->places.breaks[2] == 1 && b->places.breaks[3] == 0 && b->places.breaks[4] == 1);
    MesoGrowthStarts starts;
    CHECK(meso_growth_seeds(&starts, &b->tool.arena, &b->grammar, &b->contexts, &b->places, 1, 1, NULL) == MESO_OK);
    CHECK(starts.count == 2 + 8 + 1);
    for (uint32_t i = 0; i < 8; i++) {
        double place[3];
        meso_tip_position(&b->mesh, &starts.starts[2 + i].tip, place);
        CHECK(fabs(place[0] - (i < 4 ? 0 : 2)) < 1e-6 && fabs(place[1] - (0.125 + 0.25 * (i % 4))) < 1e-6);
    }
    must_not(b, "map p = points(\"q.csv\")" SEED, "q.csv");
}

static void test_images(Bench *b)
{
    /* two by one pixels, black and white, of 8 bits */
    static const uint8_t png[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
        0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0xd1, 0x49, 0x20,
        0x56, 0x00, 0x00, 0x00, 0x0b, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0xf8, 0x0f, 0x00,
        0x01, 0x02, 0x01, 0x00, 0x42, 0xbe, 0xbc, 0x68, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44,
        0xae, 0x42, 0x60, 0x82,
    };
    test_file_write(test_path(&folder, "i.png"), png, sizeof png);
    must(b, "map i = image(\"i.png\", filter: nearest, wrap: clamp) map j = image(\"i.png\", channel: b, wrap: clamp)"
         SEED);
    CHECK(at(b, 0, 0, 0.5, 0.2) == 0 && at(b, 0, 2, 0.5, 0.2) == 1);
    CHECK(fabs(at(b, 1, 0, 0, 0.5) - 0.5) < 1e-6);
    must_not(b, "map i = image(\"i.png\", channel: a)" SEED, "'i.png' has no channel 'a'; it has Y");
    must_not(b, "map i = image(\"i.png\", uv: 1)" SEED, "one set of texture coordinates");
    must_not(b, "map i = image(\"none.png\")" SEED, "none.png");
}

static void test_fields(Bench *b)
{
    must(b, "map d = attribute(\"damp\") field u = up field w = world(0, 0, 1) field p = point(1 m, 0, 2 m)\n"
         "field g = gradient(d) field a = principal(max) field c = principal(min) field r = random" SEED);
    const MesoGrowthField *f = b->contexts.fields;
    CHECK(f[0].kind == MESO_GROWTH_TOWARDS && f[0].vector[1] == 1 && f[1].vector[2] == 1);
    CHECK(f[2].kind == MESO_GROWTH_TO_POINT && f[2].vector[0] == 1 && f[2].vector[2] == 2);
    CHECK(f[3].kind == MESO_GROWTH_UPHILL && f[3].map == 0);
    CHECK(f[4].kind == MESO_GROWTH_LINE && f[4].vectors != f[5].vectors);
    CHECK(f[6].kind == MESO_GROWTH_ANY && b->contexts.noise == 5);
    CHECK(f[4].vectors[0].x == 0 && f[4].vectors[0].y == 0);    /* flat */
}

static void test_closed_surface(void)
{
    Bench b;
    bench_init(&b, "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
               "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
    must_not(&b, "map e = border" SEED, "a.grammar:3: map 'e': the surface has no border");
    must_not(&b, "map i = image(\"i.png\")" SEED, "an image needs texture coordinates, and the surface has none");
    bench_release(&b);
}

int main(void)
{
    Bench b;
    folder = test_folder_make();
    bench_init(&b, surface_ply);
    test_attributes(&b);
    test_regions(&b);
    test_distances(&b);
    test_images(&b);
    test_fields(&b);
    bench_release(&b);
    test_closed_surface();
    test_folder_remove(&folder);
    return 0;
}
