/*
 * Marches beside straightest walks: on a flat chart, over seams of what can be unrolled, around closed surfaces; that
 * none is lost among thousands of seams; pieces, borders and limits as walks have them.
 */
#include "libcore/chart/chart_fixture.h"
#include "libcore/growth/march/march_fixture.h"

static MesoRandom random_numbers;

static MesoWalk march(const MesoMarchScene *scene, MesoTip tip, double length, const MesoWalkOptions *options)
{
    MesoWalk walk = {.tip = tip, .length = length};
    meso_texture_walks(&scene->march, &walk, 1, options);
    CHECK(walk.tip.triangle < scene->walk.mesh.triangle_count);
    CHECK(fabs(walk.tip.weight[0] + walk.tip.weight[1] + walk.tip.weight[2] - 1) < 1e-9);
    for (uint32_t k = 0; k < 3; k++)
        CHECK(walk.tip.weight[k] >= -1e-9);
    CHECK(fabs(hypot(walk.tip.heading.re, walk.tip.heading.im) - 1) < 1e-9);
    CHECK(walk.length >= 0 && walk.length <= length && (walk.length == 0 || walk.stop != MESO_WALK_DONE));
    return walk;
}

/* One chart that keeps its shape: the same way, to a texel. */
static void test_flat(void)
{
    MesoMarchScene scene;
    meso_march_scene_init(&scene, meso_fixture_flat(40, 40, 0.1f), 6, 512);
    CHECK(scene.image.chart_count == 1);
    for (uint32_t i = 0; i < 4000; i++) {
        MesoTip tip = meso_fixture_tip(&scene.walk.ground, &random_numbers);
        double length = 3 * meso_fixture_uniform(&random_numbers);
        MesoWalk exact = {.tip = tip, .length = length};
        meso_walks(&scene.walk.ground, &exact, 1, NULL);
        scene.march.snaps = i & 1;
        scene.march.metric = i & 2;
        MesoWalk walk = march(&scene, tip, length, NULL);
        double bound = scene.march.snaps ? 1 : 0.05;
        CHECK(fabs(walk.length - exact.length) * scene.image.texels_per_unit < bound);
        CHECK(meso_fixture_texels_apart(&scene, &exact.tip, &walk.tip) < bound);
        CHECK(meso_fixture_headings_apart(&scene, &exact.tip, &walk.tip) < 1e-3);
    }
    meso_march_scene_release(&scene);
}

/*
 * What rolls off a cylinder and a twisted band is straight in its charts: over seams, too, the ways stay together, and
 * know alike that left has become right. Returns how many did.
 */
static uint32_t check_unrolled(MesoTriangulation mesh, float radius)
{
    enum { COUNT = 1000 };
    MesoMarchScene scene;
    uint32_t turned = 0, compared = 0;
    double mean = 0;
    meso_march_scene_init(&scene, mesh, radius, 1024);
    CHECK(scene.image.chart_count > 8);
    for (uint32_t i = 0; i < COUNT; i++) {
        MesoTip tip = meso_fixture_tip(&scene.walk.ground, &random_numbers);
        MesoWalk exact = {.tip = tip, .length = 3};
        meso_walks(&scene.walk.ground, &exact, 1, NULL);
        scene.march.metric = i & 1;
        MesoWalk walk = march(&scene, tip, 3, NULL);
        if (walk.stop != exact.stop || walk.tip.turned != exact.tip.turned)
            continue;
        compared++;
        turned += walk.tip.turned;
        mean += meso_fixture_texels_apart(&scene, &exact.tip, &walk.tip);
    }
    CHECK(compared > 0.98 * COUNT && mean / compared < 1.5);
    meso_march_scene_release(&scene);
    return turned;
}

static void test_unrolled(void)
{
    CHECK(check_unrolled(meso_fixture_cylinder(64, 40, 0.1f, true), 0.5f) == 0);
    CHECK(check_unrolled(meso_fixture_moebius(), 0.15f) > 30);
}

/* How far from the straightest walks, on average, marches over half a turn of a sphere end; in radians. */
static double drift_on_sphere(bool metric)
{
    MesoMarchScene scene;
    double sum = 0;
    meso_march_scene_init(&scene, meso_fixture_sphere(24, 0, 0), 0, 1024);
    scene.march.metric = metric;
    for (uint32_t i = 0; i < 200; i++) {
        MesoTip tip = meso_fixture_tip(&scene.walk.ground, &random_numbers);
        MesoWalk exact = {.tip = tip, .length = 3};
        meso_walks(&scene.walk.ground, &exact, 1, NULL);
        MesoWalk walk = march(&scene, tip, 3, NULL);
        CHECK(walk.stop == MESO_WALK_DONE);
        sum += meso_fixture_texels_apart(&scene, &exact.tip, &walk.tip) / scene.image.texels_per_unit;
    }
    meso_march_scene_release(&scene);
    return sum / 200;
}

