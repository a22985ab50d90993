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

/* So many at once: a whole number of vectors. */
enum { MESO_TRIANGLE_ROW = 32 };

/* Points, and a triangle for each, by coordinates. */
typedef struct MesoTriangleRow {
    float p[3][MESO_TRIANGLE_ROW];
    float a[3][MESO_TRIANGLE_ROW], b[3][MESO_TRIANGLE_ROW], c[3][MESO_TRIANGLE_ROW];
} MesoTriangleRow;

/* As meso_segment_square(); INFINITY where it is left out. */
static inline __attribute__((always_inline)) float meso_segment_square_unless(bool out, MesoVec3 off, MesoVec3 along)
{
    float square = meso_square_of(along), dot = meso_vec3_dot(off, along), t = dot / (square > 0 ? square : 1);
    t = square > 0 ? t : 0;
    t = t < 0 ? 0 : t;
    t = t > 1 ? 1 : t;
    float found = meso_square_of(meso_vec3_mad(off, -t, along));
    return out ? INFINITY : found;
}

/*
 * meso_triangle_square() of each, the very same floats. Every case is looked at and one chosen: without branches the
 * compiler does four at once.
 */
static inline __attribute__((always_inline)) void meso_triangle_squares(float *restrict squares,
                                                                         const MesoTriangleRow *restrict row)
{
    for (uint32_t i = 0; i < MESO_TRIANGLE_ROW; i++) {
        MesoVec3 p = {row->p[0][i], row->p[1][i], row->p[2][i]}, a = {row->a[0][i], row->a[1][i], row->a[2][i]};
        MesoVec3 b = {row->b[0][i], row->b[1][i], row->b[2][i]}, c = {row->c[0][i], row->c[1][i], row->c[2][i]};
        MesoVec3 ab = meso_vec3_sub(b, a), ac = meso_vec3_sub(c, a), bc = meso_vec3_sub(c, b);
        MesoVec3 ap = meso_vec3_sub(p, a), bp = meso_vec3_sub(p, b);
        MesoVec3 n = meso_vec3_cross(ab, ac);
        float square = meso_square_of(n), height = meso_vec3_dot(ap, n);
        bool has = square > 0;
        bool left_of_ab = has & (meso_vec3_dot(meso_vec3_cross(ab, ap), n) >= 0);
        bool left_of_bc = has & (meso_vec3_dot(meso_vec3_cross(bc, bp), n) >= 0);
        bool left_of_ca = has & (meso_vec3_dot(meso_vec3_cross(ap, ac), n) >= 0);
        float over = height * height / (has ? square : 1);
        bool inside = left_of_ab & left_of_bc & left_of_ca;
        float least = inside ? over : INFINITY;
        float other = meso_segment_square_unless(left_of_ab, ap, ab);
        least = other < least ? other : least;
        other = meso_segment_square_unless(left_of_bc, bp, bc);
        least = other < least ? other : least;
        other = meso_segment_square_unless(left_of_ca, ap, ac);
        squares[i] = other < least ? other : least;
    }
}

#endif
