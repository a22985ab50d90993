/*
 * Surface: a polygon mesh with its adjacency, built once. What every method
 * starts from; quads or triangles is what a method asks of it.
 *
 * Half-edge h runs along its face from corner h to the face's next corner, so
 * that of a mesh of quads half-edge 4 f + k is side k of face f.
 */
#ifndef MESO_SURFACE_H
#define MESO_SURFACE_H

#include "libcore/mesh/polygon_mesh.h"

typedef struct MesoSurface {
    MesoPolygonMesh mesh;
    uint32_t edge_count;        /* borders included */
    uint32_t border_count;      /* edges with one face */
    uint32_t reversed_count;    /* edges whose two faces run along them the same way */
    uint32_t crowded_count;     /* edges with three faces or more; their half-edges have no twin */
    uint32_t crowded[3];        /* half-edges of the first of them, ascending, where there is one */
    uint32_t *twin;             /* [corner_count] half-edge across, or MESO_NO_INDEX */
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
 * Joins the half-edges of a checked mesh, whose arrays `surface` goes on to use. Linear time: half-edges are
 * sorted by their smaller vertex. O(corners). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_surface_build(MesoSurface *surface, MesoArena *arena, const MesoPolygonMesh *mesh, MesoError *error);

/*
 * MESO_ERR_INPUT where the surface lacks what `needs` (of MesoSurfaceNeed) says, with the first face (counted
 * from 1), the reason, and the step of meso-mesh that would help.
 */
MesoStatus meso_surface_require(const MesoSurface *surface, unsigned needs, MesoError *error);

#endif
