/* Ways to lie over a surface: continuous from triangle to triangle, stretched no more than told, on the surface at height 0. */
#include "libcore/quilt/embed/quilt_lay.h"

#include "libcore/base/random.h"
#include "libcore/quilt/embed/quilt_fixture.h"

static MesoArena arena;

static const float HIGH = 0.15f;

/* Over each side that has a neighbour, points of its edge and heights up to HIGH, told by both triangles: an element. */
static MesoQuilt edge_points(const MesoTriangulation *base)
{
    enum { HEIGHTS = 3 };
    MesoError error;
    MesoRandom random;
    MesoQuilt quilt = {.element_count = 1};
    size_t most = 2 * HEIGHTS * 3 * (size_t)base->triangle_count;
    quilt.vertices = MESO_NEW(&arena, MesoQuiltVertex, most, &error);
    quilt.vertex_begin = MESO_NEW(&arena, uint32_t, 2, &error);
    quilt.triangle_begin = MESO_NEW(&arena, uint32_t, 2, &error);
    CHECK(quilt.vertices && quilt.vertex_begin && quilt.triangle_begin);
    meso_random_init(&random, 3, 0);
    for (uint32_t h = 0; h < 3 * base->triangle_count; h++) {
        uint32_t twin = base->twins[h];
        float along = (float)meso_random_below(&random, 1001) / 1000;
        for (uint32_t i = 0; i < HEIGHTS && twin != MESO_NO_INDEX && h < twin; i++) {
            float height = HIGH * (float)i / (HEIGHTS - 1);
            for (uint32_t side = 0; side < 2; side++) {
                uint32_t at = side ? twin : h;
                float b[3] = {0, 0, 0};
                b[(at + 1) % 3] = side ? 1 - along : along;
                b[at % 3] = side ? along : 1 - along;
                quilt.vertices[quilt.vertex_count++] = (MesoQuiltVertex){at / 3, b[1], b[2], height};
            }
        }
    }
    quilt.vertex_begin[1] = quilt.vertex_count;
    return quilt;
}

static MesoVec3 *laid(const MesoQuilt *quilt, const MesoTriangulation *base, MesoQuiltEmbedding how, MesoQuiltLay *lay)
{
    MesoError error;
    MesoVec3 *positions = MESO_NEW(&arena, MesoVec3, quilt->vertex_count, &error);
    CHECK(positions && meso_quilt_lay(positions, lay, quilt, base, how, 2, &error) == MESO_OK);
    return positions;
}

static float apart(MesoVec3 a, MesoVec3 b)
{
    return meso_vec3_length(meso_vec3_sub(a, b));
}

/* A torus: both triangles at an edge put its points to one place, where charts meet too; height 0 is the surface. */
static void test_continuous(void)
{
    MesoTriangulation torus = meso_fixture_torus(32, 16, 0.4f);
    MesoQuilt quilt = edge_points(&torus);
    for (MesoQuiltEmbedding how = MESO_QUILT_PRISMS; how < MESO_QUILT_EMBEDDINGS; how++) {
        MesoQuiltLay lay;
        const MesoVec3 *x = laid(&quilt, &torus, how, &lay);
        for (uint32_t v = 0; v < quilt.vertex_count; v += 2)
            CHECK(apart(x[v], x[v + 1]) < 2e-5f);
        for (uint32_t v = 0; v < quilt.vertex_count; v += 6) {
            float r = sqrtf(x[v].x * x[v].x + x[v].y * x[v].y) - 1, tube = sqrtf(r * r + x[v].z * x[v].z);
            CHECK(tube < 0.41f && tube > 0.38f);         /* sides cut the circles */
            CHECK(apart(x[v], x[v + 4]) > 0.9f * HIGH && apart(x[v], x[v + 4]) < 1.1f * HIGH);
        }
        CHECK(lay.layer.inverted_count == 0 && lay.layer.stretch_after >= 1);
        CHECK(how == MESO_QUILT_NORMALS ? lay.layer.stretch_after == lay.layer.stretch_before
                                        : lay.layer.stretch_after <= lay.layer.stretch_before);
        CHECK(how == MESO_QUILT_CHARTS ? lay.chart_count > 1 && lay.seam_count == 1 && lay.area_ratio >= 1
                                       : lay.chart_count == 0 && lay.seam_count == 0);
    }
    meso_triangulation_release(&torus);
}

/* On a flat surface all are the same; beyond its border, and with an element in one chart, too. */
static void test_flat(void)
{
    QuiltFixture f = quilt_fixture(&arena);
    f.quilt.vertices[0].b2 = -0.25f;
    const MesoVec3 *prisms = laid(&f.quilt, &f.base, MESO_QUILT_PRISMS, NULL);
    for (MesoQuiltEmbedding how = MESO_QUILT_NORMALS; how < MESO_QUILT_EMBEDDINGS; how++) {
        MesoQuiltLay lay;
        const MesoVec3 *x = laid(&f.quilt, &f.base, how, &lay);
        for (uint32_t v = 0; v < f.quilt.vertex_count; v++)
            CHECK(apart(x[v], prisms[v]) < 1e-5f);
        CHECK(lay.layer.stretch_after > 0.99999 && lay.layer.stretch_after < 1.00001);
    }
    meso_triangulation_release(&f.base);
}

/* Without heights there is nothing that charts could map; wound against each other there is no layer. */
static void test_no_layer(void)
{
    MesoQuiltLay lay;
    QuiltFixture f = quilt_fixture(&arena);
    const MesoVec3 *prisms = laid(&f.quilt, &f.base, MESO_QUILT_PRISMS, NULL);
    uint32_t corner = f.base.corners[0];
    f.base.corners[0] = f.base.corners[1];
    f.base.corners[1] = corner;
    laid(&f.quilt, &f.base, MESO_QUILT_CHARTS, &lay);
    CHECK(lay.layer.stretch_after == 0 && lay.chart_count == 0);
    f.base.corners[1] = f.base.corners[0];
    f.base.corners[0] = corner;
    for (uint32_t v = 0; v < f.quilt.vertex_count; v++)
        f.quilt.vertices[v].height = 0;
    const MesoVec3 *flat = laid(&f.quilt, &f.base, MESO_QUILT_CHARTS, &lay);
    CHECK(lay.chart_count == 0);
    for (uint32_t v = 0; v < f.quilt.vertex_count; v++)
        CHECK(flat[v].z == 0 && fabsf(flat[v].x - prisms[v].x) < 1e-6f);
    meso_triangulation_release(&f.base);
}

static void test_names(void)
{
    CHECK(meso_quilt_embedding_named("prisms") == MESO_QUILT_PRISMS);
    CHECK(meso_quilt_embedding_named("normals") == MESO_QUILT_NORMALS);
    CHECK(meso_quilt_embedding_named("charts") == MESO_QUILT_CHARTS);
}

int main(void)
{
    meso_arena_init(&arena);
    test_continuous();
    test_flat();
    test_no_layer();
    test_names();
    meso_arena_release(&arena);
    return 0;
}
