/*
 * Work in a process of its own: GL drivers do not survive a failed allocation,
 * and their death must not be ours. Memory that is shared with it brings the
 * results back without a copy.
 */
#ifndef MESO_ISOLATE_H
#define MESO_ISOLATE_H

#include <stddef.h>

#include "libcore/base/error.h"

/* Zeroed memory that a child of this process shares; NULL with MESO_ERR_MEMORY where there is none. */
void *meso_shared_new(size_t size, MesoError *error);
void meso_shared_free(void *memory, size_t size);

/* Has all pages of it there, which one by one, as they are written to, takes ten times as long; nothing is changed. */
void meso_shared_fill(void *memory, size_t size);

typedef MesoStatus MesoWork(void *context, MesoError *error);

/*
 * Runs `work` in a child process and waits for it. What it writes reaches the
 * caller through meso_shared_new() alone.
 *
 * what    names the work in messages: "drawing"
 * need    bytes that the work is sure to take; where they are not to be had
 *         it is not begun
 *
 * Returns what `work` returned, with its error. MESO_ERR_MEMORY where no
 * process can be started, and where the work dies and its `need` is not to be
 * had any more, or of SIGKILL, as the kernel ends what takes too much;
 * MESO_ERR_INTERNAL with the signal and the first line that it said where it
 * dies otherwise. A signal that asks the child to end (SIGTERM, SIGXCPU) is
 * raised here too. The child does not outlive this process, whatever ends
 * that; it has none of its signal handlers, and its standard error is part of
 * the message or lost.
 */
MesoStatus meso_isolate(const char *what, MesoWork *work, void *context, size_t need, MesoError *error);

#endif
