/*
 * Cells bent into cages: points and normals against the trilinear map and its differences, the same floats on a side
 * that two cages share, bounds of lengths and bends, hulls, and trajectories with their ends and tangents.
 */
#include "libcore/scene/cell.h"

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/math/bezier.h"

static MesoRandom random_state;

static float draw(float low, float high)
{
    return low + (high - low) * (float)meso_random_below(&random_state, 1 << 20) / (1 << 20);
}

static MesoVec3 draw_vector(float size)
{
    return (MesoVec3){draw(-size, size), draw(-size, size), draw(-size, size)};
}

/* The unit cube's lower half, or so: each corner is moved. */
static MesoCage draw_cage(float jitter)
{
    static const MesoVec3 base[4] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}};
    MesoCage cage = {.low = 0.1f, .high = 0.7f};
    for (uint32_t i = 0; i < 4; i++) {
        cage.base[i] = meso_vec3_add(base[i], draw_vector(jitter));
        cage.rise[i] = meso_vec3_add((MesoVec3){0, 0, 1}, draw_vector(jitter));
    }
    return cage;
}

static MesoVec3 draw_point(void)
{
    return (MesoVec3){draw(0, 1), draw(0, 1), draw(0, MESO_CELL_HEIGHT)};
}

static MesoVec3 difference(const MesoCage *cage, MesoVec3 at, MesoVec3 step)
{
    const float h = 1 / 256.0f;
    MesoVec3 a = meso_cell_point(cage, meso_vec3_mad(at, -h, step));
    MesoVec3 b = meso_cell_point(cage, meso_vec3_mad(at, h, step));
    return meso_vec3_scale(meso_vec3_sub(b, a), 1 / (2 * h));
}

/* Tangents of a plane stay across its normal, which stays on the side where it was. */
static void test_bend(void)
{
    for (uint32_t i = 0; i < 200; i++) {
        MesoCage cage = draw_cage(0.2f);
        MesoVec3 at = draw_point(), n = meso_vec3_unit(draw_vector(1), (MesoVec3){0, 0, 1});
        MesoVec3 a = meso_vec3_unit(meso_vec3_cross(n, (MesoVec3){0.3f, 0.5f, 0.8f}), n), b = meso_vec3_cross(n, a);
        MesoMeshVertex vertex = {at, n, {0, 0}};
        meso_cell_bend(&cage, &vertex, 1);
        MesoVec3 expected = meso_cage_point(&cage, at.x, at.y, 2 * at.z);
        CHECK(meso_vec3_length(meso_vec3_sub(vertex.position, expected)) < 1e-6f);
        CHECK(fabsf(meso_vec3_length(vertex.normal) - 1) < 1e-5f);
        CHECK(fabsf(meso_vec3_dot(vertex.normal, difference(&cage, at, a))) < 1e-3f);
        CHECK(fabsf(meso_vec3_dot(vertex.normal, difference(&cage, at, b))) < 1e-3f);
        CHECK(meso_vec3_dot(vertex.normal, difference(&cage, at, n)) > 0);
    }
}

