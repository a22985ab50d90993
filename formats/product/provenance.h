/*
 * Provenance: how a file came to be, and how the files that it was made of came
 * to be. No date and no host, so that the same command on the same inputs gives
 * the same bytes.
 */
#ifndef MESO_PROVENANCE_H
#define MESO_PROVENANCE_H

#include <jansson.h>

#include "formats/file/input.h"
#include "libcore/base/arena.h"

#define MESO_VERSION "0.1.0"

/*
 * The provenances of its inputs may take so many bytes in a provenance, and be so
 * deep, in levels of JSON: a chain stays short enough for every format and reader.
 * An input whose own goes beyond has its hash alone.
 */
enum { MESO_PROVENANCE_INPUTS = 256, MESO_PROVENANCE_NESTED = 65536, MESO_PROVENANCE_LEVELS = 64 };

typedef enum MesoProvenanceDetail {
    MESO_PROVENANCE_NAMES,      /* paths without their folders: the same job gives the same bytes anywhere */
    MESO_PROVENANCE_FULL,       /* paths as typed */
    MESO_PROVENANCE_NONE        /* tool and version alone */
} MesoProvenanceDetail;

typedef struct MesoProvenance {
    const char *tool;           /* "meso-map" */
    const char *command_line;   /* without what changes no byte of a product */
    uint64_t seed;
    MesoProvenanceDetail detail;
    uint32_t input_count;
    size_t nested_size;         /* of all below */
    struct {
        const char *role;       /* "tiles", "surface", "slots", ... */
        uint64_t hash[2];       /* XXH3-128 */
        const char *name;       /* of its file */
        const char *nested;     /* its own provenance, JSON text; NULL: none */
    } inputs[MESO_PROVENANCE_INPUTS];
} MesoProvenance;

/*
 * Notes an input, with its name and its own provenance in `arena`. What is wrong
 * with its file is left to its reader. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_provenance_add(MesoProvenance *provenance, const char *role, const MesoInput *input, MesoArena *arena,
                               MesoError *error);

/* What is recorded of a path, in `arena`: its last part, without a slash at its end. NULL when memory is out. */
const char *meso_provenance_name(const char *path, MesoArena *arena, MesoError *error);

/*
 * The provenance that a file of the suite carries, whatever its kind; `*found`
 * becomes NULL where it has none, or cannot be read. The caller owns it. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_provenance_find(json_t **found, const MesoInput *input, MesoError *error);

/*
 * {"tool", "version", "command", "seed", "inputs": [{"role", "name", "xxh3_128", "provenance": {...}}]},
 * with the last where the input has one; NULL when memory is out.
 */
json_t *meso_provenance_json(const MesoProvenance *provenance);

/* The same as one line of text, in `arena`; for comments and string attributes. */
const char *meso_provenance_text(const MesoProvenance *provenance, MesoArena *arena, MesoError *error);

/*
 * The same as comment lines that begin with `mark` and "provenance ", or, where readers of
 * short lines need it in pieces, "provenance+ " from the second on; "" for no provenance, NULL.
 */
const char *meso_provenance_lines(const MesoProvenance *provenance, const char *mark, MesoArena *arena,
                                  MesoError *error);

/* Copies the `size` bytes of a provenance chunk as text to `arena`. MESO_ERR_INPUT where they are
 * not one JSON object. `path` is for messages. */
MesoStatus meso_provenance_copy(const char **text, const void *data, uint64_t size,
                                const char *path, MesoArena *arena, MesoError *error);

#endif
