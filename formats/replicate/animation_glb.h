/*
 * A clip of details as one GLB with an animation: a node for each detail that is moved, turned and scaled, and the
 * surface with a morph target for each frame but the first.
 */
#ifndef MESO_ANIMATION_GLB_H
#define MESO_ANIMATION_GLB_H

#include "formats/file/output.h"
#include "formats/replicate/instance_scene.h"

/* More nodes are no longer shown smoothly; and of more frames the weights of a surface's targets alone take 4 GiB. */
enum { MESO_ANIMATION_DETAILS = 4096, MESO_ANIMATION_SHAPES = 1 << 15 };

typedef struct MesoAnimation MesoAnimation;

/* Begins a clip. `scene` and what it holds must outlive it. */
MesoStatus meso_animation_begin(MesoAnimation **animation, const MesoInstanceScene *scene, double frames_per_second,
                                MesoError *error);

/*
 * Adds a frame, and keeps it; numbers ascend. O(details + vertices). MESO_ERR_LIMIT over MESO_ANIMATION_DETAILS, or
 * over MESO_ANIMATION_SHAPES with a surface.
 */
MesoStatus meso_animation_frame(MesoAnimation *animation, int32_t number, const MesoInstanceFrame *frame,
                                MesoError *error);

/* Writes the whole clip, of at least one frame. MESO_ERR_LIMIT beyond 4 GiB, MESO_ERR_INPUT for nothing to show. */
MesoStatus meso_animation_write(MesoAnimation *animation, MesoOutput *output, MesoError *error);

/* NULL is allowed. */
void meso_animation_release(MesoAnimation *animation);

#endif
