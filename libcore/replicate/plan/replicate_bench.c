/*
 * Details on surfaces that deform: how their distribution keeps, beside the paper's Table 1 and goals, and how far two
 * draws of the same distribution are from each other; times, by the process, one core; and memory. What has missed its
 * goal says so.
 *
 *   replicate_bench [MOST]     up to so many details; 100,000 without
 */
#include <stdio.h>
#include <time.h>

#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/replicate/plan/replicate.h"
#include "libcore/replicate/statistics/points_fixture.h"

enum { FRAMES = 60, LOOKS = 4, BINS = 24, TALLEST = 21 };

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double percent(double now, double before)
{
    return 100 * (now / before - 1);
}

/* ---- ranges ---- */

typedef struct Range {
    double least, most;
} Range;

static const Range NOTHING = {INFINITY, -INFINITY};

static void widen(Range *range, double x)
{
    range->least = fmin(range->least, x);
    range->most = fmax(range->most, x);
}

static void print_range(const char *what, Range range, double goal)
{
    printf("  %s %+.1f .. %+.1f [%g]%s", what, range.least, range.most, goal,
           range.least < -goal || range.most > goal ? " MISSED" : "");
}

static void print_most(const char *what, double value, double floor, double most)
{
    printf("  %s %.3f (floor %.3f) [%.3g]%s", what, value, floor, most, value > most ? " MISSED" : "");
}

/* ---- clips ---- */

typedef MesoVec3 (*Motion)(MesoVec3 p, float time);

static MesoVec3 stretch(MesoVec3 p, float time)
{
    return (MesoVec3){p.x * (1 + time), p.y, p.z};
}

static MesoVec3 stretch_up(MesoVec3 p, float time)
{
    return (MesoVec3){p.x, p.y, p.z * (1 + time)};
}

/* First along one side, then along the other, while it is sheared. */
static MesoVec3 stretch_twice(MesoVec3 p, float time)
{
    float x = fminf(1, 2 * time), y = fmaxf(0, 2 * time - 1);
    return (MesoVec3){p.x * (1 + 0.5f * x) + 0.5f * time * p.y, p.y * (1 + 0.5f * y), p.z};
}

static MesoVec3 there_and_back(MesoVec3 p, float time)
{
    return stretch(p, 4 * time * (1 - time));
}

static MesoVec3 halve(MesoVec3 p, float time)
{
    return meso_vec3_scale(p, 1 - 0.5f * time);
}

static MesoVec3 bend(MesoVec3 p, float time)
{
    float a = 3.14159265f * time;
    return a > 0 ? (MesoVec3){sinf(a * p.x) / a, p.y, (1 - cosf(a * p.x)) / a} : p;
}

/* Longer in the middle, and blown up in front. */
static MesoVec3 animal_grows(MesoVec3 p, float time)
{
    float middle = fminf(fmaxf(p.x, -0.5f), 0.5f), front = fmaxf(0, p.x - 0.5f);
    MesoVec3 q = {p.x + time * middle, p.y, p.z};
    float wide = 1 + 0.6f * time * fminf(1, 2 * front);
    return (MesoVec3){q.x, q.y * wide, q.z * wide};
}

typedef enum Ground { SHEET, TUBE, BALL, ANIMAL } Ground;

typedef struct Scene {
    MesoTriangulation mesh;
    MesoVec3 *moved;
    Motion motion;
    uint32_t frames;        /* the last one is at time 1 */
    double area;            /* at rest */
    MesoClip clip;
} Scene;

static const MesoVec3 *positions_at(void *context, uint32_t frame, MesoError *error)
{
    Scene *scene = context;
    (void)error;
    for (uint32_t v = 0; v < scene->mesh.vertex_count; v++)
        scene->moved[v] = scene->motion(scene->mesh.positions[v], (float)frame / (float)scene->frames);
    return scene->moved;
}

static float hump(MesoVec3 p, MesoVec3 towards, float height, float narrow)
{
    float d = meso_vec3_dot(p, meso_vec3_unit(towards, towards)) - 1;
    return height * expf(narrow * d);
}

