/* Which details die where the surface has shrunk. */
#include <stdlib.h>

#include "libcore/replicate/plan/pair_target.h"
#include "libcore/replicate/statistics/point_grid.h"

enum { RING = 48 };

/* Copies die before originals, so that what has come with a stretch goes with it. */
static const double COPY_FIRST = 1000;

/* ---- how crowded ---- */

/* What lies around a node, nearest first; details before others. */
static uint32_t near_nodes(const MesoWeb *web, uint32_t node, uint32_t ring[RING], double distances[RING])
{
    uint32_t found[RING], count = meso_web_ring(web, node, found, RING);
    count = count < RING ? count : RING;
    for (uint32_t i = 0; i < count; i++) {
        double d = sqrt(meso_web_length2(web, node, found[i]));
        uint32_t at = i;
        d = found[i] < web->fixed_count ? INFINITY : d;
        for (; at > 0 && d < distances[at - 1]; at--) {
            distances[at] = distances[at - 1];
            ring[at] = ring[at - 1];
        }
        distances[at] = d;
        ring[at] = found[i];
    }
    return count;
}

/* How near others are, for what its original has at rest. */
static double crowd_of(const MesoReplication *r, uint32_t detail)
{
    uint32_t ring[RING], node = r->web.fixed_count + detail;
    double crowd = 0, rest = (double)r->exemplars.originals[r->details[detail].copied].near[0];
    uint32_t count = meso_web_ring(&r->web, node, ring, RING);
    MesoVec3 heading = meso_heading(r, r->now.positions, detail);
    for (uint32_t k = 0; k < count && k < RING && rest < INFINITY; k++) {
        if (ring[k] < r->web.fixed_count)
            continue;
        double d = (double)meso_distance(r, r->web.positions + r->web.fixed_count, detail, heading,
                                         ring[k] - r->web.fixed_count);
        double near = rest * rest / fmax(d * d, 1e-12 * rest * rest);
        crowd += pow(near, 6);      /* one that is very near is more than some that are rather near */
    }
    return crowd * (detail < r->options.original_count ? 1 : COPY_FIRST);
}

bool meso_let_die(MesoReplication *r, uint32_t detail, int32_t frame)
{
    MesoWeb *web = &r->web;
    uint32_t ring[RING], node = web->fixed_count + detail;
    double distances[RING];
    uint32_t count = near_nodes(web, node, ring, distances);
    for (uint32_t i = 0; i < count; i++)
        if (meso_web_remove(web, node, ring[i])) {
            uint32_t into = ring[i] < web->fixed_count ? MESO_NO_INDEX : ring[i] - web->fixed_count;
            r->fates[detail] = (MesoDetailFate){frame, into};
            r->due[r->blocks[detail]]++;
            return true;
        }
    return false;
}

/* ---- all of them ---- */

typedef struct Crowded {
    double crowd;
    uint32_t detail;
} Crowded;

static int by_crowd(const void *a, const void *b)
{
    const Crowded *x = a, *y = b;
    if (x->crowd != y->crowd)
        return x->crowd > y->crowd ? -1 : 1;
    return x->detail < y->detail ? -1 : x->detail > y->detail;
}

static uint32_t gather(Crowded *out, uint32_t *living, const MesoReplication *r)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->detail_count; i++) {
        if (!meso_lives(r, i))
            continue;
        living[r->blocks[i]]++;
        if (r->due[r->blocks[i]] <= -MESO_SURPLUS)
            out[count++] = (Crowded){crowd_of(r, i), i};
    }
    return count;
}

/* The most crowded first; of those around one that has died, that have more room by now, again when others are done. */
static void thin(MesoReplication *r, const Crowded *crowded, uint32_t count, uint32_t *living, int32_t frame)
{
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < count; i++) {
            uint32_t detail = crowded[i].detail, block = r->blocks[detail];
            /* the last of a block stays: where the surface grows again, others are born beside it */
            if (r->due[block] > -MESO_SURPLUS || living[block] == 1 || !meso_lives(r, detail)
                || (pass == 0 && crowd_of(r, detail) < crowded[i].crowd))
                continue;
            if (meso_let_die(r, detail, frame))
                living[block]--;
        }
}

