/*
 * "Dynamic On-Mesh Procedural Generation Control" (Buron, Marvie, Guennebaud and Granier 2014): the growth; exact walks
 * over the mesh, and strands that do not cross, are ours.
 */
#include "libcore/growth/engine/growth.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/growth/engine/growth_work.h"

/* Batches of a window, for each thread of several: few, so that what one thread has tried is still near the other. */
enum { BATCHES = 4 };

static void march_straight(const void *context, MesoWalk *walks, uint32_t count, const MesoWalkOptions *options)
{
    meso_walks(context, walks, count, options);
}

/* ---- beginnings and ends ---- */

static double least(double limit, double other)
{
    return other > 0 && other < limit ? other : limit;
}

static void *allocate(MesoGrowthWork *work, size_t count, size_t size)
{
    void *array = calloc(count ? count : 1, size);
    if (!array)
        work->status = meso_fail(work->error, MESO_ERR_MEMORY, "out of memory: %zu items of %zu bytes", count, size);
    return array;
}

/* Where every turn is told, turns are taken one by one, so that they are told as they are. */
static void size_window(MesoGrowthWork *work)
{
    uint32_t threads = work->options->thread_count ? work->options->thread_count : meso_parallel_cores();
    work->thread_count = work->options->event ? 1 : threads;
    work->batch_count = work->thread_count == 1 ? 1 : BATCHES * work->thread_count;
    work->window = work->options->event ? 1 : work->batch_count * MESO_GROWTH_BATCH;
}

static MesoStatus begin(MesoGrowthWork *work)
{
    const MesoGrowthOptions *options = work->options;
    const MesoGrammarLimits *limits = &work->grammar->limits;
    size_t window;
    work->element_limit = least(least(limits->elements, options->elements), INT32_MAX / 2);
    work->length_limit = least(limits->length, options->length);
    work->looks = meso_growth_rules_look(work->grammar);
    work->clears = meso_growth_steps_clear(work->grammar);
    work->uses_space = work->looks || meso_growth_steps_avoid(work->grammar);
    size_window(work);
    work->team = meso_team_begin(work->thread_count);
    window = work->window;
    work->turns = allocate(work, window, sizeof *work->turns);
    work->batches = allocate(work, (size_t)work->batch_count + 1, sizeof *work->batches);
    work->rules = allocate(work, work->grammar->rule_count, sizeof *work->rules);
    if (work->looks) {
        work->befores = allocate(work, window, sizeof *work->befores);
        work->register_befores = allocate(work, window * work->grammar->local_count, sizeof(double));
    }
    if (!work->status && work->uses_space)
        work->status = meso_growth_space_init(&work->space, work->ground, work->error);
    for (uint32_t i = 0; work->batches && i <= work->batch_count; i++)
        work->batches[i].space = work->uses_space ? &work->space : NULL;
    for (uint32_t i = 0; !work->status && i < options->starts->count; i++)
        meso_growth_plant(work, &options->starts->starts[i], i);
    return work->status;
}

static void release_batch(MesoGrowthBatch *batch)
{
    free(batch->pieces);
    free(batch->linked);
    free(batch->shoots);
    free(batch->middles);
    free(batch->registers);
    meso_growth_seen_release(&batch->seen);
}

void meso_growth_release(MesoGrowthWork *work)
{
    void *const arrays[] = {work->tips, work->registers, work->active, work->shoots, work->turns, work->befores,
                            work->register_befores, work->balls, work->joints, work->points, work->elements,
                            work->branches, work->rules, work->goes_on};
    for (uint32_t i = 0; work->batches && i <= work->batch_count; i++)
        release_batch(&work->batches[i]);
    free(work->batches);
    meso_team_end(work->team);
    meso_growth_space_release(&work->space);
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]);
}

/* ---- rounds ---- */

static void try_batches(void *context, uint64_t begin_at, uint64_t end)
{
    MesoGrowthWork *work = context;
    meso_growth_try(work, &work->batches[begin_at / MESO_GROWTH_BATCH], (uint32_t)begin_at, (uint32_t)end);
}

static void accept_batches(void *context, uint64_t begin_at, uint64_t end)
{
    meso_growth_accept(context, (uint32_t)begin_at, (uint32_t)end);
}

static bool run_window(MesoGrowthWork *work, uint32_t begin_at, uint32_t count)
{
    MesoGrowthBatch *again = &work->batches[work->batch_count];
    uint32_t admitted = 0;
    work->window_begin = begin_at;
    work->since = work->space.cells.piece_count;
    work->first_branch = work->branch_count;
    work->first_tip = work->tip_count;
    work->first_shoot = work->shoot_count;
    work->ball_count = 0;
    again->piece_count = again->shoot_count = again->middle_count = 0;
    meso_team_for(work->team, count, MESO_GROWTH_BATCH, try_batches, work);
    while (admitted < count && meso_growth_admit(work, admitted))
        admitted++;
    if (work->status || !meso_growth_make_rooms(work))
        return false;
    meso_team_for(work->team, admitted, MESO_GROWTH_BATCH, accept_batches, work);
    return admitted == count;
}

