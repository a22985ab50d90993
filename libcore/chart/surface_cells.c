#include "libcore/chart/surface_cells.h"

#include "libcore/chart/key_heap.h"

static double centroid_distance(const MesoTriangulation *mesh, uint32_t s, uint32_t t)
{
    double x = 0, y = 0, z = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 a = mesh->positions[mesh->corners[3 * (size_t)s + k]];
        MesoVec3 b = mesh->positions[mesh->corners[3 * (size_t)t + k]];
        x += (double)a.x - b.x, y += (double)a.y - b.y, z += (double)a.z - b.z;
    }
    return sqrt(x * x + y * y + z * z) / 3;
}

/* Takes over what is nearer to the new centre than to all before: no more is walked. */
static MesoStatus add_centre(MesoSurfaceCells *cells, MesoArena *arena, MesoKeyHeap *heap,
                             const MesoTriangulation *mesh, uint32_t centre, MesoError *error)
{
    cells->centres = MESO_GROW(arena, cells->centres, cells->count, cells->room, 64, error);
    if (!cells->centres)
        return MESO_ERR_MEMORY;
    uint32_t cell = cells->count++;
    cells->centres[cell] = centre;
    cells->cells[centre] = cell;
    cells->distances[centre] = 0;
    MesoStatus status = meso_heap_push(heap, arena, 0, centre, error);
    while (!status && heap->count) {
        MesoHeapEntry next = meso_heap_pop(heap);
        if (next.key > cells->distances[next.item])
            continue;
        for (uint32_t h = 3 * next.item; h < 3 * next.item + 3 && !status; h++) {
            if (mesh->twins[h] == MESO_NO_INDEX)
                continue;
            uint32_t t = mesh->twins[h] / 3;
            double distance = next.key + centroid_distance(mesh, next.item, t);
            if (!(distance < cells->distances[t]))
                continue;
            cells->distances[t] = distance;
            cells->cells[t] = cell;
            status = meso_heap_push(heap, arena, distance, t, error);
        }
    }
    return status;
}

/* By its first corner: of a piece of a sheet, this is in the middle. */
static uint32_t middle_triangle(const MesoTriangulation *mesh)
{
    double mean[3] = {0, 0, 0}, nearest = INFINITY;
    uint32_t middle = 0;
    for (uint32_t c = 0; c < 3 * mesh->triangle_count; c++) {
        MesoVec3 p = mesh->positions[mesh->corners[c]];
        mean[0] += p.x, mean[1] += p.y, mean[2] += p.z;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        MesoVec3 p = mesh->positions[mesh->corners[3 * (size_t)t]];
        double x = p.x - mean[0] / (3.0 * mesh->triangle_count), y = p.y - mean[1] / (3.0 * mesh->triangle_count);
        double z = p.z - mean[2] / (3.0 * mesh->triangle_count), distance = x * x + y * y + z * z;
        middle = distance < nearest ? t : middle;
        nearest = fmin(nearest, distance);
    }
    return middle;
}

static uint32_t farthest_triangle(const MesoSurfaceCells *cells, uint32_t triangle_count)
{
    uint32_t farthest = 0;
    for (uint32_t t = 1; t < triangle_count; t++)
        farthest = cells->distances[t] > cells->distances[farthest] ? t : farthest;
    return farthest;
}

MesoStatus meso_surface_cells(MesoSurfaceCells *cells, MesoArena *arena, const MesoTriangulation *mesh, double radius,
                              MesoError *error)
{
    uint32_t n = mesh->triangle_count;
    MesoKeyHeap heap = {0};
    *cells = (MesoSurfaceCells){.cells = MESO_NEW(arena, uint32_t, n, error),
                                .distances = MESO_NEW(arena, double, n, error)};
    if (!cells->cells || !cells->distances)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < n; t++)
        cells->distances[t] = INFINITY;
    MesoStatus status = MESO_OK;
    for (uint32_t next = middle_triangle(mesh); n && !status; next = farthest_triangle(cells, n)) {
        if (cells->count && !(cells->distances[next] > radius))
            break;
        status = add_centre(cells, arena, &heap, mesh, next, error);
    }
    return status;
}
