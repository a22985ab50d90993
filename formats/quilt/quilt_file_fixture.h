/* A small quilt with its surface, for the tests and the fuzz entry of files of them. */
#ifndef MESO_QUILT_FILE_FIXTURE_H
#define MESO_QUILT_FILE_FIXTURE_H

#include "formats/quilt/quilt_file.h"
#include "libcore/quilt/embed/quilt_fixture.h"

/* The mesh of the base: four triangles. */
static inline MesoPolygonMesh quilt_file_fixture_surface(MesoArena *arena)
{
    MesoError error;
    MesoTriangulation sheet = meso_fixture_sheet(2, 1, 2);
    MesoPolygonMesh mesh = {.vertex_count = sheet.vertex_count, .face_count = sheet.triangle_count,
                            .corner_count = 3 * sheet.triangle_count, .side_count = 3};
    mesh.positions = MESO_NEW(arena, MesoVec3, mesh.vertex_count, &error);
    mesh.corners = MESO_NEW(arena, uint32_t, mesh.corner_count, &error);
    mesh.attributes = MESO_NEW(arena, MesoAttribute, 0, &error);
    CHECK(mesh.positions && mesh.corners && mesh.attributes);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        mesh.positions[sheet.origins[v]] = sheet.positions[v];
    for (uint32_t c = 0; c < mesh.corner_count; c++)
        mesh.corners[c] = sheet.origins[sheet.corners[c]];
    meso_triangulation_release(&sheet);
    return mesh;
}

static inline MesoVec2 quilt_file_fixture_uv(MesoVec3 place)
{
    return (MesoVec2){place.x / 4, place.y / 4};
}

static inline MesoQuiltFile quilt_file_fixture(MesoArena *arena)
{
    QuiltFixture f = quilt_fixture(arena);
    MesoPolygonMesh mesh = quilt_file_fixture_surface(arena);
    MesoError error;
    MesoVec2 *uvs = MESO_NEW(arena, MesoVec2, 3 * (size_t)f.base.triangle_count, &error);
    CHECK(uvs);
    for (uint32_t c = 0; c < 3 * f.base.triangle_count; c++)
        uvs[c] = quilt_file_fixture_uv(f.base.positions[f.base.corners[c]]);
    return (MesoQuiltFile){f.quilt, f.swatch, f.base, meso_surface_mark(&mesh), MESO_QUILT_CHARTS, uvs};
}

static inline MesoProvenance quilt_file_fixture_provenance(void)
{
    return (MesoProvenance){.tool = "meso-try", .command_line = "meso-try", .seed = 5};
}

#endif
