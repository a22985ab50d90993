/*
 * The shadow on a ground that lies under all of a scene. Nothing of the scene is behind the ground, so whatever a light
 * map (light_map.h) has on the way from a place of the ground to the light hides that light, and the maps can be
 * blurred ahead of time, which those of surfaces that shade themselves cannot. Each of a rig's M lights stands for a
 * patch of the sky, or of the key light's disc, of the angle
 *
 *     a = sqrt(4 pi / M), or sqrt(pi / M) times the tangent of half the disc's angle,
 *
 * so that the shadow of what stands d before the ground has an edge as wide as a d: the map is blurred by nearly a
 * Gaussian, of a d / 2 for the key light and a d / 5 for the sky, with which the shadows of neighbours run into each
 * other. d is what the map has around the place, in the
 * mean, as in "Percentage-Closer Soft Shadows" (Fernando 2005); blurred maps are pyramids ("Pyramidal Parametrics",
 * Williams 1983), read with quadratic B-splines and between two levels.
 */
#ifndef MESO_GROUND_SHADOW_H
#define MESO_GROUND_SHADOW_H

#include "libcore/render/light/light_rig.h"

/* What is above a texel of a level: its share that something covers, and that share times how near to the light that
 * is; of 65535. */
typedef struct MesoGroundTexel {
    uint16_t cover, nearness;
} MesoGroundTexel;

/* Levels of maps of one size, each of half as many texels a side, rounded up; the first, of half the maps', is level
 * 1. */
typedef struct MesoGroundMaps {
    const MesoLightMaps *maps;
    MesoGroundTexel **levels;       /* [maps] levels one after another, each in a margin; NULL: not above the ground */
    uint32_t level_count, sizes[16], starts[16];
    uint32_t wide;                  /* the level on which what is in the way is looked for */
    float spread;                   /* deviation of the blur / d */
    float low, range;               /* nearness of 0, and what 65535 is more */
} MesoGroundMaps;

typedef struct MesoGroundShadow {
    const MesoLightRig *rig;
    MesoGroundMaps sky, key;
} MesoGroundShadow;

/* Blurs the maps of a rig, which has to last. About 1.4 bytes for each texel of the lights above the ground, in
 * `arena`; O(texels). MESO_ERR_MEMORY alone. */
MesoStatus meso_ground_shadow_init(MesoGroundShadow *shadow, MesoArena *arena, const MesoLightRig *rig,
                                   uint32_t thread_count, MesoError *error);

/* Share of the light on the ground at `p`, relative to the anchor, that what stands on it takes away; 0 far from it. */
float meso_ground_shadow_at(const MesoGroundShadow *shadow, MesoVec3 p);

#endif
