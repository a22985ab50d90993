/*
 * What a dart on a surface sees around it, triangle by triangle: exactly (surface_reach.h), or where that is a thousand
 * triangles by fronts (geodesic.h), which are off by less than a triangle is wide.
 */
#ifndef MESO_DART_SIGHT_H
#define MESO_DART_SIGHT_H

#include "libcore/geodesic/geodesic.h"
#include "libcore/growth/ground/surface_reach.h"

/* The distance over a triangle: in a plane where the dart is at the origin, or linear. */
typedef struct MesoDartView {
    uint32_t triangle;
    bool linear;
    double corners[3][2];       /* where the triangle's corners lie; or their distances */
    double side;                /* what is seen, is seen through a line at this height */
    double begin, end;          /* there */
    double base;
} MesoDartView;

typedef struct MesoDartSight {
    const MesoTriangulation *mesh;
    const MesoWalkGround *ground;
    MesoReach *reach;
    MesoGeodesicSolver *solver; /* once it is wanted */
    float *distance;            /* [vertex_count] INFINITY */
    double fine;                /* darts that reach farther use fronts */
    double longest;             /* side */
    MesoArena *arena;
} MesoDartSight;

/* Errors are MESO_ERR_MEMORY alone, here and below. */
MesoStatus meso_dart_sight_init(MesoDartSight *sight, MesoArena *arena, const MesoTriangulation *mesh,
                                const MesoWalkGround *ground, uint32_t thread_count, MesoError *error);

void meso_dart_sight_release(MesoDartSight *sight);

/* Tells all that is seen within the distance. Views with more of a distance may be told. */
MesoStatus meso_dart_look(MesoDartSight *sight, const MesoSurfacePlace *place, double distance,
                          void (*view)(void *context, const MesoDartView *view), void *context, MesoError *error);

/* At the point that has weights s and t of the triangle's second and third corner. O(1). */
static inline double meso_dart_distance(const MesoDartView *view, double s, double t)
{
    double r = 1 - s - t, x = r * view->corners[0][0] + s * view->corners[1][0] + t * view->corners[2][0];
    if (view->linear)
        return x;
    double y = r * view->corners[0][1] + s * view->corners[1][1] + t * view->corners[2][1];
    double through = y > 0 ? x * (view->side / y) : x;
    if (through >= view->begin && through <= view->end)
        return view->base + sqrt(x * x + y * y);
    through = through < view->begin ? view->begin : view->end;
    double dx = x - through, dy = y - view->side;
    return view->base + sqrt(through * through + view->side * view->side) + sqrt(dx * dx + dy * dy);
}

#endif
