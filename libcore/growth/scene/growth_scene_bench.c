/* Growth and its geometry in memory: the paper's scene, by the time of the process and by the clock. */
#include <sys/resource.h>

#include "libcore/base/clock.h"
#include "libcore/growth/engine/growth_fixture.h"
#include "libcore/growth/scene/growth_scene.h"

#define ROUNDS (getenv("N") ? 1 : 5)

/* 12 vertices and 24 triangles... */
static const char rules[] =
    "meso-grow 1\nunit m\nshape cord = tube(sides: 6)\nparam pace = 1 cm\nlimit elements %u\n"
    "seed Shoot(10 mm) on vertices\n"
    "rule Shoot(w) -> {\n turn(normal(0, 12 deg))\n"
    " step(pace, shape: cord, width: w, end: 0.99*w%s)%s\n"
    " choose { 80%%: Shoot(0.99*w) 20%%: { branch { turn(normal(45 deg, 8 deg)) Shoot(0.8*w) } Shoot(0.99*w) } } }\n";

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void measure(const char *what, MesoGrowthScenery *scenery, const MesoTerminalShape *shape, const char *more,
                    const char *otherwise, uint32_t elements, double pace, uint32_t thread_count, bool shows)
{
    char text[2000], setting[60];
    const char *only = getenv("ONLY");
    if (only && !strstr(what, only))
        return;
    snprintf(text, sizeof text, rules, elements, more, otherwise);
    snprintf(setting, sizeof setting, "pace=%.9g m", pace);
    MesoGrammarSetting settings = {setting};
    MesoGrammarOptions options = {&settings, 1, 1};
    MesoError error;
    if (meso_grammar_read(&scenery->grammar, &scenery->arena, "bench", text, strlen(text), &options, &error)) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    scenery->contexts.ground = &scenery->ground;
    meso_scenery_strew(scenery, 18, 5);
    double best = 1e9, best_grow = 1e9, best_clock = 1e9;
    uint32_t grown_count = 0, generations = 0;
    uint64_t triangles = 0, refused = 0;
    for (int i = 0; i < ROUNDS; i++) {
        MesoArena arena;
        meso_arena_init(&arena);
        double start = cpu_seconds(), clock = meso_seconds();
        MesoGrown grown = meso_scenery_grow(scenery, &arena, thread_count);
        double mid = cpu_seconds();
        MesoScene scene = {0};
        const char *names[] = {"cord"};
        MesoMaterial material = {{1, 1, 1}, 1, 0};
        const uint32_t material_of[] = {0};
        MesoGrowthShapes shapes = {1, shape, names, 1, &material, names, material_of};
        if (shows)
            CHECK(!meso_growth_show(&scene, &arena, &grown, &scenery->grammar, &shapes, thread_count, NULL, NULL));
        double end = cpu_seconds(), clock_end = meso_seconds();
        if (end - start < best) {
            best = end - start;
            best_grow = mid - start;
        }
        best_clock = fmin(best_clock, clock_end - clock);
        grown_count = grown.element_count;
        refused = grown.rules[0].refused;
        generations = grown.generation_count;
        triangles = (uint64_t)grown.element_count * shape->body.face_count;
        meso_arena_release(&arena);
    }
    printf("%-24s %8u faces %8u elements %4u generations %7llu refused %5.2f M triangles, %u threads: grow %.1f ms, all %.1f ms cpu, %.1f ms clock, %.0f ns an element\n", what,
           scenery->mesh.triangle_count, grown_count, generations, (unsigned long long)refused, 1e-6 * (double)triangles, thread_count, 1e3 * best_grow, 1e3 * best,
           1e3 * best_clock, 1e9 * best_grow / grown_count);
}

int main(int argc, char **argv)
{
    MesoArena arena;
    MesoTerminalShape shape;
    (void)argc, (void)argv;
    meso_arena_init(&arena);
    CHECK(!meso_builtin_shape(&shape, &arena, MESO_BUILTIN_TUBE, 0, NULL));
    printf("tube %u vertices %u faces\n", shape.body.vertex_count, shape.body.face_count);
    for (int big = 0; big < (getenv("N") ? 1 : 2); big++) {
        MesoGrowthScenery scenery = {0};
        meso_scenery_init(&scenery, big ? meso_fixture_torus(640, 256, 0.4f) : meso_fixture_torus(250, 100, 0.4f));
        for (uint32_t threads = 1; threads <= (getenv("THREADS") ? (uint32_t)atoi(getenv("THREADS")) : 2); threads++) {
            measure("crossing", &scenery, &shape, ", cross: true", "", getenv("N") ? (uint32_t)atoi(getenv("N")) : 250000, getenv("PACE") ? atof(getenv("PACE")) : 0.008, threads, true);
            measure("exact", &scenery, &shape, "", " else retry(3, 70 deg)", getenv("N") ? (uint32_t)atoi(getenv("N")) : 250000, getenv("PACE") ? atof(getenv("PACE")) : 0.008, threads, true);
        }
        meso_scenery_release(&scenery);
    }
    return 0;
}
