/* meso-solve --seeds: many seeds of one problem, a JSON line each. */
#ifndef MESO_SOLVE_SEEDS_H
#define MESO_SOLVE_SEEDS_H

#include "cmd/solve/seed_problem.h"

typedef struct MesoSeedOptions {
    const char *seeds, *each, *resume, *best;
} MesoSeedOptions;

#define MESO_SEED_OPTIONS(o)                                                                  \
    MESO_GROUP("Many seeds"), \
    MESO_TEXT(0, "seeds", "A-B[xK],...", \
              "solve for the seeds A to B, with K attempts each, and write a JSON line each to -o or " \
              "standard output", &(o).seeds), \
    MESO_PATTERN(0, "each", "PATTERN", "write each assignment too, to PATTERN with the seed for its %d", \
                 &(o).each), \
    MESO_INPUT_FILE(0, "resume", "FILE", \
                    "take the lines that FILE has of these seeds instead of solving them again", \
                    &(o).resume, .more = MESO_OPTION_OUTWARD), \
    MESO_TEXT(0, "best", "METRIC[=FILE]", \
              "say which seed is best by attempts, balance or loops, and write its assignment to FILE", \
              &(o).best, .more = MESO_OPTION_OUTWARD)

/* Checks the options among each other and with the tool's. MESO_ERR_USAGE. */
MesoStatus meso_seed_options_check(const MesoSeedOptions *options, const MesoTool *tool, bool attempts_given,
                                   MesoError *error);

/*
 * Solves all seeds, on the threads of the tool, and writes their lines in the
 * order of the seeds. With -o FILE they are kept in FILE.partial as they come, which
 * stays where the work is cut short, and is gone when FILE is there.
 * MESO_OK where a seed was solved, MESO_ERR_NO where it is proved that none
 * can be, MESO_ERR_LIMIT where all gave up; lines are written in any case.
 */
MesoStatus meso_solve_seeds(MesoTool *tool, const MesoSeedOptions *options, const MesoSeedProblem *problem);

#endif
