/* What meso-info says about files of meso-decor: patterns, macros, trees of regions. */
#ifndef MESO_INFO_DECOR_H
#define MESO_INFO_DECOR_H

#include <jansson.h>
#include <stdbool.h>

#include "libcore/base/error.h"

/*
 * Puts the facts of `root`, whose "format" is `format`. False where that is another kind of file. *status:
 * MESO_ERR_INPUT for a newer version, or one that lacks what it is about; MESO_ERR_MEMORY.
 */
bool meso_info_decor(json_t *facts, const char *format, json_t *root, const char *path, MesoStatus *status,
                     MesoError *error);

#endif
