/*
 * "Dynamic On-Mesh Procedural Generation Control" (Buron, Marvie, Guennebaud and Granier 2014): the growth; exact walks
 * over the mesh, and strands that do not cross, are ours.
 */
#include "libcore/growth/engine/growth.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/growth/engine/growth_work.h"

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

/*
 * A batch for each thread: what turns have come to is still near when they are admitted and written down. Where every
 * turn is told, turns are taken one by one, so that they are told as they are.
 */
static void size_window(MesoGrowthWork *work)
{
    uint32_t threads = work->options->thread_count ? work->options->thread_count : meso_parallel_cores();
    work->thread_count = work->options->event ? 1 : threads;
    work->batch_count = work->thread_count;
    work->window_size = work->options->event ? 1 : work->batch_count * MESO_GROWTH_BATCH;
}

static void begin_window(MesoGrowthWork *work, MesoGrowthWindow *window)
{
    window->turns = allocate(work, work->window_size, sizeof *window->turns);
    window->batches = allocate(work, (size_t)work->batch_count + 1, sizeof *window->batches);
    if (work->looks) {
        window->befores = allocate(work, work->window_size, sizeof *window->befores);
        window->register_befores =
            allocate(work, (size_t)work->window_size * work->grammar->local_count, sizeof(double));
    }
    for (uint32_t i = 0; window->batches && i <= work->batch_count; i++)
        window->batches[i].space = work->uses_space ? &work->space : NULL;
}

static MesoStatus begin(MesoGrowthWork *work)
{
    const MesoGrowthOptions *options = work->options;
    const MesoGrammarLimits *limits = &work->grammar->limits;
    work->element_limit = least(least(limits->elements, options->elements), INT32_MAX / 2);
    work->length_limit = least(limits->length, options->length);
    work->looks = meso_growth_rules_look(work->grammar);
    work->clears = meso_growth_steps_clear(work->grammar);
    work->uses_space = work->looks || meso_growth_steps_avoid(work->grammar);
    size_window(work);
    work->team = meso_team_begin(work->thread_count);
    for (uint32_t i = 0; i < (work->team ? 2 : 1); i++)
        begin_window(work, &work->windows[i]);
    work->rules = allocate(work, work->grammar->rule_count, sizeof *work->rules);
    work->ahead = options->event ? NULL : allocate(work, work->grammar->code_count, sizeof *work->ahead);
    if (work->ahead)
        meso_growth_look_ahead(work->grammar, work->ahead);
    if (!work->status && work->uses_space)
        work->status = meso_growth_space_init(&work->space, work->ground, work->error);
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

static void release_window(const MesoGrowthWork *work, MesoGrowthWindow *window)
{
    for (uint32_t i = 0; window->batches && i <= work->batch_count; i++)
        release_batch(&window->batches[i]);
    free(window->batches);
    free(window->turns);
    free(window->befores);
    free(window->register_befores);
}

void meso_growth_release(MesoGrowthWork *work)
{
    void *const arrays[] = {work->tips, work->registers, work->active, work->shoots, work->balls, work->joints,
                            work->points, work->elements, work->branches, work->rules, work->goes_on,
                            work->ahead};
    meso_team_end(work->team);
    for (uint32_t i = 0; i < 2; i++)
        release_window(work, &work->windows[i]);
    meso_growth_space_release(&work->space);
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]);
}

/* ---- rounds ---- */

/* A loop of the team: batches of one window are tried, and what those of another have grown is written down. They do
 * not touch each other: a window's branches are its own. */
typedef struct Loop {
    MesoGrowthWork *work;
    MesoGrowthWindow *tried;            /* NULL: none */
    const MesoGrowthWindow *accepted;   /* NULL: none */
    uint32_t try_count;                 /* of turns */
} Loop;

/* A thread that tries turns writes down what they have grown, too, as a rule: they are in its memory. */
static void run_batch(void *context, uint64_t begin_at, uint64_t end)
{
    const Loop *loop = context;
    uint32_t first = (uint32_t)begin_at, last = (uint32_t)end, accepted = loop->accepted ? loop->accepted->count : 0;
    if (first < loop->try_count)
        meso_growth_try(loop->work, loop->tried, first, last < loop->try_count ? last : loop->try_count);
    if (first < accepted)
        meso_growth_accept(loop->work, loop->accepted, first, last < accepted ? last : accepted);
}

static void run_loop(MesoGrowthWork *work, MesoGrowthWindow *tried, uint32_t try_count,
                     const MesoGrowthWindow *accepted)
{
    Loop loop = {work, tried, accepted, try_count};
    uint32_t count = accepted && accepted->count > try_count ? accepted->count : try_count;
    meso_team_for(work->team, count, MESO_GROWTH_BATCH, run_batch, &loop);
}

static void admit_all(MesoGrowthWork *work, MesoGrowthWindow *window, uint32_t count)
{
    do
        meso_growth_fetch_turns(work, window, window->count, count);
    while (meso_growth_admit(work, window, window->count) && ++window->count < count);
}

/* Turns active[begin_at..begin_at + count), while what those before them have grown is written down. */
static bool run_window(MesoGrowthWork *work, MesoGrowthWindow *window, uint32_t begin_at, uint32_t count,
                       const MesoGrowthWindow *before)
{
    MesoGrowthBatch *again = &window->batches[work->batch_count];
    window->begin = begin_at;
    window->count = 0;
    window->first_branch = work->branch_count;
    window->first_tip = work->tip_count;
    window->first_shoot = work->shoot_count;
    if (work->space.cells.piece_count > work->since)
        memset(work->grown_in, 0, sizeof work->grown_in);
    work->since = work->space.cells.piece_count;
    work->ball_count = 0;
    again->piece_count = again->shoot_count = again->middle_count = 0;
    run_loop(work, window, count, before);
    admit_all(work, window, count);
    if (work->status || !meso_growth_make_rooms(work, work->branch_count - window->first_branch))
        window->count = 0;
    return window->count == count;
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

/* Turns of a window, where as few windows as can be are about alike. */
static uint32_t even_window(const MesoGrowthWork *work)
{
    uint32_t size = work->window_size, windows = (work->active_count + size - 1) / size;
    uint32_t each = windows ? (work->active_count + windows - 1) / windows : 0;
    each = (each + MESO_GROWTH_BATCH - 1) / MESO_GROWTH_BATCH * MESO_GROWTH_BATCH;
    return each < size ? each : size;
}

/* A turn of each that is active. */
static bool run_each(MesoGrowthWork *work)
{
    const MesoGrowthWindow *before = NULL;
    bool goes_on = true;
    uint32_t size = even_window(work);
    for (uint32_t i = 0, k = 0; i < work->active_count && goes_on; i += size, k ^= 1) {
        MesoGrowthWindow *window = &work->windows[work->team ? k : 0];
        uint32_t rest = work->active_count - i;
        goes_on = run_window(work, window, i, rest < size ? rest : size, before);
        before = window;
        if (!work->team) {
            run_loop(work, NULL, 0, before);
            before = NULL;
        }
    }
    if (before)
        run_loop(work, NULL, 0, before);
    return goes_on;
}

/* Turns of all that are active, until all rest. */
static bool run_turns(MesoGrowthWork *work)
{
    while (work->active_count)
        if (!run_each(work) || !gather_active(work))
            return false;
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
