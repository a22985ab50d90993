/* Webs: walking around nodes, and changes of how they are joined. */
#ifndef MESO_WEB_EDIT_H
#define MESO_WEB_EDIT_H

#include "libcore/replicate/web/web.h"

/* Node of a half-edge's triangle that is not on it. */
static inline uint32_t meso_web_apex(const MesoWeb *web, uint32_t h)
{
    return web->corners[meso_previous_corner(h)];
}

/* A walk over the half-edges that begin at a node; at a border, back to the first and on to the other side. */
typedef struct MesoSpokes {
    uint32_t first, now;
    bool back;      /* clockwise of the first */
    bool last;      /* beyond it is a border, on the left: the node before it is a neighbour of its own */
} MesoSpokes;

static inline MesoSpokes meso_spokes(const MesoWeb *web, uint32_t node)
{
    uint32_t h = web->node_corner[node];
    return (MesoSpokes){h, h, false, h != MESO_NO_INDEX && web->twins[meso_previous_corner(h)] == MESO_NO_INDEX};
}

/* Goes on; false behind the last. */
bool meso_spokes_next(const MesoWeb *web, MesoSpokes *spokes);

bool meso_web_joined(const MesoWeb *web, uint32_t a, uint32_t b);

/* Whether both sides are triangles of four nodes, of which the two apexes are not joined. */
bool meso_web_can_flip(const MesoWeb *web, uint32_t h);

/*
 * From a - b, h beginning at a, to c - d between the apexes of h and its twin g. Then h: a - d, next: d - c, previous:
 * c - a, and g: b - c, next: c - d, previous: d - b.
 */
void meso_web_flip(MesoWeb *web, uint32_t h);

/* Triangle (a, b, c) becomes (a, b, node), and behind the last (b, c, node) and (c, a, node). Room is there. */
void meso_web_split(MesoWeb *web, uint32_t triangle, uint32_t node);

/*
 * Takes a node out that no border goes through: what is joined to it is joined to `into`, beside it, instead. Two
 * triangles go; the last ones get their numbers. False, and nothing is done, where two nodes would be joined twice, or
 * a triangle would turn over. O(degree^2).
 */
bool meso_web_merge(MesoWeb *web, uint32_t node, uint32_t into);

MesoStatus meso_web_reserve(MesoWeb *web, uint64_t node_count, uint64_t triangle_count, MesoError *error);

static inline void meso_web_pair(MesoWeb *web, uint32_t h, uint32_t twin)
{
    web->twins[h] = twin;
    if (twin != MESO_NO_INDEX)
        web->twins[twin] = h;
}

#endif
