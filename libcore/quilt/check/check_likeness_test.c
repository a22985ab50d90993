/* A swatch laid over a plane is like itself, however it is turned; less so where it has been bent. */
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

/* The swatch, turned by `angle` about the middle of the square, twice as large; `lift` (of the swatch's height) is a
 * wave along one of its sides. */
static Case laid_out(const char *recipe, uint32_t columns, double angle, float lift)
{
    Case c;
    MesoError error;
    MesoPolygonMesh mesh;
    meso_arena_init(&c.arena);
    const MesoSwatchRecipe made = {.name = recipe, .jitter = 0.1f, .columns = columns, .rows = columns,
                                   .sides = 6};
    CHECK(meso_swatch_make(&mesh, &c.arena, &made, &error) == MESO_OK);
    CHECK(meso_swatch_build(&c.swatch, &c.arena, &mesh, &(MesoSwatchOptions){.up = 2}, &error) == MESO_OK);
    const MesoSwatch *s = &c.swatch;
    float side = 1.4f * fminf(s->size.x, s->size.y);    /* at any angle it has swatch over it */
    c.base = meso_fixture_sheet(1, 1, side);
    c.quilt = (MesoQuilt){.vertex_count = s->vertex_count, .triangle_count = s->triangle_count,
                          .element_count = s->element_count, .corners = s->corners};
    c.quilt.vertices = MESO_NEW(&c.arena, MesoQuiltVertex, s->vertex_count, &error);
    c.quilt.origins = MESO_NEW(&c.arena, uint32_t, s->vertex_count, &error);
    CHECK(c.quilt.vertices && c.quilt.origins);
    float cosine = 2 * (float)cos(angle), sine = 2 * (float)sin(angle);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        MesoVec3 p = s->positions[v];
        float wave = lift * s->size.z * sinf(9 * p.x / s->size.x);
        p = (MesoVec3){p.x - s->size.x / 2, p.y - s->size.y / 2, p.z + wave};
        float x = side / 2 + cosine * p.x - sine * p.y, y = side / 2 + sine * p.x + cosine * p.y;
        c.quilt.vertices[v] = (MesoQuiltVertex){0, (x - y) / side, y / side, 0.25f + 2 * p.z};
        c.quilt.origins[v] = v;
    }
    return c;
}

static MesoLikeness measure(Case *c)
{
    MesoLikeness likeness;
    MesoError error;
    size_t used = c->arena.used;
    const MesoLikenessOptions options = {.scale = 2, .height_scale = 2, .offset = 0.25f};
    CHECK(meso_check_likeness(&likeness, &c->arena, &c->quilt, &c->swatch, NULL, &c->base, &options,
                              &error) == MESO_OK);
    CHECK(c->arena.used == used);
    meso_triangulation_release(&c->base);
    meso_arena_release(&c->arena);
    return likeness;
}

static void test_same(const char *recipe, uint32_t columns, double angle)
{
    Case c = laid_out(recipe, columns, angle, 0);
    MesoLikeness k = measure(&c);
    CHECK(k.window_count == 32 && k.swatch_window_count == 32);
    CHECK(k.distance < 0.1 * k.swatch_distance);
}

static void test_bent(void)
{
    Case c = laid_out("weave", 6, 0.3, 0.5f);
    MesoLikeness k = measure(&c);
    CHECK(k.distance > 3 * k.swatch_distance);
}

int main(void)
{
    test_same("weave", 6, 0);
    test_same("rings", 10, -2.5);
    test_bent();
    return 0;
}
