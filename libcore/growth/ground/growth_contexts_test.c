#include "libcore/growth/ground/growth_contexts.h"

#include "libcore/geodesic/transport/walk_fixture.h"
#include "libcore/growth/ground/ground_fixture.h"
#include "libcore/growth/ground/map_picture.h"

static MesoGroundScene scene;

static bool is_near(double a, double b, double tolerance)
{
    return fabs(a - b) <= tolerance;
}

/* The tip of a sheet of unit squares whose point is (x, y), heading along (dx, dy). */
static MesoTip tip_on_sheet(uint32_t columns, double x, double y, double dx, double dy)
{
    for (uint32_t t = 0; t < scene.mesh.triangle_count; t++) {
        MesoTip tip = {.triangle = t};
        double w[3], area = 0;
        MesoVec3 p[3];
        for (uint32_t k = 0; k < 3; k++)
            p[k] = scene.mesh.positions[scene.mesh.corners[3 * t + k]];
        for (uint32_t k = 0; k < 3; k++) {
            MesoVec3 a = p[(k + 1) % 3], b = p[(k + 2) % 3];
            w[k] = ((double)a.x - x) * ((double)b.y - y) - ((double)a.y - y) * ((double)b.x - x);
            area += w[k];
        }
        if (!(w[0] >= 0 && w[1] >= 0 && w[2] >= 0))
            continue;
        for (uint32_t k = 0; k < 3; k++)
            tip.weight[k] = w[k] / area;
        double towards[3] = {dx, dy, 0};
        CHECK(meso_tip_head(&tip, &scene.mesh, towards));
        return tip;
    }
    CHECK(columns == 0);
    return (MesoTip){0};
}

static void check_way(const MesoTip *tip, MesoComplex to, double x, double y)
{
    double way[3];
    meso_walk_direction(&scene.mesh, tip->triangle, to, way);
    CHECK(is_near(way[0], x, 1e-6) && is_near(way[1], y, 1e-6));
}

/* value = 2x + 3y by vertices, by corners, by triangles (at their middles), and as an image. */
static void test_maps(void)
{
    enum { N = 8 };
    meso_ground_scene_init(&scene, meso_fixture_sheet(N, N, 1));
    uint32_t triangles = scene.mesh.triangle_count;
    float *by_vertex = malloc(scene.mesh.vertex_count * sizeof(float)), *by_triangle = calloc(triangles, sizeof(float));
    float *by_corner = malloc(3 * triangles * sizeof(float)), *pixels = malloc(N * N * sizeof(float)), one = 7;
    MesoVec2 *uvs = malloc(3 * triangles * sizeof *uvs);
    for (uint32_t v = 0; v < scene.mesh.vertex_count; v++)
        by_vertex[v] = 2 * scene.mesh.positions[v].x + 3 * scene.mesh.positions[v].y;
    for (uint32_t c = 0; c < 3 * triangles; c++) {
        MesoVec3 p = scene.mesh.positions[scene.mesh.corners[c]];
        uvs[c] = (MesoVec2){p.x / N, p.y / N};
        by_corner[c] = by_vertex[scene.mesh.corners[c]];
        by_triangle[c / 3] += by_corner[c] / 3;
    }
    for (uint32_t i = 0; i < N * N; i++)
        pixels[i] = 2 * ((float)(i % N) + 0.5f) + 3 * ((float)(N - 1 - i / N) + 0.5f);
    scene.maps[0] = (MesoGrowthMap){.domain = MESO_GROWTH_CONSTANT, .values = &one};
    scene.maps[1] = (MesoGrowthMap){.domain = MESO_GROWTH_BY_VERTEX, .values = by_vertex};
    scene.maps[2] = (MesoGrowthMap){.domain = MESO_GROWTH_BY_CORNER, .values = by_corner};
    scene.maps[3] = (MesoGrowthMap){.domain = MESO_GROWTH_BY_IMAGE, .image = {N, N, pixels, false, MESO_GROWTH_CLAMP},
                                    .uvs = uvs};
    scene.maps[4] = (MesoGrowthMap){.domain = MESO_GROWTH_BY_TRIANGLE, .values = by_triangle};
    scene.fields[0] = (MesoGrowthField){.kind = MESO_GROWTH_UPHILL, .map = 1};
    scene.fields[1] = (MesoGrowthField){.kind = MESO_GROWTH_UPHILL, .map = 3, .reversed = true};
    MesoTip tip = tip_on_sheet(N, 3.3, 4.2, 0, 1);
    double length = sqrt(13);
    CHECK(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_MAP, 0, 0, 0) == 7);
    CHECK(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_GRADIENT, 0, 0, 0) == 0);
    for (uint32_t map = 1; map < 4; map++) {
        CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_MAP, map, 0, 0), 19.2, 1e-5));
        CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_GRADIENT, map, 0, 0), length, 1e-5));
        CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_AHEAD, map, 2, 0), 22.2, 1e-5));
        CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_AHEAD, map, -2, 0), 16.2, 1e-5));
        CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_SIDE, map, 1.5, 0), 16.2, 1e-5));
        CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_SIDE, map, -1.5, 0), 22.2, 1e-5));
    }
    tip.turned = true;
    CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_SIDE, 1, 1.5, 0), 22.2, 1e-5));
    tip.turned = false;
    CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_GRADIENT, 4, 0, 0), length, 0.3));
    /* as far as there is a way: to the border at y = 8 */
    CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_AHEAD, 1, 100, 0), 6.6 + 3 * 6.1, 1e-5));
    check_way(&tip, meso_growth_direction(&scene.contexts, 0, &tip, 0), 2 / length, 3 / length);
    check_way(&tip, meso_growth_direction(&scene.contexts, 1, &tip, 0), -2 / length, -3 / length);
    free(by_vertex), free(by_corner), free(by_triangle), free(pixels), free(uvs);
    meso_ground_scene_release(&scene);
}

