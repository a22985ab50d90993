#include "libcore/shell/prisms.h"

#include "libcore/shell/shell_fixture.h"

static MesoArena arena;

typedef struct Layer {
    MesoTriangulation mesh;
    float low, high;
    MesoVec3 *directions;
    MesoPrismReport report;
} Layer;

static Layer build(MesoTriangulation mesh, float low, float high, bool optimise)
{
    Layer layer = {.mesh = mesh, .low = low, .high = high, .directions = malloc(mesh.vertex_count * sizeof(MesoVec3))};
    MesoError error;
    size_t used = arena.used;
    CHECK(layer.directions);
    CHECK(meso_prisms_build(layer.directions, &layer.report, &arena, &mesh, &(MesoPrismOptions){low, high, optimise, 0},
                            &error) == MESO_OK);
    CHECK(arena.used == used);
    CHECK(layer.report.inverted_count == 0);
    CHECK(layer.report.stretch_after <= layer.report.stretch_before);
    CHECK(layer.report.least_limit > 0 && layer.report.least_limit <= 1);
    CHECK((layer.report.least_limit == 1) == (layer.report.limited_count == 0));
    return layer;
}

static void drop(Layer *layer)
{
    free(layer->directions);
    meso_triangulation_release(&layer->mesh);
}

/* A point on a side is the same from both triangles, at any height. */
static void check_continuous(const Layer *layer)
{
    for (uint32_t h = 0; h < 3 * layer->mesh.triangle_count; h++) {
        uint32_t twin = layer->mesh.twins[h];
        if (twin == MESO_NO_INDEX)
            continue;
        float height = layer->low + 0.7f * (layer->high - layer->low);
        MesoVec3 points[2];
        for (uint32_t side = 0; side < 2; side++) {
            float b[3] = {0, 0, 0};
            b[(side ? twin : h) % 3] = side ? 0.7f : 0.3f;
            b[((side ? twin : h) + 1) % 3] = side ? 0.3f : 0.7f;
            points[side] = meso_prism_point(&layer->mesh, layer->directions, (side ? twin : h) / 3, b[1], b[2], height);
        }
        CHECK(meso_vec3_length(meso_vec3_sub(points[0], points[1])) < 1e-5f);
    }
}

/* With and without turned directions: nothing folds, nothing meets. Returns the least limit. */
static float check_layer(MesoTriangulation (*surface)(void), float low, float high)
{
    float least = 1;
    for (uint32_t optimise = 0; optimise < 2; optimise++) {
        Layer layer = build(surface(), low, high, optimise);
        meso_fixture_check_stands(&layer.mesh, layer.directions, low, high);
        meso_fixture_check_apart(&layer.mesh, layer.directions, low, high);
        check_continuous(&layer);
        CHECK(optimise || layer.report.stretch_before == layer.report.stretch_after);
        least = layer.report.least_limit;
        drop(&layer);
    }
    return least;
}

static MesoTriangulation plane(void) { return meso_fixture_flat(12, 12, 0.1f); }
static MesoTriangulation sphere(void) { return meso_fixture_sphere(5, 0.3f, 3); }
static MesoTriangulation tube(void) { return meso_fixture_tube(20, 8, 0.1f); }
static MesoTriangulation corner(void) { return meso_fixture_groove(1.5707963f, 0.2f); }
static MesoTriangulation groove(void) { return meso_fixture_groove(2.6f, 0.2f); }
static MesoTriangulation ridge(void) { return meso_fixture_groove(-1.5707963f, 0.2f); }
static MesoTriangulation dented(void) { return meso_fixture_dented(6, 1.4f); }
static MesoTriangulation saddle(void) { return meso_fixture_saddle(0.8f); }
static MesoTriangulation bumpy(void) { return meso_fixture_bumpy(16, 16, 0.4f); }
static MesoTriangulation clip(void) { return meso_fixture_clip(0.3f); }

