/*
 * Geometry image of several charts ("Multi-Chart Geometry Images", Sander et al. 2003): the surface under each texel,
 * and pointers from the texels at a chart's border to those across it on the surface, as the indirection maps of
 * "Appearance-Space Texture Synthesis" (Lefebvre and Hoppe 2006) have them.
 */
#ifndef MESO_GEOMETRY_IMAGE_H
#define MESO_GEOMETRY_IMAGE_H

#include "libcore/base/arena.h"
#include "libcore/mesh/cut/triangulation.h"

/* From a texel at the border of a chart over a side of a triangle to the texel on the other side. */
typedef struct MesoTexelPointer {
    uint32_t from, to;      /* texels; `to` is MESO_NO_INDEX where the surface ends */
    uint32_t half_edge;     /* over which it leads, of the chart that it leaves */
    float share;            /* where on that, from 0 where it begins to 1 */
    bool mirrored;          /* directions are to be conjugated first */
    double turn[2];         /* and then multiplied by this complex number of length 1, to go on in the other chart */
} MesoTexelPointer;

typedef struct MesoTexel {
    uint32_t triangle;      /* MESO_NO_INDEX: background */
    uint32_t pointer;       /* the first of those from here, which follow each other; MESO_NO_INDEX: none */
    float weight[3];        /* of the point of the chart that is nearest to the texel's centre */
    MesoVec3 position, normal, tangent;     /* there, of unit length; the tangent is where u grows */
} MesoTexel;

typedef struct MesoGeometryImage {
    uint32_t size;              /* texels a side, row by row; u grows along a row, v from row to row */
    uint32_t chart_count, pointer_count;
    MesoTexel *texels;          /* [size * size] */
    MesoTexelPointer *pointers; /* [pointer_count] by the texel they come from */
    MesoVec2 *uv;               /* [3 * triangle_count] by corner, in texels; centres of texels are at halves */
    uint32_t *triangle_chart;   /* [triangle_count] */
    uint8_t *seams;             /* [triangle_count] bit k: side k is the end of its chart */
    double texels_per_unit;     /* on average */
} MesoGeometryImage;

enum { MESO_GEOMETRY_IMAGE_LEAST = 16, MESO_GEOMETRY_IMAGE_MOST = 4096 };

/*
 * Draws a mesh into an image by its coordinates; any box of them is laid into the square, two texels from its border.
 * Charts are what is joined by sides that have the same coordinates in both triangles. A texel belongs to the triangle
 * that its centre is deepest in, or nearest to where its square is only touched: no chart is without texels, unless
 * another one lies within the same.
 *
 * corner_uv  [3 * triangle_count] by corner; in the same place in two charts only where they meet
 * normals    [vertex_count] of unit length; NULL: those of the triangles
 *
 * Every pointer that leads somewhere has one that leads back. O(texels + triangles). MESO_ERR_INPUT, by faces from 1,
 * where two triangles lie over one centre of a texel, or coordinates are not finite; MESO_ERR_USAGE for a size out of
 * bounds; MESO_ERR_MEMORY.
 */
MesoStatus meso_geometry_image_build(MesoGeometryImage *image, MesoArena *arena, const MesoTriangulation *mesh,
                                     const MesoVec2 *corner_uv, const MesoVec3 *normals, uint32_t size,
                                     MesoError *error);

/* The texel that a point in texels lies in; MESO_NO_INDEX beyond the square. */
static inline uint32_t meso_texel_at(const MesoGeometryImage *image, double x, double y)
{
    bool inside = x >= 0 && y >= 0 && x < image->size && y < image->size;
    return inside ? (uint32_t)y * image->size + (uint32_t)x : MESO_NO_INDEX;
}

/* The chart of a texel; MESO_NO_INDEX for background and for MESO_NO_INDEX. */
static inline uint32_t meso_texel_chart(const MesoGeometryImage *image, uint32_t texel)
{
    uint32_t triangle = texel == MESO_NO_INDEX ? MESO_NO_INDEX : image->texels[texel].triangle;
    return triangle == MESO_NO_INDEX ? MESO_NO_INDEX : image->triangle_chart[triangle];
}

/* Where the point of its weights lies, in texels. */
static inline void meso_texel_place(const MesoGeometryImage *image, uint32_t texel, double place[2])
{
    const MesoTexel *at = &image->texels[texel];
    const MesoVec2 *uv = &image->uv[3 * (size_t)at->triangle];
    place[0] = (double)at->weight[0] * uv[0].x + (double)at->weight[1] * uv[1].x + (double)at->weight[2] * uv[2].x;
    place[1] = (double)at->weight[0] * uv[0].y + (double)at->weight[1] * uv[1].y + (double)at->weight[2] * uv[2].y;
}

#endif