static void test_images(void)
{
    float pixels[6] = {1, 2, 3, 4, 5, 6};
    MesoVec2 uvs[6] = {{0}};
    meso_ground_scene_init(&scene, meso_fixture_sheet(1, 1, 1));
    MesoGrowthMap map = {.domain = MESO_GROWTH_BY_IMAGE, .image = {3, 2, pixels, true, MESO_GROWTH_REPEAT}, .uvs = uvs};
    const double weight[3] = {1, 0, 0};
    /* lower left, one beyond to the right, one beyond to the left */
    const struct {
        float u, v;
        bool nearest;
        MesoGrowthWrap wrap;
        double value;
    } cases[] = {
        {0.01f, 0.01f, true, MESO_GROWTH_REPEAT, 4}, {0.99f, 0.99f, true, MESO_GROWTH_REPEAT, 3},
        {1.01f, 0.01f, true, MESO_GROWTH_REPEAT, 4}, {-0.01f, -0.01f, true, MESO_GROWTH_REPEAT, 3},
        {1.01f, 0.01f, true, MESO_GROWTH_CLAMP, 6},  {-7, 9, true, MESO_GROWTH_CLAMP, 1},
        {1.01f, 0.01f, true, MESO_GROWTH_MIRROR, 6}, {-0.4f, -0.1f, true, MESO_GROWTH_MIRROR, 5},
        {0.5f, 0.5f, false, MESO_GROWTH_REPEAT, 3.5}, {1.0f / 3, 0.25f, false, MESO_GROWTH_REPEAT, 4.5},
        {0, 0.25f, false, MESO_GROWTH_REPEAT, 5},    {0, 0.25f, false, MESO_GROWTH_CLAMP, 4},
        {INFINITY, 0, false, MESO_GROWTH_REPEAT, 3.5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uvs[0] = uvs[1] = uvs[2] = (MesoVec2){cases[i].u, cases[i].v};
        map.image.nearest = cases[i].nearest;
        map.image.wrap = cases[i].wrap;
        double value = meso_map_value(&scene.ground, &map, 0, weight);
        CHECK(is_near(value, cases[i].value, 1e-5) || isinf(cases[i].u));
        CHECK(isfinite(value));
        MesoComplex gradient = meso_map_gradient(&scene.ground, &map, 0, weight);
        CHECK(gradient.re == 0 && gradient.im == 0);
    }
    CHECK(meso_map_most(&map) == 6);
    meso_ground_scene_release(&scene);
}

/* A map drawn over coordinates that fill three quarters of a picture, read as an image, is the map. */
static void test_picture(void)
{
    enum { SIZE = 64, WIDTH = 80 };
    MesoRandom random;
    meso_ground_scene_init(&scene, meso_fixture_sheet(6, 6, 1));
    uint32_t triangles = scene.mesh.triangle_count, empty = 0;
    float *by_vertex = malloc(scene.mesh.vertex_count * sizeof(float)), *pixels = malloc(WIDTH * SIZE * sizeof(float));
    MesoVec2 *uvs = malloc(3 * triangles * sizeof *uvs);
    CHECK(by_vertex && pixels && uvs);
    for (uint32_t v = 0; v < scene.mesh.vertex_count; v++)
        by_vertex[v] = 2 * scene.mesh.positions[v].x - scene.mesh.positions[v].y;
    for (uint32_t c = 0; c < 3 * triangles; c++) {
        MesoVec3 p = scene.mesh.positions[scene.mesh.corners[c]];
        uvs[c] = (MesoVec2){0.1f + p.x / 12, 0.9f - p.y / 8};
    }
    MesoGrowthMap map = {.domain = MESO_GROWTH_BY_VERTEX, .values = by_vertex};
    CHECK(meso_map_picture(pixels, WIDTH, SIZE, &scene.ground, &map, uvs, &scene.arena, NULL) == MESO_OK);
    MesoGrowthMap image = {.domain = MESO_GROWTH_BY_IMAGE, .uvs = uvs,
                           .image = {WIDTH, SIZE, pixels, false, MESO_GROWTH_REPEAT}};
    meso_random_init(&random, 4, 0);
    for (uint32_t i = 0; i < 2000; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground.walk, &random);
        double value = meso_map_value(&scene.ground, &map, tip.triangle, tip.weight);
        CHECK(is_near(meso_map_value(&scene.ground, &image, tip.triangle, tip.weight), value, 0.3));
    }
    for (uint32_t i = 0; i < WIDTH * SIZE; i++)
        empty += isnan(pixels[i]) ? 1 : 0;
    CHECK(empty > WIDTH * SIZE / 2 && empty < 5 * WIDTH * SIZE / 8);
    free(by_vertex), free(pixels), free(uvs);
    meso_ground_scene_release(&scene);
}