/* A body, a head and four legs, out of a ball. */
static void make_animal(MesoTriangulation *mesh)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 p = mesh->positions[v];
        float r = 0.6f + hump(p, (MesoVec3){1, 0, 0.3f}, 0.5f, 8) + hump(p, (MesoVec3){-1, 0, 0.2f}, 0.6f, 12);
        for (int leg = 0; leg < 4; leg++)
            r += hump(p, (MesoVec3){leg & 1 ? 0.6f : -0.6f, leg & 2 ? 0.4f : -0.4f, -0.7f}, 0.5f, 25);
        mesh->positions[v] = meso_vec3_scale(p, r);
    }
}

static uint32_t side_of(uint32_t count)
{
    return count <= 2000 ? 20 : count <= 20000 ? 60 : 120;
}

static void scene_init(Scene *scene, Ground ground, uint32_t count, Motion motion)
{
    uint32_t side = side_of(count);
    *scene = (Scene){.motion = motion, .frames = FRAMES};
    scene->mesh = ground == SHEET ? meso_fixture_sheet(side, side, 1.0f / (float)side)
                  : ground == TUBE ? meso_fixture_tube(2 * side, side, 3) : meso_fixture_ball(side);
    if (ground == ANIMAL)
        make_animal(&scene->mesh);
    scene->area = meso_surface_area(&scene->mesh, scene->mesh.positions);
    scene->moved = malloc(scene->mesh.vertex_count * sizeof *scene->moved);
    CHECK(scene->moved);
    scene->clip = (MesoClip){&scene->mesh, FRAMES + 1, positions_at, scene};
}

static void scene_release(Scene *scene)
{
    meso_triangulation_release(&scene->mesh);
    free(scene->moved);
}

/* ---- distributions ---- */

typedef enum Kind { DISCS, GROUPS, GRID } Kind;

typedef struct Case {
    const char *name, *paper;   /* its Table 1: mean and deviation of edges, least and most in per cent of the first */
    Kind kind;
    double tightness;
    uint32_t count, seeds;
    double mean_goal, deviation_goal, g_goal;
} Case;

static const Case cases[] = {
    {"1 dense, even", "-1.4 .. +6.5, 0 .. +9.7", DISCS, 0.75, 200, 20, 2.5, 10, 0.03},
    {"2 sparse, even", "-1.5 .. +4.5, -13.8 .. -2.6", DISCS, 0.6, 200, 20, 2.5, 10, 0.03},
    {"3 alone and grouped", "+0.4 .. +15.1, -3.3 .. +3.3", GROUPS, 0, 200, 20, 2.5, 10, 0.06},
    {"jittered grid", "", GRID, 0.5, 196, 20, 2.5, 10, 0.03},
    {"discs", "", DISCS, 0.75, 2000, 4, 2.5, 10, 0.03},
    {"discs, loose", "", DISCS, 0.5, 2000, 4, 2.5, 10, 0.03},
    {"groups", "", GROUPS, 0, 2000, 4, 2.5, 10, 0.06},
    {"discs", "", DISCS, 0.75, 20000, 1, 1, 5, 0.03},
    {"discs, loose", "", DISCS, 0.5, 20000, 1, 1, 5, 0.03},
    {"groups", "", GROUPS, 0, 20000, 1, 1, 5, 0.06},
    {"discs", "", DISCS, 0.75, 100000, 1, 1, 5, 0.03},
    {"discs, loose", "", DISCS, 0.5, 100000, 1, 1, 5, 0.03},
};

static int by_triangle(const void *a, const void *b)
{
    const MesoDetail *x = a, *y = b;
    if (x->point.triangle != y->point.triangle)
        return x->point.triangle < y->point.triangle ? -1 : 1;
    return x->point.weight[0] < y->point.weight[0] ? -1 : x->point.weight[0] > y->point.weight[0];
}

