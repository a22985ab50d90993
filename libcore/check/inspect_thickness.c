/* The thinnest section: from each place straight inwards to what looks the other way. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/check/inspect_work.h"

enum { GRAIN = 1 << 11, SAMPLES = 1000 };

/* What ends a section looks away from the ray, give or take 75 degrees. */
#define OPPOSITE_COSINE 0.25
/* Of places within this share of the usual thickness one is measured: sweeps have many more columns than that. */
#define SPOT_SHARE (1.0 / 16)

typedef struct Thinnest {
    double way;
    uint32_t half;          /* whose place it is below */
    uint64_t count;         /* of places over what is too thin */
} Thinnest;

typedef struct Sections {
    const MesoInspectWork *work;
    Thinnest *ranges;
    uint32_t *first;        /* [place_count] half-edges + 1 that speak for places */
    MesoVec3 *inward;       /* [place_count] sums of area vectors, turned around */
    uint8_t *thin;          /* [place_count] */
    _Atomic uint64_t best;  /* bits of the least way so far: they sort as positive doubles do */
} Sections;

typedef struct Ray {
    const MesoInspectWork *work;
    uint32_t place, triangle;
    MesoVec3d origin, direction;
} Ray;

static bool has_place(const MesoInspectWork *work, uint32_t triangle, uint32_t place)
{
    const uint32_t *places = &work->places[3 * triangle];
    return places[0] == place || places[1] == place || places[2] == place;
}

static double way_through(void *context, uint32_t item)
{
    const Ray *ray = context;
    const MesoInspectWork *work = ray->work;
    if (work->pieces[item] != work->pieces[ray->triangle] || has_place(work, item, ray->place))
        return INFINITY;
    MesoInspectTriangle t = meso_inspect_triangle(work->mesh, item);
    double slope = meso_vec3d_dot(t.normal, ray->direction);
    if (!(slope > OPPOSITE_COSINE))
        return INFINITY;
    double way = meso_vec3d_dot(t.normal, meso_vec3d_sub(t.p[0], ray->origin)) / slope;
    MesoVec3d at = meso_vec3d_mad(ray->origin, way, ray->direction);
    for (uint32_t k = 0; k < 3; k++)
        if (meso_vec3d_det(t.normal, meso_vec3d_sub(t.p[(k + 1) % 3], t.p[k]), meso_vec3d_sub(at, t.p[k])) < 0)
            return INFINITY;
    return way >= 0 ? way : INFINITY;
}

/* INFINITY where nothing is met before `limit`. */
static double section_below(const Sections *sections, uint32_t half, double limit)
{
    const MesoInspectWork *work = sections->work;
    uint32_t place = work->places[half];
    MesoVec3d inward = meso_vec3d(sections->inward[place]);
    double length = meso_vec3d_length(inward), way = limit;
    if (!(length > 0))
        return INFINITY;
    Ray ray = {.work = work, .place = place, .triangle = half / 3,
               .origin = meso_vec3d(meso_inspect_corner(work->mesh, half)),
               .direction = meso_vec3d_scale(inward, 1 / length)};
    uint32_t met = meso_inspect_tree_ray(&work->tree, ray.origin, ray.direction, work->things[half / 3], &way,
                                         way_through, &ray);
    return met == MESO_NO_INDEX ? INFINITY : way;
}

/* The first half-edge of each place speaks for it. */
static MesoStatus describe_places(Sections *sections, MesoError *error)
{
    const MesoInspectWork *work = sections->work;
    sections->first = MESO_NEW(work->scratch, uint32_t, work->place_count, error);
    sections->inward = MESO_NEW(work->scratch, MesoVec3, work->place_count, error);
    sections->thin = MESO_NEW(work->scratch, uint8_t, work->place_count, error);
    if (!sections->first || !sections->inward || !sections->thin)
        return MESO_ERR_MEMORY;
    for (uint32_t t = work->mesh->triangle_count; t-- > 0;) {
        MesoVec3 outward = meso_vec3d_narrow(meso_inspect_triangle(work->mesh, t).normal);
        for (uint32_t k = 0; k < 3 && work->mates[3 * t] != MESO_MATE_OUT && meso_vec3_finite(outward); k++) {
            MesoVec3 *inward = &sections->inward[work->places[3 * t + k]];
            *inward = meso_vec3_sub(*inward, outward);
            sections->first[work->places[3 * t + k]] = 3 * t + k + 1;
        }
    }
    return MESO_OK;
}

