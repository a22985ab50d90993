#include "libcore/quilt/settle/quilt_settle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/base/quilt_base.h"
#include "libcore/quilt/check/check_crossings.h"
#include "libcore/quilt/finish/quilt_finish.h"
#include "libcore/quilt/swatch/swatch_make.h"

#define RADIUS 2.2f
#define MARGIN 2.0f

typedef struct Figures {
    double least, largest;      /* volumes, as shares */
    uint64_t crossings;         /* between elements */
} Figures;

typedef struct Case {
    MesoArena arena;
    MesoTriangulation surface;
    MesoSwatch swatch;
    MesoQuilt grown, quilt;     /* before settling, and after */
    Figures before, after;
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

/* Volumes against the swatch's, and what crosses. */
static Figures measure(Case *c, const MesoQuilt *quilt)
{
    MesoError error;
    MesoPrismReport report;
    MesoCheckMesh mesh, sample;
    MesoMeshFaults faults;
    MesoCrossings crossings;
    Figures figures = {.least = 1, .largest = 1};
    MesoVec3 *directions = MESO_NEW(&c->arena, MesoVec3, c->surface.vertex_count, &error);
    MesoVec3 *positions = MESO_NEW(&c->arena, MesoVec3, quilt->vertex_count, &error);
    MesoElementShape *shapes = MESO_NEW(&c->arena, MesoElementShape, quilt->element_count, &error);
    MesoElementShape *originals = MESO_NEW(&c->arena, MesoElementShape, c->swatch.element_count, &error);
    CHECK(directions && positions && shapes && originals);
    CHECK(meso_quilt_layer(directions, &report, &c->surface, meso_quilt_heights(quilt), 1, &error) == MESO_OK);
    meso_quilt_embed(positions, quilt, &c->surface, directions, 1);
    CHECK(meso_check_mesh_of_quilt(&mesh, &faults, &c->arena, quilt, positions, 1, &error) == MESO_OK);
    CHECK(meso_check_mesh_of_swatch(&sample, &c->arena, &c->swatch, &error) == MESO_OK);
    CHECK(meso_check_shapes(shapes, &c->arena, &mesh, &error) == MESO_OK);
    CHECK(meso_check_shapes(originals, &c->arena, &sample, &error) == MESO_OK);
    CHECK(meso_check_crossings(&crossings, &c->arena, &mesh, 1, &error) == MESO_OK);
    CHECK(faults.open_count == 0 && faults.unplaced_count == 0);
    for (uint32_t e = 0; e < quilt->element_count; e++) {
        const MesoElementShape *original = &originals[quilt->element_origins[e]];
        if (c->swatch.kinds[quilt->element_origins[e]] != MESO_ELEMENT_WHOLE)
            continue;
        CHECK(shapes[e].triangle_count == original->triangle_count && shapes[e].euler == original->euler);
        double share = shapes[e].volume / original->volume;
        figures.least = fmin(figures.least, share);
        figures.largest = fmax(figures.largest, share);
    }
    figures.crossings = crossings.between_count;
    return figures;
}

static void settle(Case *c, bool partial)
{
    MesoError error;
    grow(c);
    c->quilt = c->grown;
    CHECK(meso_quilt_settle(&c->quilt, &c->arena, &c->surface, &c->swatch,
                            &(MesoSettleOptions){.scale = 1, .partial = partial}, &error) == MESO_OK);
    c->before = measure(c, &c->grown);
    c->after = measure(c, &c->quilt);
}

static void release(Case *c)
{
    meso_triangulation_release(&c->surface);
    meso_arena_release(&c->arena);
}

static void make_ball(Case *c)
{
    *c = (Case){0};
    meso_arena_init(&c->arena);
    c->surface = meso_fixture_ball(12);
    for (uint32_t v = 0; v < c->surface.vertex_count; v++)
        c->surface.positions[v] = meso_vec3_scale(meso_vec3_unit(c->surface.positions[v], (MesoVec3){0, 0, 1}), RADIUS);
}

/* How many there are in the swatch on the area of the ball. */
static double elements_wanted(const Case *c)
{
    return 4 * MESO_PI * RADIUS * RADIUS * c->swatch.element_count / ((double)c->swatch.size.x * c->swatch.size.y);
}

/* Nuts on a ball: as large as they are, as many as by area, and off each other. */
static void test_nuts(void)
{
    Case c;
    make_ball(&c);
    make_swatch(&c, "nuts", 0.05f);
    settle(&c, false);
    CHECK(c.before.largest > 1.1);
    CHECK(c.after.least > 0.99 && c.after.largest < 1.01 && c.after.crossings == 0);
    double wanted = elements_wanted(&c);
    CHECK(fabs(c.quilt.element_count - wanted) < 0.06 * wanted);
    CHECK(c.quilt.report.added_count > 0 && c.quilt.report.settled_count <= c.grown.element_count);
    release(&c);
}

/* What stands in another element goes with it: each apple has its stem. */
static void test_carried(void)
{
    Case c;
    make_ball(&c);
    make_swatch(&c, "apples", 0.05f);
    settle(&c, false);
    CHECK(c.after.least > 0.99 && c.after.largest < 1.01 && c.after.crossings == 0);
    uint32_t apples = 0, stems = 0;
    for (uint32_t e = 0; e < c.quilt.element_count; e++) {
        uint32_t material = c.swatch.materials[c.quilt.triangle_origins[c.quilt.triangle_begin[e]]];
        apples += material == 0;
        stems += material == 1;
    }
    CHECK(apples > 20 && apples == stems);
    release(&c);
}

/* Rings that go through each other become what they are, as many as by area, and few of them still cut another one. */
static void test_linked(void)
{
    Case c;
    make_ball(&c);
    make_swatch(&c, "mail", 0.05f);
    settle(&c, false);
    CHECK(c.before.largest > 1.1);
    CHECK(c.after.least > 0.99 && c.after.largest < 1.01);
    double wanted = elements_wanted(&c);
    CHECK(c.quilt.element_count > 0.78 * wanted && c.quilt.element_count < 1.05 * wanted);
    CHECK(c.before.crossings > 200 && c.after.crossings < 50);
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
    CHECK(c.after.least > 0.99 && c.after.largest < 1.01 && c.after.crossings == 0);
    release(&c);
}

static MesoVec3 point_on_sheet(const MesoTriangulation *sheet, MesoQuiltVertex q)
{
    const uint32_t *c = &sheet->corners[3 * (size_t)q.triangle];
    MesoVec3 p = meso_vec3_scale(sheet->positions[c[0]], 1 - q.b1 - q.b2);
    p = meso_vec3_mad(meso_vec3_mad(p, q.b1, sheet->positions[c[1]]), q.b2, sheet->positions[c[2]]);
    p.z += q.height;
    return p;
}

static MesoQuiltVertex place_on_sheet(const MesoTriangulation *sheet, MesoVec3 p)
{
    for (uint32_t t = 0; t < sheet->triangle_count; t++) {
        const uint32_t *c = &sheet->corners[3 * (size_t)t];
        MesoVec3 o = sheet->positions[c[0]], a = meso_vec3_sub(sheet->positions[c[1]], o);
        MesoVec3 b = meso_vec3_sub(sheet->positions[c[2]], o), q = meso_vec3_sub(p, o);
        float area = a.x * b.y - a.y * b.x, u = (q.x * b.y - q.y * b.x) / area, v = (a.x * q.y - a.y * q.x) / area;
        if (u >= -1e-5f && v >= -1e-5f && u + v <= 1.00002f)
            return (MesoQuiltVertex){t, u, v, p.z};
    }
    fprintf(stderr, "a point is off the sheet\n");
    exit(1);
}

/* Where a swatch lies on the plane around it, moved, each of its elements turned around its centre. */
static void lay_turned(Case *c, float angle)
{
    MesoError error;
    const MesoSwatch *s = &c->swatch;
    MesoQuilt *q = &c->grown;
    *q = (MesoQuilt){.vertex_count = s->vertex_count, .triangle_count = s->triangle_count,
                     .element_count = s->element_count, .corners = s->corners, .vertex_begin = s->vertex_begin,
                     .triangle_begin = s->triangle_begin};
    q->vertices = MESO_NEW(&c->arena, MesoQuiltVertex, s->vertex_count, &error);
    q->origins = MESO_NEW(&c->arena, uint32_t, s->vertex_count, &error);
    q->element_origins = MESO_NEW(&c->arena, uint32_t, s->element_count, &error);
    q->triangle_origins = MESO_NEW(&c->arena, uint32_t, s->triangle_count, &error);
    q->patches = MESO_NEW(&c->arena, uint32_t, s->triangle_count, &error);
    CHECK(q->vertices && q->origins && q->element_origins && q->triangle_origins && q->patches);
    for (uint32_t t = 0; t < s->triangle_count; t++)
        q->triangle_origins[t] = t;
    for (uint32_t e = 0; e < s->element_count; e++) {
        q->element_origins[e] = e;
        for (uint32_t v = s->vertex_begin[e]; v < s->vertex_begin[e + 1]; v++) {
            MesoVec3 off = meso_vec3_sub(s->positions[v], s->centres[e]);
            float x = s->centres[e].x + cosf(angle) * off.x - sinf(angle) * off.y;
            float y = s->centres[e].y + sinf(angle) * off.x + cosf(angle) * off.y;
            q->vertices[v] = place_on_sheet(&c->surface, (MesoVec3){x + MARGIN, y + MARGIN, s->positions[v].z});
            q->origins[v] = v;
        }
    }
}

/* How far points of a quilt are turned against the swatch, each group of them around its middle. */
static double turn_of(const Case *c, const MesoQuilt *quilt, uint32_t groups)
{
    double along = 0, across = 0;
    for (uint32_t g = 0; g < groups; g++) {
        uint32_t first = groups > 1 ? quilt->vertex_begin[g] : 0;
        uint32_t end = groups > 1 ? quilt->vertex_begin[g + 1] : quilt->vertex_count;
        MesoVec3 here = {0, 0, 0}, there = {0, 0, 0};
        for (uint32_t v = first; v < end; v++) {
            here = meso_vec3_mad(here, 1 / (float)(end - first), point_on_sheet(&c->surface, quilt->vertices[v]));
            there = meso_vec3_mad(there, 1 / (float)(end - first), c->swatch.positions[v]);
        }
        for (uint32_t v = first; v < end; v++) {
            MesoVec3 p = meso_vec3_sub(point_on_sheet(&c->surface, quilt->vertices[v]), here);
            MesoVec3 q = meso_vec3_sub(c->swatch.positions[v], there);
            along += (double)(p.x * q.x + p.y * q.y);
            across += (double)(q.x * p.y - q.y * p.x);
        }
    }
    return atan2(across, along);
}

/* Elements turn as what is around them lies, and do not turn all with them although they are turned alike. */
static void test_turned(void)
{
    Case c = {0};
    MesoError error;
    meso_arena_init(&c.arena);
    c.surface = meso_fixture_sheet(1, 1, 10);
    make_swatch(&c, "nuts", 0);
    lay_turned(&c, 0.15f);
    c.quilt = c.grown;
    CHECK(meso_quilt_settle(&c.quilt, &c.arena, &c.surface, &c.swatch,
                            &(MesoSettleOptions){.scale = 1, .partial = true}, &error) == MESO_OK);
    uint32_t count = c.quilt.element_count;
    CHECK(turn_of(&c, &c.grown, count) - turn_of(&c, &c.grown, 1) > 0.13);
    CHECK(fabs(turn_of(&c, &c.quilt, count)) < 0.06 && fabs(turn_of(&c, &c.quilt, 1)) < 0.06);
    release(&c);
}

/* Strands alone are left as they are. */
static void test_strands(void)
{
    Case c;
    make_ball(&c);
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
    test_turned();
    test_strands();
    return 0;
}