/* Groups of six about, of small ones, and as many large ones alone as there are groups; else all alike. */
static MesoDetail *strew(const Case *c, const MesoTriangulation *mesh, uint64_t seed, uint32_t *count)
{
    uint32_t alone = 0, grouped = 0;
    MesoMeshPoint *points, *others = NULL;
    *count = c->count;
    if (c->kind == DISCS) {
        points = meso_strew_discs(mesh, count, c->tightness, seed);
    } else if (c->kind == GRID) {
        points = meso_strew_grid(side_of(*count), (uint32_t)(sqrt(*count) + 0.5), c->tightness, seed);
    } else {
        alone = *count / 7;
        grouped = *count - alone;
        points = meso_strew_groups(side_of(*count), grouped, 6, 0.4 / sqrt(*count), seed);
        others = meso_strew_discs(mesh, &alone, 0.7, seed);
        *count = grouped + alone;
    }
    MesoDetail *details = calloc(*count, sizeof *details);
    CHECK(details);
    for (uint32_t i = 0; i < *count; i++) {
        bool large = others && i >= grouped;
        details[i] = (MesoDetail){.point = large ? others[i - grouped] : points[i], .size = large ? 3 : 1,
                                  .width = large ? 3 : 1, .kind = large};
    }
    qsort(details, *count, sizeof *details, by_triangle);
    free(points);
    free(others);
    return details;
}

/* ---- what is measured ---- */

typedef struct Run {
    Scene *scene;
    MesoArena arena;
    MesoDetail *originals;
    uint32_t count;
    bool marked;
    double spacing;
    MesoMeshPoint *points;      /* [room] of those that are there, and their sizes */
    float *marks;
    uint32_t room;
    MesoPairCorrelation before;
} Run;

static MesoPairCorrelation correlate(Run *run, const MesoVec3 *positions, uint32_t count)
{
    MesoPairCorrelation g;
    MesoPointSet set = {&run->scene->mesh, positions, run->points, run->marked ? run->marks : NULL, count};
    MesoPairOptions options = {.radius = 4 * run->spacing, .source_limit = 10000};
    CHECK(meso_pair_correlation(&g, &run->arena, &set, &options, NULL) == MESO_OK);
    return g;
}

/* Those of which there is more than half, of details of a share each; NULL: all. */
static uint32_t take(Run *run, const MesoDetail *details, const float *shares, const MesoDetailFate *fates,
                     uint32_t count)
{
    uint32_t taken = 0;
    CHECK(count <= run->room);
    for (uint32_t i = 0; i < count; i++) {
        if ((shares && !(shares[i] > 0.5f)) || (fates && fates[i].died != MESO_DETAIL_LIVES))
            continue;
        run->points[taken] = details[i].point;
        run->marks[taken++] = details[i].size;
    }
    return taken;
}

static void run_init(Run *run, Scene *scene, MesoDetail *originals, uint32_t count, bool marked)
{
    *run = (Run){.scene = scene, .originals = originals, .count = count, .marked = marked,
                 .spacing = sqrt(scene->area / count), .room = 12 * count};
    meso_arena_init(&run->arena);
    run->points = MESO_NEW(&run->arena, MesoMeshPoint, run->room, NULL);
    run->marks = MESO_NEW(&run->arena, float, run->room, NULL);
    CHECK(run->points && run->marks);
    run->before = correlate(run, scene->mesh.positions, take(run, originals, NULL, NULL, count));
}

static MesoReplication *begin(Run *run, MesoReplicateMode mode, MesoReplicateBirths births, double *seconds)
{
    MesoReplicateOptions options = {.clip = &run->scene->clip, .originals = run->originals,
                                    .original_count = run->count, .thread_count = 1, .mode = mode, .births = births,
                                    .substeps = mode == MESO_REPLICATE_PLAN ? 3 : 1};
    MesoReplication *r;
    double start = cpu_seconds();
    MesoStatus status = meso_replicate_begin(&r, &options, NULL);
    *seconds = cpu_seconds() - start;
    return status == MESO_OK ? r : NULL;
}

/* ---- tallies ---- */

/* What is looked at of details, in the mean of all seeds: of a few the pairs of one draw are no more than a draw. */
typedef struct Look {
    double g[BINS], marks[BINS];
} Look;

