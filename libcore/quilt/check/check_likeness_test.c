/*
 * A swatch laid over a plane is like itself, however it is turned, and where it is of patches; less so where it has
 * been bent, where a strand is cut, and where an element is there twice.
 */
#include "libcore/base/check.h"
#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/check/check_likeness.h"
#include "libcore/quilt/swatch/swatch_make.h"

typedef struct Case {
    MesoArena arena;
    MesoSwatch swatch;
    MesoTriangulation base;     /* a square under the swatch's middle; all is said by the first of its triangles */
    MesoQuilt quilt;
} Case;

/* Where a place of the swatch comes to be: turned about the middle of the square, twice as large. */
static MesoQuiltVertex laid(const Case *c, MesoVec3 p, double angle)
{
    float side = c->base.positions[1].x - c->base.positions[0].x;
    float cosine = 2 * (float)cos(angle), sine = 2 * (float)sin(angle);
    p = (MesoVec3){p.x - c->swatch.size.x / 2, p.y - c->swatch.size.y / 2, p.z};
    float x = side / 2 + cosine * p.x - sine * p.y, y = side / 2 + sine * p.x + cosine * p.y;
    return (MesoQuiltVertex){0, (x - y) / side, y / side, 0.25f + 2 * p.z};
}

/* The swatch, turned by `angle`; `lift` (of the swatch's height) is a wave along one of its sides. */
static Case laid_out(const char *recipe, uint32_t columns, float jitter, double angle, float lift)
{
    Case c;
    MesoError error;
    MesoPolygonMesh mesh;
    meso_arena_init(&c.arena);
    const MesoSwatchRecipe made = {.name = recipe, .jitter = jitter, .columns = columns, .rows = columns, .sides = 6};
    CHECK(meso_swatch_make(&mesh, &c.arena, &made, &error) == MESO_OK);
    CHECK(meso_swatch_build(&c.swatch, &c.arena, &mesh, &(MesoSwatchOptions){.up = 2, .periodic = -1}, &error) ==
          MESO_OK);
    const MesoSwatch *s = &c.swatch;
    c.base = meso_fixture_sheet(1, 1, 1.4f * fminf(s->size.x, s->size.y));  /* at any angle it has swatch over it */
    c.quilt = (MesoQuilt){.vertex_count = s->vertex_count, .triangle_count = s->triangle_count,
                          .element_count = s->element_count, .corners = s->corners};
    c.quilt.vertices = MESO_NEW(&c.arena, MesoQuiltVertex, s->vertex_count, &error);
    c.quilt.origins = MESO_NEW(&c.arena, uint32_t, s->vertex_count, &error);
    CHECK(c.quilt.vertices && c.quilt.origins);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        MesoVec3 p = s->positions[v];
        p.z += lift * s->size.z * sinf(9 * p.x / s->size.x);
        c.quilt.vertices[v] = laid(&c, p, angle);
        c.quilt.origins[v] = v;
    }
    return c;
}

static MesoLikeness measure_by(Case *c, uint32_t window_count)
{
    MesoLikeness likeness;
    MesoError error;
    size_t used = c->arena.used;
    const MesoLikenessOptions options = {.scale = 2, .height_scale = 2, .offset = 0.25f,
                                         .window_count = window_count};
    CHECK(meso_check_likeness(&likeness, &c->arena, &c->quilt, &c->swatch, NULL, &c->base, &options,
                              &error) == MESO_OK);
    CHECK(c->arena.used == used);
    meso_triangulation_release(&c->base);
    meso_arena_release(&c->arena);
    CHECK(likeness.window_count == window_count && likeness.swatch_window_count == window_count);
    CHECK(likeness.laid_window_count >= window_count / 2);
    return likeness;
}

static MesoLikeness measure(Case *c)
{
    return measure_by(c, 8);
}

static void test_same(const char *recipe, uint32_t columns, double angle)
{
    Case c = laid_out(recipe, columns, 0.1f, angle, 0);
    MesoLikeness k = measure(&c);
    CHECK(k.distance < 0.1 * k.swatch_distance);
    CHECK(fabs(k.laid_distance - k.swatch_distance) < 0.3 * k.swatch_distance);
}

static void test_bent(void)
{
    Case c = laid_out("weave", 6, 0.1f, 0.3, 0.5f);
    MesoLikeness k = measure(&c);
    CHECK(k.distance > 3 * k.swatch_distance && k.ratio > 3);
}

/* Four times as many windows have half the error, and few and many differ by no more than a few errors. */
static void test_error(void)
{
    Case a = laid_out("weave", 6, 0.1f, 0.3, 0.5f), b = laid_out("weave", 6, 0.1f, 0.3, 0.5f);
    MesoLikeness few = measure_by(&a, 12), many = measure_by(&b, 48);
    CHECK(few.ratio_error > 0.01 * few.ratio && few.ratio_error < 0.3 * few.ratio);
    CHECK(many.ratio_error > 0.3 * few.ratio_error && many.ratio_error < 0.75 * few.ratio_error);
    CHECK(fabs(many.ratio - few.ratio) < 3 * few.ratio_error);
}

