/*
 * Where the nodes of lines come to stand on a triangulation: what of them
 * becomes vertices that are there, points along edges, and points inside
 * triangles, once those too near to each other are one.
 */
#ifndef MESO_CUT_NODES_H
#define MESO_CUT_NODES_H

#include "libcore/mesh/cut/cut_lines.h"

/* Of a node. On an edge: number in `shares` below; inside: x and y are the weights of the second and third corner. */
typedef struct MesoCutPlace {
    MesoNodeKind kind;
    uint32_t element;
    int32_t x, y;
} MesoCutPlace;

/* An edge that has nodes. */
typedef struct MesoCutEdge {
    uint32_t half_edge;     /* the lower-numbered of the two */
    uint32_t first, count;  /* of `shares` */
} MesoCutEdge;

typedef struct MesoCutNodes {
    MesoCutPlace *places;   /* [node_count] */
    uint32_t edge_count, share_count;
    MesoCutEdge *edges;     /* [edge_count] half-edges ascend */
    int32_t *shares;        /* [share_count] of the way along the half-edge, as whole numbers; ascend along each edge */
} MesoCutNodes;

/* MESO_ERR_INTERNAL where a node has no place on the mesh, MESO_ERR_MEMORY. */
MesoStatus meso_cut_nodes_place(MesoCutNodes *placed, const MesoTriangulation *mesh, const MesoCutLines *lines,
                                MesoArena *arena, MesoError *error);

/* The lower-numbered half-edge of an edge. */
static inline uint32_t meso_cut_lower(const MesoTriangulation *mesh, uint32_t half_edge)
{
    uint32_t twin = mesh->twins[half_edge];     /* MESO_NO_INDEX is the highest number */
    return twin < half_edge ? twin : half_edge;
}

/* Whether half-edge `across` of an edge runs against `half_edge`, as it does where windings agree. */
static inline bool meso_cut_runs_against(const MesoTriangulation *mesh, uint32_t half_edge, uint32_t across)
{
    return half_edge != across && mesh->corners[half_edge] != mesh->corners[across];
}

#endif
