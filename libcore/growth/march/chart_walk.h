/* Straight lines in a chart of a geometry image, triangle by triangle. */
#ifndef MESO_CHART_WALK_H
#define MESO_CHART_WALK_H

#include "libcore/chart/geometry_image.h"
#include "libcore/geodesic/transport/straight_walk.h"

typedef struct MesoChartPlace {
    uint32_t triangle;
    bool turned;            /* the triangle is wound against the one in which all began */
    double weight[3];
    double at[2];           /* in texels */
} MesoChartPlace;

/* What is told of a line: its pieces, as walks tell theirs; the ends of a line lie within. */
typedef struct MesoChartTell {
    const MesoWalkGround *ground;
    const MesoWalkOptions *options;
    uint32_t walk;
} MesoChartTell;

MesoChartPlace meso_chart_place(const MesoGeometryImage *image, uint32_t triangle, bool turned,
                                const double weight[3]);

/*
 * Goes straight to a point in texels, or to the end of the chart before it: then returns the half-edge there, and
 * MESO_NO_INDEX else. Signs alone decide, as in straight_walk.h.
 *
 * tell       NULL: nothing is told
 * crossings  sides that are crossed are added; it stops where there are `limit`: triangles without area have no end
 */
uint32_t meso_chart_walk(const MesoGeometryImage *image, const MesoTriangulation *mesh, MesoChartPlace *place,
                         const double to[2], const MesoChartTell *tell, uint32_t *crossings, uint32_t limit);

#endif
