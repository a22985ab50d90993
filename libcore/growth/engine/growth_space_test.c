/* What has grown against brute force: what crosses, what is near, what is joined. */
#include "libcore/growth/engine/growth_fixture.h"
#include "libcore/growth/engine/growth_work.h"

static const char dense[] =
    "meso-grow 1\nshape cord = tube\nlimit elements 6000\nlimit generations 300\n"
    "seed Shoot(1 cm) on vertices\n"
    "rule Shoot(w) -> {\n turn(normal(0, 20 deg))\n"
    " step(6 cm, normal(0, 30 deg), shape: cord, width: w) else retry(3, 80 deg)\n"
    " choose { 80%: Shoot(0.99*w) 20%: { branch { turn(normal(60 deg, 8 deg)) Shoot(0.8*w) } Shoot(0.99*w) } } }\n";

static const char joining[] =
    "meso-grow 1\nshape cord = tube\nlimit generations 300\n"
    "seed Crack(1 cm) on vertices\n"
    "rule Crack(w) -> {\n turn(normal(0, 20 deg))\n"
    " step(6 cm, shape: cord, width: w) else join\n"
    " choose { 80%: Crack(0.99*w) 20%: { branch { turn(normal(80 deg, 8 deg)) Crack(0.8*w) } Crack(0.99*w) } } }\n";

static const char spaced[] =
    "meso-grow 1\nshape cord = tube\nlimit elements 1500\nlimit generations 300\n"
    "seed Shoot(1 cm) on vertices\n"
    "rule Shoot(w) -> {\n turn(normal(0, 15 deg))\n"
    " step(5 cm, shape: cord, width: w, clear: 4 cm) else retry(2, 60 deg)\n"
    " if chance(0.3) { branch { move(3 cm, 90 deg) Leaf(w) } }\n"
    " choose { 70%: Shoot(w) 30%: { branch { turn(70 deg) Shoot(w) } Shoot(w) } } }\n"
    "rule Leaf(w) : clear(9 cm) -> place cord(4 cm, width: w)\n";

static void run(MesoGrowthWork *work, MesoGrowthScenery *scenery, const char *text, uint32_t starts,
                uint32_t thread_count)
{
    MesoError error = {0};
    meso_scenery_read(scenery, text);
    meso_scenery_strew(scenery, starts, 5);
    static MesoGrowthOptions options;
    options = meso_scenery_options(scenery, thread_count);
    if (meso_growth_run(work, &options, &error)) {
        fprintf(stderr, "%s\n", error.message);
        CHECK(false);
    }
}

/* ---- pieces, by element ---- */

typedef struct Piece {
    MesoComplex ends[2];
    uint32_t element, triangle;
} Piece;

/* Once, though it may lie in several cells. */
static void list_piece(Piece *pieces, uint32_t *count, uint32_t first, Piece piece)
{
    for (uint32_t i = first; i < *count; i++)
        if (pieces[i].element == piece.element && memcmp(pieces[i].ends, piece.ends, sizeof piece.ends) == 0)
            return;
    pieces[(*count)++] = piece;
}

static Piece *list_pieces(const MesoGrowthWork *work, uint32_t *count)
{
    const MesoGrowthCells *cells = &work->space.cells;
    Piece *pieces = malloc((size_t)(cells->block_count + 1) * MESO_GROWTH_LANES * sizeof *pieces);
    CHECK(pieces);
    *count = 0;
    for (uint32_t t = 0; t < work->ground->walk.triangle_count; t++) {
        MesoGrowthSight sight;
        uint32_t first = *count, b;
        meso_growth_sight(&sight, cells, t, NULL);
        while ((b = meso_growth_next_cell(&sight)) != MESO_NO_INDEX)
            for (; b != MESO_NO_INDEX; b = cells->blocks[b].next)
                for (uint32_t i = 0; i < cells->blocks[b].count; i++) {
                    uint32_t number = cells->blocks[b].piece[i];
                    Piece piece = {.element = cells->elements[number], .triangle = t};
                    memcpy(piece.ends, cells->ends[number], sizeof piece.ends);
                    list_piece(pieces, count, first, piece);
                }
    }
    return pieces;
}

