/* Many seeds of one problem, on several cores: each seed is solved by itself, on one thread. */
#ifndef MESO_MANY_SEEDS_H
#define MESO_MANY_SEEDS_H

#include "libcore/tiling/solve/solve.h"

typedef struct MesoManySeeds {
    const MesoTilingProblem *problem;
    MesoSolveOptions options;   /* but for the seed; its progress must be NULL */
    uint32_t thread_count;      /* 0: all cores */
    uint32_t seed_count;
    const uint64_t *seeds;      /* [seed_count] */

    /*
     * Gets the result of seeds[index], which is gone afterwards. Called once for
     * each seed, in no set order, from several threads at a time. What it does
     * not return MESO_OK for ends the sweep.
     */
    MesoStatus (*take)(void *context, uint32_t index, const MesoSolveResult *result, MesoError *error);
    void *context;
} MesoManySeeds;

/*
 * Solves every seed as meso_solve() does; the results do not depend on the
 * number of threads, nor on which seeds are solved beside. Returns MESO_OK for
 * every verdict, or what ended the sweep; seeds that were begun by then are taken.
 * Memory as meso_solve(), for each thread.
 */
MesoStatus meso_many_seeds(const MesoManySeeds *sweep, MesoError *error);

#endif
