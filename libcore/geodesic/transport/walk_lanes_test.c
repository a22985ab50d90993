/* Walks in lanes are walks alone, byte for byte, pieces too: wherever they begin, and on meshes that are none. */
#include "libcore/geodesic/transport/walk_lanes.h"

#include "libcore/geodesic/transport/walk_fixture.h"

enum { COUNT = 203, MOST_PIECES = 1 << 16 };

typedef struct Trail {
    MesoWalkPiece pieces[MOST_PIECES];
    uint32_t count;
} Trail;

static void note(void *context, const MesoWalkPiece *piece)
{
    Trail *trail = context;
    CHECK(trail->count < MOST_PIECES);
    trail->pieces[trail->count++] = *piece;
}

static bool same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static bool same_complex(MesoComplex a, MesoComplex b)
{
    return same(a.re, b.re) && same(a.im, b.im);
}

static void check_walk(const MesoWalk *a, const MesoWalk *b)
{
    CHECK(a->tip.triangle == b->tip.triangle && a->tip.turned == b->tip.turned);
    for (uint32_t k = 0; k < 3; k++)
        CHECK(same(a->tip.weight[k], b->tip.weight[k]));
    CHECK(same_complex(a->tip.heading, b->tip.heading) && same(a->length, b->length));
    CHECK(a->crossings == b->crossings && a->stop == b->stop);
}

/* Those of one walk, in their order. */
static void check_pieces(const Trail *together, uint32_t walk, const Trail *alone)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < together->count; i++) {
        const MesoWalkPiece *a = &together->pieces[i], *b = &alone->pieces[found];
        if (a->walk != walk)
            continue;
        CHECK(found++ < alone->count && a->triangle == b->triangle && a->turned == b->turned);
        CHECK(a->enters == b->enters && a->leaves == b->leaves);
        CHECK(same_complex(a->ends[0], b->ends[0]) && same_complex(a->ends[1], b->ends[1]));
    }
    CHECK(found == alone->count);
}

/* Inside, on sides and at corners; along sides, too. */
static MesoTip tip_anywhere(const MesoWalkGround *ground, MesoRandom *random)
{
    MesoTip tip = meso_fixture_tip(ground, random);
    uint32_t kind = meso_random_below(random, 4), k = meso_random_below(random, 3);
    if (kind == 1)
        tip.weight[meso_next_side(k)] += tip.weight[k];
    else if (kind == 2)
        tip.weight[meso_next_side(k)] = 1 - (tip.weight[meso_previous_side(k)] = 0);
    if (kind == 1 || kind == 2)
        tip.weight[k] = 0;
    if (meso_random_below(random, 3) == 0)
        tip.heading = meso_walk_side(&ground->faces[tip.triangle], meso_random_below(random, 3));
    tip.turned = meso_random_below(random, 2);
    return tip;
}

static void check_ground(const MesoWalkGround *ground, MesoRandom *random, double most, uint32_t limit)
{
    static Trail trails[2];
    MesoWalk together[COUNT], alone[COUNT];
    MesoWalkOptions options = {limit, note, &trails[0]}, apart = {limit, note, &trails[1]};
    for (uint32_t i = 0; i < COUNT; i++)
        alone[i] = together[i] = (MesoWalk){.tip = tip_anywhere(ground, random),
                                            .length = most * pow(meso_fixture_uniform(random), 3)};
    trails[0].count = 0;
    meso_walks(ground, together, COUNT, &options);
    for (uint32_t i = 0; i < COUNT; i++) {
        trails[1].count = 0;
        meso_walks(ground, &alone[i], 1, &apart);
        check_walk(&together[i], &alone[i]);
        check_pieces(&trails[0], i, &trails[1]);
    }
}

static void check_mesh(MesoTriangulation mesh, uint64_t seed)
{
    MesoWalkScene scene;
    MesoRandom random;
    meso_random_init(&random, seed, 0);
    meso_walk_scene_init(&scene, mesh);
    for (uint32_t i = 0; i < 6; i++)
        check_ground(&scene.ground, &random, 1, i < 4 ? 0 : i - 3);
    meso_walk_scene_release(&scene);
}

/* Sides that lead anywhere, corners that lie anywhere, and nowhere. */
static void test_broken(void)
{
    static const double odd[] = {0, -1, 1e300, INFINITY, NAN};
    MesoWalkScene scene;
    MesoRandom random;
    meso_random_init(&random, 4, 0);
    meso_walk_scene_init(&scene, meso_fixture_torus(9, 5, 0.4f));
    uint32_t count = scene.ground.triangle_count;
    for (uint32_t i = 0; i < 60; i++) {
        MesoWalkFace *face = &scene.ground.faces[meso_random_below(&random, count)];
        uint32_t k = meso_random_below(&random, 3);
        face->twins[k] = meso_random_below(&random, 4) ? meso_random_below(&random, 3 * count) : MESO_NO_INDEX;
        face->marks ^= meso_random_below(&random, 2) << k;
        double *part = meso_random_below(&random, 2) ? &face->apexes[k].re : &face->apexes[k].im;
        *part = odd[meso_random_below(&random, sizeof odd / sizeof *odd)];
        check_ground(&scene.ground, &random, 2, 50);
    }
    meso_walk_scene_release(&scene);
}

int main(void)
{
    check_mesh(meso_fixture_bumpy_torus(20, 12), 1);
    check_mesh(meso_fixture_sheet(5, 5, 0.7f), 2);
    check_mesh(meso_fixture_moebius(), 3);
    test_broken();
    return 0;
}
