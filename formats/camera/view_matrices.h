/* The prototype's cameras: view matrices, one a frame, as GL has them. */
#ifndef MESO_VIEW_MATRICES_H
#define MESO_VIEW_MATRICES_H

#include "formats/file/input.h"
#include "libcore/base/arena.h"
#include "libcore/render/camera_path.h"

/*
 * Files of 16 little-endian floats a frame, column by column: the camera's axes, right, up and back, and its place seen
 * from there. Frames count from 1. What they do not say is as `usual` has it. MESO_ERR_INPUT, with the frame, for
 * another size, or a matrix that is not of a turn and a move.
 */
MesoStatus meso_view_matrices_read(MesoCameraKey **keys, uint32_t *count, MesoArena *arena, const MesoInput *input,
                                   const MesoCamera *usual, MesoError *error);

#endif