/* Of all seeds of one way. */
typedef struct Tally {
    Range mean, deviation, density;         /* of the worst seed */
    Look looks[LOOKS + 1];
    double change, build, step;
    uint32_t runs, count, living, wrong;
} Tally;

static void look_at(Look *look, const MesoPairCorrelation *g, uint32_t seeds)
{
    CHECK(g->bin_count == BINS);
    for (uint32_t b = 0; b < BINS; b++) {
        look->g[b] += g->g[b] / seeds;
        look->marks[b] += g->marks ? g->marks[b] / seeds : 0;
    }
}

static double apart(const double a[BINS], const double b[BINS])
{
    double sum = 0;
    for (uint32_t i = 0; i < BINS; i++)
        sum += fabs(a[i] - b[i]) / BINS;
    return sum;
}

/* Beside those at rest; and beside each other those at rest of two sets of seeds, which differ by as much as chance. */
static void print_looks(const Tally *tally, const Look at_rest[2], double goal, bool marked)
{
    double g = 0, marks = 0;
    for (uint32_t k = 0; k <= LOOKS; k++) {
        g = fmax(g, apart(tally->looks[k].g, at_rest[0].g));
        marks = fmax(marks, apart(tally->looks[k].marks, at_rest[0].marks));
    }
    print_most("g", g, apart(at_rest[0].g, at_rest[1].g), goal);
    if (marked)
        print_most("marks", marks, apart(at_rest[0].marks, at_rest[1].marks), 0.1);
}

static void note_changes(Tally *tally, const float *grown, float *earlier, uint32_t count, bool first)
{
    for (uint32_t i = 0; i < count && !first; i++)
        tally->change = fmax(tally->change, fabs((double)grown[i] - (double)earlier[i]));
    memcpy(earlier, grown, count * sizeof *earlier);
}

/* ---- from frame to frame ---- */

static void run_steps(Tally *tally, Run *run, const Case *c, MesoReplicateMode mode, MesoReplicateBirths births)
{
    double build;
    MesoReplication *r = begin(run, mode, births, &build);
    if (!r)
        return;
    MesoWebEdges first = meso_web_edges(meso_replicate_web(r));
    float *earlier = MESO_NEW(&run->arena, float, run->room, NULL);
    uint32_t count;
    tally->build += build / c->seeds;
    for (uint32_t f = 0; f <= FRAMES; f++) {
        double start = cpu_seconds();
        CHECK(meso_replicate_step(r, f, NULL) == MESO_OK);
        tally->step += (cpu_seconds() - start) / (FRAMES + 1) / c->seeds;
        MesoWebEdges edges = meso_web_edges(meso_replicate_web(r));
        const MesoDetail *details = meso_replicate_details(r, &count);
        tally->living = take(run, details, NULL, meso_replicate_fates(r), count);
        double area = meso_surface_area(&run->scene->mesh, run->scene->moved) / run->scene->area;
        widen(&tally->mean, percent(edges.mean, first.mean));
        widen(&tally->deviation, percent(edges.deviation, first.deviation));
        widen(&tally->density, percent(tally->living, run->count * area));
        note_changes(tally, meso_replicate_grown(r), earlier, count, f == 0);
        if (f % (FRAMES / LOOKS) == 0) {
            MesoPairCorrelation now = correlate(run, run->scene->moved, tally->living);
            look_at(&tally->looks[f / (FRAMES / LOOKS)], &now, c->seeds);
        }
    }
    tally->count = run->count;
    tally->runs++;
    meso_replicate_release(r);
}

static void print_steps(const Tally *tally, const Case *c, const char *name, const Look at_rest[2])
{
    if (tally->runs == 0)
        return;
    printf("  %s", name);
    print_range("edges", tally->mean, c->mean_goal);
    print_range("deviation", tally->deviation, c->deviation_goal);
    print_range("density", tally->density, 2);
    print_looks(tally, at_rest, c->g_goal, c->kind == GROUPS);
    printf("  share a frame %.2f  begin %.1f ms  step %.2f ms  %u -> %u\n", tally->change, 1e3 * tally->build,
           1e3 * tally->step, tally->count, tally->living);
}

/* ---- played ---- */

