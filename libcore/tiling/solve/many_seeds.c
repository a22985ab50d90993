#include "libcore/tiling/solve/many_seeds.h"

#include <assert.h>
#include <stdatomic.h>
#include <threads.h>

#include "libcore/base/parallel.h"

typedef struct Run {
    const MesoManySeeds *sweep;
    mtx_t lock;                 /* of `error` */
    MesoError error;            /* of the first failure */
    atomic_bool failed;
} Run;

static void fail_run(Run *run, const MesoError *error)
{
    mtx_lock(&run->lock);
    if (!atomic_load(&run->failed))
        run->error = *error;
    atomic_store(&run->failed, true);
    mtx_unlock(&run->lock);
}

static void solve_range(void *context, uint64_t begin, uint64_t end)
{
    Run *run = context;
    const MesoManySeeds *sweep = run->sweep;
    for (uint64_t i = begin; i < end && !atomic_load(&run->failed); i++) {
        MesoArena arena;
        MesoSolveResult result;
        MesoError error = {0};
        MesoSolveOptions options = sweep->options;
        options.seed = sweep->seeds[i];
        meso_arena_init(&arena);
        MesoStatus status = meso_solve(&result, &arena, sweep->problem, &options, &error);
        if (!status)
            status = sweep->take(sweep->context, (uint32_t)i, &result, &error);
        if (status)
            fail_run(run, &error);
        meso_arena_release(&arena);
    }
}

MesoStatus meso_many_seeds(const MesoManySeeds *sweep, MesoError *error)
{
    assert(!sweep->options.progress);
    Run run = {.sweep = sweep};
    if (mtx_init(&run.lock, mtx_plain) != thrd_success)
        return meso_fail(error, MESO_ERR_INTERNAL, "no lock for the threads");
    meso_parallel_for(sweep->thread_count, sweep->seed_count, 1, solve_range, &run);
    mtx_destroy(&run.lock);
    if (!atomic_load(&run.failed))
        return MESO_OK;
    *error = run.error;
    return run.error.status;
}
