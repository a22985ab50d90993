/* What meso-info says about details that replicate: files of details and deformations, states, plans, reports. */
#ifndef MESO_INFO_REPLICATE_H
#define MESO_INFO_REPLICATE_H

#include <jansson.h>
#include <stdbool.h>

#include "formats/file/input.h"
#include "libcore/base/arena.h"

/* Of JSON by its "format"; false where that is none of these. `status` as of the readers. */
bool meso_info_replicate(json_t *facts, MesoArena *arena, const char *format, const json_t *root,
                         const MesoInput *input, MesoStatus *status, MesoError *error);

/* Each reads and checks all of `input`, and sets what it found in `facts`. */
MesoStatus meso_info_state(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error);
MesoStatus meso_info_plan(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
