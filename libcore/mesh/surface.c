#include "libcore/mesh/surface.h"

#include <math.h>

#include "libcore/base/parallel.h"

/* ---- lengths ---- */

enum { LENGTH_GRAIN = 1 << 16 };

/* No more of them than there are blocks of faces in a mesh that is as large as it may be. */
enum { MOST_SUMS = (uint32_t)-1 / LENGTH_GRAIN / 3 + 1 };

typedef struct Lengths {
    const MesoPolygonMesh *mesh;
    double *sums;               /* [blocks of LENGTH_GRAIN faces] */
} Lengths;

static double length_between(MesoVec3 a, MesoVec3 b)
{
    double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z;
    return sqrt(x * x + y * y + z * z);
}

static void sum_lengths(void *context, uint64_t begin, uint64_t end)
{
    const Lengths *lengths = context;
    const MesoPolygonMesh *mesh = lengths->mesh;
    double sum = 0;
    for (uint32_t f = (uint32_t)begin; f < end; f++) {
        uint32_t sides = meso_polygon_sides(mesh, f);
        const uint32_t *v = mesh->corners + meso_polygon_begin(mesh, f);
        for (uint32_t i = 0; i < sides; i++)
            sum += length_between(mesh->positions[v[i]], mesh->positions[v[i + 1 < sides ? i + 1 : 0]]);
    }
    lengths->sums[begin / LENGTH_GRAIN] = sum;
}

double meso_polygon_mean_edge(const MesoPolygonMesh *mesh, uint32_t thread_count)
{
    static const uint32_t grain = LENGTH_GRAIN;
    double sums[MOST_SUMS], sum = 0;
    Lengths lengths = {mesh, sums};
    meso_parallel_for(thread_count, mesh->face_count, grain, sum_lengths, &lengths);
    for (uint32_t b = 0; b < (mesh->face_count + (uint64_t)grain - 1) / grain; b++)
        sum += sums[b];
    return sum / mesh->corner_count;
}

/* ---- surfaces ---- */

MesoStatus meso_surface_build(MesoSurface *surface, MesoArena *arena, const MesoPolygonMesh *mesh,
                              uint32_t thread_count, MesoError *error)
{
    *surface = (MesoSurface){.mesh = *mesh};
    surface->mean_edge_length = (float)meso_polygon_mean_edge(mesh, thread_count);
    return meso_half_edges_join(&surface->edges, arena, mesh, thread_count, error);
}

static MesoStatus require_sides(const MesoPolygonMesh *mesh, uint32_t wanted, const char *what, uint32_t *face,
                                MesoError *error)
{
    for (uint32_t f = 0; mesh->side_count != wanted && f < mesh->face_count; f++) {
        uint32_t sides = meso_polygon_sides(mesh, f);
        if (sides == wanted)
            continue;
        *face = f;
        return meso_fail(error, MESO_ERR_INPUT, "face %u has %u sides; %s", f + 1, sides, what);
    }
    return MESO_OK;
}

/* Of the half-edges whose twin runs the same way, the first. */
static MesoStatus require_oriented(const MesoSurface *surface, uint32_t *face, MesoError *error)
{
    const uint32_t *twin = surface->edges.twin, *corners = surface->mesh.corners;
    uint32_t h = 0;
    if (surface->edges.reversed_count == 0)
        return MESO_OK;
    while (twin[h] == MESO_NO_INDEX || corners[h] != corners[twin[h]])
        h++;
    *face = meso_polygon_face(&surface->mesh, h);
    return meso_fail(error, MESO_ERR_INPUT, "face %u is wound against its neighbour, face %u", *face + 1,
                     meso_polygon_face(&surface->mesh, twin[h]) + 1);
}

MesoStatus meso_surface_require(const MesoSurface *surface, unsigned needs, uint32_t *face, MesoError *error)
{
    uint32_t ignored;
    MesoStatus status = MESO_OK;
    if (!face)
        face = &ignored;
    *face = MESO_NO_INDEX;
    if (needs & MESO_NEEDS_QUADS)
        status = require_sides(&surface->mesh, 4,
                               "every face of a macrosurface must be a quad: meso-mesh quads makes them", face, error);
    if (!status && needs & MESO_NEEDS_TRIANGLES)
        status = require_sides(&surface->mesh, 3, "every face must be a triangle", face, error);
    if (!status && needs & MESO_NEEDS_MANIFOLD)
        status = meso_half_edges_require_manifold(&surface->edges, &surface->mesh, error);
    if (!status && needs & MESO_NEEDS_ORIENTED)
        status = require_oriented(surface, face, error);
    return status;
}