/* ---- one place for many ---- */

/* What places have in common that are measured once. */
typedef struct Spot {
    int64_t cell[3];
    uint32_t piece, facing;         /* facing: the axis that is nearest to the way inwards, and its sign */
} Spot;

static uint32_t facing_of(MesoVec3 v)
{
    float x = fabsf(v.x), y = fabsf(v.y), z = fabsf(v.z);
    if (x >= y && x >= z)
        return v.x < 0;
    return y >= z ? 2 + (v.y < 0) : 4 + (v.z < 0);
}

static Spot spot_of(const Sections *sections, uint32_t half, double cell)
{
    const MesoInspectWork *work = sections->work;
    MesoVec3 p = meso_inspect_corner(work->mesh, half);
    MesoVec3 low = work->result->box.low;
    const double at[3] = {(double)p.x - (double)low.x, (double)p.y - (double)low.y, (double)p.z - (double)low.z};
    Spot spot = {.piece = work->pieces[half / 3], .facing = facing_of(sections->inward[work->places[half]])};
    for (int i = 0; i < 3; i++)
        spot.cell[i] = at[i] / cell < 1e18 ? (int64_t)(at[i] / cell) : INT64_MAX;
    return spot;
}

static bool same_spot(const Spot *a, const Spot *b)
{
    return a->cell[0] == b->cell[0] && a->cell[1] == b->cell[1] && a->cell[2] == b->cell[2] && a->piece == b->piece &&
           a->facing == b->facing;
}

static uint64_t hash_of(const Spot *spot)
{
    uint64_t hash = spot->piece * UINT64_C(0x9e3779b97f4a7c15) + spot->facing;
    for (int i = 0; i < 3; i++)
        hash = (hash ^ (uint64_t)spot->cell[i]) * UINT64_C(0xd6e8feb86659fd93);
    return hash ^ hash >> 32;
}

/* Places closer to each other than `cell` that look the same way are as thick: the first of them is measured. */
static MesoStatus thin_out(Sections *sections, double cell, MesoError *error)
{
    const MesoInspectWork *work = sections->work;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint64_t room = 64;
    while (room < 2 * (uint64_t)work->place_count)
        room *= 2;
    uint32_t *table = MESO_NEW(work->scratch, uint32_t, room, error);
    if (!table)
        return MESO_ERR_MEMORY;
    for (uint32_t p = 0; p < work->place_count; p++) {
        if (!sections->first[p])
            continue;
        Spot spot = spot_of(sections, sections->first[p] - 1, cell);
        uint64_t at = hash_of(&spot) & (room - 1);
        for (; table[at]; at = (at + 1) & (room - 1)) {
            Spot other = spot_of(sections, table[at] - 1, cell);
            if (same_spot(&spot, &other))
                break;
        }
        if (table[at])
            sections->first[p] = 0;
        else
            table[at] = sections->first[p];
    }
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}

/* ---- the thinnest ---- */

static double read_best(Sections *sections)
{
    uint64_t bits = atomic_load_explicit(&sections->best, memory_order_relaxed);
    double best;
    memcpy(&best, &bits, sizeof best);
    return best;
}

static void lower_best(Sections *sections, double way)
{
    uint64_t bits, seen = atomic_load_explicit(&sections->best, memory_order_relaxed);
    memcpy(&bits, &way, sizeof bits);
    while (bits < seen && !atomic_compare_exchange_weak(&sections->best, &seen, bits))
        ;
}

