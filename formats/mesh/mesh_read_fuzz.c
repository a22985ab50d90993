/* Any bytes as a surface and as triangles, on one thread and on several; the first one chooses the kind of file. */
#include <string.h>

#include "formats/mesh/mesh_read.h"
#include "formats/mesh/surface_field.h"
#include "libcore/base/check.h"
#include "libcore/mesh/orientation.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Every number of every attribute can be asked for. */
static void look_at(const MesoPolygonMesh *mesh)
{
    for (const MesoAttribute *a = mesh->attributes; a < mesh->attributes + mesh->attribute_count; a++) {
        for (uint32_t e = 0; e < meso_polygon_elements(mesh, a->domain); e++) {
            uint32_t entry = meso_attribute_entry(a, e);
            CHECK(entry < a->entry_count || entry == MESO_NO_INDEX);
            if (entry != MESO_NO_INDEX && a->width == 0)
                CHECK(a->names[entry]);
        }
        for (uint32_t e = 0; e < a->entry_count; e++)
            for (uint32_t c = 0; c < a->width; c++)
                (void)meso_attribute_number(a, e, c);
        for (uint32_t f = 0; f < mesh->face_count && a->width; f++)
            (void)meso_polygon_face_number(mesh, a, 0, f);
    }
}

/* The same mesh, or the same error. */
static void compare(MesoStatus status, const MesoPolygonMesh *mesh, const MesoError *error, const MesoInput *input)
{
    MesoArena arena;
    MesoPolygonMesh again;
    MesoError other;
    meso_arena_init(&arena);
    CHECK(meso_polygon_mesh_read(&again, &arena, input, 2, &other) == status);
    if (status) {
        CHECK(strcmp(error->message, other.message) == 0);
    } else {
        CHECK(again.vertex_count == mesh->vertex_count && again.corner_count == mesh->corner_count);
        CHECK(memcmp(again.positions, mesh->positions, mesh->vertex_count * sizeof *mesh->positions) == 0);
        CHECK(memcmp(again.corners, mesh->corners, mesh->corner_count * sizeof *mesh->corners) == 0);
    }
    meso_arena_release(&arena);
}

static void use_as_quads(MesoArena *arena, const MesoPolygonMesh *mesh, const MesoInput *input)
{
    MesoQuadSurface quads;
    MesoVec3 *directions;
    MesoError error;
    if (meso_quad_surface_make(&quads, arena, mesh, input, 1, &error))
        return;
    uint32_t *component = MESO_NEW(arena, uint32_t, mesh->face_count, &error);
    CHECK(component && meso_slot_graph_components(&quads.graph, component) >= 1);
    meso_surface_texture_field(&directions, arena, &quads, input, &error);
    if (meso_surface_attribute_field(&directions, arena, &quads, input, "n", &error) == MESO_OK) {
        uint8_t *quarters = MESO_NEW(arena, uint8_t, mesh->face_count, &error);
        CHECK(quarters && meso_orientation_along(quarters, &quads.mesh, directions) <= mesh->face_count);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const paths[] = {"a.obj", "a.ply", "a.off", "a.glb", "a.gltf", "a.drc", "a"};
    enum { PATH_COUNT = sizeof paths / sizeof *paths };
    if (size == 0)
        return 0;
    MesoArena arena;
    MesoInput input;
    MesoPolygonMesh mesh;
    MesoSurface surface;
    MesoTriangleMesh triangles;
    MesoError error;
    meso_arena_init(&arena);
    meso_input_wrap(&input, paths[data[0] % PATH_COUNT], data + 1, size - 1);
    MesoStatus status = meso_polygon_mesh_read(&mesh, &arena, &input, 1, &error);
    compare(status, &mesh, &error, &input);
    if (!status) {
        look_at(&mesh);
        use_as_quads(&arena, &mesh, &input);
        CHECK(meso_surface_build(&surface, &arena, &mesh, 1, &error) == MESO_OK);
        CHECK(meso_polygon_triangulate(&triangles, &arena, &mesh, &error) == MESO_OK);
        for (uint32_t i = 0; i < 3 * triangles.triangle_count; i++)
            CHECK(triangles.triangles[i] < triangles.vertex_count);
    }
    meso_arena_release(&arena);
    return 0;
}
