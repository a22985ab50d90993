/* The plan that comes out of a replication: which details give way to which, and from how near. */
#include "libcore/base/grow.h"
#include "libcore/replicate/plan/replicate_work.h"
#include "libcore/replicate/statistics/point_grid.h"

enum { RING = 32, WIDEST = 600 };

/* A ramp begins beyond where details lie at rest. */
static const double BEYOND_REST = 1.001;

typedef struct Pairing {
    const MesoReplication *r;
    MesoArena *arena;
    MesoReplicaPlan *plan;
    uint32_t room;
    MesoVec3 *places;       /* [detail_count] at rest */
    MesoPointGrid grid;     /* of originals */
} Pairing;

static MesoStatus add(Pairing *p, uint32_t *count, MesoReplicaPair pair, MesoError *error)
{
    p->plan->pairs = MESO_GROW(p->arena, p->plan->pairs, *count, p->room, 1024, error);
    if (!p->plan->pairs)
        return MESO_ERR_MEMORY;
    p->plan->pairs[(*count)++] = pair;
    return MESO_OK;
}

/* The nearest of lower rank, if it is among so many around it. */
static MesoNeighbour find_above(const MesoReplication *r, uint32_t detail, uint32_t *stamps, uint32_t *queue)
{
    const MesoWeb *web = &r->web;
    MesoNeighbour above = {MESO_NO_INDEX, INFINITY};
    uint32_t begin = 0, end = 0, ring[RING], last = WIDEST;
    MesoVec3 heading = meso_heading(r, r->rest->positions, detail);
    queue[end++] = detail;
    stamps[detail] = detail + 1;
    while (begin < end && begin < last) {
        uint32_t count = meso_web_ring(web, web->fixed_count + queue[begin++], ring, RING);
        for (uint32_t i = 0; i < count && i < RING && end < WIDEST; i++) {
            uint32_t other = ring[i] - web->fixed_count;
            if (ring[i] < web->fixed_count || stamps[other] == detail + 1)
                continue;
            stamps[other] = detail + 1;
            queue[end++] = other;
            float d = meso_distance(r, web->positions + web->fixed_count, detail, heading, other);
            if (r->details[other].rank < r->details[detail].rank && d < above.distance) {
                above = (MesoNeighbour){other, d};
                last = end < last ? end : last;     /* what is joined to those before may be nearer */
            }
        }
    }
    return above;
}

MesoStatus meso_find_above(MesoReplication *r, MesoError *error)
{
    uint32_t *stamps = MESO_NEW(&r->arena, uint32_t, r->detail_count, error), queue[WIDEST];
    r->above = MESO_NEW(&r->arena, MesoNeighbour, r->detail_count, error);
    if (!stamps || !r->above)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < r->detail_count; i++)
        r->above[i] = find_above(r, i, stamps, queue);
    return MESO_OK;
}

/*
 * Originals: one of rank k out of n is to be gone where the surface has shrunk to k / n of its area, and so to the root
 * of that in length; also where the other one has gone.
 */
static MesoStatus pair_original(Pairing *p, uint32_t detail, uint32_t *count, MesoError *error)
{
    const MesoReplication *r = p->r;
    MesoNeighbour above = r->above[detail];
    double ramp = r->options.ramp, share = sqrt((r->details[detail].rank + 0.5) / r->options.original_count);
    double to = fmin(share * (1 + ramp / 2), 1 / BEYOND_REST) * (double)above.distance;
    p->plan->details[detail].radius = (float)to;
    if (above.detail == MESO_NO_INDEX || !(to > 0))
        return MESO_OK;
    return add(p, count, (MesoReplicaPair){above.detail, true, (float)((1 - ramp) * to), (float)to}, error);
}

/* The original that is nearest at rest. */
static uint32_t nearest_original(const Pairing *p, uint32_t detail)
{
    uint32_t nearest = MESO_NO_INDEX;
    float least = INFINITY;
    for (uint32_t cell = 0; cell < MESO_POINT_CELLS; cell++) {
        MesoPointRange range = meso_point_grid_range(&p->grid, p->places[detail], cell);
        for (uint32_t i = range.begin; i < range.end; i++) {
            float d = meso_vec3_length(meso_vec3_sub(p->grid.places[i], p->places[detail]));
            if (p->grid.keys[i] == range.key && d < least) {
                least = d;
                nearest = p->grid.order[i];
            }
        }
    }
    return nearest;
}

