/* Growth of charts: triangles one after another, so that the first k of them are a disk for every k. */
#ifndef MESO_CHART_GROWTH_H
#define MESO_CHART_GROWTH_H

#include "libcore/chart/chart_maker.h"

typedef struct MesoChartGrowth {
    uint32_t vertex_count, triangle_count;
    uint32_t triangle_room;
    uint32_t *triangles;    /* [triangle_count] of the mesh */
    uint32_t *corners;      /* [3 * triangle_count] vertices of the growth */
    uint32_t *vertex_ends;  /* [triangle_count] how many vertices the triangles up to this one have */
    double *reaches;        /* [triangle_count] ascending: the radius from which on it belongs */
    uint32_t *vertices;     /* [vertex_count] of the mesh */
    double *distances;      /* [vertex_count] along the surface from the seed's centroid */
} MesoChartGrowth;

/* On the maker's scratch; until meso_chart_growth_forget() its triangle_numbers say where a triangle stands. */
MesoStatus meso_chart_growth_run(MesoChartGrowth *growth, MesoChartMaker *maker, uint32_t seed, double radius,
                                 MesoError *error);

/* Has the maker's numbers as they were. */
void meso_chart_growth_forget(const MesoChartGrowth *growth, MesoChartMaker *maker);

/* The half-edge across that is wound alike, or MESO_NO_INDEX. */
static inline uint32_t meso_chart_across(const MesoTriangulation *mesh, uint32_t half_edge)
{
    uint32_t across = mesh->twins[half_edge];
    return across != MESO_NO_INDEX && mesh->corners[across] != mesh->corners[half_edge] ? across : MESO_NO_INDEX;
}

#endif
