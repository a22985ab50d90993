/* Frames of triangles, in double precision, and how directions are carried from one to its neighbour. */
#ifndef MESO_TRIANGLE_FRAMES_H
#define MESO_TRIANGLE_FRAMES_H

#include "libcore/mesh/cut/triangulation.h"

/* A direction in a triangle's frame: a complex number. */
typedef struct MesoComplex {
    double re, im;
} MesoComplex;

static inline MesoComplex meso_complex_times(MesoComplex a, MesoComplex b)
{
    return (MesoComplex){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static inline MesoComplex meso_complex_conjugate(MesoComplex a)
{
    return (MesoComplex){a.re, -a.im};
}

/* Of length 1; 1 where it has none. */
static inline MesoComplex meso_complex_unit(MesoComplex a)
{
    double length = sqrt(a.re * a.re + a.im * a.im);
    return length > 0 && length < INFINITY ? (MesoComplex){a.re / length, a.im / length} : (MesoComplex){1, 0};
}

/* To a power from 1 on. */
static inline MesoComplex meso_complex_power(MesoComplex a, uint32_t power)
{
    for (; power % 2 == 0; power /= 2)
        a = meso_complex_times(a, a);
    MesoComplex product = a;
    for (; power > 1; power--)
        product = meso_complex_times(product, a);
    return product;
}

/* That root of a number of length 1 which is the nearest to 1, but for a side. */
static inline MesoComplex meso_complex_root(MesoComplex a, uint32_t power)
{
    for (; power % 2 == 0; power /= 2) {
        double re = sqrt(fmax(0, 0.5 * (1 + a.re))), im = sqrt(fmax(0, 0.5 * (1 - a.re)));
        a = (MesoComplex){re, a.im < 0 ? -im : im};
    }
    double angle = power > 1 ? atan2(a.im, a.re) / power : 0;
    return power > 1 ? (MesoComplex){cos(angle), sin(angle)} : a;
}

/* x along the longest side, y to its left: the triangle lies there. */
typedef struct MesoTriangleFrame {
    double x[3], y[3];
    double area;
} MesoTriangleFrame;

MesoTriangleFrame meso_frame(const MesoTriangulation *mesh, uint32_t triangle);

/* The part of a vector that lies in the plane. */
static inline MesoComplex meso_frame_in(const MesoTriangleFrame *frame, MesoVec3 v)
{
    return (MesoComplex){frame->x[0] * v.x + frame->x[1] * v.y + frame->x[2] * v.z,
                         frame->y[0] * v.x + frame->y[1] * v.y + frame->y[2] * v.z};
}

static inline MesoVec3 meso_frame_out(const MesoTriangleFrame *frame, MesoComplex c)
{
    return (MesoVec3){(float)(c.re * frame->x[0] + c.im * frame->y[0]),
                      (float)(c.re * frame->x[1] + c.im * frame->y[1]),
                      (float)(c.re * frame->x[2] + c.im * frame->y[2])};
}

/* Directions to the power of their symmetry: the same number for all turns of a direction. */
typedef struct MesoFieldPowers {
    const MesoTriangulation *mesh;
    uint32_t symmetry;
    const MesoTriangleFrame *frames;    /* [triangle_count] */
    const MesoComplex *powers;  /* [triangle_count] of length 1 */
} MesoFieldPowers;

/* The half-edge across that is wound alike, or MESO_NO_INDEX. */
static inline uint32_t meso_frame_across(const MesoTriangulation *mesh, uint32_t half_edge)
{
    uint32_t across = mesh->twins[half_edge];
    return across != MESO_NO_INDEX && mesh->corners[across] != mesh->corners[half_edge] ? across : MESO_NO_INDEX;
}

/* What a direction in the frame of `half_edge`'s triangle is times, to be that direction across it. */
MesoComplex meso_frame_turn(const MesoTriangulation *mesh, const MesoTriangleFrame *frames, uint32_t half_edge,
                            uint32_t across);

#endif
