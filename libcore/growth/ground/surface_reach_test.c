#include "libcore/growth/ground/surface_reach.h"

#include "libcore/geodesic/exact/exact_geodesic.h"
#include "libcore/geodesic/transport/walk_fixture.h"

typedef struct Told {
    const MesoWalkGround *ground;
    const MesoTriangulation *mesh;
    double *least;              /* [vertex_count] */
    uint32_t views;
} Told;

static void tell(void *context, const MesoReachView *view)
{
    Told *told = context;
    for (uint32_t k = 0; k < 3; k++) {
        double weight[3] = {k == 0, k == 1, k == 2};
        uint32_t v = told->mesh->corners[3 * view->triangle + k];
        told->least[v] = fmin(told->least[v], meso_view_distance(told->ground, view, weight));
    }
    told->views++;
}

/* Distances of all vertices within `distance` of random points are the exact solver's. */
static uint32_t compare(MesoTriangulation mesh, double distance, uint32_t count)
{
    MesoWalkScene scene;
    MesoReach *reach;
    MesoRandom random;
    uint32_t reached = 0;
    meso_walk_scene_init(&scene, mesh);
    meso_random_init(&random, 3, 0);
    CHECK(meso_reach_init(&reach, &scene.arena, &scene.mesh, &scene.ground, 2, NULL) == MESO_OK);
    double *least = malloc(2 * mesh.vertex_count * sizeof *least), *exact = least + mesh.vertex_count;
    CHECK(least);
    for (uint32_t i = 0; i < count; i++) {
        Told told = {&scene.ground, &scene.mesh, least, 0};
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        MesoSurfacePlace place = {tip.triangle, {0, 0, 0}};
        MesoExactGeodesicPoint seed = {.at = {tip.triangle, {0, 0, 0}}};
        MesoExactGeodesicField field;
        for (uint32_t k = 0; k < 3; k++) {
            seed.at.weight[k] = (float)tip.weight[k];
            place.weight[k] = (double)seed.at.weight[k];
        }
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            least[v] = INFINITY;
        CHECK(meso_reach_tell(reach, &place, distance, tell, &told, NULL) == MESO_OK);
        MesoExactGeodesicQuery query = {.points = &seed, .point_count = 1, .target = MESO_NO_INDEX};
        CHECK(meso_exact_geodesic(&scene.mesh, NULL, &query, &scene.arena, exact, &field, NULL) == MESO_OK);
        for (uint32_t v = 0; v < mesh.vertex_count; v++) {
            CHECK(least[v] >= exact[v] * (1 - 1e-6) - 1e-7);
            if (exact[v] < distance * (1 - 1e-6)) {
                CHECK(least[v] < exact[v] * (1 + 1e-6) + 1e-7);
                reached++;
            }
        }
    }
    free(least);
    meso_walk_scene_release(&scene);
    return reached;
}

typedef struct Pair {
    const MesoWalkGround *ground;
    const MesoTip *to;
    double least;
} Pair;

static void tell_pair(void *context, const MesoReachView *view)
{
    Pair *pair = context;
    if (view->triangle == pair->to->triangle)
        pair->least = fmin(pair->least, meso_view_distance(pair->ground, view, pair->to->weight));
}

static double distance_between(MesoReach *reach, const MesoWalkGround *ground, const MesoTip *from, const MesoTip *to,
                               double within)
{
    Pair pair = {ground, to, INFINITY};
    MesoSurfacePlace place = {from->triangle, {from->weight[0], from->weight[1], from->weight[2]}};
    CHECK(meso_reach_tell(reach, &place, within, tell_pair, &pair, NULL) == MESO_OK);
    return pair.least;
}

/* Points of triangles: as far there as back, behind saddles too, which see all of the triangles around them. */
static void compare_ways(MesoTriangulation mesh, double within, uint32_t count)
{
    MesoWalkScene scene;
    MesoReach *reach;
    MesoRandom random;
    uint32_t met = 0;
    meso_walk_scene_init(&scene, mesh);
    meso_random_init(&random, 8, 0);
    CHECK(meso_reach_init(&reach, &scene.arena, &scene.mesh, &scene.ground, 1, NULL) == MESO_OK);
    for (uint32_t i = 0; i < count; i++) {
        MesoTip a = meso_fixture_tip(&scene.ground, &random);
        MesoWalk walk = {.tip = a, .length = within * meso_fixture_uniform(&random)};
        meso_walks(&scene.ground, &walk, 1, NULL);
        double there = distance_between(reach, &scene.ground, &a, &walk.tip, within);
        double back = distance_between(reach, &scene.ground, &walk.tip, &a, within);
        CHECK(there > within || fabs(there - back) < 1e-7 * within);
        met += there <= within;
    }
    CHECK(met > count / 2);
    meso_walk_scene_release(&scene);
}

/* Nine by nine squares without three columns from the top down to row 3: paths bend at borders. */
static MesoTriangulation make_u(void)
{
    MesoTriangulation sheet = meso_fixture_sheet(9, 9, 1);
    uint32_t corners[3 * 162], count = 0;
    for (uint32_t t = 0; t < sheet.triangle_count; t++) {
        uint32_t column = t / 2 % 9, row = t / 18;
        for (uint32_t k = 0; k < 3 && (row < 3 || column < 3 || column >= 6); k++)
            corners[count++] = sheet.corners[3 * t + k];
    }
    MesoTriangulation u = meso_fixture_triangulation(sheet.positions, sheet.vertex_count, corners, count / 3);
    meso_triangulation_release(&sheet);
    return u;
}

int main(void)
{
    CHECK(compare(meso_fixture_sheet(6, 5, 1), 3, 20) > 200);
    CHECK(compare(make_u(), 9, 20) > 200);
    CHECK(compare(meso_fixture_sphere(2, 0.3f, 1), 1.5, 20) > 100);
    CHECK(compare(meso_fixture_sphere(8, 0.5f, 2), 0.6, 20) > 300);
    CHECK(compare(meso_fixture_sphere(2, 0, 1), 20, 5) > 100);
    CHECK(compare(meso_fixture_bumpy_torus(24, 12), 0.7, 30) > 300);
    CHECK(compare(meso_fixture_moebius(), 0.5, 30) > 300);
    compare_ways(meso_fixture_sphere(20, 0.5f, 2), 0.15, 4000);
    compare_ways(meso_fixture_bumpy_torus(24, 12), 0.4, 4000);
    compare_ways(make_u(), 4, 1000);
    return 0;
}