/*
 * The original whose distance has grown most by its birth tells how far the surface has come: in the middle of its ramp
 * it is as far as then. At rest none is there that was born.
 */
static MesoStatus keep_away(Pairing *p, uint32_t detail, MesoVec3 heading, uint32_t *count, MesoError *error)
{
    const MesoReplication *r = p->r;
    uint32_t best = MESO_NO_INDEX;
    double most = 0, rest = 0;
    for (uint32_t i = r->near_begin[detail]; i < r->near_begin[detail + 1]; i++) {
        uint32_t other = r->near[i].detail;
        double d = meso_distance(r, p->places, detail, heading, other);
        double ratio = d > 0 ? (double)r->near[i].distance / d : 0;
        if (other < r->options.original_count && ratio > most) {
            most = ratio;
            best = other;
            rest = d;
        }
    }
    bool grows = most > BEYOND_REST;
    if (!grows) {
        best = nearest_original(p, detail);
        best = best == MESO_NO_INDEX ? 0 : best;
        rest = meso_distance(r, p->places, detail, heading, best);
    }
    double from = BEYOND_REST * rest, to = INFINITY;
    if (grows) {
        from = fmax(from, (1 - r->options.ramp / 2) * most * rest);
        to = from / (1 - r->options.ramp);
    }
    return from > 0 ? add(p, count, (MesoReplicaPair){best, true, (float)from, (float)to}, error) : MESO_OK;
}

static MesoStatus pair_born(Pairing *p, uint32_t detail, uint32_t *count, MesoError *error)
{
    const MesoReplication *r = p->r;
    double radius = (double)r->details[detail].radius;
    MesoVec3 heading = meso_heading(r, r->rest->positions, detail);
    for (uint32_t i = r->near_begin[detail]; i < r->near_begin[detail + 1]; i++) {
        uint32_t other = r->near[i].detail;
        double rest = meso_distance(r, p->places, detail, heading, other);
        double from = (1 - r->options.ramp) * radius;
        if (!(BEYOND_REST * rest < from))
            continue;       /* it has hardly come nearer */
        MesoStatus status = add(p, count, (MesoReplicaPair){other, false, (float)from, (float)radius}, error);
        if (status != MESO_OK)
            return status;
    }
    return keep_away(p, detail, heading, count, error);
}

static MesoStatus pair_all(Pairing *p, MesoError *error)
{
    const MesoReplication *r = p->r;
    MesoReplicaPlan *plan = p->plan;
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->detail_count; i++) {
        MesoStatus status = i < r->options.original_count ? pair_original(p, i, &count, error)
                                                          : pair_born(p, i, &count, error);
        if (status != MESO_OK)
            return status;
        plan->pair_begin[i + 1] = count;
    }
    return MESO_OK;
}

MesoStatus meso_replicate_plan(MesoReplicaPlan *plan, MesoArena *arena, const MesoReplication *r, MesoError *error)
{
    uint32_t n = r->detail_count;
    *plan = (MesoReplicaPlan){n, MESO_NEW(arena, MesoDetail, n, error), MESO_NEW(arena, uint32_t, (size_t)n + 1, error),
                              NULL};
    Pairing p = {.r = r, .arena = arena, .plan = plan, .places = MESO_NEW(arena, MesoVec3, n, error)};
    if (!plan->details || !plan->pair_begin || !p.places)
        return MESO_ERR_MEMORY;
    float reach = 0;
    for (uint32_t i = 0; i < n; i++) {
        plan->details[i] = r->details[i];
        p.places[i] = meso_detail_position(r->rest, r->rest->positions, &r->details[i].point);
    }
    for (uint32_t i = 0; i < r->options.original_count; i++)
        reach = fmaxf(reach, sqrtf(r->exemplars.originals[i].area));
    MesoStatus status = meso_point_grid_build(&p.grid, arena, p.places, r->options.original_count, 2 * reach, error);
    return status == MESO_OK ? pair_all(&p, error) : status;
}
