/*
 * The lights of a picture, and light on its surfaces: a warm key light from the upper left of the camera, which has an
 * extent and so soft shadows; a cool sky over a warm ground, whose light comes from many directions and is held off by
 * what stands in its way; and a weak light from behind.
 *
 *     L(p, n, e) = sum over the sky's directions d of  (4 / M) max(n.d, 0) V(p, d) S(d) albedo (1 - metallic) (1 - F)
 *                + S(reflected e) F W + K max(n.k, 0) V(p, k) f(k) + R max(n.r, 0) f(r) V
 *
 * with V from light maps (light_map.h), f the microfacets of "Understanding the Masking-Shadowing Function" (Heitz
 * 2014) over a Lambertian base, F what of the sky's light those reflect, W how open the reflected side is by "Moving
 * Frostbite to Physically Based Rendering" (Lagarde, de Rousiers 2014), and what light loses between surfaces given
 * back by their colour. No surface gives back more than it gets.
 *
 * Or the light of an environment (environment.h), which stands in the world. Its irradiance is that of the harmonics,
 * times the share that comes through where the sky's directions have the map's colours; its key light has maps all over
 * its extent; and each part is reflected as the map has it, the key light's as far as it is seen:
 *
 *     L(p, n, e) = H(n) sum(max(n.d, 0) V(p, d) S(d)) / sum(max(n.d, 0) S(d)) albedo (1 - metallic) (1 - F)
 *                + G(reflected e) F W
 *                + K V(p, k) (max(n.k, 0) albedo (1 - metallic) (1 - F) / pi + Gk(reflected e) F / K)
 */
#ifndef MESO_LIGHT_RIG_H
#define MESO_LIGHT_RIG_H

#include "libcore/render/environment/environment.h"
#include "libcore/render/light/light_map.h"
#include "libcore/scene/material.h"

enum { MESO_SKY_MOST = 256, MESO_KEY_MOST = 64 };

/* How much is spent on the light. */
typedef struct MesoLightQuality {
    uint32_t sky_count, sky_size;       /* directions, and texels a side of their maps */
    uint32_t key_count, key_size;
    float tolerance;                    /* texels that what is drawn may lie from shapes; 0: all of them */
} MesoLightQuality;

/* What a picture of so many samples a pixel deserves. */
MesoLightQuality meso_light_quality(uint32_t samples);

/* What a surface gets that faces the key light or the one behind; radiance of sky and ground, and of the window around
 * the key light that shows in reflections. Linear. */
typedef struct MesoLightColors {
    float key[3], rim[3], sky[3], ground[3], window[3];
} MesoLightColors;

typedef struct MesoLightRig {
    const MesoEnvironment *environment;     /* NULL: the lights that come with the camera */
    MesoVec3 axes[3];           /* of the environment's map, in the world */
    float key_extent;           /* tangent of half the angle of the key light's disc */
    MesoVec3 to_key, to_rim, up;
    MesoLightColors colors;
    MesoLightMaps sky, key;
    float *sky_colors;          /* [3 * sky.count] */
    float open_sky[3];          /* irradiance / pi of a surface that looks up and sees all of it */
    float ground;               /* height of the ground along `up`, relative to the anchor */
    MesoVec3 middle;            /* of the scene's sphere */
    float radius;
} MesoLightRig;

/*
 * Draws the maps of all lights; they live in `arena`. `view` is the camera's, `up` what is up in the world, unit;
 * `environment`, which may be NULL, has to last. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_light_rig_init(MesoLightRig *rig, MesoArena *arena, MesoShapes *shapes, const MesoView *view,
                               MesoVec3 up, const MesoEnvironment *environment, const MesoLightQuality *quality,
                               uint32_t thread_count, MesoError *error);

/* What is lit. */
typedef struct MesoLitSurface {
    MesoVec3 position, normal, to_eye;  /* relative to the anchor; unit */
    float albedo[3], roughness, metallic;
} MesoLitSurface;

/* Radiance to the eye; `openness`, which may be NULL, gets the share of the sky that is seen. */
void meso_light_on(const MesoLightRig *rig, const MesoLitSurface *surface, float radiance[3], float *openness);

#endif
