/*
 * Details: what sits on a surface that deforms, each at a material point of it ("Real-Time Continuous Self-Replicating
 * Details for Shape Deformation", Rohmer, Hahmann and Cani 2015). A detail goes where its point goes and turns as the
 * surface turns there, but is not stretched with it.
 */
#ifndef MESO_SURFACE_DETAIL_H
#define MESO_SURFACE_DETAIL_H

#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoDetail {
    MesoMeshPoint point;    /* of the surface at rest */
    float angle;            /* of its heading to the x axis of the triangle's frame (triangle_frames.h), in radians */
    float size, width;      /* along its heading and across, grown */
    uint32_t kind;          /* of the distribution's kinds */
    uint32_t copied;        /* the original detail that it is a copy of; originals are of themselves */
    uint32_t rank;          /* those of lower rank do not give way to it: originals first, then by birth */
    float radius;           /* distance at birth from the nearest of lower rank; INFINITY: none */
    int32_t born;           /* the frame; MESO_DETAIL_ORIGINAL for those that were there */
} MesoDetail;

#define MESO_DETAIL_ORIGINAL INT32_MIN

/* A detail as a frame has it. */
typedef struct MesoPlacedDetail {
    MesoVec3 position;
    MesoVec3 normal, tangent;   /* unit length, at right angles; the tangent is its heading */
    float size, width;          /* 0: it is not there */
} MesoPlacedDetail;

/*
 * Places details on a surface that has moved. The heading is carried by the rotation in the polar decomposition F = R U
 * of the triangle's deformation F, and laid into the plane across the normal; normals are interpolated.
 *
 * rest       of which the details are
 * positions  [rest->vertex_count] of the frame
 * normals    [rest->vertex_count] of the frame, unit length
 * grown      [count] shares of their sizes, in [0,1]; NULL: all of it
 *
 * What a triangle without area has is not there. O(count) on `thread_count` threads (0: all cores), the same for any.
 */
void meso_details_place(MesoPlacedDetail *out, const MesoTriangulation *rest, const MesoVec3 *positions,
                        const MesoVec3 *normals, const MesoDetail *details, const float *grown, uint32_t count,
                        uint32_t thread_count);

static inline MesoVec3 meso_detail_position(const MesoTriangulation *rest, const MesoVec3 *positions,
                                            const MesoMeshPoint *point)
{
    const uint32_t *corners = rest->corners + 3 * (size_t)point->triangle;
    MesoVec3 p = meso_vec3_scale(positions[corners[0]], point->weight[0]);
    p = meso_vec3_mad(p, point->weight[1], positions[corners[1]]);
    return meso_vec3_mad(p, point->weight[2], positions[corners[2]]);
}

/* Unit length, in the plane of its triangle; zero where that has no area. */
MesoVec3 meso_detail_heading(const MesoTriangulation *rest, const MesoVec3 *positions, const MesoDetail *detail);

/* Size over width, of those that are not alike in all directions; else 1. */
static inline float meso_detail_aspect(const MesoDetail *detail)
{
    float aspect = detail->size > 0 && detail->width > 0 ? detail->size / detail->width : 1;
    return aspect < 16 ? aspect > 0.0625f ? aspect : 0.0625f : 16;
}

/*
 * Squared distance in the norm of a detail's ellipse, whose area is that of the unit circle: what is across its heading
 * is farther than it looks, if it is longer than wide.
 */
static inline float meso_detail_norm2(MesoVec3 apart, MesoVec3 heading, float aspect)
{
    float along = meso_vec3_dot(apart, heading);
    return meso_vec3_dot(apart, apart) * aspect + along * along * (1 / aspect - aspect);
}

/* Area of a triangle in a frame over that at rest; 0 where it had none. */
double meso_stretch_of_area(const MesoTriangulation *rest, const MesoVec3 *positions, uint32_t triangle);

#endif