static void run_play(Tally *tally, Run *run, const Case *c)
{
    MesoReplicaPlan plan;
    MesoPlayer *player;
    double build;
    MesoReplication *r = begin(run, MESO_REPLICATE_PLAN, MESO_BIRTHS_USUAL, &build);
    CHECK(r);
    for (uint32_t f = 0; f <= FRAMES; f++)
        CHECK(meso_replicate_step(r, f, NULL) == MESO_OK);
    double start = cpu_seconds();
    CHECK(meso_replicate_plan(&plan, &run->arena, r, NULL) == MESO_OK);
    CHECK(meso_player_build(&player, &run->arena, &run->scene->mesh, &plan, NULL) == MESO_OK);
    tally->build += (cpu_seconds() - start) / c->seeds;
    float *grown = MESO_NEW(&run->arena, float, plan.detail_count, NULL);
    float *earlier = MESO_NEW(&run->arena, float, plan.detail_count, NULL);
    CHECK(grown && earlier);
    for (uint32_t f = 0; f <= FRAMES; f++) {
        const MesoVec3 *positions = positions_at(run->scene, f, NULL);
        start = cpu_seconds();
        meso_player_play(player, grown, positions, 1);
        tally->step += (cpu_seconds() - start) / (FRAMES + 1) / c->seeds;
        double sum = 0, area = meso_surface_area(&run->scene->mesh, positions) / run->scene->area;
        for (uint32_t i = 0; i < plan.detail_count; i++) {
            sum += (double)grown[i];
            tally->wrong += f == 0 && grown[i] != (float)(i < run->count);
        }
        widen(&tally->density, percent(sum, run->count * area));
        note_changes(tally, grown, earlier, plan.detail_count, f == 0);
        if (f % (FRAMES / LOOKS) == 0) {
            uint32_t taken = take(run, plan.details, grown, NULL, plan.detail_count);
            MesoPairCorrelation now = correlate(run, positions, taken);
            look_at(&tally->looks[f / (FRAMES / LOOKS)], &now, c->seeds);
        }
    }
    meso_replicate_release(r);
}

static void print_play(const Tally *tally, const Case *c, const Look at_rest[2])
{
    printf("  play ");
    print_range("density", tally->density, 2);
    print_looks(tally, at_rest, c->g_goal, c->kind == GROUPS);
    printf("  share a frame %.2f  wrong at rest %u  plan %.1f ms  frame %.2f ms\n", tally->change, tally->wrong,
           1e3 * tally->build, 1e3 * tally->step);
}

/* ---- a row ---- */

enum { PLAN, OTHER, PAPER, PLAY, TALLIES };

static void run_seed(Tally tallies[TALLIES], Look at_rest[2], const Case *c, uint64_t seed, Scene *scene, bool all)
{
    Run run;
    for (uint64_t k = 2; k-- > 0;) {    /* those of the seed itself last: they are gone on with */
        uint32_t count;
        MesoDetail *originals = strew(c, &scene->mesh, seed + 1000 * k, &count);
        run_init(&run, scene, originals, count, c->kind == GROUPS);
        look_at(&at_rest[k], &run.before, c->seeds);
        if (k == 0) {
            run_steps(&tallies[PLAN], &run, c, MESO_REPLICATE_LIVE, MESO_BIRTHS_USUAL);
            if (all)
                run_steps(&tallies[OTHER], &run, c, MESO_REPLICATE_LIVE,
                          c->kind == GROUPS ? MESO_BIRTHS_EXEMPLARS : MESO_BIRTHS_STATISTICS);
            if (all)
                run_steps(&tallies[PAPER], &run, c, MESO_REPLICATE_PAPER, MESO_BIRTHS_USUAL);
            run_play(&tallies[PLAY], &run, c);
        }
        meso_arena_release(&run.arena);
        free(originals);
    }
}

