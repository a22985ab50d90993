/*
 * Statistics of points on a surface: the pair correlation function ("Analysis and Synthesis of Point Distributions
 * based on Pair Correlation", Oeztireli and Gross 2012), and that of their marks.
 *
 *     g(r) = pairs of points at distance r / as many as there were, were points strewn without regard to each other
 *
 * What there were is counted, with places that lie evenly over the surface: so borders and curvature are the same in
 * both. Distances are straight lines in space, between what is joined by triangles nearer than `radius`: the other
 * side of a thin sheet is not near.
 */
#ifndef MESO_PAIR_CORRELATION_H
#define MESO_PAIR_CORRELATION_H

#include "libcore/base/arena.h"
#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoPointSet {
    const MesoTriangulation *mesh;
    const MesoVec3 *positions;      /* [mesh->vertex_count] of the frame */
    const MesoMeshPoint *points;    /* [count] */
    const float *marks;             /* [count]; NULL: none */
    uint32_t count;
} MesoPointSet;

typedef struct MesoPairOptions {
    double radius;          /* of the largest distance; > 0 */
    uint32_t bin_count;     /* 0: 24 */
    uint32_t source_limit;  /* points from which pairs are counted, evenly from all; 0: 20,000 */
} MesoPairOptions;

typedef struct MesoPairCorrelation {
    uint32_t bin_count;
    double radius;
    double *g;              /* [bin_count] distances from radius * i / bin_count on */
    double *marks;          /* [bin_count] mean product of two marks at that distance over the square of their mean; 1
                               where there are no pairs; NULL without marks */
    double area, density;   /* of the surface, and points by area */
} MesoPairCorrelation;

/*
 * O(pairs nearer than the radius + triangles around each source). MESO_ERR_MEMORY alone; arrays are in the arena.
 */
MesoStatus meso_pair_correlation(MesoPairCorrelation *out, MesoArena *arena, const MesoPointSet *set,
                                 const MesoPairOptions *options, MesoError *error);

/* Mean of |a - b| over the bins; both with the same number of them. */
double meso_pair_difference(const MesoPairCorrelation *a, const MesoPairCorrelation *b);

/* Area of a frame. */
double meso_surface_area(const MesoTriangulation *mesh, const MesoVec3 *positions);

/*
 * `count` places that lie evenly by area over a frame; those of one triangle by a sequence of low discrepancy. A
 * surface without area: all in its first triangle. O(triangles + count).
 */
void meso_even_points(MesoMeshPoint *out, uint32_t count, const MesoTriangulation *mesh, const MesoVec3 *positions);

static inline MesoVec3 meso_point_position(const MesoTriangulation *mesh, const MesoVec3 *positions,
                                           const MesoMeshPoint *point)
{
    const uint32_t *corners = mesh->corners + 3 * (size_t)point->triangle;
    MesoVec3 p = meso_vec3_scale(positions[corners[0]], point->weight[0]);
    p = meso_vec3_mad(p, point->weight[1], positions[corners[1]]);
    return meso_vec3_mad(p, point->weight[2], positions[corners[2]]);
}

#endif