static bool make_active(MesoGrowthWork *work, uint64_t count)
{
    if (meso_make_room((void **)&work->active, &work->active_room, count, sizeof *work->active) &&
        meso_make_room((void **)&work->goes_on, &work->goes_on_room, count, sizeof *work->goes_on))
        return true;
    work->status = meso_fail(work->error, MESO_ERR_MEMORY, "out of memory: %u branches", work->tip_count);
    return false;
}

/* Those whose rule goes on, in their order, and then those that have begun. */
static bool gather_active(MesoGrowthWork *work)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < work->active_count; i++) {
        work->active[count] = work->active[i];
        count += work->goes_on[i];
    }
    if (!make_active(work, (uint64_t)count + work->shoot_count + 1))
        return false;
    if (work->shoot_count)
        memcpy(work->active + count, work->shoots, work->shoot_count * sizeof *work->active);
    work->active_count = count + work->shoot_count;
    work->shoot_count = 0;
    return true;
}

/* Turns of all that are active, until all rest. */
static bool run_turns(MesoGrowthWork *work)
{
    while (work->active_count) {
        for (uint32_t i = 0; i < work->active_count; i += work->window) {
            uint32_t rest = work->active_count - i;
            if (!run_window(work, i, rest < work->window ? rest : work->window))
                return false;
        }
        if (!gather_active(work))
            return false;
    }
    return true;
}

/* Living branches keep their order; all of them become active. */
static bool wake(MesoGrowthWork *work)
{
    size_t width = work->grammar->local_count;
    uint32_t count = 0;
    for (uint32_t i = 0; i < work->tip_count; i++) {
        if (work->tips[i].ended)
            continue;
        if (i != count) {
            work->tips[count] = work->tips[i];
            meso_copy_registers(work->registers + count * width, work->registers + i * width, (uint32_t)width);
        }
        work->tips[count].rests = false;
        work->rules[work->tips[count++].rule].runs++;
    }
    work->tip_count = work->active_count = count;
    if (!make_active(work, count))
        return false;
    for (uint32_t i = 0; i < count; i++)
        work->active[i] = i;
    return true;
}

static bool goes_on(MesoGrowthWork *work, double generations)
{
    const MesoGrowthOptions *options = work->options;
    bool lives = false;
    for (uint32_t i = 0; i < work->tip_count && !lives; i++)
        lives = !work->tips[i].ended;
    if (!lives)
        return false;
    if (!((double)work->generation < generations))
        work->end = MESO_GROWTH_GENERATIONS;
    else if (options->progress &&
             !options->progress(options->context, (uint32_t)work->generation, work->element_count))
        work->end = MESO_GROWTH_STOPPED;
    else
        return true;
    return false;
}

static void grow(MesoGrowthWork *work)
{
    double generations = least(work->grammar->limits.generations, work->options->generations);
    if (!gather_active(work) || !run_turns(work))
        return;
    while (goes_on(work, generations) && wake(work)) {
        work->generation++;
        if (!run_turns(work))
            return;
    }
}

/* ---- results ---- */

/* The array, as the arena's own. */
static void *keep(MesoArena *arena, void **array, MesoError *error)
{
    void *kept = *array ? *array : malloc(1);
    if (!kept || !meso_arena_adopt(arena, kept, error))
        return NULL;
    *array = NULL;
    return kept;
}

#define KEEP(array) (grown->array = keep(arena, (void **)&work->array, work->error))

static MesoStatus finish(MesoGrowthWork *work, MesoGrown *grown, MesoArena *arena)
{
    *grown = (MesoGrown){.joint_count = work->joint_count, .element_count = work->element_count,
                         .branch_count = work->branch_count, .generation_count = (uint32_t)work->generation,
                         .length = work->length, .end = work->end, .divided = work->divided,
                         .raised = work->raised, .depth = work->depth};
    bool kept = KEEP(joints) && KEEP(points) && KEEP(elements) && KEEP(branches) && KEEP(rules);
    return kept ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_growth_run(MesoGrowthWork *work, const MesoGrowthOptions *options, MesoError *error)
{
    *work = (MesoGrowthWork){.options = options, .grammar = options->grammar, .ground = options->contexts->ground,
                             .error = error};
    work->march = options->march ? *options->march : (MesoGrowthMarch){march_straight, &work->ground->walk};
    if (!begin(work))
        grow(work);
    return work->status;
}

MesoStatus meso_grow(MesoGrown *grown, MesoArena *arena, const MesoGrowthOptions *options, MesoError *error)
{
    MesoGrowthWork work;
    MesoStatus status = meso_growth_run(&work, options, error);
    if (!status)
        status = finish(&work, grown, arena);
    meso_growth_release(&work);
    return status;
}
