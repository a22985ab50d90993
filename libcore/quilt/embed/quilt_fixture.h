/* A small quilt for tests: two cubes over a sheet, with a swatch of one cube whose top is of another material. */
#ifndef MESO_QUILT_FIXTURE_H
#define MESO_QUILT_FIXTURE_H

#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/quilt.h"

typedef struct QuiltFixture {
    MesoTriangulation base;     /* 2 x 1 squares of side 2 */
    MesoSwatch swatch;
    MesoQuilt quilt;
} QuiltFixture;

/* The cube of side 1 whose lowest corner is the origin; the last two triangles are its top. */
static inline MesoSwatch quilt_fixture_swatch(MesoArena *arena)
{
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {0, 1, 5, 4}, {1, 3, 7, 5},
                                         {3, 2, 6, 7}, {2, 0, 4, 6}, {4, 5, 7, 6}};
    static const float uvs[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    MesoError error;
    MesoSwatch swatch;
    MesoPolygonMesh mesh = {.vertex_count = 8, .face_count = 6, .corner_count = 24, .side_count = 4};
    mesh.attribute_count = 2;
    mesh.positions = MESO_NEW(arena, MesoVec3, 8, &error);
    mesh.corners = MESO_NEW(arena, uint32_t, 24, &error);
    mesh.attributes = MESO_NEW(arena, MesoAttribute, 2, &error);
    uint32_t *materials = MESO_NEW(arena, uint32_t, 6, &error);
    float *coordinates = MESO_NEW(arena, float, 48, &error);
    const char **names = MESO_NEW(arena, const char *, 2, &error);
    CHECK(mesh.positions && mesh.corners && mesh.attributes && materials && coordinates && names);
    for (uint32_t v = 0; v < 8; v++)
        mesh.positions[v] = (MesoVec3){(float)(v & 1), (float)(v >> 1 & 1), (float)(v >> 2)};
    for (uint32_t c = 0; c < 24; c++) {
        mesh.corners[c] = quads[c / 4][c % 4];
        coordinates[2 * c] = uvs[c % 4][0];
        coordinates[2 * c + 1] = uvs[c % 4][1];
    }
    materials[5] = 1;
    names[0] = "stone";
    names[1] = "gold";
    mesh.attributes[0] = (MesoAttribute){.name = "material", .domain = MESO_ON_FACES, .entry_count = 2, .names = names,
                                         .entry_of = materials};
    mesh.attributes[1] = (MesoAttribute){.name = "uv", .domain = MESO_ON_CORNERS, .scalar = MESO_SCALAR_FLOAT,
                                         .width = 2, .entry_count = 24, .values = coordinates};
    CHECK(meso_swatch_build(&swatch, arena, &mesh, &(MesoSwatchOptions){.up = 2}, &error) == MESO_OK);
    CHECK(swatch.triangle_count == 12 && swatch.element_count == 1 && swatch.material_count == 2);
    return swatch;
}

/* Copy `e` of the swatch stands in the middle of square e of the sheet, whose diagonal it crosses; heights are half. */
static inline void quilt_fixture_copy(QuiltFixture *f, uint32_t e)
{
    const uint32_t vertices = f->swatch.vertex_count, triangles = f->swatch.triangle_count;
    for (uint32_t v = 0; v < vertices; v++) {
        MesoVec3 p = f->swatch.positions[v];
        float x = (p.x + 0.5f) / 2, y = (p.y + 0.5f) / 2;
        f->quilt.vertices[e * vertices + v] = y <= x ? (MesoQuiltVertex){2 * e, x - y, y, p.z / 2}
                                                     : (MesoQuiltVertex){2 * e + 1, x, y - x, p.z / 2};
        f->quilt.origins[e * vertices + v] = v;
    }
    for (uint32_t t = 0; t < triangles; t++) {
        for (uint32_t c = 3 * t; c < 3 * t + 3; c++)
            f->quilt.corners[3 * e * triangles + c] = f->swatch.corners[c] + e * vertices;
        f->quilt.triangle_origins[e * triangles + t] = t;
        f->quilt.patches[e * triangles + t] = e;
    }
    f->quilt.vertex_begin[e + 1] = (e + 1) * vertices;
    f->quilt.triangle_begin[e + 1] = (e + 1) * triangles;
}

static inline QuiltFixture quilt_fixture(MesoArena *arena)
{
    MesoError error;
    QuiltFixture f = {.base = meso_fixture_sheet(2, 1, 2), .swatch = quilt_fixture_swatch(arena)};
    MesoQuilt *q = &f.quilt;
    q->element_count = 2;
    q->vertex_count = 2 * f.swatch.vertex_count;
    q->triangle_count = 2 * f.swatch.triangle_count;
    q->vertices = MESO_NEW(arena, MesoQuiltVertex, q->vertex_count, &error);
    q->origins = MESO_NEW(arena, uint32_t, q->vertex_count, &error);
    q->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)q->triangle_count, &error);
    q->triangle_origins = MESO_NEW(arena, uint32_t, q->triangle_count, &error);
    q->patches = MESO_NEW(arena, uint32_t, q->triangle_count, &error);
    q->vertex_begin = MESO_NEW(arena, uint32_t, 3, &error);
    q->triangle_begin = MESO_NEW(arena, uint32_t, 3, &error);
    q->element_origins = MESO_NEW(arena, uint32_t, 2, &error);
    CHECK(q->vertices && q->origins && q->corners && q->triangle_origins && q->patches && q->vertex_begin &&
          q->triangle_begin && q->element_origins);
    quilt_fixture_copy(&f, 0);
    quilt_fixture_copy(&f, 1);
    return f;
}

#endif
