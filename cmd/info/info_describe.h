/* What meso-info says about each kind of file, as JSON. */
#ifndef MESO_INFO_DESCRIBE_H
#define MESO_INFO_DESCRIBE_H

#include <jansson.h>

#include "formats/file/input.h"
#include "libcore/base/arena.h"

/* Each reads and checks all of `input`, and sets what it found in `facts`. */
MesoStatus meso_info_slots(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error);
MesoStatus meso_info_model(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error);
MesoStatus meso_info_mesh(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error);

MesoStatus meso_info_seed_lines(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error);

/* A tile set of either kind, constraints, or a report. */
MesoStatus meso_info_json(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