MesoStatus meso_thin_out(MesoReplication *r, int32_t frame, MesoError *error)
{
    double due = 0;
    for (uint32_t b = 0; b < r->block_count; b++)
        due += r->due[b] <= -MESO_SURPLUS ? fmax(1, floor(-r->due[b])) : 0;
    if (due == 0)
        return MESO_OK;
    if (r->by_pairs)
        return meso_thin_by_pairs(r, (uint32_t)fmin(due, r->detail_count), frame, error);
    MesoArenaMark mark = meso_arena_mark(&r->scratch);
    Crowded *crowded = MESO_NEW(&r->scratch, Crowded, r->detail_count, error);
    uint32_t *living = MESO_NEW(&r->scratch, uint32_t, r->block_count, error);
    bool there = crowded && living;
    if (there) {
        uint32_t count = gather(crowded, living, r);
        qsort(crowded, count, sizeof *crowded, by_crowd);
        thin(r, crowded, count, living, frame);
    }
    meso_arena_rewind(&r->scratch, mark);
    return there ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- beforehand ---- */

/* Others are counted up to so many mean spacings: when three of four have gone, the nearest ones still are. */
static const double REACH = 2.5;

/* Originals as they go one after another while a surface shrinks evenly. */
typedef struct Leaving {
    MesoReplication *r;
    MesoPointGrid grid;
    float reach;
    double *crowds;         /* by original */
    bool *gone;             /* by original */
    uint32_t *begin, *members;      /* by block */
    uint32_t left;          /* in all */
} Leaving;

/* One that leaves takes from others what it has been to them; `sign` 1: it comes. */
static void count_around(const Leaving *l, uint32_t detail, double sign)
{
    const MesoVec3 *places = l->r->web.positions + l->r->web.fixed_count;
    for (uint32_t cell = 0; cell < MESO_POINT_CELLS; cell++) {
        MesoPointRange range = meso_point_grid_range(&l->grid, places[detail], cell);
        for (uint32_t i = range.begin; i < range.end; i++) {
            uint32_t other = l->grid.order[i];
            MesoVec3 apart = meso_vec3_sub(l->grid.places[i], places[detail]);
            double d2 = (double)meso_vec3_dot(apart, apart);
            double rest = (double)l->r->exemplars.originals[other].near[0];
            if (l->grid.keys[i] != range.key || other == detail || !(d2 < (double)(l->reach * l->reach))
                || !(rest < INFINITY))
                continue;
            double near = rest * rest / fmax(d2, 1e-6 * rest * rest);
            l->crowds[other] += sign * pow(near, 6);
        }
    }
}

static MesoStatus prepare(Leaving *l, MesoArena *arena, MesoError *error)
{
    const MesoReplication *r = l->r;
    uint32_t n = r->detail_count;
    double area = 0;
    for (uint32_t t = 0; t < r->rest->triangle_count; t++)
        area += (double)r->rest_areas[t];
    l->reach = (float)(REACH * sqrt(area / n));
    l->crowds = MESO_NEW(arena, double, n, error);
    l->gone = MESO_NEW(arena, bool, n, error);
    l->begin = MESO_NEW(arena, uint32_t, (size_t)r->block_count + 2, error);
    l->members = MESO_NEW(arena, uint32_t, n, error);
    if (!l->crowds || !l->gone || !l->begin || !l->members)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < n; i++)
        l->begin[r->blocks[i] + 2]++;
    for (uint32_t b = 2; b < r->block_count + 2; b++)
        l->begin[b] += l->begin[b - 1];
    for (uint32_t i = 0; i < n; i++)
        l->members[l->begin[r->blocks[i] + 1]++] = i;
    MesoStatus status = meso_point_grid_build(&l->grid, arena, r->web.positions + r->web.fixed_count, n,
                                              l->reach > 0 ? l->reach : 1, error);
    for (uint32_t i = 0; i < n && status == MESO_OK; i++)
        count_around(l, i, 1);
    l->left = n;
    return status;
}

/* The most crowded one of a block. */
static void let_one_leave(Leaving *l, uint32_t block)
{
    uint32_t best = MESO_NO_INDEX;
    for (uint32_t k = l->begin[block]; k < l->begin[block + 1]; k++) {
        uint32_t i = l->members[k];
        if (!l->gone[i] && (best == MESO_NO_INDEX || l->crowds[i] > l->crowds[best]))
            best = i;
    }
    l->gone[best] = true;
    l->r->details[best].rank = --l->left;
    count_around(l, best, -1);
}

MesoStatus meso_rank_by_crowd(MesoReplication *r, MesoError *error)
{
    enum { ROUNDS = 128 };
    Leaving l = {.r = r};
    MesoArenaMark mark = meso_arena_mark(&r->scratch);
    MesoStatus status = r->detail_count ? prepare(&l, &r->scratch, error) : MESO_OK;
    for (uint32_t round = 1; round <= ROUNDS && status == MESO_OK && r->detail_count; round++)
        for (uint32_t b = 0; b < r->block_count; b++) {
            uint32_t count = l.begin[b + 1] - l.begin[b];
            for (uint32_t k = count * (round - 1) / ROUNDS; k < count * round / ROUNDS; k++)
                let_one_leave(&l, b);
        }
    meso_arena_rewind(&r->scratch, mark);
    return status;
}
