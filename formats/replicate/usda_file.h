/*
 * Clips of details as one file of Universal Scene Description, as text (.usda): a PointInstancer with time samples, ids
 * that stay, and the surface that moves below it.
 *
 * A file has all samples of one attribute together, and frames come one by one: each attribute goes to a file of its
 * own until the end.
 */
#ifndef MESO_USDA_FILE_H
#define MESO_USDA_FILE_H

#include "formats/file/output.h"
#include "formats/replicate/instance_scene.h"

typedef struct MesoUsda MesoUsda;

/*
 * Begins a clip. `scene` and what it holds must outlive it.
 *
 * near       path of the product, in whose folder the attributes wait; they have no names there
 */
MesoStatus meso_usda_begin(MesoUsda **usda, const MesoInstanceScene *scene, double frames_per_second,
                           const char *near, MesoError *error);

/* Adds a frame; numbers ascend. O(details + vertices); memory does not grow. */
MesoStatus meso_usda_frame(MesoUsda *usda, int32_t number, const MesoInstanceFrame *frame, MesoError *error);

/* Writes the whole clip, of at least one frame. */
MesoStatus meso_usda_write(MesoUsda *usda, MesoOutput *output, MesoError *error);

/* NULL is allowed. */
void meso_usda_release(MesoUsda *usda);

#endif
