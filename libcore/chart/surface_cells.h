/* Cells of a surface: triangles by the nearest of some centres. */
#ifndef MESO_SURFACE_CELLS_H
#define MESO_SURFACE_CELLS_H

#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoSurfaceCells {
    uint32_t count, room;
    uint32_t *centres;      /* [count] triangles */
    uint32_t *cells;        /* [triangle_count] number of the centre */
    double *distances;      /* [triangle_count] to it, from centroid to centroid */
} MesoSurfaceCells;

/*
 * Centres one after another, each the triangle farthest from those before, until none is farther than `radius`;
 * that nearest to the mean of all corners first. All on `arena`. O(n log n log count). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_surface_cells(MesoSurfaceCells *cells, MesoArena *arena, const MesoTriangulation *mesh, double radius,
                              MesoError *error);

#endif
