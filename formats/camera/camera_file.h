/* Cameras from files: .camera.json, key frames (camera_path.h). */
#ifndef MESO_CAMERA_FILE_H
#define MESO_CAMERA_FILE_H

#include "formats/file/input.h"
#include "libcore/base/arena.h"
#include "libcore/render/camera_path.h"

/*
 * {"format": "meso-camera", "version": 1, "keys": [{"frame": 1, "eye": [x, y, z], "target": [x, y, z], "up": [0, 1, 0],
 * "fov": 30}, ...]}: frames ascend; what is left out of a key is as in the one before, but of the first, where eye and
 * target must be and `usual` gives the rest. In place of "fov" are "focal" and "sensor", the lens and the width of the
 * picture in mm, or "ortho", the height of an orthographic picture: all keys are of one sort. `aspect` is the picture's
 * width / height. MESO_ERR_INPUT names the key.
 */
MesoStatus meso_camera_read(MesoCameraKey **keys, uint32_t *count, MesoArena *arena, const MesoInput *input,
                            const MesoCamera *usual, float aspect, MesoError *error);

#endif
