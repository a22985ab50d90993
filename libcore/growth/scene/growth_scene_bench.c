/*
 * Growth and its geometry in memory, as in "Dynamic On-Mesh Procedural Generation Control" (Buron et al. 2014): 18
 * seeds, 250 thousand terminals of 24 triangles, on tori; looked at for what is below the surface, too. Best of some
 * rounds, by the time of the process and by the clock.
 *
 *   growth_scene_bench [MILLIONS]    and so many million terminals without geometry, with the most memory used; half as
 *                                    many first, and on two threads: piled up around 18 seeds, and as dense as the 250
 *                                    thousand are, with more seeds and smaller terminals
 */
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "libcore/base/clock.h"
#include "libcore/growth/engine/growth_fixture.h"
#include "libcore/growth/scene/growth_scene.h"

enum { SEEDS = 18, ROUNDS = 5 };

typedef struct Case {
    const char *name;
    const char *step;           /* more arguments of the step, and what is done where it is refused */
    const char *otherwise;
    uint32_t elements;
    double pace, girth;         /* length of a step, and how wide the first is, in metres */
    uint32_t seeds;
    bool shows;
} Case;

static const Case cases[] = {
    {"strands may cross", ", cross: true", "", 250000, 0.005, 0.004, SEEDS, true},
    {"strands do not cross", "", " else retry(3, 70 deg)", 250000, 0.005, 0.004, SEEDS, true},
    {"8.84 M polygons, may cross", ", cross: true", "", 368334, 0.005, 0.004, SEEDS, true},
};

static const char rules[] =
    "meso-grow 1\nparam pace = 1 cm\nparam girth = 4 mm\nshape cord = tube(sides: 6)\nlimit elements %u\n"
    "seed Shoot(girth) on vertices\n"
    "rule Shoot(w) -> {\n"
    "  turn(normal(0, 12 deg))\n"
    "  step(pace, shape: cord, width: w, end: 0.995*w%s)%s\n"
    "  choose { 85%%: Shoot(0.995*w)  15%%: { branch { turn(normal(60 deg, 8 deg)) Shoot(0.8*w) } Shoot(0.99*w) } }\n"
    "}\n";

typedef struct Times {
    double grow, lift, all, clock;
} Times;

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void read_case(MesoGrowthScenery *scenery, const Case *one)
{
    char text[1000], pace[40], girth[40];
    MesoError error = {0};
    snprintf(text, sizeof text, rules, one->elements, one->step, one->otherwise);
    snprintf(pace, sizeof pace, "pace=%.9g m", one->pace);
    snprintf(girth, sizeof girth, "girth=%.9g m", one->girth);
    const MesoGrammarSetting settings[] = {{pace}, {girth}};
    const MesoGrammarOptions options = {settings, 2, 1};
    CHECK(!meso_grammar_read(&scenery->grammar, &scenery->arena, "bench", text, strlen(text), &options, &error));
    scenery->contexts = (MesoGrowthContexts){.ground = &scenery->ground};
    meso_scenery_strew(scenery, one->seeds, 5);
}

/* Once; adds to the best times. */
static void time_once(MesoGrowthScenery *scenery, const MesoTerminalShape *shape, const Case *one,
                      uint32_t thread_count, Times *best, MesoGrown *grown, uint64_t *refused)
{
    static const char *const names[] = {"cord"};
    const MesoMaterial material = {{1, 1, 1}, 1, 0};
    const uint32_t material_of[] = {0};
    const MesoGrowthShapes shapes = {1, shape, names, 1, &material, names, material_of};
    MesoScene scene;
    MesoArena arena;
    meso_arena_init(&arena);
    double start = cpu_seconds(), clock = meso_seconds();
    *grown = meso_scenery_grow(scenery, &arena, thread_count);
    double middle = cpu_seconds();
    CHECK(!meso_growth_lift(grown, &arena, &scenery->ground, thread_count, NULL));
    best->lift = fmin(best->lift, cpu_seconds() - middle);
    if (one->shows)
        CHECK(!meso_growth_show(&scene, &arena, grown, &scenery->grammar, &shapes, thread_count, NULL, NULL));
    best->grow = fmin(best->grow, middle - start);
    best->all = fmin(best->all, cpu_seconds() - start);
    best->clock = fmin(best->clock, meso_seconds() - clock);
    *refused = grown->rules[0].refused;
    meso_arena_release(&arena);
}

