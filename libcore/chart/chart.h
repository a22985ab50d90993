/*
 * Chart: a part of a surface that is a disk, laid flat: by least squares
 * conformal maps ("Least Squares Conformal Maps for Automatic Texture Atlas
 * Generation", Levy et al. 2002), then as rigidly as possible ("A Local/Global
 * Approach to Mesh Parameterization", Liu et al. 2008).
 */
#ifndef MESO_CHART_H
#define MESO_CHART_H

#include "libcore/chart/chart_maker.h"

typedef struct MesoChart {
    uint32_t vertex_count, triangle_count;
    uint32_t *vertices;     /* [vertex_count] of the mesh; each once */
    uint32_t *triangles;    /* [triangle_count] of the mesh, each an edge away from one before it; the seed first */
    uint32_t *corners;      /* [3 * triangle_count] vertices of the chart */
    MesoVec2 *places;       /* [vertex_count] in the surface's units; the seed's centroid at 0,0, side 0 along x */
    float area_ratio;       /* largest over smallest area scale of a triangle, at least 1 */
    float radius;           /* that it was grown to */
} MesoChart;

typedef struct MesoChartOptions {
    float radius;           /* along the surface, from the seed's centroid */
    float largest_ratio;    /* of area scales; 0: 4 */
    uint32_t relaxations;   /* steps as rigid as possible, after the conformal map */
} MesoChartOptions;

/*
 * Grows a chart around triangle `seed` and lays it flat.
 *
 * Triangles come in the order of their distance along the surface, and only such that what there is stays a disk: a
 * border that is one loop and passes no vertex twice. Where the surface closes around a cylinder or a handle, a slit
 * is left. Triangles wound against each other are not joined.
 *
 * Laid flat it is injective: each triangle counter-clockwise by an exact test of the floats, no two overlap. The total
 * area is kept. Where that fails or area scales differ by more than the bound, the radius shrinks by fifths; a single
 * triangle always does. Triangles thinner than 1e-4 of their longest side are laid out at that height.
 *
 * Same arguments, same bytes. O(n log n) for the growth, and two sparse factorisations; memory is O(n) in `arena`.
 * MESO_ERR_MEMORY alone.
 */
MesoStatus meso_chart_grow(MesoChart *chart, MesoArena *arena, MesoChartMaker *maker, uint32_t seed,
                           const MesoChartOptions *options, MesoError *error);

/* A direction on the chart's triangle number `triangle`, carried to the plane by its linear map. Not of unit length. */
MesoVec2 meso_chart_direction(const MesoChart *chart, const MesoTriangulation *mesh, uint32_t triangle,
                              MesoVec3 direction);

#endif
