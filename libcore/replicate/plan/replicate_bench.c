/*
 * Details on a patch that is stretched to twice its length in 60 frames: how their distribution keeps, beside the
 * paper's Table 1, and times, by the process, one core.
 *
 *   replicate_bench [MOST]     up to so many details; 100,000 without
 */
#include <stdio.h>
#include <time.h>

#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/mesh/point/vertex_normals.h"
#include "libcore/replicate/plan/replicate.h"
#include "libcore/replicate/statistics/points_fixture.h"

enum { FRAMES = 60 };

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---- the clip ---- */

typedef struct Patch {
    MesoTriangulation mesh;
    MesoVec3 *moved;
    MesoClip clip;
} Patch;

static const MesoVec3 *stretched(void *context, uint32_t frame, MesoError *error)
{
    Patch *patch = context;
    (void)error;
    for (uint32_t v = 0; v < patch->mesh.vertex_count; v++) {
        MesoVec3 p = patch->mesh.positions[v];
        patch->moved[v] = (MesoVec3){p.x * (1 + (float)frame / FRAMES), p.y, p.z};
    }
    return patch->moved;
}

static void patch_init(Patch *patch, uint32_t side)
{
    patch->mesh = meso_fixture_sheet(side, side, 1.0f / (float)side);
    patch->moved = malloc(patch->mesh.vertex_count * sizeof *patch->moved);
    CHECK(patch->moved);
    patch->clip = (MesoClip){&patch->mesh, FRAMES + 1, stretched, patch};
}

/* ---- what is measured ---- */

typedef struct Case {
    const char *name, *paper;   /* its Table 1: mean and deviation of edges, least and most in per cent of the first */
    int kind;                   /* 0: discs, 1: groups, 2: grid */
    double tightness;
    uint32_t count;
} Case;

static const Case cases[] = {
    {"1 dense, even", "-1.4 .. +6.5, 0 .. +9.7", 0, 0.75, 200},
    {"2 sparse, even", "-1.5 .. +4.5, -13.8 .. -2.6", 0, 0.6, 60},
    {"3 alone and grouped", "+0.4 .. +15.1, -3.3 .. +3.3", 1, 0, 150},
    {"jittered grid", "", 2, 0.5, 196},
    {"discs", "", 0, 0.75, 200},
    {"discs", "", 0, 0.75, 2000},
    {"discs, loose", "", 0, 0.5, 2000},
    {"discs", "", 0, 0.75, 20000},
    {"discs, loose", "", 0, 0.5, 20000},
    {"groups", "", 1, 0, 20000},
    {"discs", "", 0, 0.75, 100000},
    {"discs, loose", "", 0, 0.5, 100000},
};

typedef struct Range {
    double least, most;
} Range;

static void widen(Range *range, double x)
{
    range->least = fmin(range->least, x);
    range->most = fmax(range->most, x);
}

static int by_triangle(const void *a, const void *b)
{
    const MesoMeshPoint *x = a, *y = b;
    if (x->triangle != y->triangle)
        return x->triangle < y->triangle ? -1 : 1;
    return x->weight[0] < y->weight[0] ? -1 : x->weight[0] > y->weight[0];
}

static MesoMeshPoint *strew(const Case *c, const Patch *patch, uint32_t side, uint32_t *count)
{
    *count = c->count;
    if (c->kind == 0)
        return meso_strew_discs(&patch->mesh, count, c->tightness, 7);
    if (c->kind == 1)
        return meso_strew_groups(side, *count, 6, 0.4 / sqrt(*count), 7);
    return meso_strew_grid(side, (uint32_t)(sqrt(*count) + 0.5), c->tightness, 7);
}

static MesoPairCorrelation correlation(MesoArena *arena, const Patch *patch, const MesoVec3 *positions,
                                       const MesoMeshPoint *points, uint32_t count, double spacing)
{
    MesoPairCorrelation g;
    MesoPointSet set = {&patch->mesh, positions, points, NULL, count};
    CHECK(meso_pair_correlation(&g, arena, &set, &(MesoPairOptions){.radius = 4 * spacing, .source_limit = 10000}, NULL)
          == MESO_OK);
    return g;
}

static double percent(double now, double before)
{
    return 100 * (now / before - 1);
}

/* ---- a case ---- */

typedef struct Run {
    const Case *c;
    Patch *patch;
    MesoArena arena;
    MesoDetail *originals;
    MesoMeshPoint *points;      /* of details, for statistics */
    uint32_t count;
    MesoPairCorrelation before;
    double spacing;
} Run;

