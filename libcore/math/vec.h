/* Small vectors. All lengths are in scene units unless a name says otherwise. */
#ifndef MESO_VEC_H
#define MESO_VEC_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "libcore/base/index.h"

#define MESO_PI 3.14159265358979323846

typedef struct MesoVec2 {
    float x, y;
} MesoVec2;

typedef struct MesoVec3 {
    float x, y, z;
} MesoVec3;

static inline MesoVec2 meso_vec2_add(MesoVec2 a, MesoVec2 b)
{
    return (MesoVec2){a.x + b.x, a.y + b.y};
}

static inline MesoVec2 meso_vec2_sub(MesoVec2 a, MesoVec2 b)
{
    return (MesoVec2){a.x - b.x, a.y - b.y};
}

static inline MesoVec2 meso_vec2_scale(MesoVec2 a, float s)
{
    return (MesoVec2){a.x * s, a.y * s};
}

static inline MesoVec2 meso_vec2_lerp(MesoVec2 a, MesoVec2 b, float t)
{
    return (MesoVec2){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
}

static inline float meso_vec2_cross(MesoVec2 a, MesoVec2 b)
{
    return a.x * b.y - a.y * b.x;
}

static inline float meso_vec2_length(MesoVec2 a)
{
    return sqrtf(a.x * a.x + a.y * a.y);
}

static inline MesoVec3 meso_vec3_add(MesoVec3 a, MesoVec3 b)
{
    return (MesoVec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline MesoVec3 meso_vec3_sub(MesoVec3 a, MesoVec3 b)
{
    return (MesoVec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline MesoVec3 meso_vec3_scale(MesoVec3 a, float s)
{
    return (MesoVec3){a.x * s, a.y * s, a.z * s};
}

/* a + s * b */
static inline MesoVec3 meso_vec3_mad(MesoVec3 a, float s, MesoVec3 b)
{
    return (MesoVec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline MesoVec3 meso_vec3_lerp(MesoVec3 a, MesoVec3 b, float t)
{
    return (MesoVec3){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t};
}

static inline float meso_vec3_dot(MesoVec3 a, MesoVec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline MesoVec3 meso_vec3_cross(MesoVec3 a, MesoVec3 b)
{
    return (MesoVec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline float meso_vec3_length(MesoVec3 a)
{
    return sqrtf(meso_vec3_dot(a, a));
}

/* `a` at unit length; `fallback` where `a` has no direction. */
static inline MesoVec3 meso_vec3_unit(MesoVec3 a, MesoVec3 fallback)
{
    float length = meso_vec3_length(a);
    return length > 0 && isfinite(length) ? meso_vec3_scale(a, 1 / length) : fallback;
}

/* The same for components from 1e-37 to 1e37, whose squares single precision does not hold. */
static inline MesoVec3 meso_vec3_direction(MesoVec3 a, MesoVec3 fallback)
{
    float largest = fmaxf(fabsf(a.x), fmaxf(fabsf(a.y), fabsf(a.z)));
    if (largest > 1e-15f && largest < 1e15f)
        return meso_vec3_unit(a, fallback);
    return meso_vec3_unit(meso_vec3_scale(a, 1 / largest), fallback);
}

static inline bool meso_vec3_finite(MesoVec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

#endif