static void test_surfaces(void)
{
    CHECK(check_layer(plane, 0, 0.3f) == 1);
    CHECK(check_layer(plane, -0.2f, 0.3f) == 1);
    CHECK(check_layer(sphere, 0, 0.5f) == 1);
    CHECK(check_layer(sphere, -0.4f, 0.1f) > 0.5f);
    check_layer(sphere, -2, 0);             /* more than there is room for */
    CHECK(check_layer(tube, 0, 0.2f) == 1);
    CHECK(check_layer(tube, 0, 0.5f) > 0.5f);
    check_layer(tube, -0.5f, 0.2f);
    for (float height = 0.1f; height < 1; height *= 3) {
        check_layer(corner, 0, height);
        check_layer(groove, 0, height);
        check_layer(ridge, 0, height);
        check_layer(ridge, -height, height);
        check_layer(dented, 0, height);
        check_layer(saddle, 0, height);
        check_layer(bumpy, -0.5f * height, height);
        check_layer(clip, 0, height);
    }
    check_layer(bumpy, 0.05f, 0.1f);        /* not from the surface itself */
}

/* On a plane directions are its normal, whatever the triangles. */
static void test_plane(void)
{
    for (uint32_t optimise = 0; optimise < 2; optimise++) {
        Layer layer = build(plane(), -0.1f, 0.4f, optimise);
        for (uint32_t v = 0; v < layer.mesh.vertex_count; v++) {
            MesoVec3 off = meso_vec3_sub(layer.directions[v], (MesoVec3){0.36f, -0.48f, 0.8f});
            CHECK(meso_vec3_length(off) < 1e-4f);
        }
        CHECK(fabs(layer.report.stretch_after - 1) < 1e-6 && fabs(layer.report.stretch_after_inverse - 1) < 1e-6);
        drop(&layer);
    }
}

/* A layer of a sphere that its lids scale by 1 + h and nothing turns: the stretch by the integrals of (1 + h)^2. */
static void test_sphere(void)
{
    double high = 0.2, length = high, square = ((1 + high) * (1 + high) * (1 + high) - 1) / 3;
    double expected = sqrt((2 * square / length + 1) / 3) * cbrt(length / square);
    Layer layer = build(meso_fixture_sphere(24, 0, 3), 0, (float)high, false);
    CHECK(fabs(layer.report.stretch_after / expected - 1) < 1e-3);
    for (uint32_t v = 0; v < layer.mesh.vertex_count; v++) {
        MesoVec3 p = layer.mesh.positions[v];
        CHECK(meso_vec3_length(meso_vec3_sub(layer.directions[v], p)) < 0.01f);
    }
    drop(&layer);
}

/* The edges of a right angle, both ways, keep the thickness of both sides: a mitre. */
static void test_mitre(void)
{
    Layer layer = build(meso_fixture_groove(-1.5707963f, 0), 0, 0.3f, false);
    for (uint32_t v = 0; v < layer.mesh.vertex_count; v++)
        if (v % 21 == 10) {
            MesoVec3 off = meso_vec3_sub(layer.directions[v], (MesoVec3){-1, 0, 1});
            CHECK(v / 21 == 0 || v / 21 == 10 || meso_vec3_length(off) < 0.6f);
            CHECK(fabsf(layer.directions[v].y) < 1e-5f);
        }
    drop(&layer);
}

/* Sheets that face each other at less than twice the height share what is between them. */
static void test_facing(void)
{
    float gap = 0.3f;
    Layer layer = build(meso_fixture_clip(gap), 0, 0.5f, false);
    uint32_t met = 0;
    for (uint32_t v = 0; v < layer.mesh.vertex_count; v++) {
        MesoVec3 p = layer.mesh.positions[v];
        if (p.x < 0.4f || p.x > 1.0f)
            continue;
        float height = 0.5f * fabsf(layer.directions[v].z);
        CHECK(height < 0.55f * gap && height > 0.3f * gap);
        met++;
    }
    CHECK(met > 50);
    Layer low = build(meso_fixture_clip(gap), 0, 0.1f, false);
    CHECK(low.report.least_limit == 1);
    drop(&layer);
    drop(&low);
}

/* A scale is a scale: the same directions in other units. */
static void test_units(void)
{
    Layer layer = build(bumpy(), 0, 0.2f, true);
    MesoTriangulation small = bumpy();
    for (uint32_t v = 0; v < small.vertex_count; v++)
        small.positions[v] = meso_vec3_scale(small.positions[v], 0x1p-12f);
    Layer other = build(small, 0, 0.2f * 0x1p-12f, true);
    for (uint32_t v = 0; v < small.vertex_count; v++)
        CHECK(meso_vec3_length(meso_vec3_sub(layer.directions[v], other.directions[v])) < 1e-5f);
    drop(&layer);
    drop(&other);
}

