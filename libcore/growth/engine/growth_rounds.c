/*
 * "Dynamic On-Mesh Procedural Generation Control" (Buron, Marvie, Guennebaud and Granier 2014): the growth; exact walks
 * over the mesh, and strands that do not cross, are ours.
 */
#include "libcore/growth/engine/growth.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/growth/engine/growth_work.h"

/* Turns of a thread below which it takes longer to hand them over. */
enum { FEW = 16 };

static void march_straight(const void *context, MesoWalk *walks, uint32_t count, const MesoWalkOptions *options)
{
    meso_walks(context, walks, count, options);
}

/* ---- beginnings and ends ---- */

static double least(double limit, double other)
{
    return other > 0 && other < limit ? other : limit;
}

/* Whole lines of memory, and 0: what is next to them, and may be another thread's, is in others. */
static void *allocate(MesoGrowthWork *work, size_t count, size_t size)
{
    size_t bytes = (count * size + MESO_GROWTH_TURN_LINE) / MESO_GROWTH_TURN_LINE * MESO_GROWTH_TURN_LINE;
    void *array = aligned_alloc(MESO_GROWTH_TURN_LINE, bytes);
    if (!array)
        work->status = meso_fail(work->error, MESO_ERR_MEMORY, "out of memory: %zu items of %zu bytes", count, size);
    return array ? memset(array, 0, bytes) : NULL;
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
    work->relay_batch = work->uses_space || work->batch_count == 1 ? MESO_GROWTH_BATCH : MESO_GROWTH_BATCH_UNSEEN;
}

static void begin_window(MesoGrowthWork *work, MesoGrowthWindow *window)
{
    window->turns = allocate(work, (size_t)work->batch_count * work->relay_batch, sizeof *window->turns);
    window->batches = allocate(work, 2 * (size_t)work->batch_count, sizeof *window->batches);
    if (work->looks) {
        window->befores = allocate(work, work->window_size, sizeof *window->befores);
        window->register_befores =
            allocate(work, (size_t)work->window_size * work->grammar->local_count, sizeof(double));
    }
    for (uint32_t i = 0; window->batches && i < work->batch_count; i++)
        window->batches[i].runs = allocate(work, work->grammar->rule_count, sizeof *window->batches[i].runs);
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
    uint32_t team = meso_team_size(work->team), cores = meso_parallel_cores();
    work->relay_places = team < cores ? team : cores;
    for (uint32_t i = 0; i < (work->team ? 2 : 1); i++)
        begin_window(work, &work->windows[i]);
    work->rules = allocate(work, work->grammar->rule_count, sizeof *work->rules);
    work->shares = allocate(work, work->batch_count, sizeof *work->shares);
    for (uint32_t i = 0; work->shares && i < work->batch_count; i++)
        work->shares[i] = work->relay_batch;
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
    free(batch->runs);
    meso_growth_seen_release(&batch->seen);
}

static void release_window(const MesoGrowthWork *work, MesoGrowthWindow *window)
{
    for (uint32_t i = 0; window->batches && i < 2 * work->batch_count; i++)
        release_batch(&window->batches[i]);
    free(window->batches);
    free(window->turns);
    free(window->befores);
    free(window->register_befores);
}

void meso_growth_release(MesoGrowthWork *work)
{
    void *const arrays[] = {work->tips, work->ended, work->registers, work->active, work->shoots, work->balls,
                            work->joints, work->points, work->elements, work->branches, work->rules, work->goes_on,
                            work->ahead, work->shares};
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
    uint32_t number = first / MESO_GROWTH_BATCH;
    if (first < loop->try_count) {
        MesoGrowthBatch *batch = &loop->tried->batches[number];
        meso_growth_begin_batch(loop->work, batch, loop->tried->begin);
        meso_growth_run_rules(loop->work, loop->tried, batch, first, last < loop->try_count ? last : loop->try_count);
        meso_growth_judge_walks(loop->work, loop->tried, batch);
    }
    if (first < accepted)
        meso_growth_accept(loop->work, loop->accepted, &loop->accepted->batches[number], first,
                           last < accepted ? last : accepted);
}

static void run_loop(MesoGrowthWork *work, MesoGrowthWindow *tried, uint32_t try_count,
                     const MesoGrowthWindow *accepted)
{
    Loop loop = {work, tried, accepted, try_count};
    uint32_t count = accepted && accepted->count > try_count ? accepted->count : try_count;
    meso_team_for(work->team, count, MESO_GROWTH_BATCH, run_batch, &loop);
}


/* Turns active[begin_at..begin_at + count), while what those before them have grown is written down. */
static bool run_window(MesoGrowthWork *work, MesoGrowthWindow *window, uint32_t begin_at, uint32_t count,
                       const MesoGrowthWindow *before)
{
    window->begin = begin_at;
    meso_growth_begin_window(work, window);
    run_loop(work, window, count, before);
    window->count = meso_growth_admit_range(work, window, 0, count);
    uint32_t begun = work->branch_count - window->first_branch;
    if (work->status || !meso_growth_make_rooms(work, 0, 0, begun))
        window->count = 0;
    meso_growth_end_window(work, window);
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
    for (uint32_t i = 0; i < work->shoot_count; i++) {
        work->active[count] = work->shoots[i];
        count += work->shoots[i] != MESO_NO_INDEX;
    }
    work->active_count = count;
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

/* A turn of each that is active; of several threads, where they are worth their while. */
static bool run_each(MesoGrowthWork *work)
{
    if (work->team && !work->looks && work->active_count >= FEW * meso_team_size(work->team))
        return meso_growth_relay(work);
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

/* Of rules that have begun since the last were counted. */
static void count_runs(MesoGrowthWork *work)
{
    for (uint32_t i = 0; i < (work->team ? 2 : 1) * work->batch_count; i++) {
        uint64_t *runs = work->windows[i / work->batch_count].batches[i % work->batch_count].runs;
        for (uint32_t k = 0; k < work->grammar->rule_count; k++) {
            work->rules[k].runs += runs[k];
            runs[k] = 0;
        }
    }
}

/* Those that have ended go; the others keep their order, and stay where they are as a rule. */
static void keep_living(MesoGrowthWork *work)
{
    size_t width = work->grammar->local_count;
    uint32_t count = 0;
    for (uint32_t i = 0; i < work->tip_count; i++) {
        if (work->ended[i])
            continue;
        if (i != count) {
            work->tips[count] = work->tips[i];
            work->ended[count] = 0;
            meso_copy_registers(work->registers + count * width, work->registers + i * width, (uint32_t)width);
        }
        count++;
    }
    work->tip_count = count;
}

static uint32_t count_living(const MesoGrowthWork *work)
{
    uint32_t ended = 0;
    for (uint32_t i = 0; i < work->tip_count; i++)
        ended += work->ended[i];
    return work->tip_count - ended;
}

/* All living branches become active. Others keep their places until they are many: to move the rest takes long. */
static bool wake(MesoGrowthWork *work)
{
    enum { MANY_OF = 4 };
    count_runs(work);
    uint32_t living = count_living(work), count = 0;
    if (work->tip_count - living > living / MANY_OF)
        keep_living(work);
    if (!make_active(work, (uint64_t)living + 1))
        return false;
    for (uint32_t i = 0; i < work->tip_count; i++) {
        work->active[count] = i;
        count += !work->ended[i];
    }
    work->active_count = count;
    return true;
}

static bool goes_on(MesoGrowthWork *work, double generations)
{
    const MesoGrowthOptions *options = work->options;
    bool lives = false;
    for (uint32_t i = 0; i < work->tip_count && !lives; i++)
        lives = !work->ended[i];
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
