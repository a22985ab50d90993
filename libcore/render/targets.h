/* The framebuffers of one window of the image, and their textures. */
#ifndef MESO_TARGETS_H
#define MESO_TARGETS_H

#include <stddef.h>

#include "libcore/render/gl_functions.h"

/* What the surface pass writes, in the order of its outputs. */
typedef enum MesoSurfaceTarget {
    MESO_TARGET_NORMAL,     /* and roughness */
    MESO_TARGET_ALBEDO,     /* and metallic */
    MESO_TARGET_DEPTH,
    MESO_TARGET_IDS,        /* row of the scene's ids, from 1 */
    MESO_SURFACE_TARGETS
} MesoSurfaceTarget;

typedef struct MesoTargets {
    const MesoGl *gl;
    uint32_t width, height, sample_side, shadow_size;
    GLuint center[MESO_SURFACE_TARGETS];    /* at the pixels' centres */
    GLuint multi;                           /* sample_side x sample_side a pixel, packed; 0 for 1 */
    GLuint center_z, multi_z;
    GLuint openness_raw, openness, color, shadow;
    GLuint center_frame, multi_frame, openness_raw_frame, openness_frame, color_frame, shadow_frame;
} MesoTargets;

/*
 * Samples lie on a grid in larger textures rather than in multisampled ones:
 * software drivers take three times as long for those where triangles are small.
 * MESO_ERR_LIMIT where the driver has no such framebuffers.
 */
MesoStatus meso_targets_init(MesoTargets *targets, const MesoGl *gl, uint32_t width, uint32_t height,
                             uint32_t sample_side, uint32_t shadow_size, MesoError *error);

/* What their textures take. */
size_t meso_targets_bytes(uint32_t width, uint32_t height, uint32_t sample_side, uint32_t shadow_size);
void meso_targets_release(MesoTargets *targets);

/* Binds, sets the viewport, and clears: to nothing seen, infinitely far. */
void meso_targets_begin_center(const MesoTargets *targets);
void meso_targets_begin_multi(const MesoTargets *targets);
void meso_targets_begin_shadow(const MesoTargets *targets);

#endif
