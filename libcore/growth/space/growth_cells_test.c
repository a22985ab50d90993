/* Cells against brute force: pieces that are short, long, in a bundle, and on the sides of cells. */
#include "libcore/growth/engine/growth_fixture.h"
#include "libcore/growth/space/growth_space.h"

enum { PIECES = 6000, QUERIES = 1500 };

typedef struct Bed {
    MesoGrowthScenery scenery;
    MesoGrowthSpace space;
    MesoGrowthPiece *pieces;
    MesoRandom random;
    double size;
    bool places;                /* every third piece is of a placed shape, which may be crossed */
} Bed;

/* Makes a segment. */
typedef void Shape(Bed *bed, MesoComplex ends[2]);

static double draw(Bed *bed)
{
    return meso_fixture_uniform(&bed->random);
}

static MesoComplex draw_point(Bed *bed)
{
    MesoComplex corners[3];
    double a = draw(bed), b = draw(bed);
    if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
    }
    meso_walk_corners(&bed->space.ground->walk, 0, corners);
    return meso_walk_point(corners, (double[]){1 - a - b, a, b});
}

/* From a point towards another. */
static void draw_towards(Bed *bed, MesoComplex ends[2], MesoComplex to, double share)
{
    ends[0] = draw_point(bed);
    ends[1] = (MesoComplex){ends[0].re + share * (to.re - ends[0].re), ends[0].im + share * (to.im - ends[0].im)};
}

static void short_ones(Bed *bed, MesoComplex ends[2])
{
    draw_towards(bed, ends, draw_point(bed), 0.03);
}

static void long_ones(Bed *bed, MesoComplex ends[2])
{
    draw_towards(bed, ends, draw_point(bed), 1);
}

static void bundle(Bed *bed, MesoComplex ends[2])
{
    MesoComplex middle = {0.41 * bed->size, 0.23 * bed->size};
    draw_towards(bed, ends, middle, 1.01);
}

/* On lines that are sides of cells, and between ends that lie on such. */
static void on_sides(Bed *bed, MesoComplex ends[2])
{
    double step = bed->size / 64, x = floor(16 + 32 * draw(bed)) * step, y = floor(1 + 20 * draw(bed)) * step;
    bool across = draw(bed) < 0.5, aslant = draw(bed) < 0.3;
    ends[0] = (MesoComplex){x, y};
    ends[1] = (MesoComplex){across || aslant ? x + step : x, !across || aslant ? y + step : y};
}

static double turn_of(MesoComplex a, MesoComplex b, MesoComplex c)
{
    return (b.re - a.re) * (c.im - a.im) - (b.im - a.im) * (c.re - a.re);
}

/* Whether two have a point in common; nearly so, either is right. */
static int do_meet(const Bed *bed, const MesoComplex a[2], const MesoComplex b[2])
{
    double turns[4] = {turn_of(a[0], a[1], b[0]), turn_of(a[0], a[1], b[1]), turn_of(b[0], b[1], a[0]),
                       turn_of(b[0], b[1], a[1])};
    bool apart = turns[0] * turns[1] > 0 || turns[2] * turns[3] > 0;
    for (uint32_t i = 0; i < 4 && !apart; i++)
        if (fabs(turns[i]) < 1e-12 * bed->size * bed->size)
            return -1;
    return !apart;
}

static bool is_placed(const Bed *bed, uint32_t piece)
{
    return bed->places && piece % 3 == 1;
}

/* 1, 0, or -1 for either. */
static int meets_any(const Bed *bed, const MesoComplex ends[2], uint32_t since)
{
    int meets = 0;
    for (uint32_t i = since; i < PIECES && meets != 1; i++) {
        int now = is_placed(bed, i) ? 0 : do_meet(bed, ends, bed->pieces[i].ends);
        meets = now != 0 ? now : meets;
    }
    return meets;
}