static void test_sphere(void)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    meso_ground_scene_init(&scene, meso_fixture_sphere(24, 0.3f, 2));
    scene.fields[0] = (MesoGrowthField){.kind = MESO_GROWTH_TOWARDS, .vector = {0, 0, 1}};
    scene.fields[1] = (MesoGrowthField){.kind = MESO_GROWTH_TO_POINT, .vector = {0, 0, 9}};
    scene.fields[2] = (MesoGrowthField){.kind = MESO_GROWTH_ANY};
    for (uint32_t i = 0; i < 200; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground.walk, &random);
        double at[3];
        meso_tip_position(&scene.mesh, &tip, at);
        MesoVec3 n = meso_growth_normal(&scene.ground, tip.triangle, tip.weight, false);
        CHECK(is_near((double)meso_vec3_dot(n, (MesoVec3){(float)at[0], (float)at[1], (float)at[2]}), 1, 5e-3));
        CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_CURVATURE, MESO_NO_INDEX, 0, 0), 1, 0.2));
        double height = meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_HEIGHT, MESO_NO_INDEX, 0, 0);
        CHECK(is_near(height, at[2] + 1, 2e-3));
        CHECK(is_near(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_SLOPE, MESO_NO_INDEX, 0, 0),
                      acos((double)n.z), 1e-3));
        double noise = meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_NOISE, MESO_NO_INDEX, 0.3, 0);
        double other_noise = meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_NOISE, MESO_NO_INDEX, 0.3, 1);
        CHECK(fabs(noise) <= 1 && noise != other_noise);
        CHECK(meso_growth_answer(&scene.contexts, &tip, MESO_LOOK_NOISE, MESO_NO_INDEX, 0, 0) == 0);
        MesoTip faced = tip, half = tip, other = tip;
        CHECK(meso_growth_face(&scene.contexts, 0, 1, 0, &faced) && meso_growth_face(&scene.contexts, 1, 1, 0, &other));
        double up = meso_growth_answer(&scene.contexts, &faced, MESO_LOOK_HEIGHT, MESO_NO_INDEX, 0, 0);
        MesoWalk walk = {.tip = faced, .length = 1e-3};
        meso_walks(&scene.ground.walk, &walk, 1, NULL);
        CHECK(fabs(at[2]) > 0.97 ||
              meso_growth_answer(&scene.contexts, &walk.tip, MESO_LOOK_HEIGHT, MESO_NO_INDEX, 0, 0) > up);
        CHECK(meso_growth_face(&scene.contexts, 0, 0.5, 0, &half));
        MesoComplex a = meso_complex_times(half.heading, meso_complex_conjugate(tip.heading));
        MesoComplex b = meso_complex_times(faced.heading, meso_complex_conjugate(half.heading));
        CHECK(is_near(a.re, b.re, 1e-12) && is_near(a.im, b.im, 1e-12) && a.re >= 0);
        CHECK(meso_growth_face(&scene.contexts, 2, 1, i, &half) && meso_growth_face(&scene.contexts, 2, 1, i, &other));
        CHECK(half.heading.re == other.heading.re && half.heading.im == other.heading.im);
    }
    CHECK(is_near(scene.ground.extent, 2 * sqrt(3), 1e-2));
    meso_ground_scene_release(&scene);
}

