/* The plan that comes out of a replication: which details give way to which, and from how near. */
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/replicate/plan/replicate_work.h"

enum { RING = 32, WIDEST = 600 };

/* So much more or less than at rest, of area, nothing comes or goes: a bent surface has its triangles' chords. */
static const double BEYOND_REST = 0.004;

/* Of the ramp: what is left of it, of area, where it would begin at rest. */
static const double LEAST_RAMP = 0.9;

/* Of the distance at which it was born. */
static const double CROWDED = 0.8;

typedef struct Pairing {
    const MesoReplication *r;
    MesoArena *arena;
    MesoReplicaPlan *plan;
    uint32_t room;
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
 * Originals: one that goes where its part has shrunk to a share of its area has come nearer to the others by the root
 * of that then; where it comes nearer by far, since the surface has become longer and narrower, it gives way before.
 */
static MesoStatus pair_original(Pairing *p, uint32_t detail, uint32_t *count, MesoError *error)
{
    const MesoReplication *r = p->r;
    MesoNeighbour above = r->above[detail];
    double share = sqrt(fmin(1, (double)p->plan->rooms[detail].to));
    double to = CROWDED * share * (double)above.distance;
    p->plan->details[detail].radius = (float)to;
    if (above.detail == MESO_NO_INDEX || !(to > 0))
        return MESO_OK;
    return add(p, count, (MesoReplicaPair){above.detail, (float)((1 - r->options.ramp) * to), (float)to}, error);
}

static MesoStatus pair_born(Pairing *p, uint32_t detail, uint32_t *count, MesoError *error)
{
    const MesoReplication *r = p->r;
    double to = CROWDED * (double)r->details[detail].radius, from = (1 - r->options.ramp) * to;
    for (uint32_t i = r->near_begin[detail]; i < r->near_begin[detail + 1] && from > 0; i++) {
        MesoReplicaPair pair = {r->near[i].detail, (float)from, (float)to};
        if (!(pair.from < pair.to))
            continue;
        MesoStatus status = add(p, count, pair, error);
        if (status != MESO_OK)
            return status;
    }
    return MESO_OK;
}

/*
 * When there is how much room: details of a part are counted by rank, and one is there while so many are due. Those
 * born begin later than at rest, and originals go earlier.
 */
static MesoStatus find_rooms(Pairing *p, MesoError *error)
{
    const MesoReplication *r = p->r;
    uint32_t n = r->detail_count, originals = r->options.original_count;
    double *counts = MESO_NEW(p->arena, double, r->block_count, error);
    double *all = MESO_NEW(p->arena, double, r->block_count, error);
    uint32_t *by_rank = MESO_NEW(p->arena, uint32_t, n, error);
    if (!counts || !all || !by_rank)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < n; i++)
        by_rank[r->details[i].rank] = i;
    for (uint32_t i = 0; i < originals; i++)
        all[r->blocks[i]]++;
    for (uint32_t k = 0; k < n; k++) {
        uint32_t i = by_rank[k], block = r->blocks[i];
        bool born = i >= originals;
        double middle = (counts[block]++ + 0.5 - (born ? meso_phase_of(block) : 0)) / fmax(1, all[block]);
        double half = r->options.ramp * middle, least = LEAST_RAMP * r->options.ramp;     /* twice as much of area */
        double from = middle - half, to = middle + half;
        if (born && from < 1 + BEYOND_REST) {
            from = 1 + BEYOND_REST;
            to = fmax(2 * middle - from, from + least);
        } else if (!born && to > 1 - BEYOND_REST) {
            to = 1 - BEYOND_REST;
            from = fmax(0, fmin(2 * middle - to, to - least));
        }
        p->plan->rooms[i] = (MesoReplicaRoom){block, (float)from, (float)to};
    }
    return MESO_OK;
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
    *plan = (MesoReplicaPlan){.detail_count = n, .details = MESO_NEW(arena, MesoDetail, n, error),
                              .pair_begin = MESO_NEW(arena, uint32_t, (size_t)n + 1, error),
                              .rooms = MESO_NEW(arena, MesoReplicaRoom, n, error)};
    Pairing p = {.r = r, .arena = arena, .plan = plan};
    if (!plan->details || !plan->pair_begin || !plan->rooms)
        return MESO_ERR_MEMORY;
    memcpy(plan->details, r->details, n * sizeof *plan->details);
    MesoStatus status = find_rooms(&p, error);
    return status == MESO_OK ? pair_all(&p, error) : status;
}
