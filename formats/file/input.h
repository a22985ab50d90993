/* Input files: whole, read-only, with their hash. */
#ifndef MESO_INPUT_H
#define MESO_INPUT_H

#include <stddef.h>
#include <stdint.h>

#include "libcore/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct MesoInput {
    const char *path;       /* as given; must outlive the input */
    const uint8_t *data;    /* [size] page-aligned, never NULL */
    size_t size;
    uint64_t hash[2];       /* XXH3-128 of the bytes, high word first */
    void *mapping;
    size_t mapping_size;
} MesoInput;

/*
 * Maps `path` ("-": reads standard input). MESO_ERR_INPUT for what is missing,
 * unreadable, empty, or not a regular file or pipe, each by its own message.
 * Bytes that others write into the file while we read are not guarded against; where they cut it,
 * reading what is gone raises SIGBUS: meso_input_mapped_at() tells its handler which file it was.
 */
MesoStatus meso_input_open(MesoInput *input, const char *path, MesoError *error);

/* Wraps bytes that the caller owns; for tests, chunks and fuzzers. */
void meso_input_wrap(MesoInput *input, const char *path, const void *data, size_t size);

/* Length of the UTF-8 byte order mark that the text begins with; 0 for none. */
size_t meso_input_mark(const MesoInput *input);

void meso_input_close(MesoInput *input);

/* Path of the open input whose mapping holds `address`, or NULL. Async-signal-safe. */
const char *meso_input_mapped_at(const void *address);

#ifdef __cplusplus
}
#endif

#endif