static long double turn_of(MesoComplex a, MesoComplex b, MesoComplex c)
{
    return ((long double)b.re - a.re) * ((long double)c.im - a.im) -
           ((long double)b.im - a.im) * ((long double)c.re - a.re);
}

/* Their inner points have one in common. */
static bool cross(const Piece *a, const Piece *b)
{
    long double c = turn_of(a->ends[0], a->ends[1], b->ends[0]), d = turn_of(a->ends[0], a->ends[1], b->ends[1]);
    long double e = turn_of(b->ends[0], b->ends[1], a->ends[0]), f = turn_of(b->ends[0], b->ends[1], a->ends[1]);
    return ((c < 0 && d > 0) || (c > 0 && d < 0)) && ((e < 0 && f > 0) || (e > 0 && f < 0));
}

static void place(const MesoGrowthWork *work, const Piece *piece, uint32_t end, double out[3])
{
    MesoTip tip = {.triangle = piece->triangle};
    meso_growth_weigh(&work->ground->walk, piece->triangle, piece->ends[end], tip.weight);
    meso_tip_position(work->ground->mesh, &tip, out);
}

/* ---- tests ---- */

/* Exactly: no two pieces of a triangle cross, whichever elements they are of. */
static uint32_t count_crossings(const MesoGrowthWork *work, uint64_t *pairs)
{
    uint32_t count, crossings = 0;
    Piece *pieces = list_pieces(work, &count);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = i + 1; j < count && pieces[j].triangle == pieces[i].triangle; j++) {
            bool shapes = work->space.kin[pieces[i].element].placed || work->space.kin[pieces[j].element].placed;
            crossings += !shapes && pieces[i].element != pieces[j].element && cross(&pieces[i], &pieces[j]);
            ++*pairs;
        }
    free(pieces);
    return crossings;
}

static void test_crossing(MesoTriangulation mesh)
{
    static const char *const texts[] = {dense, joining, spaced};
    MesoGrowthScenery scenery = {0};
    meso_scenery_init(&scenery, mesh);
    for (uint32_t i = 0; i < 3; i++) {
        MesoGrowthWork work;
        uint64_t pairs = 0;
        run(&work, &scenery, texts[i], 18, 1 + i % 2);
        CHECK(count_crossings(&work, &pairs) == 0);
        CHECK(work.element_count > 100 && pairs > 500);
        meso_growth_release(&work);
    }
    meso_scenery_release(&scenery);
}

/* With `cross` the same grammar crosses: the test above can fail. */
static void test_crossing_allowed(void)
{
    MesoGrowthScenery scenery = {0};
    MesoGrowthWork work;
    uint64_t pairs = 0;
    meso_scenery_init(&scenery, meso_fixture_bumpy_torus(60, 30));
    run(&work, &scenery, "meso-grow 1\nlimit elements 3000\nseed Shoot(chance(0.5)) on vertices\n"
        "rule Shoot(c) -> { turn(normal(0, 20 deg)) step(6 cm, cross: c) branch { turn(60 deg) Shoot(c) } Shoot(c) }\n",
        18, 1);
    CHECK(count_crossings(&work, &pairs) > 100);
    meso_growth_release(&work);
    meso_scenery_release(&scenery);
}

/* Where a joined strand ends another strand is, and it ends there. */
static void test_joins(void)
{
    MesoGrowthScenery scenery = {0};
    MesoGrowthWork work;
    uint32_t count, joins = 0;
    meso_scenery_init(&scenery, meso_fixture_bumpy_torus(60, 30));
    run(&work, &scenery, joining, 18, 1);
    Piece *pieces = list_pieces(&work, &count);
    for (uint32_t i = 0; i < count; i++) {
        const MesoGrowthKin *kin = &work.space.kin[pieces[i].element];
        double nearest = INFINITY;
        if (kin->end - kin->begin > 0.0599f)
            continue;
        for (uint32_t j = 0; j < count; j++) {
            if (pieces[j].element == pieces[i].element || pieces[j].triangle != pieces[i].triangle)
                continue;
            MesoComplex a = pieces[j].ends[0], b = pieces[j].ends[1], p = pieces[i].ends[1];
            double length = hypot(b.re - a.re, b.im - a.im);
            double along = ((p.re - a.re) * (b.re - a.re) + (p.im - a.im) * (b.im - a.im)) / length;
            if (along >= 0 && along <= length && kin->node != pieces[j].element)
                nearest = fmin(nearest, (double)fabsl(turn_of(a, b, p)) / length);
        }
        joins += nearest < 1e-14;
    }
    uint32_t ends = 0;
    for (uint32_t e = 0; e < work.space.kin_count; e++)
        ends += work.space.kin[e].end - work.space.kin[e].begin < 0.0599f;
    CHECK(ends > 18 && joins == ends);
    free(pieces);
    meso_growth_release(&work);
    meso_scenery_release(&scenery);
}

