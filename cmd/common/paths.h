/*
 * The files of one call: none that is written may be one that is read, nor be
 * written twice. Files are compared by what they are: other spellings and links,
 * hard or symbolic, name the same one.
 */
#ifndef MESO_PATHS_H
#define MESO_PATHS_H

#include <stdbool.h>
#include <stdint.h>

#include "libcore/base/arena.h"

/* What a path names: a file that is there, or a name in a folder that is. */
typedef struct MesoFileKey {
    uint64_t device, inode;     /* of the file, or of the folder */
    uint64_t name[2];           /* hash of the name in the folder; 0 for a file that is there */
} MesoFileKey;

typedef struct MesoPath {
    const char *path;
    const char *option;         /* as in "-o" or "--report" of an output; NULL: an input */
    MesoFileKey key;
} MesoPath;

typedef struct MesoPaths {
    MesoPath *paths;            /* [count] */
    uint32_t count, room;
    const char *clash[2];       /* the two paths of the last refusal, as they were added */
} MesoPaths;

/*
 * Adds a file that is read, or one that `option` has written; "-" is a standard
 * stream. Devices, pipes, and what is in no folder that there is, are anyone's to
 * use twice, and two outputs on standard output are for the tool to judge. MESO_ERR_USAGE names both
 * where one would be lost. `path` and `option` must outlive `paths`. O(count).
 */
MesoStatus meso_paths_add_input(MesoPaths *paths, const char *path, MesoArena *arena, MesoError *error);
MesoStatus meso_paths_add_output(MesoPaths *paths, const char *option, const char *path, MesoArena *arena,
                                 MesoError *error);

/* Whether `path` is one of those that were added: then MESO_ERR_USAGE, as above. Adds nothing. */
MesoStatus meso_paths_check_output(MesoPaths *paths, const char *option, const char *path, MesoError *error);

/* False where `path` names nothing that could be lost. */
bool meso_path_key(MesoFileKey *key, const char *path, bool output);

#endif