static void measure_place(Sections *sections, Thinnest *range, uint32_t half)
{
    double asked = sections->work->options->thinnest;
    double way = section_below(sections, half, fmax(nextafter(read_best(sections), INFINITY), asked));
    if (way < asked) {
        sections->thin[sections->work->places[half]] = 1;
        range->count++;
    }
    if (way < range->way || (way == range->way && half < range->half)) {
        range->way = way;
        range->half = half;
        lower_best(sections, way);
    }
}

/* Only what is as thin as the thinnest so far is looked for, so that rays are short, or as what is too thin. */
static void measure_range(void *context, uint64_t begin, uint64_t end)
{
    Sections *sections = context;
    const MesoInspectWork *work = sections->work;
    Thinnest *range = &sections->ranges[begin / GRAIN];
    *range = (Thinnest){INFINITY, MESO_NO_INDEX, 0};
    for (uint64_t i = begin; i < end; i++)
        for (uint32_t k = 0, t = work->tree.order[i]; k < 3; k++)
            if (sections->first[work->places[3 * t + k]] == 3 * t + k + 1)
                measure_place(sections, range, 3 * t + k);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median over places at even distances along the tree. */
static double usual_thickness(const Sections *sections)
{
    const MesoInspectWork *work = sections->work;
    double ways[SAMPLES];
    uint32_t count = 0, items = work->tree.item_count;
    for (uint32_t i = 0; i < SAMPLES && i < items; i++) {
        uint64_t at = items <= SAMPLES ? i : (uint64_t)i * items / SAMPLES;
        double way = section_below(sections, 3 * work->tree.order[at], INFINITY);
        if (isfinite(way))
            ways[count++] = way;
    }
    qsort(ways, count, sizeof *ways, compare_doubles);
    return count ? ways[count / 2] : 0;
}

static void note_thinnest(const Sections *sections, uint64_t range_count)
{
    const MesoInspectWork *work = sections->work;
    Thinnest all = {INFINITY, MESO_NO_INDEX, 0};
    for (uint64_t r = 0; r < range_count; r++) {
        const Thinnest *range = &sections->ranges[r];
        all.count += range->count;
        if (range->way < all.way || (range->way == all.way && range->half < all.half)) {
            all.way = range->way;
            all.half = range->half;
        }
    }
    bool found = isfinite(all.way);
    work->result->thinnest = found ? all.way : 0;
    work->result->findings[MESO_FAULT_THIN] = (MesoFinding){
        all.count, work->result->thinnest, found ? all.half / 3 : MESO_NO_INDEX, MESO_NO_INDEX};
    for (uint32_t h = 0; h < 3 * work->mesh->triangle_count; h++)
        work->result->marks[h / 3] |= sections->thin[work->places[h]] ? 1u << MESO_FAULT_THIN : 0;
}

MesoStatus meso_inspect_thickness(MesoInspectWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint64_t range_count = (work->tree.item_count + (uint64_t)GRAIN - 1) / GRAIN;
    Sections sections = {.work = work};
    sections.ranges = MESO_NEW(work->scratch, Thinnest, range_count, error);
    MesoStatus status = sections.ranges ? describe_places(&sections, error) : MESO_ERR_MEMORY;
    if (status)
        return status;
    work->result->usual_thickness = usual_thickness(&sections);
    double limit = work->result->usual_thickness;
    if (limit > 0 && thin_out(&sections, limit * SPOT_SHARE, error))
        return MESO_ERR_MEMORY;
    limit = limit > 0 ? limit : INFINITY;
    uint64_t bits;
    memcpy(&bits, &limit, sizeof bits);
    sections.best = bits;
    meso_parallel_for(work->options->thread_count, work->tree.item_count, GRAIN, measure_range, &sections);
    note_thinnest(&sections, range_count);
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}
