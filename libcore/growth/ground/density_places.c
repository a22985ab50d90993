/*
 * As rain falls: on every triangle drops arrive at random times, as many as its largest value wants, and those stay
 * that the value where they fall is large enough for. The first ones of all are the seeds. So a change of the map
 * changes only what falls there.
 */
#include <stdlib.h>

#include "libcore/growth/ground/seed_places.h"

/* For each seed that is wanted, before it is clear that there is nearly no place for them. */
enum { DROPS_A_SEED = 4096 };

typedef struct Drop {
    double time;
    MesoSeedPlace place;
} Drop;

typedef struct Rain {
    MesoSeedWork *work;
    const MesoGrowthMap *map;
    MesoArena *arena;
    double most;                /* of an image */
    double until;
    Drop *drops;                /* [count] that stay */
    uint32_t count, room;
    uint64_t fallen;
} Rain;

static MesoStatus keep(Rain *rain, const Drop *drop)
{
    rain->drops = MESO_GROW(rain->arena, rain->drops, rain->count, rain->room, 1024, rain->work->error);
    if (!rain->drops)
        return MESO_ERR_MEMORY;
    rain->drops[rain->count++] = *drop;
    return MESO_OK;
}

static MesoStatus rain_on(Rain *rain, uint32_t triangle)
{
    const MesoGrowthGround *ground = rain->work->contexts->ground;
    double bound = meso_map_bound(rain->map, ground, triangle, rain->most), time = 0;
    double rate = bound * meso_place_area(ground->mesh, triangle);
    uint32_t order[3];
    uint64_t hash = meso_place_triangle(ground->mesh, triangle, order), key = rain->work->job;
    MesoStatus status = MESO_OK;
    for (uint64_t i = 0; rate > 0 && !status; i++) {
        Drop drop = {.place = {{triangle, {0, 0, 0}}, meso_draw_mix(hash + i)}};
        uint64_t number = drop.place.number;
        time -= log(1 - meso_draw_share(meso_draw_key(key, number, 0))) / rate;
        if (!(time < rain->until))
            break;
        double s = meso_draw_share(meso_draw_key(key, number, 1)), t = meso_draw_share(meso_draw_key(key, number, 2));
        double a = s + t > 1 ? 1 - s : s, b = s + t > 1 ? 1 - t : t, *weight = drop.place.at.weight;
        weight[order[0]] = 1 - a - b;
        weight[order[1]] = a;
        weight[order[2]] = b;
        drop.time = time;
        rain->fallen++;
        double value = meso_map_value(ground, rain->map, triangle, weight);
        if (meso_draw_share(meso_draw_key(key, number, 3)) * bound < value)
            status = keep(rain, &drop);
    }
    return status;
}

static int compare_drops(const void *a, const void *b)
{
    const Drop *x = a, *y = b;
    if (x->time != y->time)
        return x->time < y->time ? -1 : 1;
    return (x->place.number > y->place.number) - (x->place.number < y->place.number);
}

static MesoStatus let_rain(Rain *rain)
{
    MesoStatus status = MESO_OK;
    rain->count = 0;
    rain->fallen = 0;
    for (uint32_t t = 0; t < rain->work->contexts->ground->mesh->triangle_count && !status; t++)
        status = rain_on(rain, t);
    return status;
}

/* Rates of all triangles together. */
static double whole_rate(const Rain *rain)
{
    const MesoGrowthGround *ground = rain->work->contexts->ground;
    double sum = 0;
    for (uint32_t t = 0; t < ground->mesh->triangle_count; t++)
        sum += fmax(meso_map_bound(rain->map, ground, t, rain->most), 0) * meso_place_area(ground->mesh, t);
    return sum;
}

/* Until there are enough; or so few stay that there is nearly nowhere where the map is above 0. */
static MesoStatus rain_enough(Rain *rain, uint32_t wanted)
{
    double rate = whole_rate(rain), drops = 1.25 * wanted + 16;
    MesoStatus status = MESO_OK;
    if (!(rate > 0))
        return MESO_OK;
    do {
        rain->until = drops / rate;
        status = let_rain(rain);
        drops *= rain->count > 0 ? fmin(fmax(1.1 * wanted / rain->count, 1.2), 16) : 16;
    } while (!status && rain->count < wanted && rain->fallen < (uint64_t)wanted * DROPS_A_SEED);
    qsort(rain->drops, status ? 0 : rain->count, sizeof *rain->drops, compare_drops);
    return status;
}

static MesoStatus check_count(const MesoSeedWork *work, double *count)
{
    const MesoGrammarValue *value = &work->seed->places.values[1];
    MesoSurfacePlace first = {0, {1, 0, 0}};
    *count = floor(meso_place_number(work, value, &first, 0));
    if (!isfinite(*count))
        return meso_place_fault(work, value, "the count");
    if (*count >= 0x1p31)
        return meso_fail(work->error, MESO_ERR_LIMIT, "more than 2147483648 places for seeds");
    return MESO_OK;
}

MesoStatus meso_places_density(MesoSeedWork *work)
{
    MesoArena arena;
    Rain rain = {.work = work, .map = &work->contexts->maps[work->seed->places.values[0].index], .arena = &arena};
    double count;
    MesoStatus status = check_count(work, &count);
    if (status || !(count > 0))
        return status;
    meso_arena_init(&arena);
    rain.most = meso_map_most(rain.map);
    status = rain_enough(&rain, (uint32_t)count);
    for (uint32_t i = 0; i < rain.count && i < (uint32_t)count && !status; i++)
        status = meso_place_add(work, &rain.drops[i].place.at, rain.drops[i].place.number);
    meso_arena_release(&arena);
    return status;
}
