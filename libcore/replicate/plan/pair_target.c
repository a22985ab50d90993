#include "libcore/replicate/plan/pair_target.h"

#include <float.h>
#include <string.h>

#include "libcore/base/random.h"
#include "libcore/replicate/plan/web_edit.h"

enum { BINS = MESO_TARGET_BINS, SAMPLE = 4096, TRIED = 12, COPIES = 12, NEAREST = MESO_ORIGINAL_NEAR };

/* Distances are counted up to so many mean spacings. */
static const double REACH = 4;

/* Of pairs nearer than half a spacing, over those of details strewn freely: groups. */
static const double GROUPED = 1.5;

/* What it costs that an original dies. */
static const double ORIGINAL_LAST = 1e9;

/* ---- cells ---- */

/* A detail that lives, with all that is asked of it in one place of memory. */
typedef struct Spot {
    MesoVec3 place, normal;
    uint32_t detail;
    uint64_t cell;
} Spot;

typedef struct Slot {
    uint32_t begin, end;        /* spots */
    uint32_t later;             /* the first of those that came later, or MESO_NO_INDEX */
} Slot;

/* Details by cell of space, as wide as distances that are counted. Those that come later are in lists. */
typedef struct Cells {
    float width;
    uint32_t mask;
    Slot *slots;            /* [mask + 2] in each there may be a few cells */
    Spot *spots;            /* [spot_count] by slot, and those that came later, in any order */
    uint32_t spot_count;
    uint32_t *next;         /* [later] */
    uint32_t first_later;   /* spot */
    const MesoVec3 *places, *normals;
} Cells;

static int32_t cell_at(float x, float width)
{
    return (int32_t)fminf(fmaxf(floorf(x / width), -1e9f), 1e9f);
}

/* The same for cells that are 2^21 apart alone. */
static uint64_t cell_of(int32_t x, int32_t y, int32_t z)
{
    const uint64_t mask = 0x1fffff;
    return ((uint64_t)(uint32_t)x & mask) << 42 | ((uint64_t)(uint32_t)y & mask) << 21 | ((uint64_t)(uint32_t)z & mask);
}

static uint32_t slot_of(const Cells *cells, uint64_t cell)
{
    return (uint32_t)((cell ^ cell >> 31) * 0x9e3779b97f4a7c15u >> 32) & cells->mask;
}

static Spot spot_of(const Cells *cells, uint32_t detail)
{
    MesoVec3 p = cells->places[detail];
    return (Spot){p, cells->normals[detail], detail, cell_of(cell_at(p.x, cells->width), cell_at(p.y, cells->width),
                                                             cell_at(p.z, cells->width))};
}

/* One that has come. */
static void put(Cells *cells, uint32_t detail)
{
    Spot spot = spot_of(cells, detail);
    Slot *slot = &cells->slots[slot_of(cells, spot.cell)];
    cells->next[cells->spot_count - cells->first_later] = slot->later;
    slot->later = cells->spot_count;
    cells->spots[cells->spot_count++] = spot;
}

/* One that was there from the beginning goes. */
static void take(Cells *cells, uint32_t detail)
{
    Slot *slot = &cells->slots[slot_of(cells, spot_of(cells, detail).cell)];
    uint32_t at = slot->begin;
    while (cells->spots[at].detail != detail)
        at++;
    cells->spots[at] = cells->spots[--slot->end];
}

