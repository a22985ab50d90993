/* Parallel loops whose results do not depend on the number of threads. */
#ifndef MESO_PARALLEL_H
#define MESO_PARALLEL_H

#include <stdint.h>

/*
 * Calls `body(context, begin, end)` for consecutive ranges of at most `grain`
 * items that together cover [0, count). Ranges are the same for every
 * `thread_count` (0: all cores); which thread runs which is not. `body` must
 * write only to what belongs to its range. Threads that the system refuses are
 * done without.
 */
void meso_parallel_for(uint32_t thread_count, uint64_t count, uint64_t grain,
                       void (*body)(void *context, uint64_t begin, uint64_t end), void *context);

/*
 * The same, and says which of `worker_count` threads, at least one, runs the range: what belongs to a worker, such as
 * scratch, is used by no two at once.
 */
void meso_parallel_team(uint32_t worker_count, uint64_t count, uint64_t grain,
                        void (*body)(void *context, uint32_t worker, uint64_t begin, uint64_t end), void *context);

/* Threads that `thread_count` 0 stands for. */
uint32_t meso_parallel_cores(void);

#endif
