/* Normals are unit vectors whatever the scale of the surface, and +Z where there is no direction. */
#include "libcore/mesh/point/vertex_normals.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

static void test_scale(float size)
{
    MesoTriangulation mesh = meso_fixture_sheet(2, 1, 1);
    MesoVec3 normals[6];
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        mesh.positions[v] = (MesoVec3){size * mesh.positions[v].x, 0, -size * mesh.positions[v].y};
    meso_vertex_normals(normals, &mesh);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(fabsf(normals[v].y - (size > 0 ? 1 : 0)) < 1e-6f && fabsf(normals[v].z - (size > 0 ? 0 : 1)) < 1e-6f);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    const float sizes[] = {0, 1e-15f, 1e-11f, 1, 1e11f, 1e17f};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        test_scale(sizes[i]);
    return 0;
}
