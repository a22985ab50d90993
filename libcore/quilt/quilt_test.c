#include "libcore/quilt/quilt.h"

#include <string.h>

#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/swatch/swatch_make.h"

/* `sides` of cross-sections: 0 for the usual ones, few for what is to take little time. */
static MesoSwatch make_swatch(MesoArena *arena, const char *name, float jitter, uint32_t sides)
{
    MesoError error;
    MesoPolygonMesh mesh;
    MesoSwatch swatch;
    MesoSwatchRecipe recipe = {.name = name, .jitter = jitter, .sides = sides};
    CHECK(meso_swatch_make(&mesh, arena, &recipe, &error) == MESO_OK);
    CHECK(meso_swatch_build(&swatch, arena, &mesh, &(MesoSwatchOptions){.up = -1, .periodic = -1}, &error) == MESO_OK);
    return swatch;
}

/* x, the same for all triangles of a plane. */
static MesoVec3 *make_guide(MesoArena *arena, uint32_t triangle_count)
{
    MesoError error;
    MesoVec3 *guide = MESO_NEW(arena, MesoVec3, triangle_count, &error);
    CHECK(guide);
    for (uint32_t t = 0; t < triangle_count; t++)
        guide[t] = (MesoVec3){1, 0, 0};
    return guide;
}

static MesoQuilt grow(MesoArena *arena, const MesoTriangulation *base, const MesoSwatch *swatch, uint32_t threads)
{
    MesoQuilt quilt;
    MesoError error;
    MesoQuiltOptions options = {.scale = 1, .turn_count = 1, .thread_count = threads, .seed = 5};
    options.guide = make_guide(arena, base->triangle_count);
    CHECK(meso_quilt_grow(&quilt, arena, base, swatch, &options, &error) == MESO_OK);
    return quilt;
}

/* All that is promised of the arrays, whatever has been grown. */
static void check_quilt(const MesoQuilt *quilt, const MesoTriangulation *base, const MesoSwatch *swatch)
{
    CHECK(quilt->vertex_begin[0] == 0 && quilt->vertex_begin[quilt->element_count] == quilt->vertex_count);
    CHECK(quilt->triangle_begin[0] == 0 && quilt->triangle_begin[quilt->element_count] == quilt->triangle_count);
    for (uint32_t e = 0; e < quilt->element_count; e++) {
        CHECK(quilt->element_origins[e] < swatch->element_count);
        for (uint32_t c = 3 * quilt->triangle_begin[e]; c < 3 * quilt->triangle_begin[e + 1]; c++)
            CHECK(quilt->corners[c] >= quilt->vertex_begin[e] && quilt->corners[c] < quilt->vertex_begin[e + 1]);
    }
    for (uint32_t v = 0; v < quilt->vertex_count; v++) {
        MesoQuiltVertex p = quilt->vertices[v];
        CHECK(p.triangle < base->triangle_count && quilt->origins[v] < swatch->vertex_count);
        CHECK(p.b1 >= -1e-4f && p.b2 >= -1e-4f && p.b1 + p.b2 <= 1 + 1e-4f && isfinite(p.height));
    }
}

/* Copies of a periodic swatch on a plane: nothing is cut, nothing is moved, and strands are as many as by count. */
static void test_periodic_strands(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena, "weave", 0, 0);
    CHECK(swatch.periodic_x && swatch.periodic_y);
    MesoTriangulation base = meso_fixture_sheet(24, 24, 0.5f);
    MesoQuilt quilt = grow(&arena, &base, &swatch, 2);
    check_quilt(&quilt, &base, &swatch);
    CHECK(quilt.report.weld_count == quilt.report.patch_count && quilt.report.patch_count > 8);
    CHECK(quilt.report.join_count == 0 && quilt.report.cap_count == 0 && quilt.report.skipped_count == 0);
    CHECK(quilt.report.deformation_largest < 1e-5);
    CHECK(quilt.element_count >= 24 && quilt.element_count <= 26);     /* 12 each way; at borders one may be halved */
    meso_triangulation_release(&base);
    meso_arena_release(&arena);
}

