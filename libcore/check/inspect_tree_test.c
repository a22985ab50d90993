/* Trees against all items. */
#include "libcore/check/inspect_tree.h"

#include "libcore/base/check.h"
#include "libcore/base/index.h"
#include "libcore/base/random.h"

static MesoArena arena;

static float random_unit(MesoRandom *random)
{
    return (float)meso_random_below(random, 1 << 20) / (1 << 20);
}

enum { POINTS = 500 };

typedef struct AskedPoints {
    MesoVec3 points[POINTS];
    uint32_t owners[POINTS], but, asked;
    MesoVec3d from;
} AskedPoints;

static double distance_to_point(void *context, uint32_t item)
{
    AskedPoints *points = context;
    MesoVec3d way = meso_vec3d_sub(meso_vec3d(points->points[item]), points->from);
    points->asked++;
    return points->owners[item] == points->but ? INFINITY : meso_vec3d_dot(way, way);
}

/* Owners by where points lie, so that whole nodes have one. */
static void nearest_is_that_of_all_points(void)
{
    static AskedPoints points;
    MesoBox boxes[POINTS];
    MesoInspectTree tree;
    MesoRandom random;
    MesoError error;
    meso_random_init(&random, 6, 0);
    for (uint32_t i = 0; i < POINTS; i++) {
        MesoVec3 p = {random_unit(&random), random_unit(&random), random_unit(&random)};
        points.points[i] = p;
        points.owners[i] = p.x < 0.5f ? 1 : p.y < 0.5f ? 2 : 3;
        boxes[i] = (MesoBox){p, p};
    }
    CHECK(!meso_inspect_tree_build(&tree, &arena, boxes, points.owners, POINTS, &error));
    for (uint32_t round = 0; round < 100; round++) {
        MesoVec3 p = {random_unit(&random), random_unit(&random), random_unit(&random)};
        points.from = meso_vec3d(p);
        points.but = 1 + round % 3;
        double least = INFINITY, square = INFINITY, few = INFINITY;
        uint32_t best = MESO_NO_INDEX;
        for (uint32_t i = 0; i < POINTS; i++)
            if (distance_to_point(&points, i) < least) {
                least = distance_to_point(&points, i);
                best = i;
            }
        MesoInspectAsking asking = {points.from, MESO_NO_INDEX, points.but, 0};
        points.asked = 0;
        CHECK(meso_inspect_tree_nearest(&tree, &asking, &square, distance_to_point, &points) == best);
        CHECK(square == least && points.asked < POINTS / 2);
        asking.most = 2;
        points.asked = 0;
        meso_inspect_tree_nearest(&tree, &asking, &few, distance_to_point, &points);
        CHECK(points.asked <= 2 * MESO_INSPECT_LEAF && few >= least);
    }
}

int main(void)
{
    meso_arena_init(&arena);
    nearest_is_that_of_all_points();
    meso_arena_release(&arena);
    return 0;
}