static void test_given(void)
{
    meso_ground_scene_init(&scene, meso_fixture_sheet(2, 2, 1));
    MesoVec3 vectors[8];
    for (uint32_t t = 0; t < 8; t++)
        vectors[t] = t == 7 ? (MesoVec3){0, 0, 4} : (MesoVec3){0, 5, 3};
    scene.fields[0] = (MesoGrowthField){.kind = MESO_GROWTH_GIVEN, .vectors = vectors};
    scene.fields[1] = (MesoGrowthField){.kind = MESO_GROWTH_LINE, .vectors = vectors};
    MesoTip tip = tip_on_sheet(2, 0.5, 0.3, 1, -0.1);
    check_way(&tip, meso_growth_direction(&scene.contexts, 0, &tip, 0), 0, 1);
    check_way(&tip, meso_growth_direction(&scene.contexts, 1, &tip, 0), 0, -1);
    tip = (MesoTip){7, false, {0.3, 0.3, 0.4}, {1, 0}};
    CHECK(!meso_growth_face(&scene.contexts, 0, 1, 0, &tip) && !meso_growth_face(&scene.contexts, 1, 0.5, 0, &tip));
    CHECK(tip.heading.re == 1 && tip.heading.im == 0);
    meso_ground_scene_release(&scene);
}

/* A band with one side: normals go on smoothly along a walk around it, which comes back on the other side. */
static void test_moebius(void)
{
    meso_ground_scene_init(&scene, meso_fixture_moebius());
    CHECK(scene.ground.against);
    MesoTip tip = {0, false, {0.3, 0.3, 0.4}, {1, 0}};
    MesoVec3 first = meso_growth_normal(&scene.ground, 0, tip.weight, false), last = first;
    MesoWalk walk = {.tip = tip};
    bool turned = false;
    for (uint32_t i = 0; i < 2000; i++) {
        walk.length = 0.01;
        meso_walks(&scene.ground.walk, &walk, 1, NULL);
        MesoVec3 normal = meso_growth_normal(&scene.ground, walk.tip.triangle, walk.tip.weight, walk.tip.turned);
        CHECK(meso_vec3_dot(normal, last) > 0.98f);
        last = normal;
        turned |= walk.tip.turned;
        if (walk.stop == MESO_WALK_BORDER)
            walk.tip.heading = (MesoComplex){-walk.tip.heading.re, walk.tip.heading.im};
    }
    CHECK(turned || walk.stop == MESO_WALK_BORDER);
    meso_ground_scene_release(&scene);
}

int main(void)
{
    test_maps();
    test_images();
    test_picture();
    test_sphere();
    test_given();
    test_moebius();
    return 0;
}
