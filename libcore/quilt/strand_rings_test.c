/* Rings of strands: those of a weave are as it was made; a sheet has none. */
#include "libcore/quilt/quilt_work.h"

#include "libcore/base/check.h"
#include "libcore/quilt/swatch/swatch_make.h"

static MesoSwatch make_swatch(MesoArena *arena, const char *name, float jitter)
{
    MesoError error;
    MesoPolygonMesh mesh;
    MesoSwatch swatch;
    MesoSwatchRecipe recipe = {.name = name, .jitter = jitter};
    CHECK(meso_swatch_make(&mesh, arena, &recipe, &error) == MESO_OK);
    CHECK(meso_swatch_build(&swatch, arena, &mesh, &(MesoSwatchOptions){.up = -1, .periodic = -1}, &error) == MESO_OK);
    return swatch;
}

/* Nine bands a pitch, twelve sides: each ring has these, middles follow each other by a step along the axis. */
static void test_weave(void)
{
    MesoArena arena;
    MesoError error;
    MesoStrandRings rings;
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena, "weave", 0.1f);
    CHECK(meso_strands_find_rings(&rings, &swatch, &arena, &error) == MESO_OK);
    CHECK(rings.count == 12 * (6 * 9 + 1) && swatch.vertex_count == 12 * rings.count);
    uint32_t ends = 0;
    for (uint32_t r = 0; r < rings.count; r++) {
        CHECK(rings.sizes[r] == 12 && rings.reaches[r] > 0.3f && rings.reaches[r] < 0.4f);
        CHECK(fabsf(meso_vec3_length(rings.axes[r]) - 1) < 1e-4f && rings.next[2 * r] != MESO_NO_INDEX);
        CHECK(rings.steps[r] > 0.1f && rings.steps[r] < 0.18f);
        ends += rings.next[2 * r + 1] == MESO_NO_INDEX;
        MesoVec3 d = meso_vec3_sub(rings.middles[rings.next[2 * r]], rings.middles[r]);
        CHECK(fabsf(meso_vec3_dot(d, rings.axes[r])) > 0.9f * meso_vec3_length(d));
    }
    CHECK(ends == 2 * 12);
    for (uint32_t v = 0; v < swatch.vertex_count; v++)
        CHECK(meso_vec3_length(meso_vec3_sub(swatch.positions[v], rings.middles[rings.of_vertex[v]])) < 0.4f);
    meso_arena_release(&arena);
}

/* Whole elements have no rings. */
static void test_nuts(void)
{
    MesoArena arena;
    MesoError error;
    MesoStrandRings rings;
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena, "nuts", 0);
    CHECK(meso_strands_find_rings(&rings, &swatch, &arena, &error) == MESO_OK);
    CHECK(rings.count == 0 && rings.of_vertex[0] == MESO_NO_INDEX);
    meso_arena_release(&arena);
}

/* A sheet with one border around it: its rings would be as wide as the tile, so that each vertex stands for itself. */
static void test_sheet(void)
{
    enum { SIDE = 9 };
    MesoArena arena;
    MesoError error;
    MesoStrandRings rings;
    meso_arena_init(&arena);
    MesoVec3 positions[SIDE * SIDE];
    uint32_t corners[6 * (SIDE - 1) * (SIDE - 1)], count = 0, begin[2] = {0, SIDE * SIDE}, triangles[2] = {0, 0};
    for (uint32_t v = 0; v < SIDE * SIDE; v++)
        positions[v] = (MesoVec3){(float)(v % SIDE), (float)(v / SIDE), 0};
    for (uint32_t y = 0; y + 1 < SIDE; y++)
        for (uint32_t x = 0; x + 1 < SIDE; x++) {
            uint32_t a = y * SIDE + x, quad[6] = {a, a + 1, a + SIDE + 1, a, a + SIDE + 1, a + SIDE};
            for (int k = 0; k < 6; k++)
                corners[count++] = quad[k];
        }
    triangles[1] = count / 3;
    uint32_t loop[4 * (SIDE - 1)], loop_begin[2] = {0, 4 * (SIDE - 1)}, at = 0;
    for (uint32_t i = 0; i + 1 < SIDE; i++) {
        loop[at++] = i;
        loop[at++] = i * SIDE + SIDE - 1;
        loop[at++] = SIDE * SIDE - 1 - i;
        loop[at++] = (i + 1) * SIDE;
    }
    uint8_t kind = MESO_ELEMENT_STRAND;
    const MesoSwatch sheet = {.vertex_count = SIDE * SIDE, .triangle_count = triangles[1], .element_count = 1,
                              .positions = positions, .corners = corners, .vertex_begin = begin,
                              .triangle_begin = triangles, .kinds = &kind, .size = {SIDE - 1, SIDE - 1, 1},
                              .loop_count = 1, .loop_begin = loop_begin, .loop_vertices = loop};
    CHECK(meso_strands_find_rings(&rings, &sheet, &arena, &error) == MESO_OK);
    /* those of the two innermost rings, at most a quarter of the side wide, may be rings */
    uint32_t alone = 0;
    for (uint32_t r = 0; r < rings.count; r++)
        alone += rings.sizes[r] == 1;
    CHECK(alone >= SIDE * SIDE - 9);
    for (uint32_t r = 0; r < rings.count; r++)
        CHECK(rings.reaches[r] <= 0.25f * (SIDE - 1) && rings.middles[r].x >= 0);
    meso_arena_release(&arena);
}

int main(void)
{
    test_weave();
    test_nuts();
    test_sheet();
    return 0;
}
