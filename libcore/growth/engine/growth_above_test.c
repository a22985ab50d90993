/* Elements over two triangles that make a roof, a valley or a plane; and those of a torus, above it and sunk. */
#include "libcore/growth/engine/growth_above.h"
#include "libcore/growth/engine/growth_fixture.h"

/*
 *   3 --- 2     two triangles of a square; the corners 0 and 2 lie at `side`, 1 and 3 at `other`: the side between 0
 *   |   / |     and 2 is a ridge, or a valley
 *   | /   |
 *   0 --- 1
 */
static MesoTriangulation square(float side, float other)
{
    static const uint32_t corners[] = {0, 1, 2, 0, 2, 3};
    const MesoVec3 positions[] = {{0, 0, side}, {1, 0, other}, {1, 1, side}, {0, 1, other}};
    return meso_fixture_triangulation(positions, 4, corners, 2);
}

/* Whether an element is above, from (0.6, 0.4) to (0.4, 0.6), or that and `more` along both. */
static bool is_above(float side, float other, float lift, float more)
{
    MesoGrowthScenery scenery = {0};
    meso_scenery_init(&scenery, square(side, other));
    float height = 0.2f * other + 0.8f * side + lift, half = 0.70710678f;
    MesoJoint joints[2] = {{{0.6f + more, 0.4f + more, height}, {-half, half, 0}, {0, 0, 1}, 0.1f, 0},
                           {{0.4f + more, 0.6f + more, height}, {-half, half, 0}, {0, 0, 1}, 0.1f, 0}};
    MesoMeshPoint points[2] = {{0, {0.4f - more, 0.2f, 0.4f + more}}, {1, {0.4f - more, 0.4f + more, 0.2f}}};
    MesoGrowthElement element = {.span = {0, 1}};
    MesoGrown grown = {.joint_count = 2, .element_count = 1, .joints = joints, .points = points, .elements = &element};
    bool above = meso_growth_is_above(&grown, &scenery.ground, &element, 0.01f);
    meso_scenery_release(&scenery);
    return above;
}

static void test_two_triangles(void)
{
    CHECK(is_above(0, 0, 0, 0));
    CHECK(is_above(0, 0, -0.002f, 0) && !is_above(0, 0, -0.004f, 0));   /* of a length of 0.28 */
    CHECK(!is_above(0.1f, 0, 0, 0));        /* straight through the ridge, 0.02 below it */
    CHECK(is_above(0.1f, 0, 0.018f, 0));
    CHECK(is_above(0, 0.1f, 0, 0));         /* over the valley */
    CHECK(!is_above(0, 0, 0, 0.5f));        /* beyond the border */
}

/* Nearly all of what grows is found to be above, and nothing is when it has sunk by a twentieth of its length. */
static void test_torus(void)
{
    static const char text[] = "meso-grow 1\nlimit elements 4000\nseed A() on vertices\n"
        "rule A() -> { turn(normal(0, 30 deg)) step(4 cm, width: 4 mm, end: 4 mm, cross: true) choose { 9: A() 1: "
        "{ branch { turn(60 deg) A() } A() } } }\n";
    MesoGrowthScenery scenery = {0};
    MesoArena arena;
    uint32_t above = 0, sunk = 0;
    meso_scenery_init(&scenery, meso_fixture_torus(120, 48, 0.4f));
    meso_scenery_read(&scenery, text);
    meso_scenery_strew(&scenery, 10, 3);
    meso_arena_init(&arena);
    MesoGrown grown = meso_scenery_grow(&scenery, &arena, 1);
    for (uint32_t i = 0; i < grown.element_count; i++)
        above += meso_growth_is_above(&grown, &scenery.ground, &grown.elements[i], 0.008f);
    CHECK(above > grown.element_count * 9 / 10);
    for (uint32_t i = 0; i < grown.joint_count; i++)
        grown.joints[i].position = meso_vec3_mad(grown.joints[i].position, -0.002f, grown.joints[i].normal);
    for (uint32_t i = 0; i < grown.element_count; i++)
        sunk += meso_growth_is_above(&grown, &scenery.ground, &grown.elements[i], 0.008f);
    CHECK(sunk == 0);
    meso_arena_release(&arena);
    meso_scenery_release(&scenery);
}

int main(void)
{
    test_two_triangles();
    test_torus();
    return 0;
}
