/*
 * Progress of long work on standard error: one line on a terminal, rewritten
 * in place, or JSON lines for programs.
 */
#ifndef MESO_PROGRESS_H
#define MESO_PROGRESS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

typedef enum MesoProgressMode {
    MESO_PROGRESS_NONE,
    MESO_PROGRESS_LINE,     /* from the first second on, at most 10 times a second */
    MESO_PROGRESS_JSON      /* at most twice a second, and once more at the end */
} MesoProgressMode;

typedef struct MesoProgress {
    MesoProgressMode mode;
    const char *what, *unit;        /* of the work under way; NULL for none */
    uint64_t start;                 /* nanoseconds */
    atomic_uint_fast64_t next;      /* no update before */
    atomic_uint_fast64_t done, total;
    atomic_bool shown;              /* a line stands on the terminal */
} MesoProgress;

/* `mode` of the option; "auto" is a line if standard error is a terminal and `quiet` is not set. */
void meso_progress_init(MesoProgress *progress, const char *mode, bool quiet);

/* `what` ("mapping") and `unit` ("slots") must outlive the work. Ends the work before. */
void meso_progress_begin(MesoProgress *progress, const char *what, const char *unit);

/* From any thread. Most calls only look at the clock. */
void meso_progress_update(MesoProgress *progress, uint64_t done, uint64_t total);

/* Last JSON line, or takes the line off the terminal. */
void meso_progress_end(MesoProgress *progress);

/* Takes the line off the terminal, for a message; the next update brings it back. */
void meso_progress_hide(MesoProgress *progress);

/* "mapping  41% 12.3k slots/s, 8 s left", to `out` of `size` bytes; `seconds` since the start. */
void meso_progress_format(char *out, unsigned size, const char *what, const char *unit,
                          uint64_t done, uint64_t total, double seconds);

#endif
