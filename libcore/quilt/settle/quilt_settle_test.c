#include "libcore/quilt/settle/quilt_settle.h"

#include <string.h>

#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/base/quilt_base.h"
#include "libcore/quilt/check/quilt_check.h"
#include "libcore/quilt/finish/quilt_finish.h"
#include "libcore/quilt/swatch/swatch_make.h"

typedef struct Case {
    MesoArena arena;
    MesoTriangulation surface;
    MesoSwatch swatch;
    MesoQuilt grown, quilt;     /* before settling, and after */
    MesoQuiltCheck before, after;
} Case;

static void make_swatch(Case *c, const char *name, float jitter)
{
    MesoError error;
    MesoPolygonMesh mesh;
    MesoSwatchRecipe recipe = {.name = name, .jitter = jitter};
    CHECK(meso_swatch_make(&mesh, &c->arena, &recipe, &error) == MESO_OK);
    CHECK(meso_swatch_build(&c->swatch, &c->arena, &mesh, &(MesoSwatchOptions){.up = 2, .periodic = -1}, &error) ==
          MESO_OK);
}

static void grow(Case *c)
{
    MesoError error;
    MesoQuiltBase base;
    MesoVec3 size = c->swatch.size;
    CHECK(meso_quilt_base_build(&base, &c->arena, &c->surface, NULL, 0.1f * fminf(size.x, size.y),
                                0.5f * hypotf(size.x, size.y), &error) == MESO_OK);
    CHECK(meso_quilt_grow(&c->grown, &c->arena, &base.mesh, &c->swatch,
                          &(MesoQuiltOptions){.scale = 1, .turn_count = 1, .thread_count = 1}, &error) == MESO_OK);
    CHECK(meso_quilt_finish(&c->grown, &c->arena, &base, &c->swatch, &(MesoFinishOptions){.scale = 1}, &error) ==
          MESO_OK);
    meso_quilt_base_release(&base);
}

static MesoQuiltCheck check(Case *c, const MesoQuilt *quilt)
{
    MesoError error;
    MesoPrismReport report;
    MesoQuiltCheck result;
    MesoVec3 *directions = MESO_NEW(&c->arena, MesoVec3, c->surface.vertex_count, &error);
    MesoVec3 *positions = MESO_NEW(&c->arena, MesoVec3, quilt->vertex_count, &error);
    CHECK(directions && positions);
    CHECK(meso_quilt_layer(directions, &report, &c->surface, meso_quilt_heights(quilt), &error) == MESO_OK);
    meso_quilt_embed(positions, quilt, &c->surface, directions, 1);
    CHECK(meso_quilt_check(&result, &c->arena, quilt, &c->swatch, positions, &c->surface,
                           &(MesoQuiltCheckOptions){.scale = 1, .thread_count = 1}, &error) == MESO_OK);
    return result;
}

static void settle(Case *c, bool partial)
{
    MesoError error;
    grow(c);
    c->quilt = c->grown;
    CHECK(meso_quilt_settle(&c->quilt, &c->arena, &c->surface, &c->swatch,
                            &(MesoSettleOptions){.scale = 1, .partial = partial}, &error) == MESO_OK);
    c->before = check(c, &c->grown);
    c->after = check(c, &c->quilt);
}

static void release(Case *c)
{
    meso_triangulation_release(&c->surface);
    meso_arena_release(&c->arena);
}

static void make_ball(Case *c, float radius)
{
    *c = (Case){0};
    meso_arena_init(&c->arena);
    c->surface = meso_fixture_ball(12);
    for (uint32_t v = 0; v < c->surface.vertex_count; v++)
        c->surface.positions[v] = meso_vec3_scale(meso_vec3_unit(c->surface.positions[v], (MesoVec3){0, 0, 1}), radius);
}

/* Nuts on a ball: as large as they are, as many as by area, and off each other. */
static void test_nuts(void)
{
    Case c;
    make_ball(&c, 2.2f);
    make_swatch(&c, "nuts", 0.05f);
    settle(&c, false);
    CHECK(c.before.squeezed_count > 0);
    CHECK(c.after.changed_count == 0 && c.after.squeezed_count == 0);
    CHECK(c.after.least_volume > 0.99 && c.after.largest_volume < 1.01);
    CHECK(fabs(c.after.whole_count - c.after.expected_whole_count) < 0.06 * c.after.expected_whole_count);
    CHECK(c.after.crossings.between_count == 0 && c.after.faults.open_count == 0);
    CHECK(c.quilt.report.added_count > 0 && c.quilt.report.settled_count <= c.grown.element_count);
    release(&c);
}

/* What stands in another element goes with it: each apple has its stem. */
static void test_carried(void)
{
    Case c;
    make_ball(&c, 2.2f);
    make_swatch(&c, "apples", 0.05f);
    settle(&c, false);
    CHECK(c.after.squeezed_count == 0 && c.after.crossings.between_count == 0);
    uint32_t apples = 0, stems = 0;
    for (uint32_t e = 0; e < c.quilt.element_count; e++) {
        uint32_t material = c.swatch.materials[c.quilt.triangle_origins[c.quilt.triangle_begin[e]]];
        apples += material == 0;
        stems += material == 1;
    }
    CHECK(apples > 20 && apples == stems);
    release(&c);
}

/* Rings that go through each other stay as they were but for their volume, and what is added cuts nothing. */
static void test_linked(void)
{
    Case c;
    make_ball(&c, 2.2f);
    make_swatch(&c, "mail", 0.05f);
    settle(&c, false);
    CHECK(c.before.squeezed_count > 0);
    CHECK(c.after.changed_count == 0 && c.after.squeezed_count == 0);
    CHECK(c.quilt.element_count >= c.grown.element_count);
    CHECK(memcmp(c.quilt.element_origins, c.grown.element_origins, c.grown.element_count * sizeof(uint32_t)) == 0);
    release(&c);
}

/* On a plane elements are what they are; of a part of it nothing is added. */
static void test_plane(void)
{
    Case c = {0};
    meso_arena_init(&c.arena);
    c.surface = meso_fixture_sheet(1, 1, 9);
    make_swatch(&c, "nuts", 0);
    settle(&c, true);
    CHECK(c.quilt.element_count == c.grown.element_count && c.quilt.report.added_count == 0);
    CHECK(c.after.squeezed_count == 0 && c.after.crossings.between_count == 0);
    release(&c);
}

/* Strands alone are left as they are. */
static void test_strands(void)
{
    Case c;
    make_ball(&c, 2.2f);
    make_swatch(&c, "wire", 0.05f);
    settle(&c, false);
    CHECK(c.quilt.vertices == c.grown.vertices && c.quilt.report.settled_count == 0);
    release(&c);
}

int main(void)
{
    test_nuts();
    test_carried();
    test_linked();
    test_plane();
    test_strands();
    return 0;
}