static MesoStatus make_cells(Cells *cells, MesoReplication *r, double width, uint32_t due, MesoError *error)
{
    uint32_t n = r->detail_count;
    *cells = (Cells){.width = (float)width, .mask = 255, .places = r->web.positions + r->web.fixed_count,
                     .normals = r->web.normals + r->web.fixed_count};
    while (cells->mask < n)
        cells->mask = 2 * cells->mask + 1;
    cells->slots = MESO_NEW(&r->scratch, Slot, (size_t)cells->mask + 2, error);
    cells->spots = MESO_NEW(&r->scratch, Spot, (size_t)n + due + 1, error);
    cells->next = meso_arena_alloc(&r->scratch, (size_t)due + 1, sizeof *cells->next, error);
    if (!cells->slots || !cells->spots || !cells->next)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < n; i++)
        if (meso_lives(r, i))
            cells->slots[slot_of(cells, spot_of(cells, i).cell) + 1].begin++;
    for (uint32_t s = 0; s <= cells->mask; s++) {
        cells->slots[s + 1].begin += cells->slots[s].begin;
        cells->slots[s].end = cells->slots[s].begin;
        cells->slots[s].later = MESO_NO_INDEX;
    }
    for (uint32_t i = 0; i < n; i++) {
        Spot spot = spot_of(cells, i);
        if (meso_lives(r, i))
            cells->spots[cells->slots[slot_of(cells, spot.cell)].end++] = spot;
    }
    cells->spot_count = cells->first_later = cells->slots[cells->mask + 1].begin;
    return MESO_OK;
}

/* ---- around a place ---- */

typedef struct Vicinity {
    MesoPairCounts counts;
    float near[NEAREST];    /* squared distances */
    uint32_t nearest;       /* detail; MESO_NO_INDEX */
} Vicinity;

static void see(Vicinity *v, uint32_t detail, float d2, double radius)
{
    float at = sqrtf(d2) * (float)(BINS / radius);
    if (at < BINS)
        v->counts.of[(uint32_t)at]++;
    if (d2 < v->near[0])
        v->nearest = detail;
    for (uint32_t k = 0; k < NEAREST; k++)
        if (d2 < v->near[k]) {
            float further = v->near[k];
            v->near[k] = d2;
            d2 = further;
        }
}

/* Not of the other side of a thin sheet, whose normals point the other way. */
static void see_spot(Vicinity *v, const Spot *spot, uint64_t cell, MesoVec3 place, MesoVec3 normal, uint32_t self,
                     double radius)
{
    MesoVec3 apart = meso_vec3_sub(spot->place, place);
    float d2 = meso_vec3_dot(apart, apart);
    if (d2 < (float)(radius * radius) && spot->cell == cell && spot->detail != self
        && !(meso_vec3_dot(spot->normal, normal) < 0))
        see(v, spot->detail, d2, radius);
}

static void look_around(Vicinity *v, const Cells *cells, MesoVec3 place, MesoVec3 normal, uint32_t self, double radius)
{
    *v = (Vicinity){.nearest = MESO_NO_INDEX};
    for (uint32_t k = 0; k < NEAREST; k++)
        v->near[k] = INFINITY;
    int32_t x = cell_at(place.x, cells->width), y = cell_at(place.y, cells->width), z = cell_at(place.z, cells->width);
    for (int32_t k = 0; k < 27; k++) {
        uint64_t cell = cell_of(x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1);
        const Slot *slot = &cells->slots[slot_of(cells, cell)];
        for (uint32_t i = slot->begin; i < slot->end; i++)
            see_spot(v, &cells->spots[i], cell, place, normal, self, radius);
        for (uint32_t i = slot->later; i != MESO_NO_INDEX; i = cells->next[i - cells->first_later])
            see_spot(v, &cells->spots[i], cell, place, normal, self, radius);
    }
}

/* Of every `stride`th that lives. */
static MesoPairCounts mean_counts(const MesoReplication *r, const Cells *cells, uint32_t stride)
{
    MesoPairCounts mean = {{0}};
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->detail_count; i += stride) {
        Vicinity v;
        if (!meso_lives(r, i))
            continue;
        look_around(&v, cells, cells->places[i], cells->normals[i], i, r->pairs.radius);
        for (uint32_t b = 0; b < BINS; b++)
            mean.of[b] += v.counts.of[b];
        count++;
    }
    for (uint32_t b = 0; b < BINS && count; b++)
        mean.of[b] /= count;
    return mean;
}

static double ring_area(double radius, uint32_t bin)
{
    double width = radius / BINS;
    return MESO_PI * width * width * (2 * bin + 1);
}

