#include "libcore/mesh/point/vertex_normals.h"

#include <string.h>

static MesoVec3 area_vector(const MesoTriangulation *mesh, const uint32_t *corners)
{
    MesoVec3 a = mesh->positions[corners[0]];
    return meso_vec3_cross(meso_vec3_sub(mesh->positions[corners[1]], a), meso_vec3_sub(mesh->positions[corners[2]], a));
}

void meso_vertex_normals_add(MesoVec3 *sums, const MesoTriangulation *mesh, uint32_t triangle)
{
    const uint32_t *corners = &mesh->corners[3 * (size_t)triangle];
    MesoVec3 area = area_vector(mesh, corners);
    for (int k = 0; k < 3; k++)
        sums[corners[k]] = meso_vec3_add(sums[corners[k]], area);
}

void meso_vertex_normals(MesoVec3 *normals, const MesoTriangulation *mesh)
{
    memset(normals, 0, mesh->vertex_count * sizeof *normals);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        meso_vertex_normals_add(normals, mesh, t);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        normals[v] = meso_vec3_direction(normals[v], (MesoVec3){0, 0, 1});
}
