/*
 * Half-edges: the sides of faces, joined across the edges that they share.
 * Half-edge h runs along its face from corner h to the face's next corner, so
 * that of a mesh of quads half-edge 4 f + k is side k of face f.
 */
#ifndef MESO_HALF_EDGES_H
#define MESO_HALF_EDGES_H

#include "libcore/mesh/polygon_mesh.h"

typedef struct MesoHalfEdges {
    uint32_t edge_count;        /* borders included */
    uint32_t border_count;      /* edges with one face */
    uint32_t reversed_count;    /* edges whose two faces run along them the same way */
    uint32_t crowded_count;     /* edges with three faces or more; their half-edges have no twin */
    uint32_t crowded[3];        /* half-edges of the first of them, ascending, where there is one */
    uint32_t *twin;             /* [corner_count] half-edge across, or MESO_NO_INDEX */
} MesoHalfEdges;

/*
 * Joins the half-edges of a checked mesh; of its arrays only the corners are read. They are sorted into lists by
 * their lower vertex, which `twin` itself holds. The first of the crowded edges is that of the lowest vertex whose
 * third half-edge comes first. Linear time; scratch of a word a vertex, and a bit a corner where faces have
 * different numbers of sides. On `thread_count` threads (0: all cores), the same for any number of them.
 * MESO_ERR_MEMORY alone.
 */
MesoStatus meso_half_edges_join(MesoHalfEdges *joined, MesoArena *arena, const MesoPolygonMesh *mesh,
                                uint32_t thread_count, MesoError *error);

/* MESO_ERR_INPUT with the first edge that joins more than two faces, and these, where there is one. */
MesoStatus meso_half_edges_require_manifold(const MesoHalfEdges *joined, const MesoPolygonMesh *mesh, MesoError *error);

#endif