/* Straight in curved charts is not straight; with their metric it nearly is. */
static void test_metric(void)
{
    double plain = drift_on_sphere(false), metric = drift_on_sphere(true);
    CHECK(plain < 0.15 && metric < 0.005);
}

/* Charts of a triangle each: a march goes over thousands of seams, all of its way. */
static void test_none_is_lost(void)
{
    for (uint32_t kind = 0; kind < 8; kind++) {
        MesoMarchScene scene;
        MesoTriangulation mesh = kind & 4 ? meso_fixture_bumpy_torus(40, 16) : meso_fixture_sphere(10, 0.4f, 7);
        MesoJumpErrors errors = {.scene = &scene};
        meso_march_scene_init(&scene, mesh, 1e-4f, 1024);
        CHECK(scene.image.chart_count == mesh.triangle_count);
        scene.march.snaps = kind & 1;
        scene.march.metric = kind & 2;
        scene.march.jump = meso_fixture_tell_jump;
        scene.march.context = &errors;
        for (uint32_t i = 0; i < 16; i++) {
            uint64_t before = errors.count;
            MesoTip tip = meso_fixture_tip(&scene.walk.ground, &random_numbers);
            CHECK(march(&scene, tip, 150, NULL).stop == MESO_WALK_DONE && errors.count - before > 1000);
        }
        double count = (double)errors.count;
        CHECK(errors.distance / count < (scene.march.snaps ? 1 : 0.03) && errors.worst_distance < 8);
        CHECK(errors.angle / count < 0.02);
        meso_march_scene_release(&scene);
    }
}

/* Many small steps, of less than a texel, too, come as far as they should at least. */
static void test_small_steps(void)
{
    MesoMarchScene scene;
    meso_march_scene_init(&scene, meso_fixture_sphere(24, 0.3f, 5), 0.3f, 1024);
    for (uint32_t kind = 0; kind < 4; kind++) {
        scene.march.snaps = kind & 1;
        scene.march.metric = kind & 2;
        for (uint32_t i = 0; i < 60; i++) {
            double length = i % 2 ? 0.0005 : 0.004, apart;
            MesoTip tip = meso_fixture_tip(&scene.walk.ground, &random_numbers), first = tip;
            for (uint32_t s = 0; s < 0.5 / length; s++)
                tip = march(&scene, tip, length, NULL).tip;
            apart = meso_fixture_texels_apart(&scene, &first, &tip) / scene.image.texels_per_unit;
            CHECK(apart > 0.97 * 2 * sin(0.25) && (scene.march.snaps || apart < 1.03 * 2 * sin(0.25)));
        }
    }
    meso_march_scene_release(&scene);
}

/* ---- pieces ---- */

typedef struct Trail {
    const MesoMarchScene *scene;
    MesoTip at;                 /* where the last piece ended */
    double length, gaps;        /* of all pieces, and between them */
    uint32_t count;
} Trail;

static void tell_piece(void *context, const MesoWalkPiece *piece)
{
    Trail *trail = context;
    const MesoTriangulation *mesh = &trail->scene->walk.mesh;
    MesoTriangleFrame frame = meso_frame(mesh, piece->triangle);
    double ends[2][3], last[3];
    for (uint32_t e = 0; e < 2; e++) {
        /* the frame's origin is where its longest side begins */
        uint32_t base = meso_walk_base(&trail->scene->walk.ground.faces[piece->triangle]);
        MesoVec3 origin = mesh->positions[mesh->corners[3 * piece->triangle + base]];
        const double at[3] = {origin.x, origin.y, origin.z};
        for (uint32_t i = 0; i < 3; i++)
            ends[e][i] = at[i] + piece->ends[e].re * frame.x[i] + piece->ends[e].im * frame.y[i];
    }
    meso_tip_position(mesh, &trail->at, last);
    double gap = meso_fixture_apart(last, ends[0]);
    CHECK(trail->count > 0 || gap < 1e-9);
    /* pieces that come in by a side begin where the one before has left by it */
    CHECK(piece->enters == 3 || gap < 1e-6);
    CHECK(piece->walk == 0);
    trail->gaps += gap;
    trail->length += meso_fixture_apart(ends[0], ends[1]);
    trail->count++;
    trail->at.triangle = piece->triangle;
    MesoComplex corners[3];
    meso_walk_corners(&trail->scene->walk.ground, piece->triangle, corners);
    double area = (corners[1].re - corners[0].re) * (corners[2].im - corners[0].im) -
                  (corners[1].im - corners[0].im) * (corners[2].re - corners[0].re);
    for (uint32_t k = 0; k < 3; k++) {
        MesoComplex a = corners[(k + 1) % 3], b = corners[(k + 2) % 3], p = piece->ends[1];
        trail->at.weight[k] = ((a.re - p.re) * (b.im - p.im) - (a.im - p.im) * (b.re - p.re)) / area;
    }
}

