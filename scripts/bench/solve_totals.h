/* Many solves against a clock, and what came of them: for the benchmarks of this folder. */
#ifndef MESO_SOLVE_TOTALS_H
#define MESO_SOLVE_TOTALS_H

#include <stdio.h>

#include "formats/tiling/result/report_file.h"
#include "libcore/base/clock.h"

typedef struct SolveTotals {
    uint64_t seed;              /* of all solves */
    uint32_t verdicts[3];
    uint32_t deciders[MESO_DECIDER_STOP + 1];
    double slowest, sum;        /* seconds */
} SolveTotals;

static inline bool solve_past(void *context)
{
    const double *deadline = context;
    return meso_seconds() > *deadline;
}

/* meso_solve() with 20 attempts, for `limit` seconds at most; `time` gets those it took. */
static inline MesoStatus solve_timed(MesoSolveResult *result, MesoArena *arena, const MesoTileSet *set,
                                     const MesoVariantSet *variants, const MesoSlotGraph *graph, double limit,
                                     double *time, SolveTotals *totals, MesoError *error)
{
    double start = meso_seconds(), deadline = start + limit;
    const MesoSolveOptions options = {.seed = totals->seed, .max_attempts = 20, .max_dead_ends = 20,
                                      .stop = solve_past, .stop_context = &deadline};
    MesoStatus status = meso_solve(result, arena, &(MesoTilingProblem){set, variants, graph, NULL}, &options, error);
    *time = meso_seconds() - start;
    if (status)
        return status;
    totals->verdicts[result->verdict]++;
    totals->deciders[result->decider]++;
    totals->sum += *time;
    totals->slowest = *time > totals->slowest ? *time : totals->slowest;
    return MESO_OK;
}

static inline void solve_print_totals(const SolveTotals *totals, const char *name)
{
    printf("%s: ", name);
    for (MesoVerdict v = MESO_VERDICT_SOLVED; v <= MESO_VERDICT_GAVE_UP; v++)
        printf("%s %u, ", meso_verdict_name(v), totals->verdicts[v]);
    printf("by");
    for (MesoDecider d = MESO_DECIDER_PROPAGATION; d <= MESO_DECIDER_STOP; d++)
        if (totals->deciders[d])
            printf(" %s %u,", meso_decider_name(d), totals->deciders[d]);
    printf(" %.1f s in all, the slowest %.1f s\n", totals->sum, totals->slowest);
}

#endif
