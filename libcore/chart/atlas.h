/* Atlas: charts that cover a whole surface, side by side in a square. */
#ifndef MESO_ATLAS_H
#define MESO_ATLAS_H

#include "libcore/chart/chart.h"

typedef struct MesoAtlas {
    uint32_t chart_count;
    MesoChart *charts;          /* [chart_count] */
    uint32_t *triangle_chart;   /* [triangle_count] by triangle of the mesh */
    MesoVec2 *corner_uv;        /* [3 * triangle_count] in [0,1]; where charts meet, a corner has a place in each */
    float scale;                /* of uv by a unit of the surface: the same in all charts */
    float largest_ratio;        /* of area scales, within a chart and among all */
} MesoAtlas;

/*
 * Divides the surface into cells around centres at about the options' radius, each far from all others, and each cell
 * into charts (chart.h): one where it is a disk that can be laid flat within the bound. A radius of 0: that of a circle
 * of a quarter of the area.
 *
 * Each triangle is in one chart. Charts are injective, and lie in boxes that are 1/512 apart at least: no two places of
 * the surface have one uv, but for triangles that are lower than floats can tell.
 *
 * O(n log n) for the cells and what charts cost. MESO_ERR_LIMIT for more than 2^28 triangles, MESO_ERR_MEMORY.
 */
MesoStatus meso_atlas_build(MesoAtlas *atlas, MesoArena *arena, const MesoTriangulation *mesh,
                            const MesoChartOptions *options, MesoError *error);

#endif