/* Whole elements: as many as by area, each with all of its triangles. */
static void test_whole_elements(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena, "nuts", 0, 0);
    MesoTriangulation base = meso_fixture_sheet(24, 24, 0.5f);
    MesoQuilt quilt = grow(&arena, &base, &swatch, 2);
    check_quilt(&quilt, &base, &swatch);
    for (uint32_t e = 0; e < quilt.element_count; e++) {
        uint32_t origin = quilt.element_origins[e];
        CHECK(quilt.triangle_begin[e + 1] - quilt.triangle_begin[e] ==
              swatch.triangle_begin[origin + 1] - swatch.triangle_begin[origin]);
    }
    /* those whose centre lies where they fit whole: a reach away from the border */
    double density = swatch.element_count / ((double)swatch.size.x * swatch.size.y), inner = 12 - 2 * (double)swatch.radii[0];
    CHECK(fabs(quilt.element_count - density * inner * inner) < 0.1 * density * inner * inner);
    meso_triangulation_release(&base);
    meso_arena_release(&arena);
}

/* Edges shorter than that, on a plane. */
static uint32_t count_short(const MesoQuilt *quilt, const MesoTriangulation *base, float length)
{
    uint32_t count = 0;
    for (uint32_t c = 0; c < 3 * quilt->triangle_count; c++) {
        MesoVec3 ends[2];
        for (int k = 0; k < 2; k++) {
            MesoQuiltVertex v = quilt->vertices[quilt->corners[k ? meso_next_corner(c) : c]];
            const uint32_t *corner = &base->corners[3 * (size_t)v.triangle];
            MesoVec3 p = meso_vec3_scale(base->positions[corner[0]], 1 - v.b1 - v.b2);
            p = meso_vec3_mad(p, v.b1, base->positions[corner[1]]);
            ends[k] = meso_vec3_mad(p, v.b2, base->positions[corner[2]]);
            ends[k].z += v.height;
        }
        count += meso_vec3_length(meso_vec3_sub(ends[0], ends[1])) < length;
    }
    return count;
}

/*
 * Irregular ribbons, so dense that seams run along some of them: they are cut across all the same, between their rings, so
 * that no edge is short, and hardly one ends.
 */
static void test_dense_strands(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena, "weave", 0.1f, 0);
    MesoTriangulation base = meso_fixture_sheet(32, 32, 0.5f);
    MesoQuilt quilt = grow(&arena, &base, &swatch, 2);
    check_quilt(&quilt, &base, &swatch);
    CHECK(quilt.report.join_count > 200 && quilt.report.cap_count < 10 && quilt.report.skipped_count == 0);
    CHECK(count_short(&quilt, &base, 0.2f * swatch.mean_edge) == 0);
    meso_triangulation_release(&base);
    meso_arena_release(&arena);
}

/* Irregular strands: joined, and the same for any number of threads. */
static void test_threads(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena, "wire", 0.08f, 5);
    MesoTriangulation base = meso_fixture_sheet(22, 22, 0.5f);
    MesoQuilt one = grow(&arena, &base, &swatch, 1);
    check_quilt(&one, &base, &swatch);
    CHECK(one.report.join_count > 50);
    const uint32_t threads[2] = {2, 7};
    for (int i = 0; i < 2; i++) {
        MesoQuilt other = grow(&arena, &base, &swatch, threads[i]);
        CHECK(other.vertex_count == one.vertex_count && other.triangle_count == one.triangle_count);
        CHECK(memcmp(other.vertices, one.vertices, one.vertex_count * sizeof *one.vertices) == 0);
        CHECK(memcmp(other.corners, one.corners, 3 * one.triangle_count * sizeof *one.corners) == 0);
        CHECK(memcmp(other.patches, one.patches, one.triangle_count * sizeof *one.patches) == 0);
    }
    meso_triangulation_release(&base);
    meso_arena_release(&arena);
}

/* A limit on triangles is met. */
static void test_limit(void)
{
    MesoArena arena;
    MesoQuilt quilt;
    MesoError error;
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena, "wire", 0.08f, 5);
    MesoTriangulation base = meso_fixture_sheet(22, 22, 0.5f);
    MesoQuiltOptions options = {.scale = 1, .triangle_limit = 1000};
    CHECK(meso_quilt_grow(&quilt, &arena, &base, &swatch, &options, &error) == MESO_ERR_LIMIT);
    CHECK_TEXT(error.message, "the quilt has more than 1000 triangles");
    meso_triangulation_release(&base);
    meso_arena_release(&arena);
}

int main(void)
{
    test_periodic_strands();
    test_whole_elements();
    test_dense_strands();
    test_threads();
    test_limit();
    return 0;
}
