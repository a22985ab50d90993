/* How far two pictures are from each other. */
#ifndef MESO_INFO_COMPARE_H
#define MESO_INFO_COMPARE_H

#include <jansson.h>

#include "formats/file/input.h"
#include "libcore/base/arena.h"

/*
 * Adds to `facts` the size of both pictures, and of each channel that both have: how many pixels differ; in how many of
 * them one alone is finite; of the others the largest difference and the pixel that has it, the root of the mean
 * square, and that beside the first picture's own (null where it is 0).
 * Returns MESO_ERR_NO where any pixel differs, or a channel is in one of them alone; MESO_ERR_INPUT for what is no
 * picture, or pictures of different sizes; MESO_ERR_MEMORY.
 */
MesoStatus meso_info_compare(json_t *facts, MesoArena *arena, const MesoInput *a, const MesoInput *b, MesoError *error);

#endif
