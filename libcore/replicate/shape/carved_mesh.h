/*
 * A surface that details are carved into: a copy of its triangulation at rest that is finer around them, so that it can
 * go up there, or have a hole. It is made finer by bisection of longest edges ("New longest-edge algorithms for the
 * refinement and/or improvement of unstructured triangulations", Rivara 1997): no angle becomes less than half of the
 * least one there was.
 *
 * Details are carved one after another, by the shape at rest alone, and what was carved stays: so the mesh is a
 * function of which they are and of their order, whenever they came.
 */
#ifndef MESO_CARVED_MESH_H
#define MESO_CARVED_MESH_H

#include "libcore/replicate/detail/surface_detail.h"

/* A triangle of it. */
typedef struct MesoCarvedTriangle {
    uint32_t corners[3], twins[3];  /* as in a triangulation; twins count half-edges */
    uint32_t root;                  /* the triangle at rest that it is part of */
    float weights[3][2];            /* of its corners: those of the root's second and third corner */
    uint32_t hole;                  /* that has taken it; MESO_NO_INDEX: none */
} MesoCarvedTriangle;

typedef struct MesoCarvedVertex {
    MesoMeshPoint point;            /* of the surface at rest */
    MesoVec3 rest;                  /* its place there */
    uint32_t rim;                   /* of the hole of this detail; MESO_NO_INDEX: of none */
} MesoCarvedVertex;

typedef struct MesoCarvedMesh {
    const MesoTriangulation *mesh;  /* at rest */
    uint32_t vertex_count, vertex_room, triangle_count, triangle_room;
    MesoCarvedVertex *vertices;     /* [vertex_count] those of the surface come first */
    MesoCarvedTriangle *triangles;  /* [triangle_count] */
    uint32_t *stamps;               /* [triangle_room] for searches */
    uint32_t stamp;
    uint32_t *queue;                /* [queue_room] of a search */
    uint32_t queue_room;
    uint32_t carved_count;          /* details that were carved so far */
    uint32_t uncut_count;           /* holes among them that were not cut */
} MesoCarvedMesh;

typedef enum MesoCarving {
    MESO_CARVE_NOTHING, MESO_CARVE_BUMP, MESO_CARVE_HOLE
} MesoCarving;

/* Owns its arrays. MESO_ERR_LIMIT, MESO_ERR_MEMORY. O(triangles). */
MesoStatus meso_carved_init(MesoCarvedMesh *carved, const MesoTriangulation *mesh, MesoError *error);
void meso_carved_release(MesoCarvedMesh *carved);

/*
 * Carves the next detail. A hole is not cut where it would meet a border or another hole; it is no hole then.
 *
 * fineness  edges under a bump are as long as this share of its size, at most
 *
 * O(triangles under it). MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_carve(MesoCarvedMesh *carved, const MesoDetail *detail, MesoCarving carving, float fineness,
                      MesoError *error);

/*
 * Checks that twins are mutual and join the same vertices, that no triangle has a vertex twice, and that each lies in
 * its root. MESO_ERR_INTERNAL with the first place that fails. For tests. O(triangles).
 */
MesoStatus meso_carved_check(const MesoCarvedMesh *carved, MesoError *error);

#endif