static void measure(const Case *c, const char *where, Ground ground, Motion motion, bool all)
{
    Scene scene;
    Tally tallies[TALLIES];
    Look at_rest[2] = {0};
    scene_init(&scene, ground, c->count, motion);
    for (uint32_t i = 0; i < TALLIES; i++)
        tallies[i] = (Tally){.mean = NOTHING, .deviation = NOTHING, .density = NOTHING};
    for (uint64_t seed = 7; seed < 7 + c->seeds; seed++)
        run_seed(tallies, at_rest, c, seed, &scene, all);
    printf("%s, %u%s, %u seed%s%s%s\n", c->name, tallies[PLAN].count, where, c->seeds, c->seeds == 1 ? "" : "s",
           *c->paper ? "; the paper: " : "", c->paper);
    print_steps(&tallies[PLAN], c, "plan ", at_rest);
    print_steps(&tallies[OTHER], c, c->kind == GROUPS ? "plan, by exemplars" : "plan, by statistics", at_rest);
    print_steps(&tallies[PAPER], c, "paper", at_rest);
    print_play(&tallies[PLAY], c, at_rest);
    scene_release(&scene);
}

/* ---- times ---- */

static void print_time(const char *what, double seconds, double goal)
{
    printf("  %-44s %8.2f ms [%g]%s\n", what, 1e3 * seconds, goal, 1e3 * seconds > goal ? " MISSED" : "");
}

/* A frame of a stretch that bears a hundredth: the best and the mean of twenty. */
static void print_step_time(uint32_t count, double begin_goal, double step_goal)
{
    Scene scene;
    Run run;
    char what[64];
    double build, least = INFINITY, all = 0;
    Case c = {.kind = DISCS, .tightness = 0.75, .count = count};
    scene_init(&scene, SHEET, count, stretch);
    scene.frames = 100;
    MesoDetail *originals = strew(&c, &scene.mesh, 7, &count);
    run_init(&run, &scene, originals, count, false);
    MesoReplication *r = begin(&run, MESO_REPLICATE_LIVE, MESO_BIRTHS_USUAL, &build);
    size_t before = meso_replicate_bytes(r);
    for (uint32_t f = 0; f < TALLEST; f++) {
        double start = cpu_seconds();
        CHECK(meso_replicate_step(r, f, NULL) == MESO_OK);
        double seconds = cpu_seconds() - start;
        least = f > 0 ? fmin(least, seconds) : least;
        all += f > 0 ? seconds : 0;
    }
    uint32_t after;
    meso_replicate_details(r, &after);
    snprintf(what, sizeof what, "%u details: begin", count);
    print_time(what, build, begin_goal);
    snprintf(what, sizeof what, "%u details: a step with %u births", count, (after - count) / (TALLEST - 1));
    print_time(what, least, step_goal);
    printf("  %-44s %8.2f ms; %.0f bytes a detail\n", "    in the mean", 1e3 * all / (TALLEST - 1),
           (double)before / count);
    meso_replicate_release(r);
    meso_arena_release(&run.arena);
    scene_release(&scene);
    free(originals);
}

int main(int argc, char **argv)
{
    uint32_t most = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 100000;
    printf("Stretched to twice the length in %d frames; in per cent of rest, least and most of all frames and seeds "
           "[goal]; pairs in the mean of the seeds\n", FRAMES);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (cases[i].count <= most)
            measure(&cases[i], "", SHEET, stretch, true);
    const struct {
        const char *where;
        Ground ground;
        Motion motion;
    } others[] = {
        {" on a sheet, stretched in two directions", SHEET, stretch_twice}, {" on a sheet, there and back", SHEET,
                                                                             there_and_back},
        {" on a sheet, half the size", SHEET, halve}, {" on a sheet, bent", SHEET, bend},
        {" on a cylinder", TUBE, stretch_up}, {" on a sphere", BALL, stretch}, {" on an animal", ANIMAL, animal_grows},
    };
    printf("Other clips\n");
    for (size_t i = 0; i < sizeof others / sizeof *others && most >= 2000; i++)
        measure(&cases[4], others[i].where, others[i].ground, others[i].motion, false);
    printf("Times of one core\n");
    print_step_time(200, 100, 1);
    print_step_time(500, 100, 1);
    if (most >= 20000)
        print_step_time(20000, 500, 15);
    if (most >= 100000)
        print_step_time(100000, 500, 15);
    return 0;
}
