/*
 * Surface: a polygon mesh with its adjacency, built once. What every method
 * starts from; quads or triangles is what a method asks of it.
 */
#ifndef MESO_SURFACE_H
#define MESO_SURFACE_H

#include "libcore/mesh/half_edges.h"

typedef struct MesoSurface {
    MesoPolygonMesh mesh;
    MesoHalfEdges edges;
    float mean_edge_length;     /* over all sides of all faces */
} MesoSurface;

/* What a method may ask for, together. */
typedef enum MesoSurfaceNeed {
    MESO_NEEDS_QUADS = 1,
    MESO_NEEDS_TRIANGLES = 2,
    MESO_NEEDS_MANIFOLD = 4,    /* no edge with three faces */
    MESO_NEEDS_ORIENTED = 8     /* neighbours wound alike */
} MesoSurfaceNeed;

/*
 * Joins the half-edges of a checked mesh, whose arrays `surface` goes on to use. O(corners), on
 * `thread_count` threads (0: all cores); the same for any number of them. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_surface_build(MesoSurface *surface, MesoArena *arena, const MesoPolygonMesh *mesh,
                              uint32_t thread_count, MesoError *error);

/*
 * MESO_ERR_INPUT where the surface lacks what `needs` (of MesoSurfaceNeed) says, with the reason and the first
 * face, counted from 1. Its number from 0 goes to `face`, which may be NULL; MESO_NO_INDEX where the
 * message does not begin with a face. O(corners).
 */
MesoStatus meso_surface_require(const MesoSurface *surface, unsigned needs, uint32_t *face, MesoError *error);

/*
 * Mean length over all sides of all faces, summed up in double precision over each 65536 faces, and then over
 * those sums. O(corners).
 */
double meso_polygon_mean_edge(const MesoPolygonMesh *mesh, uint32_t thread_count);

#endif