static void measure(MesoGrowthScenery *scenery, const MesoTerminalShape *shape, const Case *one, uint32_t thread_count,
                    int rounds)
{
    Times best = {INFINITY, INFINITY, INFINITY, INFINITY};
    MesoGrown grown;
    uint64_t refused = 0;
    read_case(scenery, one);
    for (int i = 0; i < rounds; i++)
        time_once(scenery, shape, one, thread_count, &best, &grown, &refused);
    printf("grow %-26s %7u faces, %8u terminals, %5.2f M triangles, %6llu refused, %u %s: growth %.0f ms, depths %.0f "
           "ms, with geometry %.0f ms, by the clock %.0f ms\n",
           one->name, scenery->mesh.triangle_count, grown.element_count,
           1e-6 * grown.element_count * shape->body.face_count, (unsigned long long)refused, thread_count,
           thread_count == 1 ? "thread" : "threads", 1e3 * best.grow, 1e3 * best.lift, 1e3 * best.all,
           1e3 * best.clock);
}

static void measure_on(MesoTriangulation mesh, const MesoTerminalShape *shape)
{
    MesoGrowthScenery scenery = {0};
    meso_scenery_init(&scenery, mesh);
    for (uint32_t threads = 1; threads <= 2; threads++)
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
            measure(&scenery, shape, &cases[i], threads, ROUNDS);
    meso_scenery_release(&scenery);
}

/* In a process of its own, whose most memory is that of this alone. */
static void measure_apart(MesoGrowthScenery *scenery, const MesoTerminalShape *shape, const Case *many,
                          uint32_t thread_count)
{
    struct rusage before, after;
    fflush(stdout);
    pid_t child = fork();
    CHECK(child >= 0);
    if (child > 0) {
        int status;
        CHECK(waitpid(child, &status, 0) == child && status == 0);
        return;
    }
    getrusage(RUSAGE_SELF, &before);
    measure(scenery, shape, many, thread_count, 1);
    getrusage(RUSAGE_SELF, &after);
    printf("     at most %.0f bytes a terminal\n",
           1024.0 * (double)(after.ru_maxrss - before.ru_maxrss) / many->elements);
    exit(0);
}

/* All around the seeds of the others: the more there are, the less room each has. */
static Case piled_up(uint32_t elements)
{
    return (Case){"many, piled up", "", " else retry(3, 70 deg)", elements, 0.9 / sqrt(elements), 0.004, SEEDS, false};
}

/* Each with as much room for its size as the others have. */
static Case as_dense(uint32_t elements)
{
    const Case *like = &cases[1];
    double more = (double)elements / like->elements, smaller = 1 / sqrt(more);
    return (Case){"many, as dense as few", "", " else retry(3, 70 deg)", elements, smaller * like->pace,
                  smaller * like->girth, (uint32_t)(more * like->seeds), false};
}

/* Linear: twice as many take twice the time, and memory. */
static void measure_many(const MesoTerminalShape *shape, double millions)
{
    Case (*const kinds[])(uint32_t) = {piled_up, as_dense};
    MesoGrowthScenery scenery = {0};
    uint32_t elements = (uint32_t)(1e6 * millions);
    meso_scenery_init(&scenery, meso_fixture_torus(1280, 512, 0.4f));
    for (uint32_t i = 0; i < 2; i++) {
        Case half = kinds[i](elements / 2), whole = kinds[i](elements);
        measure_apart(&scenery, shape, &half, 1);
        measure_apart(&scenery, shape, &whole, 1);
        measure_apart(&scenery, shape, &whole, 2);
    }
    meso_scenery_release(&scenery);
}

int main(int argc, char **argv)
{
    MesoArena arena;
    MesoTerminalShape shape;
    meso_arena_init(&arena);
    CHECK(!meso_builtin_shape(&shape, &arena, MESO_BUILTIN_TUBE, 0, NULL));
    measure_on(meso_fixture_torus(250, 100, 0.4f), &shape);
    measure_on(meso_fixture_torus(640, 256, 0.4f), &shape);
    if (argc > 1)
        measure_many(&shape, atof(argv[1]));
    meso_arena_release(&arena);
    return 0;
}