/* From the tip's place to the tip's place, without a gap but at seams, and as long as the way. */
static void test_pieces(void)
{
    for (uint32_t kind = 0; kind < 4; kind++) {
        MesoMarchScene scene;
        meso_march_scene_init(&scene, meso_fixture_torus(40, 16, 0.3f), 0.3f, 1024);
        scene.march.snaps = kind & 1;
        scene.march.metric = kind & 2;
        for (uint32_t i = 0; i < 200; i++) {
            MesoTip tip = meso_fixture_tip(&scene.walk.ground, &random_numbers);
            Trail trail = {&scene, tip, 0, 0, 0};
            MesoWalk walk = march(&scene, tip, 1, &(MesoWalkOptions){0, tell_piece, &trail});
            CHECK(walk.stop == MESO_WALK_DONE && trail.count > 0);
            /* the way may end with a jump */
            CHECK(meso_fixture_texels_apart(&scene, &walk.tip, &trail.at) < 6);
            CHECK(trail.gaps * scene.image.texels_per_unit < 40);
            CHECK(!scene.march.metric || fabs(trail.length + trail.gaps - 1) < 0.05);
        }
        meso_march_scene_release(&scene);
    }
}

/* A limit of crossings, from where it goes on to where it would have come; the border, by a heading out of it. */
static void test_ends(void)
{
    MesoMarchScene scene;
    uint32_t borders = 0;
    meso_march_scene_init(&scene, meso_fixture_cylinder(24, 30, 0.1f, false), 0.4f, 1024);
    for (uint32_t i = 0; i < 200; i++) {
        MesoTip tip = meso_fixture_tip(&scene.walk.ground, &random_numbers);
        MesoWalk whole = march(&scene, tip, 2, NULL), part = march(&scene, tip, 2, &(MesoWalkOptions){3, NULL, NULL});
        if (part.stop == MESO_WALK_LIMIT) {
            CHECK(part.length > 0 && part.length < 2);
            part = march(&scene, part.tip, part.length, NULL);
        }
        CHECK(part.stop == whole.stop);
CHECK(meso_fixture_texels_apart(&scene, &part.tip, &whole.tip) < 0.1);
        CHECK(march(&scene, tip, 0, NULL).tip.triangle == tip.triangle);
        borders += whole.stop == MESO_WALK_BORDER;
        if (whole.stop == MESO_WALK_BORDER) {
            MesoWalk again = march(&scene, whole.tip, whole.length, NULL);
            CHECK(again.stop == MESO_WALK_BORDER && meso_fixture_texels_apart(&scene, &again.tip, &whole.tip) < 0.1);
        }
    }
    CHECK(borders > 40 && borders < 180);
    meso_march_scene_release(&scene);
}

/* ---- meshes that are none ---- */

/* Vertices in few places, on a line, or far apart. */
static void break_positions(MesoTriangulation *mesh, uint32_t kind)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (uint32_t i = 0; i < 3; i++) {
            float x = meso_fixture_signed(&random_numbers);
            const float values[5] = {roundf(x), i ? 0 : x, x * powf(10, 10 * meso_fixture_signed(&random_numbers)),
                                     i == 2 ? 0 : roundf(2 * x), i ? 1e-30f * x : x};
            (&mesh->positions[v].x)[i] = values[kind];
        }
}

static void test_broken(void)
{
    for (uint32_t i = 0; i < 400; i++) {
        MesoMarchScene scene;
        MesoTriangulation mesh = meso_fixture_torus(4, 3, 0.4f);
        break_positions(&mesh, i % 5);
        meso_march_scene_init(&scene, mesh, 0, 64);
        for (uint32_t k = 0; k < 8; k++) {
            MesoTip tip = meso_fixture_tip(&scene.walk.ground, &random_numbers);
            double length = pow(10, 6 * meso_fixture_uniform(&random_numbers) - 3);
            scene.march.snaps = k & 1;
            scene.march.metric = k & 2;
            MesoWalk walk = march(&scene, tip, length, &(MesoWalkOptions){2000, NULL, NULL});
            CHECK(walk.crossings <= 2001);
        }
        meso_march_scene_release(&scene);
    }
}

int main(void)
{
    meso_random_init(&random_numbers, 11, 0);
    test_flat();
    test_unrolled();
    test_metric();
    test_none_is_lost();
    test_small_steps();
    test_pieces();
    test_ends();
    test_broken();
    return 0;
}
