#include "libcore/growth/ground/growth_seeds.h"

#include <stdlib.h>

#include "libcore/base/parallel.h"
#include "libcore/growth/ground/seed_places.h"

static MesoStatus find_places(MesoSeedWork *work)
{
    switch (work->seed->places.kind) {
    case MESO_SEEDS_POISSON: return meso_places_poisson(work);
    case MESO_SEEDS_DENSITY: return meso_places_density(work);
    case MESO_SEEDS_POINTS: return meso_places_points(work);
    case MESO_SEEDS_AT: return meso_places_at(work);
    case MESO_SEEDS_VERTICES: return meso_places_vertices(work);
    case MESO_SEEDS_BORDER: return meso_places_border(work);
    case MESO_SEEDS_CURVE: return meso_places_curve(work);
    default: return meso_fail(work->error, MESO_ERR_INTERNAL, "seeds of a kind without places");
    }
}

/* ---- numbers ---- */

typedef struct Numbered {
    uint64_t number;
    uint32_t place;
} Numbered;

static int compare_numbered(const void *a, const void *b)
{
    const Numbered *x = a, *y = b;
    if (x->number != y->number)
        return x->number < y->number ? -1 : 1;
    return (x->place > y->place) - (x->place < y->place);
}

/* Places that lie upon one another have the same number; no two branches may have the same key. */
static MesoStatus part_numbers(MesoSeedWork *work, MesoArena *scratch)
{
    Numbered *sorted = MESO_NEW(scratch, Numbered, work->count, work->error);
    if (!sorted)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < work->count; i++)
        sorted[i] = (Numbered){work->places[i].number, i};
    qsort(sorted, work->count, sizeof *sorted, compare_numbered);
    for (uint32_t i = 1, equal = 0; i < work->count; i++) {
        equal = sorted[i].number == sorted[i - 1].number ? equal + 1 : 0;
        if (equal > 0)
            work->places[sorted[i].place].number = meso_draw_mix(sorted[i].number + equal);
    }
    return MESO_OK;
}

/* ---- trying places ---- */

typedef struct Trial {
    const MesoSeedWork *work;
    MesoGrowthStart *starts;    /* [work->count] */
    uint8_t *taken;             /* [work->count] 2: the condition is no number there */
    uint32_t seed;
} Trial;

/* A heading by the key, and that of the field from there where it leads somewhere. */
static MesoTip tip_at(const MesoSeedWork *work, const MesoSurfacePlace *at, uint64_t key)
{
    double angle = 2 * MESO_PI * meso_draw_share(meso_draw_key(key, work->seed->site, 1));
    MesoTip tip = {at->triangle, false, {at->weight[0], at->weight[1], at->weight[2]}, {cos(angle), sin(angle)}};
    if (work->seed->field != MESO_NO_INDEX)
        meso_growth_face(work->contexts, work->seed->field, 1, meso_draw_key(key, work->seed->site, 2), &tip);
    return tip;
}

static void try_places(void *context, uint64_t begin, uint64_t end)
{
    const Trial *trial = context;
    const MesoSeedWork *work = trial->work;
    for (uint64_t i = begin; i < end; i++) {
        uint64_t key = meso_growth_seed_key(work->job, work->seed->site, work->places[i].number);
        MesoTip tip = tip_at(work, &work->places[i].at, key);
        trial->starts[i] = (MesoGrowthStart){tip, trial->seed, key};
        double holds = work->seed->where == MESO_NO_INDEX ? 1 : meso_place_value(work, work->seed->where, &tip, key);
        trial->taken[i] = isnan(holds) ? 2 : holds != 0;
    }
}

static MesoStatus take_places(MesoGrowthStarts *out, MesoSeedWork *work, const Trial *trial)
{
    uint32_t taken = 0;
    for (uint32_t i = 0; i < work->count && taken < work->seed->count; i++) {
        if (trial->taken[i] == 2)
            return meso_fail(work->error, MESO_ERR_INPUT, "line %u: 'where' is no number at a place",
                             work->grammar->lines[work->seed->where]);
        if (trial->taken[i] && taken++ < UINT32_MAX)
            out->starts[out->count++] = trial->starts[i];
    }
    return MESO_OK;
}

/* Adds the starts of one seed of the grammar to `out`, whose array has room for `*room`. */
static MesoStatus add_starts(MesoGrowthStarts *out, uint32_t *room, MesoArena *arena, MesoSeedWork *work, uint32_t seed,
                             MesoArena *scratch)
{
    work->arena = scratch;
    MesoStatus status = find_places(work);
    if (!status)
        status = part_numbers(work, scratch);
    if (status)
        return status;
    if ((uint64_t)out->count + work->count > (uint64_t)1 << 31)
        return meso_fail(work->error, MESO_ERR_LIMIT, "more than 2147483648 places for seeds");
    Trial trial = {work, MESO_NEW(scratch, MesoGrowthStart, work->count, work->error),
                   MESO_NEW(scratch, uint8_t, work->count, work->error), seed};
    if (!trial.starts || !trial.taken)
        return MESO_ERR_MEMORY;
    meso_parallel_for(work->thread_count, work->count, 1024, try_places, &trial);
    uint32_t most = out->count + work->count;
    if (most > *room) {
        *room = most > 2 * (uint64_t)*room ? most : 2 * *room;
        out->starts = meso_arena_enlarge(arena, out->starts, out->count, *room, sizeof *out->starts, work->error);
    }
    return out->starts ? take_places(out, work, &trial) : MESO_ERR_MEMORY;
}

MesoStatus meso_growth_seeds(MesoGrowthStarts *out, MesoArena *arena, const MesoGrammar *grammar,
                             const MesoGrowthContexts *contexts, const MesoGrowthPlaces *places, uint64_t seed,
                             uint32_t thread_count, MesoError *error)
{
    uint32_t room = 64;
    MesoStatus status = MESO_OK;
    *out = (MesoGrowthStarts){0, MESO_NEW(arena, MesoGrowthStart, room, error)};
    if (!out->starts)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < grammar->seed_count && !status; i++) {
        MesoArena scratch;
        MesoSeedWork work = {.grammar = grammar, .seed = &grammar->seeds[i], .contexts = contexts, .job = seed,
                             .thread_count = thread_count, .error = error};
        if (places && places->begin) {
            work.points = places->points + places->begin[i];
            work.breaks = places->breaks ? places->breaks + places->begin[i] : NULL;
            work.point_count = places->begin[i + 1] - places->begin[i];
        }
        meso_arena_init(&scratch);
        if (contexts->ground->mesh->triangle_count > 0)
            status = add_starts(out, &room, arena, &work, i, &scratch);
        meso_arena_release(&scratch);
    }
    return status;
}