MesoStatus meso_pair_target_build(MesoPairTarget *target, MesoReplication *r, MesoError *error)
{
    double area = 0, near = 0, free_near = 0;
    for (uint32_t t = 0; t < r->rest->triangle_count; t++)
        area += (double)r->rest_areas[t];
    *target = (MesoPairTarget){.radius = REACH * sqrt(area / (r->detail_count ? r->detail_count : 1))};
    if (!(target->radius > 0 && target->radius < (double)FLT_MAX))
        return MESO_OK;
    Cells cells;
    MesoArenaMark mark = meso_arena_mark(&r->scratch);
    MesoStatus status = make_cells(&cells, r, target->radius, 0, error);
    if (status == MESO_OK)
        target->rest = mean_counts(r, &cells, 1 + r->detail_count / (2 * SAMPLE));
    meso_arena_rewind(&r->scratch, mark);
    for (uint32_t b = 0; b < BINS; b++) {
        double expected = ring_area(target->radius, b) * r->detail_count / area;
        target->weights.of[b] = 1 / expected;
        near += b < BINS / (2 * REACH) ? target->rest.of[b] : 0;
        free_near += b < BINS / (2 * REACH) ? expected : 0;
    }
    target->grouped = near > GROUPED * free_near;
    return status;
}

/* ---- births ---- */

typedef struct Bearing {
    MesoReplication *r;
    Cells cells;
    MesoRandom random;
    MesoPairCounts wanted;      /* a birth's */
    double sums[BINS + 1];      /* of what is wanted, where it is */
    uint32_t *begin, *members;  /* details that live, by block */
} Bearing;

static double share(Bearing *b)
{
    return (double)(meso_random_next(&b->random) >> 11) * 0x1p-53;
}

/* What births, or deaths, have to have around them, so that all together are as at rest then; no more than they can. */
static void know_wanted(Bearing *b, double births)
{
    const MesoPairTarget *target = &b->r->pairs;
    double before = b->begin[b->r->block_count];
    MesoPairCounts now = mean_counts(b->r, &b->cells, 1 + b->r->detail_count / SAMPLE);
    for (uint32_t i = 0; i < BINS; i++) {
        double rest = target->rest.of[i], most = 2 * rest + 0.5;
        double wanted = (rest * (before + births) - now.of[i] * before) / (2 * births);
        b->wanted.of[i] = fmin(rest + most, fmax(rest - most, wanted));
        b->sums[i + 1] = b->sums[i] + fmax(0, b->wanted.of[i]);
    }
}

static MesoStatus sort_members(Bearing *b, MesoError *error)
{
    MesoReplication *r = b->r;
    b->begin = MESO_NEW(&r->scratch, uint32_t, (size_t)r->block_count + 2, error);
    b->members = MESO_NEW(&r->scratch, uint32_t, r->detail_count, error);
    if (!b->begin || !b->members)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < r->detail_count; i++)
        b->begin[r->blocks[i] + 2] += meso_lives(r, i);
    for (uint32_t k = 2; k < r->block_count + 2; k++)
        b->begin[k] += b->begin[k - 1];
    for (uint32_t i = 0; i < r->detail_count; i++)
        if (meso_lives(r, i))
            b->members[b->begin[r->blocks[i] + 1]++] = i;
    return MESO_OK;
}

/* In a triangle beside a detail. */
static MesoVec3 place_inside(Bearing *b, uint32_t detail)
{
    const MesoWeb *web = &b->r->web;
    uint32_t node = web->fixed_count + detail, turns = meso_random_below(&b->random, 8);
    MesoSpokes s = meso_spokes(web, node);
    for (uint32_t i = 0; i < turns; i++)
        if (!meso_spokes_next(web, &s))
            s = meso_spokes(web, node);
    const uint32_t *c = web->corners + 3 * (size_t)(s.now / 3);
    double u = share(b), v = share(b);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    MesoVec3 p = meso_vec3_scale(web->positions[c[0]], (float)(1 - u - v));
    p = meso_vec3_mad(p, (float)u, web->positions[c[1]]);
    return meso_vec3_mad(p, (float)v, web->positions[c[2]]);
}