static double apart(const MesoGrowthWork *work, const Piece *a, const Piece *b)
{
    double p[2][3], q[2][3], nearest = INFINITY;
    for (uint32_t end = 0; end < 2; end++) {
        place(work, a, end, p[end]);
        place(work, b, end, q[end]);
    }
    for (uint32_t i = 0; i <= 20; i++)
        for (uint32_t j = 0; j <= 20; j++) {
            double x[3], y[3];
            for (uint32_t k = 0; k < 3; k++) {
                x[k] = p[0][k] + (p[1][k] - p[0][k]) * i / 20;
                y[k] = q[0][k] + (q[1][k] - q[0][k]) * j / 20;
            }
            nearest = fmin(nearest, meso_fixture_apart(x, y));
        }
    return nearest;
}

/* No piece of its element ends where it begins. */
static bool is_first(const MesoGrowthWork *work, const Piece *pieces, uint32_t count, const Piece *piece)
{
    double begin[3], end[3];
    place(work, piece, 0, begin);
    for (uint32_t i = 0; i < count; i++)
        if (pieces[i].element == piece->element) {
            place(work, &pieces[i], 1, end);
            if (meso_fixture_apart(begin, end) < 1e-9)
                return false;
        }
    return true;
}

/* Whether `newer` was free to grow beside `older`. */
static void check_pair(const MesoGrowthWork *work, const Piece *newer, const Piece *older, uint64_t *near)
{
    const MesoGrowthKin *kin = &work->space.kin[newer->element];
    const MesoGrowthAsker asker = {kin->node, kin->moved, kin->begin, 0};
    double clear = kin->placed ? 0.09 : 0.04, distance = apart(work, newer, older), most = MESO_GROWTH_KIN * clear;
    bool kin_counts = kin->placed && work->space.kin[older->element].placed;
    *near += distance < 1.2 * clear;
    if (distance < clear * (1 - 1e-6)) {
        CHECK(!kin_counts);
        CHECK(meso_growth_way_to(&work->space, &asker, older->element, most) < most * (1 + 1e-6));
    }
}

/* Steps keep clear of all that is not kin; placed shapes, where they begin, of all of those. */
static void test_clearance(uint32_t thread_count)
{
    MesoGrowthScenery scenery = {0};
    MesoGrowthWork work;
    uint32_t count, shapes = 0;
    uint64_t near = 0;
    meso_scenery_init(&scenery, meso_fixture_bumpy_torus(60, 30));
    run(&work, &scenery, spaced, 18, thread_count);
    Piece *pieces = list_pieces(&work, &count);
    for (uint32_t i = 0; i < count; i++) {
        Piece newer = pieces[i];
        double a[3], b[3];
        if (work.space.kin[newer.element].placed) {
            if (!is_first(&work, pieces, count, &newer))
                continue;
            newer.ends[1] = newer.ends[0];
            shapes++;
        }
        place(&work, &newer, 0, a);
        for (uint32_t j = 0; j < count; j++) {
            place(&work, &pieces[j], 0, b);
            if (pieces[j].element < newer.element && meso_fixture_apart(a, b) < 0.25)
                check_pair(&work, &newer, &pieces[j], &near);
        }
    }
    CHECK(shapes > 20 && near > 100);
    free(pieces);
    meso_growth_release(&work);
    meso_scenery_release(&scenery);
}

int main(void)
{
    test_crossing(meso_fixture_bumpy_torus(60, 30));
    test_crossing(meso_fixture_sphere(8, 0.2f, 3));
    test_crossing(meso_fixture_moebius());
    test_crossing(meso_fixture_sheet(30, 30, 0.05f));
    test_crossing_allowed();
    test_joins();
    test_clearance(1);
    test_clearance(2);
    return 0;
}