/* How far along the nearest piece is met. */
static double nearest_of(const Bed *bed, const MesoComplex ends[2])
{
    double nearest = INFINITY;
    for (uint32_t i = 0; i < PIECES; i++) {
        const MesoComplex *other = bed->pieces[i].ends;
        double from = turn_of(other[0], other[1], ends[0]), to = turn_of(other[0], other[1], ends[1]);
        if (!is_placed(bed, i) && do_meet(bed, ends, other) == 1)
            nearest = fmin(nearest, from / (from - to) * hypot(ends[1].re - ends[0].re, ends[1].im - ends[0].im));
    }
    return nearest;
}

static void check_query(const Bed *bed, const MesoComplex ends[2], uint32_t since, uint32_t *met)
{
    const MesoGrowthAsker asker = {MESO_GROWTH_ROOT, true, 0, since};
    const MesoGrowthPiece piece = {{ends[0], ends[1]}, 0, false};
    MesoGrowthMeeting first;
    int meets = meets_any(bed, ends, since);
    bool found = meso_growth_meets(&bed->space, &asker, &piece, 1, NULL);
    CHECK(meets == -1 || found == meets);
    CHECK(meso_growth_meets(&bed->space, &asker, &piece, 1, &first) == found);
    if (meets == 1 && since == 0)
        CHECK(first.along < nearest_of(bed, ends) + 1e-9 * bed->size);
    *met += found;
}

/* Pieces that are looked at where a segment lies. */
static uint32_t count_near(const Bed *bed, const MesoComplex ends[2])
{
    MesoGrowthSight sight;
    uint32_t count = 0, block;
    meso_growth_sight(&sight, &bed->space.cells, 0, ends);
    while ((block = meso_growth_next_cell(&sight)) != MESO_NO_INDEX)
        for (; block != MESO_NO_INDEX; block = bed->space.cells.blocks[block].next)
            count += bed->space.cells.blocks[block].count;
    return count;
}

static void fill(Bed *bed, Shape *shape)
{
    CHECK(!meso_growth_space_init(&bed->space, &bed->scenery.ground, NULL));
    bed->size = bed->scenery.ground.walk.lengths[0];
    for (uint32_t i = 0; i < PIECES; i++) {
        bed->pieces[i] = (MesoGrowthPiece){.triangle = 0};
        shape(bed, bed->pieces[i].ends);
        CHECK(meso_growth_space_add(&bed->space,
                                    (MesoGrowthKin){MESO_GROWTH_ROOT | 1, false, is_placed(bed, i), 0, 0},
                                    &bed->pieces[i], 1));
    }
}

/* Where a short segment is looked for there are no more than about `most` pieces; and blocks are not wasted. */
static void test_shape(Shape *shape, uint32_t most, uint32_t least_met, bool places)
{
    Bed bed = {.pieces = malloc(PIECES * sizeof(MesoGrowthPiece)), .places = places};
    uint32_t met = 0;
    uint64_t looked = 0;
    CHECK(bed.pieces);
    meso_random_init(&bed.random, 3, 0);
    meso_scenery_init(&bed.scenery, meso_fixture_sheet(2, 2, 1));
    fill(&bed, shape);
    for (uint32_t i = 0; i < QUERIES; i++) {
        MesoComplex ends[2];
        draw_towards(&bed, ends, draw_point(&bed), i % 4 == 0 ? 0.5 : 0.01);
        check_query(&bed, ends, i % 3 == 0 ? PIECES - 50 : 0, &met);
        looked += i % 4 == 0 ? 0 : count_near(&bed, ends);
    }
    CHECK(looked < (uint64_t)most * QUERIES && met > least_met);
    CHECK(bed.space.cells.block_count < PIECES);
    meso_growth_space_release(&bed.space);
    meso_scenery_release(&bed.scenery);
    free(bed.pieces);
}

int main(void)
{
    test_shape(short_ones, 30, 300, false);
    test_shape(short_ones, 30, 300, true);
    test_shape(long_ones, PIECES / 2, 900, false);
    test_shape(bundle, PIECES / 4, 900, false);
    test_shape(on_sides, 200, 300, false);
    test_shape(on_sides, 200, 200, true);
    return 0;
}
