#include "libcore/mesh/cut/chain_samples.h"

#include <assert.h>

static double side_length(const MesoTriangulation *mesh, uint32_t half_edge)
{
    MesoVec3 a = mesh->positions[mesh->corners[half_edge]];
    MesoVec3 b = mesh->positions[mesh->corners[meso_next_corner(half_edge)]];
    return meso_vec3_length(meso_vec3_sub(a, b));
}

double meso_chain_length(const MesoTriangulation *mesh, const MesoEdgeChain *chain)
{
    double length = 0;
    for (uint32_t i = 0; i < chain->count; i++)
        length += side_length(mesh, chain->half_edges[i]);
    return length;
}

/* `share` of the way along the chain's side number `i`. */
static MesoMeshPoint point_of_side(const MesoTriangulation *mesh, const MesoEdgeChain *chain, uint32_t i, double share)
{
    const double at_end = 1e-5;     /* some tens of units in the last place of a float */
    uint32_t half_edge = chain->half_edges[i];
    MesoMeshPoint point = {half_edge / 3, {0, 0, 0}};
    if (mesh->corners[half_edge] != chain->vertices[i])
        share = 1 - share;
    share = share > at_end ? share < 1 - at_end ? share : 1 : 0;
    point.weight[half_edge % 3] = 1 - (float)share;
    point.weight[meso_next_corner(half_edge) % 3] = (float)share;
    return point;
}

void meso_chain_sample(const MesoTriangulation *mesh, const MesoEdgeChain *chain, uint32_t count, double offset,
                       bool ends, MesoMeshPoint *points)
{
    assert(chain->count > 0 && offset >= 0 && offset <= 1 && (!ends || (!chain->closed && count > 1)));
    double length = meso_chain_length(mesh, chain), step = length / (ends ? count - 1 : count);
    double first = ends ? 0 : offset * step, before = 0, side = side_length(mesh, chain->half_edges[0]);
    uint32_t i = 0;
    for (uint32_t n = 0; n < count; n++) {
        double at = first + n * step;
        while (at > before + side && i + 1 < chain->count) {
            before += side;
            side = side_length(mesh, chain->half_edges[++i]);
        }
        double share = side > 0 ? (at - before) / side : 0;
        points[n] = point_of_side(mesh, chain, i, share < 1 ? share : 1);
    }
}

uint32_t meso_chain_sample_count(double length, double spacing, uint32_t least)
{
    double count = floor(length / spacing + 0.5);
    if (!(count > least))
        return least;
    return count < UINT32_MAX / 2 ? (uint32_t)count : UINT32_MAX / 2;
}
