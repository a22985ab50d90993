/* The square of the distance from a point to a triangle (Ericson, "Real-Time Collision Detection", 2005, 5.1.5). */
#ifndef MESO_TRIANGLE_DISTANCE_H
#define MESO_TRIANGLE_DISTANCE_H

#include "libcore/math/vec.h"

static inline float meso_square_of(MesoVec3 a)
{
    return meso_vec3_dot(a, a);
}

/* To the segment from `a` along `along`; `off` is from `a` to the point. */
static inline float meso_segment_square(MesoVec3 off, MesoVec3 along)
{
    float square = meso_square_of(along), t = square > 0 ? meso_vec3_dot(off, along) / square : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return meso_square_of(meso_vec3_mad(off, -t, along));
}

/* Triangles without area are their sides. */
static inline float meso_triangle_square(MesoVec3 p, MesoVec3 a, MesoVec3 b, MesoVec3 c)
{
    MesoVec3 ab = meso_vec3_sub(b, a), ac = meso_vec3_sub(c, a), bc = meso_vec3_sub(c, b);
    MesoVec3 ap = meso_vec3_sub(p, a), bp = meso_vec3_sub(p, b);
    MesoVec3 n = meso_vec3_cross(ab, ac);
    bool left_of_ab = meso_vec3_dot(meso_vec3_cross(ab, ap), n) >= 0;
    bool left_of_bc = meso_vec3_dot(meso_vec3_cross(bc, bp), n) >= 0;
    bool left_of_ca = meso_vec3_dot(meso_vec3_cross(ap, ac), n) >= 0;
    float square = meso_square_of(n);
    if (left_of_ab && left_of_bc && left_of_ca && square > 0) {
        float height = meso_vec3_dot(ap, n);
        return height * height / square;
    }
    float least = square > 0 ? INFINITY : meso_segment_square(ap, ac);
    if (!left_of_ab || !(square > 0))
        least = meso_segment_square(ap, ab);
    if (!left_of_bc || !(square > 0)) {
        float other = meso_segment_square(bp, bc);
        least = other < least ? other : least;
    }
    if (!left_of_ca || !(square > 0)) {
        float other = meso_segment_square(ap, ac);
        least = other < least ? other : least;
    }
    return least;
}

#endif
