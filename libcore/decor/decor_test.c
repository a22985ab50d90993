/* Invariants of finished patterns, after random programs on surfaces of every kind. */
#include <stdlib.h>
#include <string.h>

#include "libcore/base/random.h"
#include "libcore/decor/decor_fixture.h"
#include "libcore/decor/decor_scene.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

/* ---- surfaces ---- */

/* A tube with a waist. */
static MesoVec3 on_vase(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    float a = 6.2831853f * (float)column / (float)squares->columns, h = (float)row / (float)squares->rows;
    float r = 1 + 0.3f * sinf(4 * h);
    return (MesoVec3){r * cosf(a), 2 * h, r * sinf(a)};
}

/* A band around a circle, which the seam turns over. */
static MesoVec3 on_band(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    float a = 6.2831853f * (float)column / (float)squares->columns, h = (float)row / (float)squares->rows;
    float across = 0.4f * (h - 0.5f), out = 1 + across * cosf(a / 2);
    return (MesoVec3){out * cosf(a), out * sinf(a), across * sinf(a / 2)};
}

static MesoTriangulation vase(uint32_t columns, uint32_t rows)
{
    return meso_fixture_squares(&(MesoFixtureSquares){columns, rows, MESO_SEAM_JOINED, false, {0, 0}, on_vase});
}

static MesoTriangulation band(uint32_t columns, uint32_t rows)
{
    return meso_fixture_squares(&(MesoFixtureSquares){columns, rows, MESO_SEAM_TWISTED, false, {0, 0}, on_band});
}

static MesoTriangulation one_triangle(void)
{
    const MesoVec3 positions[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const uint32_t corners[3] = {0, 1, 2};
    return meso_fixture_triangulation(positions, 3, corners, 1);
}

/* Two sheets that do not touch. */
static MesoTriangulation two_sheets(void)
{
    const uint32_t side = 9, count = 2 * side * side;
    MesoVec3 positions[2 * 9 * 9];
    uint32_t corners[2 * 6 * 8 * 8], n = 0;
    for (uint32_t v = 0; v < count; v++) {
        uint32_t sheet = v / (side * side), w = v % (side * side);
        positions[v] = (MesoVec3){(float)(w % side) + 20 * (float)sheet, (float)(w / side), 0};
    }
    for (uint32_t sheet = 0; sheet < 2; sheet++)
        for (uint32_t r = 0; r + 1 < side; r++)
            for (uint32_t c = 0; c + 1 < side; c++) {
                uint32_t a = sheet * side * side + r * side + c;
                uint32_t quad[6] = {a, a + 1, a + side + 1, a, a + side + 1, a + side};
                memcpy(corners + n, quad, sizeof quad);
                n += 6;
            }
    return meso_fixture_triangulation(positions, count, corners, n / 3);
}

enum { SURFACES = 12 };

static MesoTriangulation surface(uint32_t number)
{
    switch (number) {
    case 0: return meso_fixture_sheet(12, 9, 0.1f);
    case 1: return meso_fixture_sheet(40, 3, 1);
    case 2: return meso_fixture_torus(24, 12, 0.4f);
    case 3: return vase(24, 16);
    case 4: return band(30, 5);
    case 5: return meso_fixture_ball(6);
    case 6: return meso_fixture_ball(12);
    case 7: return one_triangle();
    case 8: return two_sheets();
    case 9: return meso_fixture_sheet(1, 1, 100);
    case 10: return vase(48, 40);
    default: return meso_fixture_torus(9, 30, 0.7f);
    }
}

/* ---- random programs ---- */

static float share(MesoRandom *random)
{
    return (float)meso_random_below(random, 1000) / 1000;
}

static MesoRange any_range(void)
{
    return (MesoRange){-INFINITY, INFINITY};
}

static MesoSelector random_selector(MesoRandom *random)
{
    MesoSelector s = {.borders = any_range(), .corners = any_range(), .aspect = any_range(), .area = any_range(),
                      .area_share = any_range(), .share = 1};
    switch (meso_random_below(random, 8)) {
    case 0: s.every = 2; break;
    case 1: s.largest = 3; break;
    case 2: s.colors = 2; break;
    case 3: s.share = 0.5f; break;
    case 4: s.level = MESO_SELECT_NODES; s.path = "*"; break;
    case 5: s.level = MESO_SELECT_NODES; break;
    case 6: s.has_point = true; s.point = (MesoVec3){share(random), share(random), 0}; break;
    default: break;
    }
    return s;
}

static MesoSeedSpec random_seed(MesoRandom *random)
{
    MesoSeedSpec spec = {.kind = MESO_SEED_BORDERS};
    switch (meso_random_below(random, 9)) {
    case 0: spec.kind = MESO_SEED_OUTER; break;
    case 1: spec.kind = MESO_SEED_INNER; break;
    case 2: spec.kind = MESO_SEED_SIDE; spec.corners[1] = 1 + meso_random_below(random, 3); break;
    case 3: spec.kind = MESO_SEED_POINT; spec.point = (MesoVec3){share(random), share(random), share(random)}; break;
    case 4: spec.kind = MESO_SEED_ALONG; spec.of = MESO_SEED_BORDERS; spec.count = 1 + meso_random_below(random, 9);
            break;
    case 5: case 6: spec.kind = MESO_SEED_POISSON; spec.count = 1 + meso_random_below(random, 9);
            spec.from_border = meso_random_below(random, 2); spec.border_slack = 0.5f * (float)meso_random_below(random, 3);
            break;
    default: break;
    }
    return spec;
}

enum { MOST_STEPS = 6 };

typedef struct Program {
    MesoStep steps[MOST_STEPS];
    MesoSeedSpec seeds[MOST_STEPS][6];
    float levels[MOST_STEPS][3];
    MesoAfterSplit after[MOST_STEPS];
    uint32_t count;
    bool moves;
} Program;

static void random_program(Program *p, MesoRandom *random)
{
    *p = (Program){.count = 1 + meso_random_below(random, MOST_STEPS)};
    for (uint32_t i = 0; i < p->count; i++) {
        MesoStep *step = &p->steps[i];
        for (int k = 0; k < 6; k++)
            p->seeds[i][k] = random_seed(random);
        for (int k = 0; k < 3; k++)
            p->levels[i][k] = share(random);
        step->kind = (MesoStepKind)meso_random_below(random, 4);
        step->place = "step";
        step->on = random_selector(random);
        step->field.from = (MesoSeedSet){p->seeds[i], 1 + meso_random_below(random, 2)};
        step->field.to = (MesoSeedSet){p->seeds[i] + 2, 1};
        step->field.blend = meso_random_below(random, 2);
        if (meso_random_below(random, 4) == 0)
            step->field.noise = (MesoNoise){.of = 1 + meso_random_below(random, 2), .gain = 0.05f, .frequency = 3};
        step->levels = (MesoLevels){.values = p->levels[i], .value_count = meso_random_below(random, 4),
                                    .count = meso_random_below(random, 4), .unit = MESO_LEVEL_SHARE};
        step->line_count = 1 + meso_random_below(random, 12);
        for (int k = 3; k < 6; k++) {
            p->seeds[i][k].kind = MESO_SEED_POINT;
            p->seeds[i][k].point = (MesoVec3){share(random), share(random), share(random)};
        }
        step->points = p->seeds[i] + 3;
        step->point_count = 2 + meso_random_below(random, 2);
        step->closed = meso_random_below(random, 2);
        if (meso_random_below(random, 4) == 0) {
            p->after[i] = (MesoAfterSplit){.displaced = true, .displacement = {0.02f, false, 0.5f, 0.5f, 0}};
            step->after = &p->after[i];
            step->after_count = 1;
            p->moves = true;
        }
    }
}

static uint64_t hash_of(const MesoDecor *decor)
{
    uint64_t hash = 1469598103934665603u;
    const uint8_t *bytes[3] = {(const uint8_t *)decor->mesh.positions, (const uint8_t *)decor->mesh.corners,
                               (const uint8_t *)decor->mesh.labels};
    size_t sizes[3] = {decor->mesh.vertex_count * sizeof(MesoVec3), 12 * (size_t)decor->mesh.triangle_count,
                       4 * (size_t)decor->mesh.triangle_count};
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < sizes[i]; k++)
            hash = (hash ^ bytes[i][k]) * 1099511628211u;
    return hash;
}

