/* A swatch laid over a plane has no hole, the same without an element has one. */
#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/check/check_cover.h"
#include "libcore/quilt/swatch/swatch_make.h"

/* Nuts over a square that is `side` wide, twice as large, the one nearest to the middle left out or not. */
static MesoCover measure(bool leave_out, float side)
{
    MesoArena arena;
    MesoError error;
    MesoPolygonMesh mesh;
    MesoSwatch s;
    MesoCover cover;
    meso_arena_init(&arena);
    const MesoSwatchRecipe recipe = {.name = "nuts", .columns = 8, .rows = 8};
    CHECK(meso_swatch_make(&mesh, &arena, &recipe, &error) == MESO_OK);
    CHECK(meso_swatch_build(&s, &arena, &mesh, &(MesoSwatchOptions){.up = 2}, &error) == MESO_OK);
    MesoTriangulation base = meso_fixture_sheet(1, 1, side);
    MesoQuilt quilt = {.vertex_count = s.vertex_count, .triangle_count = s.triangle_count};
    quilt.vertices = MESO_NEW(&arena, MesoQuiltVertex, s.vertex_count, &error);
    quilt.corners = MESO_NEW(&arena, uint32_t, 3 * (size_t)s.triangle_count, &error);
    CHECK(quilt.vertices && quilt.corners);
    MesoVec3 middle = {s.size.x / 2, s.size.y / 2, 0};
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        float x = side / 2 + 2 * (s.positions[v].x - middle.x), y = side / 2 + 2 * (s.positions[v].y - middle.y);
        quilt.vertices[v] = (MesoQuiltVertex){0, (x - y) / side, y / side, 2 * s.positions[v].z};
    }
    uint32_t nearest = 0;
    for (uint32_t e = 1; e < s.element_count; e++)
        if (meso_vec3_length(meso_vec3_sub(s.centres[e], middle)) <
            meso_vec3_length(meso_vec3_sub(s.centres[nearest], middle)))
            nearest = e;
    for (uint32_t c = 0; c < 3 * s.triangle_count; c++) {
        bool left_out = leave_out && c / 3 >= s.triangle_begin[nearest] && c / 3 < s.triangle_begin[nearest + 1];
        quilt.corners[c] = left_out ? 0 : s.corners[c];
    }
    size_t used = arena.used;
    CHECK(meso_check_cover(&cover, &arena, &quilt, &s, &base, 2, &error) == MESO_OK && arena.used == used);
    meso_triangulation_release(&base);
    meso_arena_release(&arena);
    return cover;
}

int main(void)
{
    MesoCover k = measure(false, 12);
    CHECK(k.place_count == 1000 && k.empty_count == 0);
    CHECK(k.widest > 0.5 * k.swatch_widest && k.widest < 1.05 * k.swatch_widest);
    k = measure(true, 12);
    CHECK(k.empty_count > 0 && k.widest > 1.5 * k.swatch_widest);
    /* nothing is far enough from the border of a square that is hardly larger than what is left out */
    k = measure(true, 3);
    CHECK(k.empty_count == 0);
    return 0;
}
