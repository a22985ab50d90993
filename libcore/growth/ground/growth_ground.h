/*
 * The surface as growth sees it: triangles to walk over, with what rules ask of a place: smooth normals, height,
 * slope, curvature. All of it is told at a point: a triangle and the weights of its corners.
 */
#ifndef MESO_GROWTH_GROUND_H
#define MESO_GROWTH_GROUND_H

#include "libcore/geodesic/transport/straight_walk.h"
#include "libcore/math/four.h"

/* A triangle's plane, and over it the weights of its second and third corner, as they grow from the first. */
typedef struct MesoGrowthFlat {
    MesoFour origin;
    MesoFour normal;            /* unit length; 0 where the triangle has no area, or a corner's normal is against it */
    MesoFour second, third;
} MesoGrowthFlat;

typedef struct MesoGrowthGround {
    const MesoTriangulation *mesh;
    MesoWalkGround walk;
    MesoVec3 *normals;          /* [vertex_count] unit length, outward: of triangles by their angles */
    float *curvatures;          /* [vertex_count] mean curvature, radians a unit; above 0 where the surface bulges */
    uint8_t *against;           /* [triangle_count] bit k: corner k's normal and curvature count the other way here;
                                 * NULL where all is wound alike */
    MesoGrowthFlat *flats;      /* [triangle_count] */
    MesoVec3 up;                /* unit length */
    double bottom;              /* of the surface along `up`: heights count from there */
    double extent;              /* diagonal of its box */
} MesoGrowthGround;

/* `up` of any length but 0. O(triangles), on `thread_count` threads (0: all cores), the same for any number.
 * MESO_ERR_MEMORY alone. */
MesoStatus meso_growth_ground_build(MesoGrowthGround *ground, MesoArena *arena, const MesoTriangulation *mesh,
                                    MesoVec3 up, uint32_t thread_count, MesoError *error);

MesoVec3 meso_growth_position(const MesoGrowthGround *ground, uint32_t triangle, const double weight[3]);

/* Unit length: the vertices' normals interpolated, as seen from the side that a tip that is `turned` grows on. */
MesoVec3 meso_growth_normal(const MesoGrowthGround *ground, uint32_t triangle, const double weight[3], bool turned);

/* Likewise, of the vertices' curvatures. */
double meso_growth_curvature(const MesoGrowthGround *ground, uint32_t triangle, const double weight[3], bool turned);

#endif
