/* Chart maker: marks by vertex and triangle, for many charts of one mesh. */
#ifndef MESO_CHART_MAKER_H
#define MESO_CHART_MAKER_H

#include "libcore/mesh/cut/triangulation.h"

/* What growing needs of the size of the mesh, so that a chart costs what the chart is. One a thread. */
typedef struct MesoChartMaker {
    const MesoTriangulation *mesh;
    const uint8_t *taken;       /* [triangle_count] 1: not for charts; NULL: none is. The caller's */
    bool unfolds;               /* charts begin from triangles unfolded one after another where that does, in half the
                                   time. The caller's; false at first */
    uint32_t *vertex_numbers;   /* [vertex_count] and [triangle_count]; MESO_NO_INDEX between charts */
    uint32_t *triangle_numbers;
    MesoArena own;
    MesoArena *lent;            /* scratch in place of its own, that keeps its room for other uses; NULL: none is. The
                                   caller's */
} MesoChartMaker;

static inline MesoArena *meso_chart_scratch(MesoChartMaker *maker)
{
    return maker->lent ? maker->lent : &maker->own;
}

/* The mesh stays the caller's and is not to change while the maker is in use. O(mesh). MESO_ERR_MEMORY alone. */
MesoStatus meso_chart_maker_init(MesoChartMaker *maker, const MesoTriangulation *mesh, MesoError *error);

void meso_chart_maker_release(MesoChartMaker *maker);

#endif
