/* Patterns that keep: groups, large ones alone, details longer than wide; on a band with one side; through folds. */
#include "libcore/field/triangle_frames.h"
#include "libcore/replicate/plan/clip_stage_fixture.h"

enum { SIDE = 20 };

/* ---- motions ---- */

static MesoVec3 breathe(MesoVec3 p, float time)
{
    return (MesoVec3){p.x * (1 + 4 * time * (1 - time)), p.y, p.z};
}

static MesoVec3 widen(MesoVec3 p, float time)
{
    return (MesoVec3){p.x, p.y * (1 + time), p.z};
}

/* Flat, folded over itself, a line and back. */
static MesoVec3 crumple(MesoVec3 p, float time)
{
    if (time < 0.3f)
        return (MesoVec3){fabsf(p.x - time) * 2, p.y, p.z};
    return time < 0.7f ? (MesoVec3){0, p.y * 3, p.z * 3} : (MesoVec3){2 * p.x, p.y, p.z};
}

/* Every second row of vertices falls onto the next. */
static MesoVec3 sliver(MesoVec3 p, float time)
{
    float row = p.y * SIDE, half = 2 * floorf(row / 2 + 0.25f);
    return (MesoVec3){p.x * (1 + time), (row + time * (half - row)) / SIDE, p.z};
}

/* ---- groups ---- */

static MesoPairCorrelation correlate(Stage *s, MesoArena *arena, const MesoVec3 *positions, const MesoDetail *details,
                                     uint32_t count)
{
    MesoPairCorrelation g;
    MesoMeshPoint *points = MESO_NEW(arena, MesoMeshPoint, count, NULL);
    float *marks = MESO_NEW(arena, float, count, NULL);
    uint32_t lives = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (meso_replicate_fates(s->replication)[i].died != MESO_DETAIL_LIVES)
            continue;
        points[lives] = details[i].point;
        marks[lives++] = details[i].size;
    }
    MesoPointSet set = {&s->mesh, positions, points, marks, lives};
    CHECK(meso_pair_correlation(&g, arena, &set, &(MesoPairOptions){.radius = 4 / sqrt(s->count)}, NULL) == MESO_OK);
    return g;
}

/* Six sevenths in groups, small; the others alone, three times as large. */
static void set_groups(Stage *s, uint32_t count, Motion motion)
{
    set_stage(s, meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE), count, motion);
    uint32_t grouped = s->count - s->count / 7;
    MesoMeshPoint *points = meso_strew_groups(SIDE, grouped, 6, 0.4 / sqrt(s->count), 7);
    uint32_t alone = s->count - grouped;
    MesoMeshPoint *others = meso_strew_discs(&s->mesh, &alone, 0.6, 7);
    CHECK(grouped + alone == s->count);
    for (uint32_t i = 0; i < s->count; i++) {
        float size = i < grouped ? 1 : 3;
        s->originals[i] = (MesoDetail){.point = i < grouped ? points[i] : others[i - grouped], .size = size,
                                       .width = size, .kind = i >= grouped};
    }
    free(points);
    free(others);
}

/* As many pairs at each distance, and large ones alone as before, when it is twice as long, and when it is back. */
static void test_groups(void)
{
    for (int back = 0; back < 2; back++) {
        Stage s;
        MesoArena arena;
        uint32_t count, large = 0;
        meso_arena_init(&arena);
        set_groups(&s, 1400, back ? breathe : stretch);
        CHECK(meso_replicate_begin(&s.replication, &s.options, NULL) == MESO_OK);
        MesoPairCorrelation rest = correlate(&s, &arena, s.mesh.positions, s.originals, s.count);
        count = run(&s);
        const MesoDetail *details = meso_replicate_details(s.replication, &count);
        MesoPairCorrelation now = correlate(&s, &arena, s.moved, details, count);
        double marks = 0;
        for (uint32_t b = 0; b < rest.bin_count; b++)
            marks += fabs(rest.marks[b] - now.marks[b]) / rest.bin_count;
        CHECK(meso_pair_difference(&rest, &now) < 0.06 && marks < 0.1);
        for (uint32_t i = s.count; i < count; i++)
            large += details[i].kind;
        CHECK(fabs(large - (count - s.count) / 7.0) < 0.03 * count);
        /* it is stretched: what is told apart is not what was there all along */
        now = correlate(&s, &arena, back ? s.mesh.positions : s.moved, s.originals, s.count);
        CHECK(back || meso_pair_difference(&rest, &now) > 0.1);
        meso_arena_release(&arena);
        end(&s);
    }
}