static void print_steps(Run *run, const char *mode, MesoReplication *r, double build)
{
    MesoWebEdges first = meso_web_edges(meso_replicate_web(r));
    Range mean = {INFINITY, -INFINITY}, deviation = mean, density = mean;
    double worst = 0, all = 0;
    uint32_t count = 0;
    for (uint32_t f = 0; f <= FRAMES; f++) {
        double start = cpu_seconds();
        CHECK(meso_replicate_step(r, f, NULL) == MESO_OK);
        double seconds = cpu_seconds() - start;
        worst = fmax(worst, seconds);
        all += seconds;
        MesoWebEdges edges = meso_web_edges(meso_replicate_web(r));
        meso_replicate_details(r, &count);
        widen(&mean, percent(edges.mean, first.mean));
        widen(&deviation, percent(edges.deviation, first.deviation));
        widen(&density, count / (run->count * (1 + (double)f / FRAMES)));
    }
    const MesoDetail *details = meso_replicate_details(r, &count);
    for (uint32_t i = 0; i < count; i++)
        run->points[i] = details[i].point;
    MesoPairCorrelation after = correlation(&run->arena, run->patch, run->patch->moved, run->points, count,
                                            run->spacing);
    printf("  %s  edges %+.1f .. %+.1f %%, deviation %+.1f .. %+.1f %%, density %.3f .. %.3f, g %.3f\n", mode,
           mean.least, mean.most, deviation.least, deviation.most, density.least, density.most,
           meso_pair_difference(&run->before, &after));
    printf("         begin %.1f ms, step %.2f ms, most %.2f ms, %u births\n", 1e3 * build, 1e3 * all / (FRAMES + 1),
           1e3 * worst, count - run->count);
}

static void print_play(Run *run, const MesoReplication *r)
{
    MesoReplicaPlan plan;
    MesoPlayer *player;
    double start = cpu_seconds();
    CHECK(meso_replicate_plan(&plan, &run->arena, r, NULL) == MESO_OK);
    double planning = cpu_seconds() - start;
    CHECK(meso_player_build(&player, &run->arena, &run->patch->mesh, &plan, NULL) == MESO_OK);
    float *grown = MESO_NEW(&run->arena, float, plan.detail_count, NULL);
    float *earlier = MESO_NEW(&run->arena, float, plan.detail_count, NULL);
    CHECK(grown && earlier);
    Range density = {INFINITY, -INFINITY}, g = density;
    double seconds = 0, change = 0;
    uint32_t at_rest = 0;
    for (uint32_t f = 0; f <= FRAMES; f++) {
        const MesoVec3 *positions = stretched(run->patch, f, NULL);
        start = cpu_seconds();
        meso_player_play(player, grown, positions, 1);
        seconds += cpu_seconds() - start;
        double sum = 0;
        uint32_t awake = 0;
        for (uint32_t i = 0; i < plan.detail_count; i++) {
            sum += (double)grown[i];
            if (f > 0)
                change = fmax(change, fabs((double)grown[i] - (double)earlier[i]));
            if (grown[i] > 0.5f)
                run->points[awake++] = plan.details[i].point;
        }
        at_rest = f == 0 ? awake : at_rest;
        widen(&density, sum / (run->count * (1 + (double)f / FRAMES)));
        if (f % 20 == 0) {
            MesoPairCorrelation now = correlation(&run->arena, run->patch, positions, run->points, awake, run->spacing);
            widen(&g, meso_pair_difference(&run->before, &now));
        }
        memcpy(earlier, grown, plan.detail_count * sizeof *grown);
    }
    printf("  play   density %.3f .. %.3f, g %.3f .. %.3f, at rest %+d, largest change %.2f, plan %.1f ms, "
           "%.2f pairs, frame %.2f ms\n", density.least, density.most, g.least, g.most,
           (int)(at_rest - run->count), change, 1e3 * planning,
           (double)plan.pair_begin[plan.detail_count] / plan.detail_count, 1e3 * seconds / (FRAMES + 1));
}

static void measure(const Case *c)
{
    Patch patch;
    uint32_t side = c->count <= 2000 ? 20 : c->count <= 20000 ? 60 : 120;
    patch_init(&patch, side);
    Run run = {.c = c, .patch = &patch};
    meso_arena_init(&run.arena);
    MesoMeshPoint *points = strew(c, &patch, side, &run.count);
    qsort(points, run.count, sizeof *points, by_triangle);
    run.spacing = 1 / sqrt(run.count);
    run.originals = MESO_NEW(&run.arena, MesoDetail, run.count, NULL);
    run.points = MESO_NEW(&run.arena, MesoMeshPoint, 8 * (size_t)run.count, NULL);
    CHECK(run.originals && run.points);
    for (uint32_t i = 0; i < run.count; i++)
        run.originals[i] = (MesoDetail){.point = points[i], .size = 1, .width = 1};
    run.before = correlation(&run.arena, &patch, patch.mesh.positions, points, run.count, run.spacing);
    printf("%s, %u%s%s\n", c->name, run.count, *c->paper ? "; the paper: " : "", c->paper);
    MesoReplicateOptions options = {.clip = &patch.clip, .originals = run.originals, .original_count = run.count,
                                    .thread_count = 1};
    MesoReplication *r;
    double start = cpu_seconds();
    CHECK(meso_replicate_begin(&r, &options, NULL) == MESO_OK);
    print_steps(&run, "plan ", r, cpu_seconds() - start);
    print_play(&run, r);
    meso_replicate_release(r);
    options.mode = MESO_REPLICATE_PAPER;
    start = cpu_seconds();
    if (meso_replicate_begin(&r, &options, NULL) == MESO_OK) {
        print_steps(&run, "paper", r, cpu_seconds() - start);
        meso_replicate_release(r);
    }
    meso_arena_release(&run.arena);
    meso_triangulation_release(&patch.mesh);
    free(patch.moved);
    free(points);
}

int main(int argc, char **argv)
{
    uint32_t most = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 100000;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (cases[i].count <= most)
            measure(&cases[i]);
    return 0;
}
