/* Quilts over other surfaces: moved ones of the same faces, finer ones of the same texture; and what is neither. */
#include "formats/quilt/quilt_move.h"

#include "formats/quilt/quilt_file_fixture.h"

static MesoArena arena;

/* Up along a slope that changes, so that nothing stays flat. */
static MesoVec3 bent(MesoVec3 p)
{
    return (MesoVec3){p.x, 0.9f * p.y, 0.2f * p.x * p.x + 0.1f * p.x * p.y};
}

static MesoVec3 *laid(const MesoQuilt *quilt, const MesoTriangulation *base)
{
    MesoError error;
    MesoVec3 *positions = MESO_NEW(&arena, MesoVec3, quilt->vertex_count, &error);
    CHECK(positions && meso_quilt_lay(positions, NULL, quilt, base, MESO_QUILT_PRISMS, 1, &error) == MESO_OK);
    return positions;
}

/* A sheet as a file would have it, with texture coordinates by its flat places; `width` numbers of each. */
static MesoPolygonMesh textured(const MesoTriangulation *sheet, uint32_t width)
{
    MesoError error;
    MesoPolygonMesh mesh = {.vertex_count = sheet->vertex_count, .face_count = sheet->triangle_count,
                            .corner_count = 3 * sheet->triangle_count, .side_count = 3, .attribute_count = width > 0};
    mesh.positions = MESO_NEW(&arena, MesoVec3, mesh.vertex_count, &error);
    mesh.corners = MESO_NEW(&arena, uint32_t, mesh.corner_count, &error);
    mesh.attributes = MESO_NEW(&arena, MesoAttribute, 1, &error);
    float *values = MESO_NEW(&arena, float, (size_t)width * mesh.vertex_count, &error);
    CHECK(mesh.positions && mesh.corners && mesh.attributes && values);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        MesoVec2 uv = quilt_file_fixture_uv(sheet->positions[v]);
        mesh.positions[v] = sheet->positions[v];
        for (uint32_t k = 0; k < width; k++)
            values[width * v + k] = k ? uv.y : uv.x;
    }
    memcpy(mesh.corners, sheet->corners, mesh.corner_count * sizeof *mesh.corners);
    mesh.attributes[0] = (MesoAttribute){.name = "uv", .domain = MESO_ON_VERTICES, .scalar = MESO_SCALAR_FLOAT,
                                         .width = width, .entry_count = mesh.vertex_count, .values = values};
    return mesh;
}

/* Laid over its base after that was bent, a quilt lies to the bit where it lies over a bent base that it is given. */
static void test_same_faces(void)
{
    MesoError error;
    uint32_t face;
    MesoQuiltFile file = quilt_file_fixture(&arena);
    MesoPolygonMesh mesh = quilt_file_fixture_surface(&arena);
    MesoTriangulation anew = meso_fixture_sheet(2, 1, 2);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        mesh.positions[v] = bent(mesh.positions[v]);
    for (uint32_t v = 0; v < anew.vertex_count; v++)
        anew.positions[v] = bent(anew.positions[v]);
    const MesoVec3 *flat = laid(&file.quilt, &file.base);
    CHECK(meso_quilt_move(&file, &arena, &mesh, &face, &error) == MESO_OK && face == MESO_NO_INDEX);
    const MesoVec3 *again = laid(&file.quilt, &file.base), *direct = laid(&file.quilt, &anew);
    CHECK(memcmp(again, direct, file.quilt.vertex_count * sizeof *again) == 0);
    CHECK(meso_vec3_length(meso_vec3_sub(again[15], flat[15])) > 0.1f);
    meso_triangulation_release(&anew);
    meso_triangulation_release(&file.base);
}

/* Over a finer sheet of the same texture a quilt lies where it lay, and over a bent one close to a bent base. */
static void test_same_texture(void)
{
    MesoError error;
    uint32_t face;
    MesoTriangulation fine = meso_fixture_sheet(40, 20, 0.1f), own;
    MesoPolygonMesh mesh = textured(&fine, 2);
    MesoQuiltFile file = quilt_file_fixture(&arena);
    own = file.base;
    const MesoVec3 *before = laid(&file.quilt, &file.base);
    CHECK(meso_quilt_move(&file, &arena, &mesh, &face, &error) == MESO_OK);
    CHECK(file.base.triangle_count == 1600);
    const MesoVec3 *after = laid(&file.quilt, &file.base);
    for (uint32_t v = 0; v < file.quilt.vertex_count; v++)
        CHECK(meso_vec3_length(meso_vec3_sub(after[v], before[v])) < 1e-5f);
    meso_triangulation_release(&own);
    meso_triangulation_release(&fine);
}