/* A run that is cut goes on owing the same pairs. */
static void test_groups_resumed(void)
{
    Stage s, cut;
    uint32_t count, again;
    set_groups(&s, 350, breathe);
    set_groups(&cut, 350, breathe);
    cut.options.thread_count = 2;
    CHECK(meso_replicate_begin(&s.replication, &s.options, NULL) == MESO_OK);
    CHECK(meso_replicate_begin(&cut.replication, &cut.options, NULL) == MESO_OK);
    run(&s);
    for (uint32_t f = 0; f <= FRAMES; f++) {
        MesoReplication *next;
        CHECK(meso_replicate_step(cut.replication, f, NULL) == MESO_OK);
        CHECK(meso_replicate_begin(&next, &cut.options, NULL) == MESO_OK);
        MesoReplicaState state = meso_replicate_state(cut.replication);
        CHECK(meso_replicate_resume(next, &state, NULL) == MESO_OK);
        meso_replicate_release(cut.replication);
        cut.replication = next;
    }
    const MesoDetail *details = meso_replicate_details(s.replication, &count);
    CHECK(memcmp(details, meso_replicate_details(cut.replication, &again), count * sizeof *details) == 0);
    CHECK(count == again && count > s.count);
    end(&s);
    end(&cut);
}

/* ---- discs ---- */

/* As far as the nearest, where distances along are shorter by that. */
static double nearest_at(const Stage *s, const MesoVec3 *positions, const MesoDetail *details, uint32_t count,
                         uint32_t i, double length)
{
    double least = INFINITY;
    MesoVec3 p = meso_detail_position(&s->mesh, positions, &details[i].point);
    for (uint32_t k = 0; k < count; k++) {
        MesoVec3 q = meso_detail_position(&s->mesh, positions, &details[k].point);
        double x = (double)(q.x - p.x) / length, y = (double)(q.y - p.y);
        least = k == i ? least : fmin(least, x * x + y * y);
    }
    return sqrt(least);
}

/* Longer, and sheared. */
static MesoVec3 slant(MesoVec3 p, float time)
{
    return (MesoVec3){p.x * (1 + 0.5f * time) + 0.5f * time * p.y, p.y * (1 + 0.5f * time), p.z};
}

/* As many at each distance as at rest; and hardly one is born nearer to another than any was. */
static void test_discs(void)
{
    enum { SEEDS = 2 };
    const double tightness = 0.75;
    double before[64] = {0}, after[64] = {0}, apart = 0;
    uint32_t near = 0, births = 0, bins = 0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        Stage s;
        MesoArena arena;
        meso_arena_init(&arena);
        set_stage(&s, meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE), 700, slant);
        MesoMeshPoint *points = meso_strew_discs(&s.mesh, &s.count, tightness, seed);
        for (uint32_t i = 0; i < s.count; i++)
            s.originals[i] = (MesoDetail){.point = points[i], .size = 1, .width = 1};
        s.options.original_count = s.count;
        CHECK(meso_replicate_begin(&s.replication, &s.options, NULL) == MESO_OK);
        MesoPairCorrelation rest = correlate(&s, &arena, s.mesh.positions, s.originals, s.count);
        uint32_t count = run(&s);
        const MesoDetail *details = meso_replicate_details(s.replication, &count);
        MesoPairCorrelation now = correlate(&s, &arena, s.moved, details, count);
        bins = rest.bin_count;
        for (uint32_t b = 0; b < bins; b++) {
            before[b] += rest.g[b] / SEEDS;
            after[b] += now.g[b] / SEEDS;
        }
        double least = tightness * sqrt(1.0 / s.count);
        for (uint32_t i = s.count; i < count; i++)
            near += nearest_at(&s, s.moved, details, count, i, 1) < 0.9 * least;
        births += count - s.count;
        free(points);
        meso_arena_release(&arena);
        end(&s);
    }
    for (uint32_t b = 0; b < bins; b++)
        apart += fabs(after[b] - before[b]) / bins;
    CHECK(apart < 0.03 && near < 0.01 * births);
}

/* ---- longer than wide ---- */

