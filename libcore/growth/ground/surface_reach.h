/*
 * All of a surface within a distance of a point, by exact paths on the polyhedron: straight ones through unfolded
 * triangles, and those that bend at saddles and borders ("Improving Chen and Han's Algorithm on the Discrete Geodesic
 * Problem", Xin and Wang 2009, whose filters leave out what cannot be shortest). For many small reaches;
 * exact_geodesic.h measures whole surfaces.
 */
#ifndef MESO_SURFACE_REACH_H
#define MESO_SURFACE_REACH_H

#include "libcore/geodesic/transport/walk_ground.h"

typedef struct MesoSurfacePlace {
    uint32_t triangle;
    double weight[3];       /* of its corners, not negative, together 1 */
} MesoSurfacePlace;

/* How a triangle is seen from the source: through a part of a side, straight. */
typedef struct MesoReachView {
    uint32_t triangle;
    uint32_t side;          /* 0 to 2; 3: the source lies in the triangle */
    double x, y;            /* of the source: along the side from where it begins, and beyond it; in the triangle's
                             * frame where it lies in it */
    double begin, end;      /* what is seen through, along the side */
    double base;            /* length of the way to the source: it may be a vertex where the path bends */
} MesoReachView;

/* Of a surface; finds its saddles once. Room for views is in the arena. */
typedef struct MesoReach MesoReach;

/* The mesh must be the ground's. O(triangles). MESO_ERR_MEMORY alone. */
MesoStatus meso_reach_init(MesoReach **reach, MesoArena *arena, const MesoTriangulation *mesh,
                           const MesoWalkGround *ground, uint32_t thread_count, MesoError *error);

/*
 * Tells all views of triangles that the point sees within the distance: the least of their meso_view_distance() is the
 * distance of the polyhedron, to rounding, wherever that is below `distance`. Views that see none of it may be told.
 *
 * place   not nearer to a corner than 1e-9 of the weights, for views to have a direction; it is moved there where it is
 *
 * O(triangles^1.5) within the distance, as a rule. After 32 views for each triangle of the surface, and
 * 4096, no more are told: triangles without area may have them without end. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_reach_tell(MesoReach *reach, const MesoSurfacePlace *place, double distance,
                           void (*view)(void *context, const MesoReachView *view), void *context, MesoError *error);

/* The length of the path that goes straight through what is seen of the side, or bends at its end. O(1). */
double meso_view_distance(const MesoWalkGround *ground, const MesoReachView *view, const double weight[3]);

#endif
