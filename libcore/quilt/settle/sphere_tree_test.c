#include "libcore/quilt/settle/sphere_tree.h"

#include "libcore/base/random.h"
#include "libcore/base/check.h"
#include "libcore/quilt/seam/bodies_meet.h"

enum { SIDES = 20, WIRE = 8, POINTS = SIDES * WIRE, TRIANGLES = 2 * POINTS };

typedef struct Ring {
    MesoVec3 points[POINTS];
    uint32_t corners[3 * TRIANGLES];
} Ring;

static void make_ring(Ring *ring)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < SIDES; i++)
        for (uint32_t j = 0; j < WIRE; j++) {
            float a = 6.2831853f * (float)i / SIDES, b = 6.2831853f * (float)j / WIRE, out = 1 + 0.2f * cosf(b);
            ring->points[i * WIRE + j] = (MesoVec3){out * cosf(a), out * sinf(a), 0.2f * sinf(b)};
            uint32_t right = (i + 1) % SIDES * WIRE + j, up = i * WIRE + (j + 1) % WIRE;
            uint32_t over = (i + 1) % SIDES * WIRE + (j + 1) % WIRE;
            const uint32_t quad[6] = {i * WIRE + j, right, over, i * WIRE + j, over, up};
            for (int k = 0; k < 6; k++)
                ring->corners[n++] = quad[k];
        }
}

static float random_number(MesoRandom *random)
{
    return (float)meso_random_below(random, 2001) / 1000 - 1;
}

static MesoPose random_pose(MesoRandom *random)
{
    MesoVec3 z = meso_vec3_unit((MesoVec3){random_number(random), random_number(random), random_number(random)},
                                (MesoVec3){0, 0, 1});
    MesoVec3 other = fabsf(z.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(z, other), other);
    return (MesoPose){x, meso_vec3_cross(z, x), z,
                      {1.5f * random_number(random), 1.5f * random_number(random), 1.5f * random_number(random)}};
}

static uint32_t count_all(const Ring *ring, const MesoPose *a, const MesoPose *b)
{
    static MesoVec3 there[2][POINTS];
    const MesoPose *poses[2] = {a, b};
    for (int i = 0; i < 2; i++)
        for (uint32_t v = 0; v < POINTS; v++) {
            MesoVec3 p = ring->points[v];
            MesoVec3 q = meso_vec3_mad(meso_vec3_mad(poses[i]->origin, p.x, poses[i]->x), p.y, poses[i]->y);
            there[i][v] = meso_vec3_mad(q, p.z, poses[i]->z);
        }
    uint32_t count = 0;
    for (uint32_t s = 0; s < TRIANGLES; s++)
        for (uint32_t t = 0; t < TRIANGLES; t++) {
            MesoVec3 p[3], q[3];
            for (uint32_t k = 0; k < 3; k++) {
                p[k] = there[0][ring->corners[3 * s + k]];
                q[k] = there[1][ring->corners[3 * t + k]];
            }
            count += meso_triangles_cross(p, q);
        }
    return count;
}

/* Rings anywhere and anyhow: as many crossings as by looking at all pairs, but for what rounding decides. */
static void test_rings(void)
{
    static Ring ring;
    MesoArena arena;
    MesoError error;
    MesoRandom random;
    MesoSphereTree tree;
    uint32_t crossing = 0, clear = 0;
    meso_arena_init(&arena);
    meso_random_init(&random, 3, 0);
    make_ring(&ring);
    CHECK(meso_sphere_tree_build(&tree, &arena, ring.points, ring.corners, TRIANGLES, &error) == MESO_OK);
    for (int i = 0; i < 40; i++) {
        MesoPose a = random_pose(&random), b = random_pose(&random);
        uint32_t all = count_all(&ring, &a, &b), found = meso_sphere_trees_crossings(&tree, &a, &tree, &b, UINT32_MAX);
        CHECK(found + 1 >= all && all + 1 >= found);
        CHECK(meso_sphere_trees_crossings(&tree, &a, &tree, &b, 1) == (found > 0));
        crossing += all > 0;
        clear += all == 0;
    }
    CHECK(crossing > 5 && clear > 5);
    meso_arena_release(&arena);
}

/* Where the wires of two rings cut each other a little, it goes apart along the way that is shortest. */
static void test_push(void)
{
    static Ring ring;
    MesoArena arena;
    MesoError error;
    MesoSphereTree tree;
    MesoVec3 push;
    meso_arena_init(&arena);
    make_ring(&ring);
    CHECK(meso_sphere_tree_build(&tree, &arena, ring.points, ring.corners, TRIANGLES, &error) == MESO_OK);
    float outer = 0, half = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        outer = fmaxf(outer, ring.points[i].x);
        half = fmaxf(half, ring.points[i].z);
    }
    const MesoPose here = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    MesoPose beside = here, above = here;
    beside.origin.x = 2 * outer - 0.2f * half;
    above.origin.z = 1.8f * half;
    CHECK(meso_sphere_trees_push(&push, &tree, &here, &tree, &beside, 64) > 0);
    CHECK(push.x < 0 && fabsf(push.x) > 4 * fabsf(push.y) && fabsf(push.x) > 4 * fabsf(push.z));
    CHECK(meso_sphere_trees_push(&push, &tree, &here, &tree, &above, UINT32_MAX) > 0);
    CHECK(push.z < 0 && fabsf(push.z) > 4 * fabsf(push.x) && fabsf(push.z) > 4 * fabsf(push.y));
    meso_arena_release(&arena);
}

static void test_nothing(void)
{
    MesoArena arena;
    MesoError error;
    MesoSphereTree tree;
    meso_arena_init(&arena);
    CHECK(meso_sphere_tree_build(&tree, &arena, NULL, NULL, 0, &error) == MESO_OK);
    const MesoPose pose = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    CHECK(meso_sphere_trees_crossings(&tree, &pose, &tree, &pose, 9) == 0);
    meso_arena_release(&arena);
}

int main(void)
{
    test_rings();
    test_push();
    test_nothing();
    return 0;
}
