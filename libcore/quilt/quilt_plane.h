/* The plane of a patch: a chart of the base in units of the swatch, turned by the guide, with heights as z. */
#ifndef MESO_QUILT_PLANE_H
#define MESO_QUILT_PLANE_H

#include "libcore/chart/chart.h"
#include "libcore/quilt/quilt.h"

typedef struct MesoQuiltPlane {
    const MesoTriangulation *base;
    const MesoChart *chart;
    float height_scale, offset;
    MesoVec2 *places;               /* [chart->vertex_count] */
    MesoVec2 low, high;             /* around them */
    MesoVec2 middle;            /* no place within a circle around it is off the chart: */
    float free_square;          /* the square of its radius */
    uint32_t *chart_triangles;      /* [base->triangle_count] of the chart, or MESO_NO_INDEX; the caller's */
    uint32_t columns, rows;         /* a grid to find triangles by */
    float cell;
    uint32_t *begin, *found;        /* [columns * rows + 1]; chart triangles by cell */
} MesoQuiltPlane;

/*
 * Lays the chart out: turned by -`angle`, divided by `scale`. `chart_triangles` has MESO_NO_INDEX everywhere before; and
 * again after meso_quilt_plane_forget(). To `arena`. O(chart). MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_plane_make(MesoQuiltPlane *plane, MesoArena *arena, const MesoTriangulation *base,
                                 const MesoChart *chart, uint32_t *chart_triangles, float angle, float scale,
                                 float height_scale, float offset, MesoError *error);

/* Its box, and its grid anew, where its places have moved. To `arena`. O(chart). MESO_ERR_MEMORY. */
MesoStatus meso_quilt_plane_index(MesoQuiltPlane *plane, MesoArena *arena, MesoError *error);

void meso_quilt_plane_forget(MesoQuiltPlane *plane);

/* Chart triangle at a place, with the weights of corners 1 and 2; MESO_NO_INDEX outside. O(1) on the mean. */
uint32_t meso_quilt_plane_locate(const MesoQuiltPlane *plane, MesoVec2 place, float *b1, float *b2);

/*
 * Whether the chart has a place. `near`: the triangle that has one near to it, or MESO_NO_INDEX; comes to be that of the
 * place. Faster where one place after the other lies in the same.
 */
bool meso_quilt_plane_has(const MesoQuiltPlane *plane, MesoVec2 place, uint32_t *near);

/* From the base to the plane and back; false outside of the chart. */
bool meso_quilt_plane_to(const MesoQuiltPlane *plane, MesoQuiltVertex vertex, MesoVec3 *point);
bool meso_quilt_plane_from(const MesoQuiltPlane *plane, MesoVec3 point, MesoQuiltVertex *vertex);

#endif
