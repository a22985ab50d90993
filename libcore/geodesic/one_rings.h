/*
 * The vertices around each vertex of a triangulation, in order: 28 bytes a
 * vertex, in one pool, in which rings that have grown move to the end.
 */
#ifndef MESO_ONE_RINGS_H
#define MESO_ONE_RINGS_H

#include "libcore/mesh/cut/triangulation.h"

/* Spokes that may be read beyond the end of any ring: what a vector takes in at once. */
enum { MESO_RING_SLACK = 8, MESO_RING_LONG = 127 };

typedef struct MesoOneRings {
    uint32_t vertex_room, pool_count, pool_room, lost;  /* lost: spokes in the pool that no ring has */
    uint32_t *begins;   /* [vertex_room] where a ring begins in the pool */
    uint8_t *sizes;     /* [vertex_room] spokes; bit 7: closed. MESO_RING_LONG: the number stands before the ring */
    uint32_t *pool;     /* [pool_room] vertices; what is behind the last ring is 0 */
} MesoOneRings;

typedef struct MesoOneRing {
    const uint32_t *spokes;
    uint32_t count;
    bool closed;        /* else the last spoke and the first are sides of borders */
} MesoOneRing;

static inline MesoOneRing meso_one_ring(const MesoOneRings *rings, uint32_t vertex)
{
    uint8_t size = rings->sizes[vertex];
    MesoOneRing ring = {rings->pool + rings->begins[vertex], size & 127u, size >> 7};
    if (ring.count == MESO_RING_LONG)
        ring.count = ring.spokes[-1];
    return ring;
}

/* Rings of all vertices of a mesh. O(corners). MESO_ERR_LIMIT, MESO_ERR_MEMORY. */
MesoStatus meso_one_rings_init(MesoOneRings *rings, const MesoTriangulation *mesh, MesoError *error);

void meso_one_rings_release(MesoOneRings *rings);

/* Room for so many vertices; the new ones have no ring yet. MESO_ERR_MEMORY. */
MesoStatus meso_one_rings_reserve(MesoOneRings *rings, uint32_t vertex_count, MesoError *error);

/*
 * Makes the ring of one vertex again, where it was if it fits. Amortised O(its triangles). MESO_ERR_LIMIT,
 * MESO_ERR_MEMORY: all rings are as before.
 */
MesoStatus meso_one_rings_remake(MesoOneRings *rings, const MesoTriangulation *mesh, uint32_t vertex, MesoError *error);

#endif
