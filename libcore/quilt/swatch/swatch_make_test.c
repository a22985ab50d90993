/* Recipes: how many elements and faces, their genus; periods; that nothing cuts anything else, jittered or repeated. */
#include "libcore/quilt/swatch/swatch_make.h"

#include "libcore/quilt/swatch/swatch_fixture.h"

static MesoArena arena;
static MesoError error;

typedef struct Expected {
    const char *name;
    uint32_t element_count, strand_count, triangle_count, open_edge_count, material_count;
    int64_t euler[2];           /* of the first element, and the last */
    MesoVec2 size;
} Expected;

/* Near to Table 1 of the paper: weave and wire 15168, links 9216, nuts 20608, apples 3784, ivy 700, armor 35640. */
static const Expected EXPECTED[] = {
    {"weave", 12, 12, 15552, 288, 2, {0, 0}, {6, 6}},
    {"wire", 12, 12, 15552, 288, 2, {0, 0}, {6, 6}},
    {"armour", 16, 16, 36864, 576, 2, {0, 0}, {8, 8}},
    {"mail", 16, 0, 9216, 0, 2, {0, 0}, {2, 2.08f}},
    {"rings", 27, 0, 15552, 0, 2, {0, 0}, {3, 3}},
    {"nuts", 16, 0, 20736, 0, 1, {0, 0}, {4, 3.4641016f}},
    {"ivy", 10, 2, 736, 24, 2, {0, 2}, {2, 2}},
    {"scales", 32, 0, 6400, 0, 1, {2, 2}, {4, 4}},
    {"apples", 40, 0, 3960, 0, 2, {2, 2}, {5, 3.4641016f}},
};

static MesoSwatch make(MesoSwatchRecipe recipe)
{
    MesoPolygonMesh mesh;
    MesoSwatch swatch;
    MesoSwatchOptions options = {.up = 2, .periodic = -1};
    CHECK(meso_swatch_make(&mesh, &arena, &recipe, &error) == MESO_OK);
    CHECK(meso_polygon_mesh_check(&mesh, 1, NULL, &error) == MESO_OK);
    CHECK(meso_swatch_build(&swatch, &arena, &mesh, &options, &error) == MESO_OK);
    check_swatch(&swatch);
    CHECK(swatch.uvs && swatch.normals);
    return swatch;
}

static void test_usual(const Expected *expected)
{
    MesoSwatch s = make((MesoSwatchRecipe){.name = expected->name});
    CHECK(s.element_count == expected->element_count && s.triangle_count == expected->triangle_count);
    CHECK(s.open_edge_count == expected->open_edge_count && s.material_count == expected->material_count);
    CHECK(element_euler(&s, 0) == expected->euler[0] && element_euler(&s, s.element_count - 1) == expected->euler[1]);
    CHECK(s.periodic_x && s.periodic_y && fabsf(s.size.x - expected->size.x) < 1e-5f &&
          fabsf(s.size.y - expected->size.y) < 1e-5f);
    uint32_t strand_count = 0;
    for (uint32_t e = 0; e < s.element_count; e++)
        strand_count += s.kinds[e] == MESO_ELEMENT_STRAND;
    CHECK(strand_count == expected->strand_count);
    CHECK(count_cuts(&s) == 0);
}

/* Twice in both directions: neither joins nor overhanging elements cut. */
static void test_repeated(const char *name)
{
    MesoSwatch s = make((MesoSwatchRecipe){.name = name, .columns = 2, .rows = 2}), twice;
    MesoVec2 cover = {2 * s.size.x, 2 * s.size.y};
    CHECK(meso_swatch_repeat(&twice, &arena, &s, cover, &error) == MESO_OK);
    check_swatch(&twice);
    CHECK(twice.triangle_count == 4 * s.triangle_count && twice.size.x == cover.x && twice.size.y == cover.y);
    CHECK(twice.open_edge_count == 2 * s.open_edge_count);
    uint32_t element_count = 0;
    for (uint32_t e = 0; e < s.element_count; e++)
        element_count += s.open_edge_count && s.kinds[e] == MESO_ELEMENT_STRAND ? 2 : 4;
    CHECK(twice.element_count == element_count);
    CHECK(count_cuts(&twice) == 0);
}

static void test_jittered(const char *name, float jitter)
{
    for (uint64_t seed = 1; seed <= 2; seed++) {
        MesoSwatch s = make((MesoSwatchRecipe){.name = name, .columns = 5, .rows = 5, .jitter = jitter, .seed = seed});
        CHECK(!s.periodic_x && !s.periodic_y && count_cuts(&s) == 0);
    }
}

/* The tile of a strewn swatch is near to that of the same in rows. */
static void test_jittered_tile(const char *name)
{
    MesoSwatch rows = make((MesoSwatchRecipe){.name = name, .columns = 8, .rows = 8});
    MesoSwatch strewn = make((MesoSwatchRecipe){.name = name, .columns = 8, .rows = 8, .jitter = 0.06f});
    CHECK(fabsf(strewn.size.x / rows.size.x - 1) < 0.05f && fabsf(strewn.size.y / rows.size.y - 1) < 0.05f);
}

/* The same recipe gives the same bytes; other seeds others. */
static void test_seeds(void)
{
    MesoPolygonMesh meshes[3];
    for (uint64_t i = 0; i < 3; i++) {
        MesoSwatchRecipe recipe = {.name = "nuts", .jitter = 0.05f, .seed = i / 2};
        CHECK(meso_swatch_make(&meshes[i], &arena, &recipe, &error) == MESO_OK);
    }
    size_t bytes = meshes[0].vertex_count * sizeof *meshes[0].positions;
    CHECK(memcmp(meshes[0].positions, meshes[1].positions, bytes) == 0);
    CHECK(memcmp(meshes[0].positions, meshes[2].positions, bytes) != 0);
}

static void test_refused(void)
{
    static const MesoSwatchRecipe refused[] = {{.name = "felt"}, {.name = NULL}, {.name = "mail", .sides = 2},
                                               {.name = "mail", .jitter = 0.3f}, {.name = "mail", .jitter = NAN},
                                               {.name = "mail", .columns = 5000}, {.name = "mail", .thickness = -1}};
    MesoPolygonMesh mesh;
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        CHECK(meso_swatch_make(&mesh, &arena, &refused[i], &error) == MESO_ERR_USAGE);
    CHECK(meso_swatch_make(&mesh, &arena, &refused[0], &error));
    CHECK(strstr(error.message, "no recipe for a swatch is named 'felt'"));
}

int main(void)
{
    meso_arena_init(&arena);
    for (size_t i = 0; i < sizeof EXPECTED / sizeof *EXPECTED; i++) {
        CHECK(strstr(meso_swatch_recipe_names(), EXPECTED[i].name));
        test_usual(&EXPECTED[i]);
        test_repeated(EXPECTED[i].name);
        test_jittered(EXPECTED[i].name, 0.06f);
        test_jittered(EXPECTED[i].name, 0.2f);
        test_jittered_tile(EXPECTED[i].name);
    }
    test_seeds();
    test_refused();
    meso_arena_release(&arena);
    return 0;
}
