/*
 * Provenance: how a file came to be. No date and no host, so that the same
 * command on the same inputs gives the same bytes.
 */
#ifndef MESO_PROVENANCE_H
#define MESO_PROVENANCE_H

#include <jansson.h>

#include "formats/input.h"
#include "libcore/base/arena.h"

#define MESO_VERSION "0.1.0"

enum { MESO_PROVENANCE_INPUTS = 256 };

typedef struct MesoProvenance {
    const char *tool;           /* "meso-map" */
    const char *command_line;   /* as given, without --threads, --progress, -q, -v and --json,
                                   which change no byte of a product */
    uint64_t seed;
    uint32_t input_count;
    struct {
        const char *role;       /* "tiles", "surface", "slots", ... */
        uint64_t hash[2];       /* XXH3-128 */
    } inputs[MESO_PROVENANCE_INPUTS];
} MesoProvenance;

void meso_provenance_add(MesoProvenance *provenance, const char *role, const MesoInput *input);

/* {"tool", "version", "command", "seed", "inputs": [{"role", "xxh3_128"}]}; NULL when memory is out. */
json_t *meso_provenance_json(const MesoProvenance *provenance);

/* The same as one line of text, in `arena`; for comments and string attributes. */
const char *meso_provenance_text(const MesoProvenance *provenance, MesoArena *arena, MesoError *error);

/* Copies the `size` bytes of a provenance chunk as text to `arena`. MESO_ERR_INPUT where they are
 * not one JSON object. `path` is for messages. */
MesoStatus meso_provenance_copy(const char **text, const void *data, uint64_t size,
                                const char *path, MesoArena *arena, MesoError *error);

#endif
