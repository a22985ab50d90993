/*
 * Mapping options beyond those of the chunk 'options' (model_file.h): the chunk 'mapping' of a model, JSON text,
 * an object with a key for each option that is not at its default. Without such an option there is no chunk.
 *
 *     "frame"           "minimal"
 *     "section_size"    "slot"
 *     "tolerance"       a number, in mean edge lengths, or with
 *     "tolerance_in"    "scene" in scene units
 *     "relax"           steps of relaxation; then there is a chunk 'joint' too
 *
 * One more option is a field of MesoMapOptions whose 0 is the default, and a row of the table in model_mapping.c.
 */
#ifndef MESO_MODEL_MAPPING_H
#define MESO_MODEL_MAPPING_H

#include <jansson.h>

#include "formats/file/input.h"
#include "libcore/tiling/strand/model.h"

/* Adds a key to `object` for each option that is not at its default. 0, or -1 where memory is out, as in Jansson. */
int meso_mapping_to_json(json_t *object, const MesoMapOptions *options);

/* The chunk's text, to be freed, or NULL with MESO_OK where all is at its default. */
MesoStatus meso_mapping_text(char **text, const MesoMapOptions *options, MesoError *error);

/* Sets what `text` has keys for. MESO_ERR_INPUT names the key that is unknown, or out of range. */
MesoStatus meso_mapping_read(MesoMapOptions *options, const MesoInput *text, MesoArena *arena, MesoError *error);

#endif
