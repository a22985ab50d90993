/* The monotonic clock, in seconds: for budgets, progress and benchmarks; never for what a result depends on. */
#ifndef MESO_CLOCK_H
#define MESO_CLOCK_H

#include <time.h>

static inline double meso_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
