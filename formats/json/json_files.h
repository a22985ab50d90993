/* Files that JSON names. */
#ifndef MESO_JSON_FILES_H
#define MESO_JSON_FILES_H

#include "formats/file/input.h"
#include "formats/json/json_field.h"

/* How a reader gets at the files that its text names. */
typedef struct MesoJsonFiles {
    void *context;
    /*
     * The file called `name`, as it is written in the text; the caller's, and open until all of that has been read. Asked
     * for once for each name. NULL, with `error` filled, where it cannot be had.
     */
    const MesoInput *(*open)(void *context, const char *name, MesoError *error);
} MesoJsonFiles;

/* The file that a field names by `name`; NULL after a problem, and where `files` is NULL, which is one. */
const MesoInput *meso_json_open(const MesoJsonFiles *files, const MesoJsonField *field, const char *name);

#endif
