/* Details that are to replicate, from files (.details.json, "meso-details", version 1): meso-details(5). */
#ifndef MESO_DETAILS_FILE_H
#define MESO_DETAILS_FILE_H

#include "formats/json/json_files.h"
#include "formats/replicate/details_spec.h"
#include "libcore/base/arena.h"

/*
 * Reads details into `arena`. `files` may be NULL; files of points are then refused. Names of kinds and materials are
 * numbers, what was left out has its default, every number is finite and within the limits of meso-details(5).
 * MESO_ERR_INPUT names the file and the place ("details[1].density.low: ..."), the line and column where the JSON
 * itself is broken, the nearest name for one that is not known, and a newer version. O(size of the files).
 */
MesoStatus meso_details_read(MesoDetailsFile *details, MesoArena *arena, const MesoInput *input,
                             const MesoJsonFiles *files, MesoError *error);

#endif