/* Bent patches of about 1000 triangles as in the paper's figure 7, which goes from 1.14 to 1.08. */
static void test_less_stretch(void)
{
    Layer thin = build(meso_fixture_bumpy(22, 22, 0.5f), 0, 0.16f, true);       /* 5 % of the diagonal */
    CHECK(thin.report.stretch_before > 1.015 && thin.report.stretch_after < 1.011);
    CHECK(thin.report.stretch_after_inverse < thin.report.stretch_before_inverse);
    Layer thick = build(meso_fixture_bumpy(22, 22, 0.3f), 0, 0.4f, true);
    CHECK(thick.report.stretch_before > 1.09 && thick.report.stretch_after < 1.03);
    CHECK(thick.report.stretch_before_inverse > 1.15 && thick.report.stretch_after_inverse < 1.04);
    Layer plain = build(meso_fixture_bumpy(22, 22, 0.3f), 0, 0.4f, false);
    CHECK(thick.report.limited_count < plain.report.limited_count / 2);
    drop(&thin);
    drop(&thick);
    drop(&plain);
}

/* A fan whose triangles wind twice around its middle vertex faces nowhere: that vertex stays, all others rise. */
static void test_no_side(void)
{
    enum { AROUND = 10 };
    MesoVec3 positions[AROUND + 1] = {{0, 0, 0}};
    uint32_t corners[3 * AROUND];
    for (uint32_t k = 0; k < AROUND; k++) {
        float angle = 4 * 3.1415927f * (float)k / AROUND;
        positions[k + 1] = (MesoVec3){cosf(angle), sinf(angle), k % 2 ? 80.0f : -80.0f};
        corners[3 * k] = 0;
        corners[3 * k + 1] = k + 1;
        corners[3 * k + 2] = (k + 1) % AROUND + 1;
    }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, AROUND + 1, corners, AROUND);
    MesoVec3 *directions = malloc(mesh.vertex_count * sizeof *directions);
    MesoPrismReport report;
    MesoError error;
    CHECK(directions);
    for (uint32_t optimise = 0; optimise < 2; optimise++) {
        CHECK(meso_prisms_build(directions, &report, &arena, &mesh, &(MesoPrismOptions){0, 0.1f, optimise, 0}, &error) ==
              MESO_OK);
        CHECK(report.inverted_count == 0 && report.stretch_after <= report.stretch_before);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            CHECK(meso_vec3_finite(directions[v]));
    }
    CHECK(report.least_limit == 0 && meso_vec3_length(directions[0]) == 0);
    free(directions);
    meso_triangulation_release(&mesh);
}

static void test_refused(void)
{
    MesoTriangulation mesh = plane();
    MesoVec3 *directions = malloc(mesh.vertex_count * sizeof *directions);
    MesoError error;
    CHECK(directions);
    const MesoPrismOptions wrong[] = {{1, 0, false, 0}, {0, INFINITY, false, 0}, {NAN, 1, true, 0}};
    for (uint32_t i = 0; i < 3; i++)
        CHECK(meso_prisms_build(directions, NULL, &arena, &mesh, &wrong[i], &error) == MESO_ERR_INPUT);
    CHECK(meso_prisms_build(directions, NULL, &arena, &mesh, &(MesoPrismOptions){0, 0, true, 0}, &error) == MESO_OK);
    meso_triangulation_release(&mesh);
    free(directions);

    MesoPrismReport report;
    MesoTriangulation none = {0};
    CHECK(meso_prisms_build(NULL, &report, &arena, &none, &(MesoPrismOptions){0, 1, true, 0}, &error) == MESO_OK);
    CHECK(report.stretch_before == 1 && report.stretch_after == 1 && report.least_limit == 1);
}

int main(void)
{
    meso_arena_init(&arena);
    test_plane();
    test_sphere();
    test_mitre();
    test_facing();
    test_units();
    test_less_stretch();
    test_no_side();
    test_refused();
    test_surfaces();
    meso_arena_release(&arena);
    return 0;
}