enum { LONG = 4 };

/* Share of those born that have another nearer than any had at rest, by a fourth. */
static double share_too_near(bool directed)
{
    Stage s;
    MesoTriangulation tall = meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE);
    uint32_t count, near = 0;
    double least = INFINITY;
    set_stage(&s, meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE), 400, widen);
    for (uint32_t v = 0; v < tall.vertex_count; v++)
        tall.positions[v].y *= LONG;
    MesoMeshPoint *points = meso_strew_discs(&tall, &s.count, 0.7, 5);
    for (uint32_t i = 0; i < s.count; i++) {
        MesoTriangleFrame frame = meso_frame(&s.mesh, points[i].triangle);
        MesoComplex along = meso_frame_in(&frame, (MesoVec3){1, 0, 0});
        s.originals[i] = (MesoDetail){.point = points[i], .size = directed ? LONG : 1, .width = 1,
                                      .angle = (float)atan2(along.im, along.re)};
    }
    s.options.original_count = s.count;
    for (uint32_t i = 0; i < s.count; i++)
        least = fmin(least, nearest_at(&s, s.mesh.positions, s.originals, s.count, i, LONG));
    CHECK(meso_replicate_begin(&s.replication, &s.options, NULL) == MESO_OK);
    run(&s);
    const MesoDetail *details = meso_replicate_details(s.replication, &count);
    CHECK(fabs(count - 2.0 * s.count) < 0.03 * count);
    for (uint32_t i = s.count; i < count; i++)
        near += nearest_at(&s, s.moved, details, count, i, LONG) < 0.75 * least;
    free(points);
    meso_triangulation_release(&tall);
    end(&s);
    return (double)near / (count - s.count);
}

static void test_directed(void)
{
    double directed = share_too_near(true), alike = share_too_near(false);
    CHECK(directed < 0.5 * alike);
}

/* ---- odd surfaces ---- */

static MesoVec3 on_band(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    float a = 6.2831853f * (float)column / (float)squares->columns;
    float w = 0.6f * ((float)row / (float)squares->rows - 0.5f), r = 1 + w * cosf(a / 2);
    return (MesoVec3){r * cosf(a), r * sinf(a), w * sinf(a / 2)};
}

static void test_one_side(void)
{
    Stage s;
    MesoFixtureSquares squares = {60, 8, MESO_SEAM_TWISTED, false, {0, 0}, on_band};
    start(&s, meso_fixture_squares(&squares), 800, scale, 1);
    uint32_t count = run(&s);
    CHECK(fabs(count - 4.0 * s.count) < 0.02 * count);
    end(&s);
}

/* Folds, what collapses, slivers: gone through, and the web is one all the time. */
static void test_crumpled(void)
{
    const Motion motions[2] = {crumple, sliver};
    for (int m = 0; m < 2; m++)
        for (int mode = 0; mode < 3; mode++) {
            Stage s;
            MesoError error;
            start_in(&s, (MesoReplicateMode)mode, meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE), 60, motions[m]);
            for (uint32_t f = 0; f <= FRAMES; f++) {
                CHECK(meso_replicate_step(s.replication, f, NULL) == MESO_OK);
                CHECK(meso_web_check(meso_replicate_web(s.replication), 1, &error) == MESO_OK);
            }
            end(&s);
        }
}

/* The same for any number of threads, also where some die. */
static void test_threads(void)
{
    const uint32_t threads[3] = {1, 2, 7};
    Stage s[3];
    uint32_t first, count;
    for (int i = 0; i < 3; i++) {
        start(&s[i], meso_fixture_torus(60, 24, 0.4f), 900, breathe, threads[i]);
        run(&s[i]);
        const MesoDetail *details = meso_replicate_details(s[0].replication, &first);
        CHECK(memcmp(details, meso_replicate_details(s[i].replication, &count), first * sizeof *details) == 0);
        CHECK(first == count);
        CHECK(memcmp(meso_replicate_grown(s[0].replication), meso_replicate_grown(s[i].replication),
                     count * sizeof(float)) == 0);
    }
    for (int i = 0; i < 3; i++)
        end(&s[i]);
}

int main(void)
{
    test_groups();
    test_groups_resumed();
    test_discs();
    test_directed();
    test_one_side();
    test_crumpled();
    test_threads();
    return 0;
}
