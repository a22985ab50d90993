/* Items that threads make, and that the caller takes, one after the other, while more are made. */
#ifndef MESO_PIPELINE_H
#define MESO_PIPELINE_H

#include <stdbool.h>
#include <stdint.h>

/*
 * `make` is called once for each of `count` items, by any of the workers, of which each has a number; `take` for item
 * after item by the caller alone, which makes items while none is ready, and which is worker 0. An item has place
 * item % room from when it is made to when it has been taken: no more than `room` of them, at least one, are there at
 * once. Once `take` returns false, no other item is taken, and few are made.
 */
typedef struct MesoPipeline {
    uint64_t count;
    uint32_t room;
    void *context;
    void (*make)(void *context, uint32_t worker, uint64_t item);
    bool (*take)(void *context, uint64_t item);
} MesoPipeline;

/* `worker_count`, at least one, counts the caller; those that the system refuses are done without. */
void meso_pipeline_run(const MesoPipeline *pipeline, uint32_t worker_count);

#endif