/* At a distance from a detail of which there are too few. */
static MesoVec3 place_at_distance(Bearing *b, uint32_t detail)
{
    double at = share(b) * b->sums[BINS], angle = 2 * MESO_PI * share(b);
    uint32_t bin = 0;
    while (bin + 1 < BINS && b->sums[bin + 1] <= at)
        bin++;
    double distance = (bin + share(b)) * b->r->pairs.radius / BINS;
    MesoVec3 n = b->cells.normals[detail], axis = fabsf(n.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(axis, n), axis), y = meso_vec3_cross(n, x);
    MesoVec3 p = meso_vec3_mad(b->cells.places[detail], (float)(distance * cos(angle)), x);
    return meso_vec3_mad(p, (float)(distance * sin(angle)), y);
}

/* `sign`: 1 of a birth, -1 of a death. */
static double cost_of(const Bearing *b, const MesoPairCounts *counts, double sign)
{
    const MesoPairTarget *target = &b->r->pairs;
    double cost = 0;
    for (uint32_t i = 0; i < BINS; i++) {
        double left = target->debt.of[i] + sign * (b->wanted.of[i] - counts->of[i]);
        cost += target->weights.of[i] * left * left;
    }
    return cost;
}

static void owe(Bearing *b, const MesoPairCounts *counts, double sign)
{
    MesoPairTarget *target = &b->r->pairs;
    for (uint32_t i = 0; i < BINS; i++) {
        double most = 4 * target->rest.of[i] + 4;
        double debt = target->debt.of[i] + sign * (b->wanted.of[i] - counts->of[i]);
        target->debt.of[i] = fmin(most, fmax(-most, debt));
    }
}

/* Of some originals the one whose nearest are about as near: so what stands alone is as what stands alone at rest. */
static uint32_t copied_at(Bearing *b, const Vicinity *v)
{
    const MesoReplication *r = b->r;
    uint32_t best = v->nearest == MESO_NO_INDEX ? 0 : r->details[v->nearest].copied;
    double least = INFINITY;
    for (uint32_t n = 0; n < COPIES; n++) {
        uint32_t i = meso_random_below(&b->random, r->options.original_count);
        const MesoOriginal *as = &r->exemplars.originals[i];
        double sum = MESO_COPY_COST * r->copies[i];
        for (uint32_t k = 0; k < NEAREST; k++) {
            if (!(as->near[k] > 0 && as->near[k] < INFINITY && v->near[k] < INFINITY))
                continue;
            double unlike = log(fmax(sqrt((double)v->near[k]) / (double)as->near[k], 1e-3));
            sum += unlike * unlike;
        }
        if (sum < least) {
            least = sum;
            best = i;
        }
    }
    return best;
}

static MesoStatus bear_one(Bearing *b, uint32_t block, int32_t frame, MesoError *error)
{
    MesoReplication *r = b->r;
    MesoPairTarget *target = &r->pairs;
    uint32_t first = b->begin[block], count = b->begin[block + 1] - first;
    MesoBirth best = {.block = block};
    Vicinity v, chosen = {.nearest = MESO_NO_INDEX};
    double least = INFINITY;
    for (uint32_t n = 0; n < TRIED; n++) {
        uint32_t beside = b->members[first + meso_random_below(&b->random, count)];
        MesoVec3 place = n % 2 ? place_at_distance(b, beside) : place_inside(b, beside);
        look_around(&v, &b->cells, place, b->cells.normals[beside], MESO_NO_INDEX, target->radius);
        double cost = cost_of(b, &v.counts, 1);
        if (n > 0 && !(cost < least))
            continue;
        least = cost;
        best.place = place;
        best.beside = beside;
        chosen = v;
    }
    best.copied = copied_at(b, &chosen);
    uint32_t triangle = r->web.node_corner[r->web.fixed_count + best.beside] / 3;
    MesoStatus status = meso_give_birth(r, triangle, &best, frame, error);
    if (status != MESO_OK)
        return status;
    uint32_t born = r->detail_count - 1;
    b->cells.places = r->web.positions + r->web.fixed_count;
    b->cells.normals = r->web.normals + r->web.fixed_count;
    look_around(&v, &b->cells, b->cells.places[born], b->cells.normals[born], born, target->radius);
    put(&b->cells, born);
    owe(b, &v.counts, 1);
    return MESO_OK;
}

