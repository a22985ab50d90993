/* What meso-info says about quilts. */
#ifndef MESO_INFO_QUILT_H
#define MESO_INFO_QUILT_H

#include <jansson.h>

#include "formats/file/input.h"
#include "libcore/base/arena.h"

/* Reads and checks all of `input`, and sets what it found in `facts`. */
MesoStatus meso_info_quilt(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
