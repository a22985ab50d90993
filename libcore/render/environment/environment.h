/*
 * Light from all around, made ready once for any number of pictures: the brightest part of a map apart, as a key light
 * that casts shadows; of the rest the irradiance by spherical harmonics ("An Efficient Representation for Irradiance
 * Environment Maps", Ramamoorthi, Hanrahan 2001); and what a surface of some roughness reflects of each of both, the
 * first part of the split sum of "Real Shading in Unreal Engine 4" (Karis 2013). Key light and rest together are the
 * map: no light is lost or made.
 */
#ifndef MESO_ENVIRONMENT_H
#define MESO_ENVIRONMENT_H

#include "libcore/render/environment/glossy_levels.h"

/* What is lit by the key light, and by the rest. */
typedef enum MesoEnvironmentPart { MESO_LIGHT_REST, MESO_LIGHT_KEY, MESO_LIGHT_PARTS } MesoEnvironmentPart;

/* In the axes of the map: y up, z to the front. */
typedef struct MesoEnvironment {
    MesoLatLong map;            /* as it was given, times the strength */
    float turn;                 /* of it about y, counter-clockwise seen from above, radians */
    MesoLatLong glossy[MESO_LIGHT_PARTS][MESO_GLOSSY_LEVELS];   /* by roughness; the first is the part itself */
    float harmonics[9][3];      /* of the rest: irradiance / pi */
    MesoVec3 to_key;            /* unit */
    float key[3];               /* irradiance of what faces it; 0: there is none */
    float key_extent;           /* tangent of half the angle of a disc as wide as the key light */
} MesoEnvironment;

typedef struct MesoEnvironmentOptions {
    float turn;                 /* degrees */
    float strength;             /* factor */
} MesoEnvironmentOptions;

/*
 * Takes over the numbers of `map`, of which those that are no radiance are mended: below 0 or not a number to 0,
 * infinite ones to 65504. What is made of it lives in `arena`. The same for any number of threads (0: all). Some 0.1 s.
 * MESO_ERR_MEMORY alone.
 */
MesoStatus meso_environment_init(MesoEnvironment *environment, MesoArena *arena, const MesoLatLong *map,
                                 const MesoEnvironmentOptions *options, uint32_t thread_count, MesoError *error);

/* Irradiance / pi of a surface with that normal from all of the rest. */
void meso_environment_diffuse(const MesoEnvironment *environment, MesoVec3 normal, float out[3]);

/* Radiance of a part around a direction, as far around as facets of that roughness look. */
void meso_environment_glossy(const MesoEnvironment *environment, MesoEnvironmentPart part, MesoVec3 direction,
                             float roughness, float out[3]);

/* Axes of the turned map in a world with that `up`, unit: x, y and z; the front is +Z, or -Y where up is along Z. */
void meso_environment_axes(const MesoEnvironment *environment, MesoVec3 up, MesoVec3 axes[3]);

#endif