/* In each block one, and so on until none is due: so none is behind others. */
static MesoStatus bear_all(Bearing *b, int32_t frame, MesoError *error)
{
    MesoReplication *r = b->r;
    for (bool any = true; any;) {
        any = false;
        for (uint32_t block = 0; block < r->block_count; block++) {
            if (r->due[block] < 0.5 || b->begin[block + 1] == b->begin[block])
                continue;
            MesoStatus status = bear_one(b, block, frame, error);
            if (status != MESO_OK)
                return status;
            any = true;
        }
    }
    return MESO_OK;
}

static MesoStatus prepare(Bearing *b, MesoReplication *r, double births, uint64_t stream, MesoError *error)
{
    *b = (Bearing){.r = r};
    r->pairs.debt = (MesoPairCounts){{0}};      /* what is left over is seen in the next step */
    meso_random_init(&b->random, r->options.seed, 16 + 2 * (uint64_t)r->step_count + stream);
    MesoStatus status = make_cells(&b->cells, r, r->pairs.radius, births > 0 ? (uint32_t)births : 0, error);
    if (status == MESO_OK)
        status = sort_members(b, error);
    if (status == MESO_OK)
        know_wanted(b, births);
    return status;
}

MesoStatus meso_bear_by_pairs(MesoReplication *r, uint32_t due, int32_t frame, MesoError *error)
{
    Bearing b;
    MesoArenaMark mark = meso_arena_mark(&r->scratch);
    MesoStatus status = prepare(&b, r, due, 0, error);
    if (status == MESO_OK)
        status = bear_all(&b, frame, error);
    meso_arena_rewind(&r->scratch, mark);
    return status;
}

/* ---- deaths ---- */

/* False where none could be taken out. */
static bool let_one_die(Bearing *b, uint32_t block, int32_t frame)
{
    MesoReplication *r = b->r;
    uint32_t first = b->begin[block], count = b->begin[block + 1] - first, best = MESO_NO_INDEX;
    double least = INFINITY;
    Vicinity v;
    for (uint32_t n = 0; n < TRIED; n++) {
        uint32_t detail = b->members[first + meso_random_below(&b->random, count)];
        if (!meso_lives(r, detail))
            continue;
        look_around(&v, &b->cells, b->cells.places[detail], b->cells.normals[detail], detail, r->pairs.radius);
        /* copies before originals: what has come with a stretch goes with it */
        double cost = cost_of(b, &v.counts, -1) + (detail < r->options.original_count ? ORIGINAL_LAST : 0);
        if (best != MESO_NO_INDEX && !(cost < least))
            continue;
        least = cost;
        best = detail;
    }
    if (best == MESO_NO_INDEX || !meso_let_die(r, best, frame))
        return false;
    take(&b->cells, best);
    look_around(&v, &b->cells, b->cells.places[best], b->cells.normals[best], best, r->pairs.radius);
    owe(b, &v.counts, -1);
    return true;
}

MesoStatus meso_thin_by_pairs(MesoReplication *r, double surplus, uint32_t due, int32_t frame, MesoError *error)
{
    Bearing b;
    MesoArenaMark mark = meso_arena_mark(&r->scratch);
    MesoStatus status = prepare(&b, r, -(double)due, 1, error);
    for (uint32_t block = 0; block < r->block_count && status == MESO_OK; block++) {
        uint32_t left = b.begin[block + 1] - b.begin[block], misses = 0;
        while (r->due[block] <= -surplus && left > 1 && misses < TRIED)
            if (let_one_die(&b, block, frame))
                left--;
            else
                misses++;
    }
    meso_arena_rewind(&r->scratch, mark);
    return status;
}
