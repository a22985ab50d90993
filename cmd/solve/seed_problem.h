/* What meso-solve --seeds solves. */
#ifndef MESO_SEED_PROBLEM_H
#define MESO_SEED_PROBLEM_H

#include "cmd/solve/solve_surface.h"
#include "libcore/tiling/solve/solve.h"

/* What is solved for each seed. */
typedef struct MesoSeedProblem {
    const MesoTilingProblem *tiling;
    const MesoSolveSurface *surface;
    const uint64_t *tiles_hash;     /* [2] */
    MesoSolveOptions solve;         /* but for seed and progress; its attempts unless --seeds says */
    const char *others;             /* whatever else is asked for, in words: part of the problem's hash */
} MesoSeedProblem;

#endif