static bool same(MesoVec3 a, MesoVec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Side x = 1 of one cage is side y = 0 of the other, which sees it the other way round. */
static void test_shared_side(void)
{
    for (uint32_t i = 0; i < 2000; i++) {
        MesoCage a = draw_cage(0.3f), b = draw_cage(0.3f);
        b.base[0] = a.base[0];
        b.rise[0] = a.rise[0];
        b.base[3] = a.base[1];
        b.rise[3] = a.rise[1];
        float along = meso_cell_round(draw(-0.1f, 1.1f)), z = meso_cell_round(draw(0, MESO_CELL_HEIGHT));
        CHECK(same(meso_cell_point(&a, (MesoVec3){1, along, z}), meso_cell_point(&b, (MesoVec3){1 - along, 0, z})));
        float place = draw(0, 1);
        CHECK(same(meso_cell_body_point(&a, (MesoVec3){1 - 4e-7f, place, z}),
                   meso_cell_body_point(&b, (MesoVec3){1 - meso_cell_round(place), -3e-7f, z})));
    }
}

static void test_stretch(void)
{
    const MesoCage box = {.base = {{2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 0, 0}},
                          .rise = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, .high = 1.5f};
    MesoCellStretch stretch = meso_cell_stretch(&box);
    CHECK(fabsf(stretch.most - 3) < 1e-6f && stretch.bend == 0);
    for (uint32_t i = 0; i < 500; i++) {
        MesoCage cage = draw_cage(0.3f);
        MesoVec3 at = draw_point(), way = meso_vec3_unit(draw_vector(1), (MesoVec3){0, 0, 1});
        stretch = meso_cell_stretch(&cage);
        CHECK(meso_vec3_length(difference(&cage, at, way)) <= 1.001f * stretch.most);
        const float h = 1 / 16.0f;
        MesoVec3 a = meso_cell_point(&cage, meso_vec3_mad(at, -h, way)), middle = meso_cell_point(&cage, at);
        MesoVec3 b = meso_cell_point(&cage, meso_vec3_mad(at, h, way));
        MesoVec3 second = meso_vec3_add(meso_vec3_mad(a, -2, middle), b);
        CHECK(meso_vec3_length(second) / (h * h) <= 1.2f * stretch.bend);   /* which grows a little beyond the cell */
    }
}

/* A bent sweep from side to side in a scene of its own. */
static void test_sweep(void)
{
    MesoCage cage = draw_cage(0.2f);
    MesoSweepInstance sweep = {{{1, 0.5f, 0.25f}, {0.7f, 0.5f, 0.25f}, {0.4f, 0.3f, 0.3f}, {0.4f, 0, 0.3f}},
                               {{0, 0, 1}, {0, 0, 1}}, {{-1, 0, 0}, {0, -1, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}};
    MesoScene scene = {.section_scale = 1, .deform = MESO_SWEEP_SHAPE, .cage_count = 1, .cages = &cage};
    MesoVec3 p[4];
    meso_sweep_trajectory(&scene, &sweep, p);
    CHECK(same(p[0], meso_cell_point(&cage, sweep.p[0])) && same(p[3], meso_cell_point(&cage, sweep.p[3])));
    for (uint32_t end = 0; end < 2; end++) {
        MesoVec3 chord = meso_vec3_sub(p[2 * end + 1], p[2 * end]);
        MesoVec3 own = meso_vec3_sub(sweep.p[2 * end + 1], sweep.p[2 * end]);
        CHECK(meso_vec3_length(meso_vec3_sub(chord, difference(&cage, sweep.p[3 * end], own))) < 1e-4f);
    }
    for (uint32_t i = 0; i <= 8; i++)
        CHECK(meso_vec3_length(meso_vec3_sub(meso_bezier_point(p, (float)i / 8),
                                             meso_sweep_middle(&scene, &sweep, (float)i / 8))) < 0.05f);

    MesoSweepHull hull = meso_sweep_hull(&scene, &sweep, 0.1f);
    MesoBox box = meso_box_of(hull.points, hull.count);
    CHECK(hull.count == 8 && hull.reach == 0);
    for (uint32_t i = 0; i < 200; i++) {
        MesoVec3 at = meso_vec3_add(meso_bezier_point(sweep.p, draw(0, 1)), draw_vector(0.1f));
        MesoVec3 bent = meso_cell_point(&cage, at);
        CHECK(bent.x >= box.low.x && bent.y >= box.low.y && bent.z >= box.low.z);
        CHECK(bent.x <= box.high.x && bent.y <= box.high.y && bent.z <= box.high.z);
    }

    /* A box twice as wide and three times as high makes sections sqrt 6 times as large. */
    for (uint32_t i = 0; i < 4; i++) {
        cage.base[i] = (MesoVec3){i < 2, i == 1 || i == 2 ? 2 : 0, 0};
        cage.rise[i] = (MesoVec3){0, 0, 1.5f};
    }
    cage.low = 0;
    cage.high = 1;
    CHECK(fabsf(meso_sweep_growth(&scene, &sweep, false) - sqrtf(6)) < 1e-5f);
    scene.deform = MESO_SWEEP_CURVES;
    CHECK(meso_sweep_growth(&scene, &sweep, false) == 1);
}

int main(void)
{
    meso_random_init(&random_state, 5, 0);
    test_bend();
    test_shared_side();
    test_stretch();
    test_sweep();
    return 0;
}
