/* Maps at points of a surface: values, gradients, averages along a straight piece. */
#ifndef MESO_GROWTH_MAPS_H
#define MESO_GROWTH_MAPS_H

#include "libcore/growth/ground/growth_ground.h"

typedef enum MesoGrowthDomain {
    MESO_GROWTH_CONSTANT,       /* values[0], everywhere */
    MESO_GROWTH_BY_VERTEX,      /* [vertex_count] linear in triangles */
    MESO_GROWTH_BY_CORNER,      /* [3 * triangle_count] linear in triangles */
    MESO_GROWTH_BY_TRIANGLE,    /* [triangle_count] */
    MESO_GROWTH_BY_IMAGE        /* at the corners' uvs: linear in triangles, and so without a seam on the way */
} MesoGrowthDomain;

typedef enum MesoGrowthWrap {
    MESO_GROWTH_REPEAT, MESO_GROWTH_CLAMP, MESO_GROWTH_MIRROR
} MesoGrowthWrap;

/* One channel. uv (0,0) is the lower left corner of the lower left pixel. */
typedef struct MesoGrowthImage {
    uint32_t width, height;
    const float *pixels;        /* [width * height] rows from the top */
    bool nearest;
    MesoGrowthWrap wrap;
} MesoGrowthImage;

typedef struct MesoGrowthMap {
    MesoGrowthDomain domain;
    const float *values;
    MesoGrowthImage image;
    const MesoVec2 *uvs;        /* [3 * triangle_count] where it is an image */
} MesoGrowthMap;

double meso_map_value(const MesoGrowthGround *ground, const MesoGrowthMap *map, uint32_t triangle,
                      const double weight[3]);

/*
 * In the triangle's frame, a unit of the surface. Of images over a pixel to each side, of values by triangle from those
 * across the sides; 0 where a triangle has no area, on the surface or in the image. O(1).
 */
MesoComplex meso_map_gradient(const MesoGrowthGround *ground, const MesoGrowthMap *map, uint32_t triangle,
                              const double weight[3]);

/* The mean from one point of a triangle to another: exact where the map is linear, else a sample each pixel, at most
 * 64. O(1). */
double meso_map_mean(const MesoGrowthGround *ground, const MesoGrowthMap *map, uint32_t triangle,
                     const double from[3], const double to[3]);

/* Pixels of an image from one point of a triangle to another, along the longer of its sides; 0 for other maps. */
double meso_map_pixels(const MesoGrowthMap *map, uint32_t triangle, const double from[3], const double to[3]);

/* No value in the triangle is larger. O(1), and O(pixels that it lies over) up to 4096 for images; beyond, it is the
 * image's largest, which `most` is. */
double meso_map_bound(const MesoGrowthMap *map, const MesoGrowthGround *ground, uint32_t triangle, double most);

/* The largest value of an image; 0 for other maps. O(pixels). */
double meso_map_most(const MesoGrowthMap *map);

#endif
