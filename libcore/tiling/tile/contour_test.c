/* Contours: areas by the shoelace formula against closed forms, orientation, sampling. */
#include <math.h>

#include "libcore/base/check.h"
#include "libcore/tiling/tile/contour.h"

static const MesoVec2 MIDDLE = {0.5f, 0.5f};

static double area(const MesoContourSet *contours, uint32_t contour)
{
    const MesoContour *c = &contours->contours[contour];
    double sum = 0;
    for (uint32_t i = 0; i < c->point_count; i++)
        sum += (double)meso_vec2_cross(contours->points[c->point_begin + i],
                                       contours->points[c->point_begin + (i + 1) % c->point_count]);
    return sum / 2;
}

/* One interface with one cross-section whose drawing is the last of `nodes`. */
static MesoContourSet build(MesoArena *arena, MesoCsgNode *nodes, uint32_t count, float step)
{
    MesoSection section = {"1", 0, count - 1, {{1, 1, 1}, 0.5f, 0}};
    MesoTileSet set = {.section_count = 1, .csg_count = count, .sections = &section, .csg = nodes};
    MesoContourSet contours;
    MesoError error;
    CHECK(meso_contour_set_build(&contours, arena, &set, step, &error) == MESO_OK);
    return contours;
}

static MesoCsgNode leaf(MesoCsgKind kind, float x, float y, float w, float h, float angle)
{
    return (MesoCsgNode){kind, 0, 0, {x, y}, {w, h}, angle};
}

static void test_disc(MesoArena *arena)
{
    MesoCsgNode disc = leaf(MESO_CSG_DISC, 0.5f, 0.5f, 0.2f, 0.2f, 0);
    MesoContourSet c = build(arena, &disc, 1, 0.01f);
    CHECK(c.contour_count == 1 && !c.contours[0].hole);
    CHECK(c.contours[0].point_count == 62);     /* floor(2 pi 0.1 / 0.01) */
    CHECK(c.center[0].x == 0.5f && c.center[0].y == 0.5f);
    /* a regular 62-gon */
    CHECK(fabs(area(&c, 0) - 31 * 0.01 * sin(2 * MESO_PI / 62)) < 1e-7);

    MesoCsgNode tiny = leaf(MESO_CSG_DISC, 0.5f, 0.5f, 0.01f, 0.01f, 0);
    c = build(arena, &tiny, 1, 0.1f);
    CHECK(c.contours[0].point_count == 8);
}

static void test_box(MesoArena *arena)
{
    MesoCsgNode box = leaf(MESO_CSG_BOX, 0.25f, 0.8f, 0.8f, 0.6f, 0.3f);
    MesoContourSet c = build(arena, &box, 1, 0.01f);
    CHECK(fabs(area(&c, 0) - 0.48) < 1e-6);
    /* Pieces of at most two steps; the sizes are floats a hair over 0.8 and 0.6. */
    CHECK(c.contours[0].point_count == 2 * (41 + 31));
    CHECK(c.center[0].x == 0.25f && c.center[0].y == 0.8f);
}

/* A ring: the disc without a smaller one has an outline and a hole.
 *
 *      ____
 *    /  __  \
 *   |  /  \  |
 *   |  \__/  |
 *    \ ____ /
 */
static void test_hole(MesoArena *arena)
{
    MesoCsgNode ring[3] = {leaf(MESO_CSG_DISC, 0.5f, 0.5f, 0.4f, 0.4f, 0),
                           leaf(MESO_CSG_DISC, 0.5f, 0.5f, 0.2f, 0.2f, 0),
                           {MESO_CSG_DIFFERENCE, 0, 1, {0, 0}, {0, 0}, 0}};
    MesoContourSet c = build(arena, ring, 3, 0.005f);
    CHECK(c.contour_count == 2 && !c.contours[0].hole && c.contours[1].hole);
    CHECK(area(&c, 0) > 0 && area(&c, 1) < 0);
    CHECK(fabs(area(&c, 0) + area(&c, 1) - MESO_PI * 0.03) < 2e-4);
}

/* Two boxes apart are two outlines about the mean of their centres; overlapping they are one. */
static void test_union(MesoArena *arena)
{
    MesoCsgNode apart[3] = {leaf(MESO_CSG_BOX, 0.2f, 0.5f, 0.1f, 0.1f, 0),
                            leaf(MESO_CSG_BOX, 0.6f, 0.9f, 0.2f, 0.1f, 0),
                            {MESO_CSG_UNION, 0, 1, {0, 0}, {0, 0}, 0}};
    MesoContourSet c = build(arena, apart, 3, 1);
    CHECK(c.contour_count == 2 && c.contours[0].point_count == 4);
    CHECK(fabs(area(&c, 0) - 0.02) < 1e-6 && fabs(area(&c, 1) - 0.01) < 1e-6);
    CHECK(fabsf(c.center[0].x - 0.4f) < 1e-6f && fabsf(c.center[0].y - 0.7f) < 1e-6f);

    apart[1].center = (MesoVec2){0.25f, 0.5f};
    c = build(arena, apart, 3, 1);
    CHECK(c.contour_count == 1);
    CHECK(fabs(area(&c, 0) - 0.1 * 0.2) < 1e-6);    /* x from 0.15 to 0.35 */
}

static void test_nothing(MesoArena *arena)
{
    MesoCsgNode same[3] = {leaf(MESO_CSG_BOX, 0.5f, 0.5f, 0.1f, 0.1f, 0),
                           leaf(MESO_CSG_DISC, 0.5f, 0.5f, 1, 1, 0),
                           {MESO_CSG_DIFFERENCE, 0, 1, {0, 0}, {0, 0}, 0}};
    CHECK(build(arena, same, 3, 0.01f).contour_count == 0);
    MesoCsgNode flat = leaf(MESO_CSG_DISC, 0.5f, 0.5f, 0, 0.1f, 0);
    CHECK(build(arena, &flat, 1, 0.01f).contour_count == 0);
}

/* A shared operand is evaluated once: 40 unions of a node with itself end at once. */
static void test_shared(MesoArena *arena)
{
    MesoCsgNode nodes[41] = {leaf(MESO_CSG_DISC, MIDDLE.x, MIDDLE.y, 0.2f, 0.2f, 0)};
    for (uint32_t i = 1; i < 41; i++)
        nodes[i] = (MesoCsgNode){MESO_CSG_DIFFERENCE, 0, 0, {0, 0}, {0, 0}, 0};
    for (uint32_t i = 1; i < 41; i++)
        nodes[i].left = i - 1, nodes[i].right = i - 1;
    CHECK(build(arena, nodes, 41, 0.01f).contour_count == 0);
}

static void test_too_fine(MesoArena *arena)
{
    MesoCsgNode disc = leaf(MESO_CSG_DISC, 0.5f, 0.5f, 60, 60, 0);
    MesoSection section = {"1", 0, 0, {{1, 1, 1}, 0.5f, 0}};
    MesoTileSet set = {.section_count = 1, .csg_count = 1, .sections = &section, .csg = &disc};
    MesoContourSet contours;
    MesoError error;
    CHECK(meso_contour_set_build(&contours, arena, &set, 1e-4f, &error) == MESO_ERR_LIMIT);
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_disc(&arena);
    test_box(&arena);
    test_hole(&arena);
    test_union(&arena);
    test_nothing(&arena);
    test_shared(&arena);
    test_too_fine(&arena);
    meso_arena_release(&arena);
    return 0;
}
