#include "libcore/render/raster/shape_points.h"

#include <string.h>

uint64_t meso_shape_point_count(const MesoShapeMesh *mesh)
{
    return mesh->columns ? (uint64_t)mesh->columns->place_count * mesh->ring_count : mesh->vertex_count;
}

static void put_points(const MesoMeshVertex *vertices, const uint32_t *which, uint32_t count, float *x, float *y,
                       float *z)
{
    for (uint32_t k = 0; k < count; k++) {
        MesoVec3 p = vertices[which ? which[k] : k].position;
        x[k] = p.x;
        y[k] = p.y;
        z[k] = p.z;
    }
}

void meso_shape_points(const MesoShapeMesh *mesh, float *x, float *y, float *z, uint8_t *joined)
{
    const MesoShapeColumns *columns = mesh->columns;
    if (!columns) {
        put_points(mesh->vertices, NULL, mesh->vertex_count, x, y, z);
        memset(joined, 0, mesh->vertex_count);
        return;
    }
    uint32_t width = columns->place_count;
    if (mesh->placed) {
        size_t count = (size_t)width * mesh->ring_count;
        memcpy(x, mesh->points, count * sizeof *x);
        memcpy(y, mesh->points + mesh->point_room, count * sizeof *y);
        memcpy(z, mesh->points + 2 * (size_t)mesh->point_room, count * sizeof *z);
    }
    for (size_t r = 0, at = 0; r < mesh->ring_count; r++, at += width) {
        if (!mesh->placed)
            put_points(mesh->vertices + r * columns->count, columns->places, width, x + at, y + at, z + at);
        if (r + 1 < mesh->ring_count)
            memcpy(joined + at, columns->joined, width);
        else
            memset(joined + at, 0, width);
    }
}
