/* Points along chains of edges, at equal distances along them: where lines start, and seeds lie. */
#ifndef MESO_CHAIN_SAMPLES_H
#define MESO_CHAIN_SAMPLES_H

#include "libcore/mesh/cut/triangulation.h"

/* Sides one after another, as of a loop of border_loops.h or a stretch of it. */
typedef struct MesoEdgeChain {
    uint32_t count;
    bool closed;
    const uint32_t *half_edges;     /* [count] */
    const uint32_t *vertices;       /* [count] at which each begins */
} MesoEdgeChain;

double meso_chain_length(const MesoTriangulation *mesh, const MesoEdgeChain *chain);

/*
 * Points at equal distances along a chain: of a closed one, and of an open one without its ends, point i lies at
 * (i + offset) / count of the length; with `ends`, which is for open chains of two points or more, at i / (count - 1).
 *
 * offset  from 0 to 1
 * points  [count] in the triangles of the chain's half-edges, ascending along the chain
 *
 * A point is exactly on its side: the weight of the corner across is 0. One nearer to an end of its side than 1e-5 of
 * the side's length is at that vertex. Sides of no length are passed over. O(sides + count).
 */
void meso_chain_sample(const MesoTriangulation *mesh, const MesoEdgeChain *chain, uint32_t count, double offset,
                       bool ends, MesoMeshPoint *points);

/* The number of points, at least `least`, whose distances are as near to `spacing` as can be; spacing > 0. */
uint32_t meso_chain_sample_count(double length, double spacing, uint32_t least);

#endif