/* A bump on a sheet: at its foot the bump's normals lean, and those of the flat band around it do not. */
static void test_crease(void)
{
    static const MesoSeedSpec borders = {.kind = MESO_SEED_BORDERS};
    static const float half[] = {0.45f};
    const MesoAfterSplit bump = {.tag = "inside", .displaced = true,
                                 .displacement = {.height = 1, .relative = true, .bias = 0.5f, .gain = 0.5f}};
    const MesoStep step = {.kind = MESO_STEP_CONTOUR, .place = "a", .on = {.borders = any_range(), .corners = any_range(),
                           .aspect = any_range(), .area = any_range(), .area_share = any_range(), .share = 1},
                           .field = {.from = {&borders, 1}}, .levels = {half, 1, .unit = MESO_LEVEL_SHARE},
                           .after = &bump, .after_count = 1};
    const MesoPattern pattern = {.steps = &step, .step_count = 1};
    const MesoDecorOptions options = {.region_limit = 100, .triangle_limit = 1 << 20};
    const MesoDecorValues values = MESO_DECOR_NO_VALUES;
    MesoDecor decor = {.mesh = meso_fixture_sheet(21, 21, 1)};
    MesoArena arena;
    MesoScene scene;
    meso_arena_init(&arena);
    CHECK(meso_decor_run(&decor, &arena, &pattern, &options, NULL) == MESO_OK && decor.tree.region_count == 3);
    CHECK(meso_decor_scene(&scene, &arena, &decor, &pattern, &values, NULL) == MESO_OK && scene.body_count == 2);
    for (uint32_t b = 0; b < 2; b++) {
        bool inside = strcmp(decor.tree.regions[1 + b].tag, "inside") == 0;
        const MesoBody *body = &scene.bodies[b];
        uint32_t feet = 0;
        for (uint32_t v = 0; v < body->vertex_count; v++) {
            MesoVec3 p = body->positions[v], n = body->normals[v];
            float x = fabsf(p.x - 10.5f), y = fabsf(p.y - 10.5f);
            bool corner = fabsf(x - y) < 2, foot = inside && p.z == 0 && !corner;
            feet += foot;
            CHECK(!foot || n.z < 0.9f);
            CHECK(inside || corner || n.z > 0.99999f);
        }
        CHECK(!inside || feet > 4);
    }
    meso_triangulation_release(&decor.mesh);
    meso_arena_release(&arena);
}

