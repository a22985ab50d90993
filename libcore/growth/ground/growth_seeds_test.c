#include "libcore/growth/ground/growth_seeds.h"

#include "libcore/geodesic/transport/walk_fixture.h"
#include "libcore/growth/ground/ground_fixture.h"
#include "libcore/growth/ground/surface_reach.h"

#define HEAD "meso-grow 1 unit m "
#define RULE " rule A() -> stop"

static MesoGroundScene scene;

static MesoGrowthStarts seeds(const char *text, uint64_t seed, uint32_t threads)
{
    MesoGrowthStarts starts;
    MesoError error;
    meso_ground_scene_read(&scene, text);
    if (meso_growth_seeds(&starts, &scene.arena, &scene.grammar, &scene.contexts, NULL, seed, threads, &error)) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    return starts;
}

/* ---- distances between seeds ---- */

typedef struct Nearest {
    const MesoGrowthStarts *starts;
    const uint32_t *first;          /* [triangle_count] seed in a triangle */
    const uint32_t *next;           /* [count] */
    uint32_t self;                  /* does not count */
    double least;
} Nearest;

static void look_from(void *context, const MesoReachView *view)
{
    Nearest *nearest = context;
    for (uint32_t s = nearest->first[view->triangle]; s != MESO_NO_INDEX; s = nearest->next[s])
        if (s != nearest->self)
            nearest->least = fmin(nearest->least, meso_view_distance(&scene.ground.walk, view,
                                                                     nearest->starts->starts[s].tip.weight));
}

typedef struct Spread {
    double nearest, farthest;       /* of seeds from each other; of points from the nearest seed */
} Spread;

static double distance_to_others(MesoReach *reach, const Nearest *like, const MesoTip *from, double within)
{
    Nearest nearest = *like;
    MesoSurfacePlace place = {from->triangle, {from->weight[0], from->weight[1], from->weight[2]}};
    nearest.least = INFINITY;
    CHECK(meso_reach_tell(reach, &place, within, look_from, &nearest, NULL) == MESO_OK);
    return nearest.least;
}

static Spread measure(const MesoGrowthStarts *starts, double within, uint32_t points)
{
    MesoReach *reach;
    MesoRandom random;
    Spread spread = {INFINITY, 0};
    uint32_t *first = malloc(scene.mesh.triangle_count * sizeof *first);
    uint32_t *next = malloc((starts->count + 1) * sizeof *next);
    CHECK(meso_reach_init(&reach, &scene.arena, &scene.mesh, &scene.ground.walk, 1, NULL) == MESO_OK && first && next);
    for (uint32_t t = 0; t < scene.mesh.triangle_count; t++)
        first[t] = MESO_NO_INDEX;
    for (uint32_t s = 0; s < starts->count; s++) {
        uint32_t *head = &first[starts->starts[s].tip.triangle];
        next[s] = *head;
        *head = s;
    }
    Nearest nearest = {.starts = starts, .first = first, .next = next};
    for (uint32_t s = 0; s < starts->count; s++) {
        nearest.self = s;
        spread.nearest = fmin(spread.nearest, distance_to_others(reach, &nearest, &starts->starts[s].tip, within));
    }
    meso_random_init(&random, 9, 0);
    for (uint32_t i = 0; i < points; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground.walk, &random);
        nearest.self = MESO_NO_INDEX;
        spread.farthest = fmax(spread.farthest, distance_to_others(reach, &nearest, &tip, within));
    }
    free(first);
    free(next);
    return spread;
}

/* ---- Poisson ---- */

/* No two nearer than the radius, and no point farther from all than that. */
static void check_poisson(MesoTriangulation mesh, const char *text, double radius, uint32_t least)
{
    meso_ground_scene_init(&scene, mesh);
    MesoGrowthStarts starts = seeds(text, 1, 1);
    CHECK(starts.count >= least);
    Spread spread = measure(&starts, 1.1 * radius, 2000);
    CHECK(spread.nearest >= radius * (1 - 1e-9));
    CHECK(spread.farthest <= radius * (1 + 1.0 / 400));
    meso_ground_scene_release(&scene);
}

static void test_poisson(void)
{
    const char *tenth = HEAD "seed A() on poisson(10 cm)" RULE;
    check_poisson(meso_fixture_sheet(1, 1, 1), tenth, 0.1, 70);
    check_poisson(meso_fixture_sheet(40, 40, 0.025f), tenth, 0.1, 70);
    check_poisson(meso_fixture_sphere(2, 0, 2), tenth, 0.1, 700);
    check_poisson(meso_fixture_sphere(20, 0.5f, 2), tenth, 0.1, 800);
    check_poisson(meso_fixture_bumpy_torus(24, 12), tenth, 0.1, 400);
    check_poisson(meso_fixture_moebius(), tenth, 0.1, 200);
    check_poisson(meso_fixture_sphere(10, 0.5f, 2), HEAD "seed A() on poisson(3 m)" RULE, 3, 1);
}

int main(void)
{
    test_poisson();
    return 0;
}
