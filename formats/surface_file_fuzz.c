/* Any bytes as a surface and as triangles; the first one chooses the kind of file. */
#include "formats/surface_field.h"
#include "formats/surface_file.h"
#include "libcore/base/check.h"
#include "libcore/mesh/orientation.h"
#include "libcore/mesh/slot_graph.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const paths[] = {"a.obj", "a.ply", "a.off", "a.glb", "a"};
    if (size == 0)
        return 0;
    MesoArena arena;
    MesoInput input;
    MesoQuadMesh mesh;
    MesoSurfaceGroups groups;
    MesoSlotGraph graph;
    MesoTriangleMesh triangles;
    MesoError error;
    meso_arena_init(&arena);
    meso_input_wrap(&input, paths[data[0] % 5], data + 1, size - 1);
    if (meso_surface_read_groups(&mesh, &groups, &arena, &input, &error) == MESO_OK) {
        CHECK(groups.face_count == mesh.face_count);
        for (uint32_t k = 0; k < MESO_GROUP_KINDS; k++)
            for (uint32_t f = 0; f < mesh.face_count && groups.names[k].of_face; f++)
                CHECK(groups.names[k].of_face[f] < groups.names[k].count ||
                      groups.names[k].of_face[f] == MESO_NO_INDEX);
        CHECK(meso_slot_graph_build(&graph, &arena, &mesh, &error) == MESO_OK);
        uint32_t *component = MESO_NEW(&arena, uint32_t, mesh.face_count, &error);
        CHECK(component && meso_slot_graph_components(&graph, component) >= 1);
        MesoVec3 *directions;
        meso_surface_texture_read(&directions, &arena, &mesh, &input, &error);
        if (meso_surface_attribute_read(&directions, &arena, &mesh, &input, "n", &error) == MESO_OK) {
            uint8_t *quarters = MESO_NEW(&arena, uint8_t, mesh.face_count, &error);
            CHECK(quarters && meso_orientation_along(quarters, &mesh, directions) <= mesh.face_count);
        }
    }
    if (meso_triangle_mesh_read(&triangles, &arena, &input, &error) == MESO_OK)
        for (uint32_t i = 0; i < 3 * triangles.triangle_count; i++)
            CHECK(triangles.triangles[i] < triangles.vertex_count);
    meso_arena_release(&arena);
    return 0;
}