/* Blends that are worth a second thread come out the same with and without. */
static void test_threads(void)
{
    static const MesoSeedSpec point = {.kind = MESO_SEED_POINT, .point = {1, 0, 0.3f}}, borders = {0};
    static const MesoSeedSpec few = {.kind = MESO_SEED_POISSON, .count = 5};
    static const float levels[] = {0.3f, 0.6f};
    MesoSelector all = {.borders = any_range(), .corners = any_range(), .aspect = any_range(), .area = any_range(),
                        .area_share = any_range(), .share = 1};
    const MesoStep steps[] = {
        {.kind = MESO_STEP_CONTOUR, .place = "a", .on = all, .levels = {levels, 2, .unit = MESO_LEVEL_SCENE},
         .field = {.from = {&point, 1}, .to = {&few, 1}, .blend = true}},
        {.kind = MESO_STEP_CONTOUR, .place = "b", .on = all, .levels = {levels, 1, .unit = MESO_LEVEL_SCENE},
         .field = {.from = {&few, 1}, .to = {&borders, 1}, .blend = true}},
    };
    const MesoPattern pattern = {.steps = steps, .step_count = 2};
    uint64_t hashes[3];
    for (uint32_t i = 0; i < 3; i++) {
        MesoArena arena;
        const MesoDecorOptions options = {.threads = i + 1, .region_limit = 1000, .triangle_limit = 1 << 20};
        MesoDecor decor = {.mesh = meso_fixture_torus(160, 80, 0.4f)};
        meso_arena_init(&arena);
        CHECK(meso_decor_run(&decor, &arena, &pattern, &options, NULL) == MESO_OK);
        CHECK(decor.tree.region_count > 8);
        hashes[i] = hash_of(&decor);
        CHECK(hashes[i] == hashes[0]);
        meso_triangulation_release(&decor.mesh);
        meso_arena_release(&arena);
    }
}

static void run(MesoDecor *decor, MesoArena *arena, uint32_t number, const MesoPattern *pattern, uint64_t seed)
{
    MesoError error;
    const MesoDecorOptions options = {.seed = seed, .region_limit = 100000, .triangle_limit = 10000000};
    *decor = (MesoDecor){.mesh = surface(number)};
    MesoStatus status = meso_decor_run(decor, arena, pattern, &options, &error);
    if (status)
        fprintf(stderr, "surface %u, seed %llu: %s\n", number, (unsigned long long)seed, error.message);
    CHECK(status == MESO_OK);
}

static void test_program(uint32_t number, uint64_t seed)
{
    MesoRandom random;
    Program program;
    MesoArena arena;
    MesoDecor decor, again;
    MesoError error;
    MesoTriangulation before = surface(number);
    meso_random_init(&random, seed, number);
    random_program(&program, &random);
    meso_arena_init(&arena);
    const MesoPattern pattern = {.steps = program.steps, .step_count = program.count};
    run(&decor, &arena, number, &pattern, seed);
    MesoStatus status = meso_triangulation_check(&decor.mesh, &error);
    if (status)
        fprintf(stderr, "surface %u, seed %llu: %s\n", number, (unsigned long long)seed, error.message);
    CHECK(status == MESO_OK);
    CHECK(meso_fixture_region_euler(&before, MESO_NO_INDEX) == meso_fixture_region_euler(&decor.mesh, MESO_NO_INDEX));
    double area = meso_fixture_surface_area(&before);
    CHECK(program.moves || fabs(area - meso_fixture_surface_area(&decor.mesh)) < 1e-5 * area);
    meso_fixture_check_connected(&decor);
    meso_fixture_check_regions(&decor, number != 4, program.moves);
    run(&again, &arena, number, &pattern, seed);
    CHECK(hash_of(&decor) == hash_of(&again));
    meso_triangulation_release(&before);
    meso_triangulation_release(&decor.mesh);
    meso_triangulation_release(&again.mesh);
    meso_arena_release(&arena);
}

int main(int argc, char **argv)
{
    uint64_t count = argc > 1 ? strtoull(argv[1], NULL, 10) : 5, first = argc > 2 ? strtoull(argv[2], NULL, 10) : 0;
    test_crease();
    test_threads();
    for (uint64_t seed = first; seed < first + count; seed++)
        for (uint32_t number = 0; number < SURFACES; number++)
            test_program(number, seed);
    return 0;
}