/* ---- what is exactly like itself in many places ---- */

/* Every other third of a pitch comes from elsewhere in the swatch, some strands further, where that is the same. */
static void take_from_elsewhere(Case *c)
{
    const MesoSwatch *s = &c->swatch;
    uint32_t moved = 0;
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        MesoVec3 p = s->positions[v];
        float further = p.x < 2 ? 4 : p.x < 3 ? 2 : p.x < 4 ? -2 : -4;
        for (uint32_t w = 0; w < s->vertex_count && (int)(3 * p.x) % 2; w++) {
            MesoVec3 d = meso_vec3_sub(s->positions[w], (MesoVec3){p.x + further, p.y, p.z});
            if (!(meso_vec3_length(d) < 1e-3f * s->mean_edge) || c->quilt.origins[v] != v)
                continue;
            c->quilt.origins[v] = w;
            moved++;
        }
    }
    CHECK(moved > s->vertex_count / 4);
}

static void test_periodic(double angle, bool of_patches)
{
    Case c = laid_out("weave", 6, 0, angle, 0);
    CHECK(c.swatch.period.x > 0);
    if (of_patches)
        take_from_elsewhere(&c);
    MesoLikeness k = measure(&c);
    CHECK(k.distance < 0.01 * (double)c.swatch.mean_edge);
    CHECK(k.ratio > 0.8 && k.ratio < 1.2);
}

/* ---- faults ---- */

/* What of an element's triangles lies in the middle third of the swatch is gone. */
static MesoLikeness measure_cut(void)
{
    Case c = laid_out("weave", 6, 0, 0.3, 0);
    MesoError error;
    const MesoSwatch *s = &c.swatch;
    uint32_t *corners = MESO_NEW(&c.arena, uint32_t, 3 * (size_t)s->triangle_count, &error), count = 0;
    CHECK(corners);
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        MesoVec3 p = s->positions[s->corners[3 * (size_t)t]];
        bool gone = t >= s->triangle_begin[2] && t < s->triangle_begin[3] && fabsf(p.x / s->size.x - 0.5f) < 0.17f &&
                    fabsf(p.y / s->size.y - 0.5f) < 0.17f;
        for (uint32_t k = 0; k < 3 && !gone; k++)
            corners[count++] = s->corners[3 * (size_t)t + k];
    }
    CHECK(count < 3 * s->triangle_count);
    c.quilt.corners = corners;
    c.quilt.triangle_count = count / 3;
    return measure(&c);
}

/* A ring in the middle is there once more, half a pitch aside. */
static MesoLikeness measure_doubled(bool doubled)
{
    Case c = laid_out("rings", 8, 0, 0.3, 0);
    MesoError error;
    const MesoSwatch *s = &c.swatch;
    uint32_t element = 0, n = s->vertex_count, m = 3 * s->triangle_count;
    float nearest = INFINITY;
    for (uint32_t e = 0; e < s->element_count; e++) {
        float away = hypotf(s->centres[e].x - s->size.x / 2, s->centres[e].y - s->size.y / 2);
        element = away < nearest ? e : element;
        nearest = fminf(away, nearest);
    }
    uint32_t *corners = MESO_NEW(&c.arena, uint32_t, 2 * (size_t)m, &error);
    MesoQuiltVertex *vertices = MESO_NEW(&c.arena, MesoQuiltVertex, 2 * (size_t)n, &error);
    uint32_t *origins = MESO_NEW(&c.arena, uint32_t, 2 * (size_t)n, &error);
    CHECK(corners && vertices && origins);
    for (uint32_t i = 0; i < m; i++)
        corners[i] = s->corners[i];
    for (uint32_t v = 0; v < n; v++) {
        MesoVec3 aside = meso_vec3_add(s->positions[v], (MesoVec3){0.5f, 0.5f, 0});
        vertices[v] = c.quilt.vertices[v];
        vertices[n + v] = laid(&c, aside, 0.3);
        origins[v] = origins[n + v] = v;
    }
    for (uint32_t i = 3 * s->triangle_begin[element]; i < 3 * s->triangle_begin[element + 1] && doubled; i++)
        corners[m++] = n + s->corners[i];
    c.quilt.corners = corners;
    c.quilt.vertices = vertices;
    c.quilt.origins = origins;
    c.quilt.vertex_count = 2 * n;
    c.quilt.triangle_count = m / 3;
    return measure(&c);
}

static void test_faults(void)
{
    MesoLikeness cut = measure_cut(), doubled = measure_doubled(true), sound = measure_doubled(false);
    CHECK(cut.ratio > 2);
    CHECK(sound.ratio < 1.2 && doubled.ratio > 1.5);
    CHECK(doubled.largest_distance > 5 * sound.largest_distance);
}

int main(void)
{
    test_same("weave", 6, 0);
    test_same("rings", 10, -2.5);
    test_bent();
    test_error();
    test_periodic(0, false);
    test_periodic(0.7, true);
    test_faults();
    return 0;
}
