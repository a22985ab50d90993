/*
 * Output files that appear whole or not at all: bytes go to a temporary file
 * beside the target, which is synced and renamed over it on commit. Standard
 * output ("-") is spooled the same way and copied on commit.
 */
#ifndef MESO_OUTPUT_H
#define MESO_OUTPUT_H

#include <stddef.h>
#include <stdint.h>

#include "libcore/base/error.h"

typedef struct MesoOutput MesoOutput;

/* MESO_ERR_OUTPUT where the folder is missing or cannot be written to. */
MesoStatus meso_output_open(MesoOutput **output, const char *path, MesoError *error);

/*
 * Where a chain of symbolic links from `path` ends, which need not exist: the file
 * that would be written. Owned by the caller; NULL with errno.
 */
char *meso_output_target(const char *path);

/* Appends. After a failure every later call fails too. */
MesoStatus meso_output_write(MesoOutput *output, const void *data, size_t size, MesoError *error);

/* Appends text of a printf format, cut after 1023 bytes. */
MesoStatus meso_output_print(MesoOutput *output, MesoError *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/*
 * Writes at `offset`, which may lie anywhere; the end of the file follows the furthest byte. Threads may call it at
 * once, for places apart.
 */
MesoStatus meso_output_write_at(MesoOutput *output, uint64_t offset, const void *data, size_t size,
                                MesoError *error);

/* Makes the file appear. Frees `output`, whether it succeeds or not. */
MesoStatus meso_output_commit(MesoOutput *output, MesoError *error);

/* Removes what was written. Frees `output`; NULL is allowed. */
void meso_output_discard(MesoOutput *output);

/*
 * Ends what was begun by meso_output_open(), which may have failed: commits where `status` is MESO_OK,
 * discards elsewhere. Returns `status`, or that of the commit. So that a file is written by
 *
 *     MesoStatus status = meso_output_open(&output, path, error);
 *     if (!status)
 *         status = thing_write(thing, output, error);
 *     return meso_output_finish(output, status, error);
 */
MesoStatus meso_output_finish(MesoOutput *output, MesoStatus status, MesoError *error);

/*
 * The same for the files of one run, of which none appears unless all could be written: [count], NULL for none. Devices
 * and pipes get their bytes first, since they may refuse them; what one has got before another fails is not undone.
 */
MesoStatus meso_output_finish_all(MesoOutput *const *outputs, uint32_t count, MesoStatus status, MesoError *error);

#endif