static void refuse(MesoQuiltFile *file, const MesoPolygonMesh *mesh, const char *message, uint32_t wanted)
{
    MesoError error;
    uint32_t face;
    CHECK(meso_quilt_move(file, &arena, mesh, &face, &error) == MESO_ERR_INPUT);
    CHECK(strncmp(error.message, message, strlen(message)) == 0);
    CHECK(face == wanted);
}

static void test_refused(void)
{
    MesoQuiltFile file = quilt_file_fixture(&arena);
    MesoTriangulation fine = meso_fixture_sheet(40, 20, 0.1f);
    MesoPolygonMesh same = quilt_file_fixture_surface(&arena), mesh = textured(&fine, 0), partly = textured(&fine, 2);
    refuse(&file, &mesh, "has no texture coordinates; nor is it the surface of the quilt, moved: it has 861 vertices; the",
           MESO_NO_INDEX);
    mesh = textured(&fine, 1);
    refuse(&file, &mesh, "has no texture coordinates; nor is it the surface of the quilt, moved: it has 861 vertices; the",
           MESO_NO_INDEX);
    ((float *)partly.attributes[0].values)[2 * partly.corners[3 * 17]] = NAN;
    uint32_t first = 0;
    while (partly.corners[first] != partly.corners[3 * 17])
        first++;
    refuse(&file, &partly, "has no texture coordinates here; nor is it", first / 3);

    file.base_uvs = NULL;       /* the quilt's own surface has none: only the same faces will do */
    refuse(&file, &mesh, "has 861 vertices; the surface of the quilt has 6", MESO_NO_INDEX);
    uint32_t turned = same.corners[0];
    same.corners[0] = same.corners[1];
    same.corners[1] = turned;
    refuse(&file, &same, "joins its vertices otherwise than the surface of the quilt does", MESO_NO_INDEX);
    same.face_count--;
    refuse(&file, &same, "has 3 faces; the surface of the quilt has 4", MESO_NO_INDEX);
    meso_triangulation_release(&fine);
    meso_triangulation_release(&file.base);
}

/* Of polygons the face is told, not the triangle that it was cut into. */
static void test_face_of_polygons(void)
{
    static const uint32_t corners[] = {0, 1, 4, 5, 3, 1, 2, 4};
    static const uint32_t begins[] = {0, 5, 8};
    static const float values[] = {0, 0, 0.5f, 0, 1, 0, 0, 0.5f, 0.5f, 0.5f, 0.25f, 0.5f};
    MesoError error;
    MesoQuiltFile file = quilt_file_fixture(&arena);
    MesoPolygonMesh mesh = {.vertex_count = 6, .face_count = 2, .corner_count = 8, .attribute_count = 1};
    mesh.positions = MESO_NEW(&arena, MesoVec3, 6, &error);
    mesh.corners = MESO_NEW(&arena, uint32_t, 8, &error);
    mesh.face_begin = MESO_NEW(&arena, uint32_t, 3, &error);
    mesh.attributes = MESO_NEW(&arena, MesoAttribute, 1, &error);
    float *copy = MESO_NEW(&arena, float, 12, &error);
    CHECK(mesh.positions && mesh.corners && mesh.face_begin && mesh.attributes && copy);
    memcpy(mesh.corners, corners, sizeof corners);
    memcpy(mesh.face_begin, begins, sizeof begins);
    memcpy(copy, values, sizeof values);
    copy[4] = NAN;              /* of vertex 2, which is of the second face alone */
    for (uint32_t v = 0; v < 6; v++)
        mesh.positions[v] = (MesoVec3){4 * values[2 * v], 4 * values[2 * v + 1], 0};
    mesh.attributes[0] = (MesoAttribute){.name = "uv", .domain = MESO_ON_VERTICES, .scalar = MESO_SCALAR_FLOAT,
                                         .width = 2, .entry_count = 6, .values = copy};
    refuse(&file, &mesh, "has no texture coordinates here; nor is it", 1);
    meso_triangulation_release(&file.base);
}

int main(void)
{
    meso_arena_init(&arena);
    test_same_faces();
    test_same_texture();
    test_refused();
    test_face_of_polygons();
    meso_arena_release(&arena);
    return 0;
}
