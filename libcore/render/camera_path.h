/* Cameras that move: through key frames, and around a model. */
#ifndef MESO_CAMERA_PATH_H
#define MESO_CAMERA_PATH_H

#include "libcore/render/projection.h"

typedef struct MesoCameraKey {
    int32_t frame;
    MesoCamera camera;
} MesoCameraKey;

/*
 * The camera at a frame: between keys, ascending and at least one, a cubic through both whose slope at each is that from
 * the key before to the one after; beyond the first and the last as there. O(log count).
 */
MesoCamera meso_camera_at(const MesoCameraKey *keys, uint32_t count, int32_t frame);

/* The camera gone by a share of a full turn around the line through its target along its `up`, counter-clockwise from
 * above, so that the model seems to turn clockwise. */
MesoCamera meso_camera_turn(const MesoCamera *camera, float share);

#endif
