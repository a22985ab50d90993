/*
 * Edges of a web beside those at rest: how far their mean and their deviation are from what they were, and what a node
 * that comes or goes would change of that, without its coming or going. So of several places for a detail the one can
 * be taken that brings all edges nearest to what they were.
 */
#ifndef MESO_EDGE_BALANCE_H
#define MESO_EDGE_BALANCE_H

#include "libcore/replicate/web/web.h"

/* Of edges between details, at rest. */
typedef struct MesoEdgeRest {
    double mean;        /* length; 0: there are none, and all that follows is 0 */
    double variance;    /* of lengths over the mean */
} MesoEdgeRest;

/* Sums over edges between details, x a length over the mean at rest: both are 0 where edges are as at rest. */
typedef struct MesoEdgeBalance {
    double excess;      /* of x - 1 */
    double spread;      /* of (x - 1)^2 - variance */
} MesoEdgeBalance;

MesoEdgeRest meso_edge_rest(const MesoWeb *web);

/*
 * Of all edges between details.
 *
 * left_out  [web->node_count] 1: edges of that node do not count; NULL: all do
 *
 * O(triangles).
 */
MesoEdgeBalance meso_edge_balance(const MesoWeb *web, const MesoEdgeRest *rest, const uint8_t *left_out);

/*
 * What a node at a place in a triangle would change: edges that are no longer Delaunay go, and it is joined to what is
 * around them. `nearest2`: squared distance of the nearest detail that it would be joined to, which is the nearest of
 * all; INFINITY where there is none. O(what is around it); nothing is written but that.
 */
MesoEdgeBalance meso_edge_balance_with(const MesoWeb *web, const MesoEdgeRest *rest, uint32_t triangle, MesoVec3 place,
                                       MesoVec3 normal, double *nearest2);

/*
 * What would change if a node went: its edges go, and what was around it is joined as is Delaunay in its tangent plane.
 * Nothing at a border, where nodes do not go, or where more are around it than are looked at. O(degree^3).
 */
MesoEdgeBalance meso_edge_balance_without(const MesoWeb *web, const MesoEdgeRest *rest, uint32_t node);

#endif
