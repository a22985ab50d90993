/* Files that DETAILS names: beside it, where their paths are not absolute. */
#ifndef MESO_REPLICATE_FILES_H
#define MESO_REPLICATE_FILES_H

#include "cmd/common/tool.h"
#include "formats/json/json_files.h"

enum { MESO_REPLICATE_FILES = 64 };

typedef struct MesoReplicateFiles {
    MesoTool *tool;
    const char *details;            /* path of DETAILS */
    MesoInput inputs[MESO_REPLICATE_FILES];     /* [count] open until the end */
    uint32_t count;
} MesoReplicateFiles;

/* The path of a file that DETAILS calls `name`; NULL where memory is out. */
const char *meso_replicate_file_path(const MesoReplicateFiles *files, const char *name);

/* Opens it, and notes it in the provenance; once for each name. NULL, with the tool's error filled. */
const MesoInput *meso_replicate_file(MesoReplicateFiles *files, const char *name, const char *role);

/* For readers of JSON. */
MesoJsonFiles meso_replicate_json_files(MesoReplicateFiles *files);

void meso_replicate_files_close(MesoReplicateFiles *files);

#endif
