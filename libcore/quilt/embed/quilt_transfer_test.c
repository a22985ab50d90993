/* Quilts carried over by texture coordinates: to finer surfaces, also beyond borders; and what is refused. */
#include "libcore/quilt/embed/quilt_transfer.h"

#include <stdlib.h>

#include "libcore/quilt/embed/quilt_embed.h"
#include "libcore/quilt/embed/quilt_fixture.h"

static MesoArena arena;

/* Texture coordinates of a sheet of a width of 4 and a height of 2, which are not its places. */
static MesoVec2 *uvs_of(const MesoTriangulation *sheet)
{
    MesoError error;
    MesoVec2 *uvs = MESO_NEW(&arena, MesoVec2, 3 * (size_t)sheet->triangle_count, &error);
    CHECK(uvs);
    for (uint32_t c = 0; c < 3 * sheet->triangle_count; c++) {
        MesoVec3 p = sheet->positions[sheet->corners[c]];
        uvs[c] = (MesoVec2){0.1f + 0.2f * p.x + 0.05f * p.y, 0.3f * p.y - 0.02f * p.x};
    }
    return uvs;
}

static MesoVec3 *embedded(const MesoQuilt *quilt, const MesoTriangulation *base)
{
    MesoError error;
    MesoVec3 *directions = MESO_NEW(&arena, MesoVec3, base->vertex_count, &error);
    MesoVec3 *positions = MESO_NEW(&arena, MesoVec3, quilt->vertex_count, &error);
    CHECK(directions && positions);
    meso_quilt_directions(directions, base);
    meso_quilt_embed(positions, quilt, base, directions, 1);
    return positions;
}

/* Flat sheets have the quilt at one place, however fine they are; also vertices that lie beyond the border. */
static void test_finer(void)
{
    static const uint32_t across[] = {2, 3, 16, 101};
    for (size_t i = 0; i < sizeof across / sizeof *across; i++) {
        MesoError error;
        uint32_t fault;
        QuiltFixture f = quilt_fixture(&arena);
        f.quilt.vertices[0].b2 -= 0.4f;
        f.quilt.vertices[9].b1 += 1.5f;
        const MesoVec3 *before = embedded(&f.quilt, &f.base);
        MesoTriangulation fine = meso_fixture_sheet(2 * across[i], across[i], 2 / (float)across[i]);
        MesoTextureMesh from = {f.base.triangle_count, uvs_of(&f.base)}, to = {fine.triangle_count, uvs_of(&fine)};
        CHECK(meso_quilt_transfer(&f.quilt, &from, &to, &fault, &error) == MESO_OK && fault == MESO_NO_INDEX);
        const MesoVec3 *after = embedded(&f.quilt, &fine);
        for (uint32_t v = 0; v < f.quilt.vertex_count; v++) {
            CHECK(f.quilt.vertices[v].triangle < fine.triangle_count);
            CHECK(meso_vec3_length(meso_vec3_sub(after[v], before[v])) < 1e-4f);
        }
        meso_triangulation_release(&fine);
        meso_triangulation_release(&f.base);
    }
}

typedef struct Refusal {
    MesoVec2 *uvs;              /* of the finer sheet */
    uint32_t triangle_count;
    const char *begin;          /* of the message */
    bool about_triangle;
} Refusal;

static void expect(const MesoTextureMesh *from, const Refusal *refusal)
{
    MesoError error;
    uint32_t fault;
    QuiltFixture f = quilt_fixture(&arena);
    MesoTextureMesh to = {refusal->triangle_count, refusal->uvs};
    CHECK(meso_quilt_transfer(&f.quilt, from, &to, &fault, &error) == MESO_ERR_INPUT);
    CHECK(strncmp(error.message, refusal->begin, strlen(refusal->begin)) == 0);
    CHECK((fault != MESO_NO_INDEX) == refusal->about_triangle);
    meso_triangulation_release(&f.base);
}

static void test_refused(void)
{
    QuiltFixture f = quilt_fixture(&arena);
    MesoTriangulation fine = meso_fixture_sheet(14, 7, 2 / 7.0f);
    uint32_t n = fine.triangle_count;
    MesoTextureMesh from = {f.base.triangle_count, uvs_of(&f.base)};
    MesoVec2 *twice = uvs_of(&fine), *mirrored = uvs_of(&fine), *nowhere = uvs_of(&fine), *none = uvs_of(&fine);
    memcpy(twice + 3 * (n / 2), twice, 3 * (n / 2) * sizeof *twice);    /* one half over the other */
    for (uint32_t t = 0; t < n; t++) {
        MesoVec2 corner = mirrored[3 * t];
        mirrored[3 * t] = mirrored[3 * t + 1];
        mirrored[3 * t + 1] = corner;
    }
    for (uint32_t c = 0; c < 3 * n; c++) {
        nowhere[c].x += 2;
        none[c] = (MesoVec2){0.3f, 0.3f};
    }
    expect(&from, &(Refusal){twice, n, "has the same texture coordinates as another face", true});
    expect(&from, &(Refusal){mirrored, n, "is wound, in its texture coordinates, against", true});
    expect(&from, &(Refusal){nowhere, n, "no face has the texture coordinates", false});
    expect(&from, &(Refusal){none, n, "no face has the texture coordinates", false});
    expect(&from, &(Refusal){none, 0, "no face has the texture coordinates", false});
    meso_triangulation_release(&fine);
    meso_triangulation_release(&f.base);
}

/* Long triangles across many cells, and one that is far away: in time and memory that triangles alone ask for. */
static void test_long_triangles(void)
{
    enum { COUNT = 20000 };
    MesoError error;
    uint32_t fault;
    QuiltFixture f = quilt_fixture(&arena);
    MesoTextureMesh from = {f.base.triangle_count, uvs_of(&f.base)};
    MesoVec2 *uvs = MESO_NEW(&arena, MesoVec2, 3 * (COUNT + 1), &error);
    CHECK(uvs);
    for (uint32_t t = 0; t < COUNT; t++) {      /* a fan over all */
        float a = (float)t / COUNT, b = (float)(t + 1) / COUNT;
        uvs[3 * t] = (MesoVec2){-1, -1};
        uvs[3 * t + 1] = (MesoVec2){3, -1 + 8 * a};
        uvs[3 * t + 2] = (MesoVec2){3, -1 + 8 * b};
    }
    uvs[3 * COUNT] = uvs[3 * COUNT + 1] = (MesoVec2){1e30f, -1e30f};
    uvs[3 * COUNT + 2] = (MesoVec2){1e30f, 1e30f};
    MesoTextureMesh to = {COUNT + 1, uvs};
    CHECK(meso_quilt_transfer(&f.quilt, &from, &to, &fault, &error) == MESO_OK);
    for (uint32_t v = 0; v < f.quilt.vertex_count; v++)
        CHECK(isfinite(f.quilt.vertices[v].b1) && isfinite(f.quilt.vertices[v].b2));
    meso_triangulation_release(&f.base);
}

int main(void)
{
    meso_arena_init(&arena);
    test_finer();
    test_refused();
    test_long_triangles();
    meso_arena_release(&arena);
    return 0;
}
