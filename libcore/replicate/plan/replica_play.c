#include "libcore/replicate/plan/replica_play.h"

#include <stdlib.h>

#include "libcore/base/parallel.h"

enum { GRAIN = 8192, BLOCK_GRAIN = 128 };

typedef struct Hindrance {
    uint32_t slot;
    float from, to;
} Hindrance;

/* A triangle that an original is on. */
typedef struct Plot {
    uint32_t triangle;
    float rest;             /* its area there */
} Plot;

typedef struct Direction {
    uint32_t triangle;
    float angle, aspect;
    MesoVec3 heading;       /* now */
} Direction;

struct MesoPlayer {
    uint32_t count, level_count;
    uint32_t *levels;       /* [level_count + 1] first slots: those of a level wait for lower levels alone */
    uint32_t *details;      /* [count] detail of each slot */
    uint32_t *corners;      /* [3 * count] vertices around its point */
    float *weights;         /* [3 * count] */
    uint32_t *begin;        /* [count + 1] */
    Hindrance *hindrances;
    MesoReplicaRoom *rooms; /* [count] */
    uint32_t block_count;
    uint32_t *block_begin;  /* [block_count + 1] */
    Plot *plots;            /* by block */
    float *extents;         /* [block_count] how large they are now */
    MesoVec3 *places;       /* [count] now */
    const MesoTriangulation *rest;
    Direction *directions;  /* [count] of ellipses; NULL: none has one */
    float *shares;          /* [count] now */
};

/* ---- order ---- */

typedef struct Slot {
    uint32_t level, triangle, detail;
} Slot;

static int by_slot(const void *a, const void *b)
{
    const Slot *x = a, *y = b;
    if (x->level != y->level)
        return x->level < y->level ? -1 : 1;
    if (x->triangle != y->triangle)
        return x->triangle < y->triangle ? -1 : 1;
    return x->detail < y->detail ? -1 : x->detail > y->detail;
}

static MesoStatus check(const MesoReplicaPlan *plan, const MesoTriangulation *rest, MesoError *error)
{
    if (plan->pair_begin[0] != 0)
        return meso_fail(error, MESO_ERR_INPUT, "pairs do not begin with the first");
    for (uint32_t k = 0; k < plan->detail_count; k++) {
        const MesoDetail *detail = &plan->details[k];
        if (detail->point.triangle >= rest->triangle_count || detail->rank >= plan->detail_count
            || plan->pair_begin[k + 1] < plan->pair_begin[k])
            return meso_fail(error, MESO_ERR_INPUT, "detail %u has no place, rank or pairs of the plan", k);
        if (plan->rooms[k].block >= plan->detail_count || !(plan->rooms[k].from >= 0)
            || !(plan->rooms[k].from < plan->rooms[k].to))
            return meso_fail(error, MESO_ERR_INPUT, "detail %u has no room of the plan", k);
        for (uint32_t i = plan->pair_begin[k]; i < plan->pair_begin[k + 1]; i++) {
            const MesoReplicaPair *pair = &plan->pairs[i];
            if (pair->other >= plan->detail_count || plan->details[pair->other].rank >= detail->rank)
                return meso_fail(error, MESO_ERR_INPUT, "detail %u gives way to one that is not of lower rank", k);
            if (!(pair->from > 0) || !(pair->from < pair->to))
                return meso_fail(error, MESO_ERR_INPUT, "detail %u has a ramp without length", k);
        }
    }
    return MESO_OK;
}

static MesoStatus order_details(Slot *slots, const MesoReplicaPlan *plan, MesoArena *arena, MesoError *error)
{
    uint32_t *by_rank = MESO_NEW(arena, uint32_t, plan->detail_count, error);
    if (!by_rank)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < plan->detail_count; k++)
        by_rank[k] = MESO_NO_INDEX;
    for (uint32_t k = 0; k < plan->detail_count; k++) {
        if (by_rank[plan->details[k].rank] != MESO_NO_INDEX)
            return meso_fail(error, MESO_ERR_INPUT, "details %u and %u have one rank",
                             by_rank[plan->details[k].rank], k);
        by_rank[plan->details[k].rank] = k;
    }
    for (uint32_t r = 0; r < plan->detail_count; r++) {
        uint32_t k = by_rank[r], level = 0;
        for (uint32_t i = plan->pair_begin[k]; i < plan->pair_begin[k + 1]; i++) {
            uint32_t other = slots[plan->pairs[i].other].level;
            level = other >= level ? other + 1 : level;
        }
        slots[k] = (Slot){level, plan->details[k].point.triangle, k};
    }
    qsort(slots, plan->detail_count, sizeof *slots, by_slot);
    return MESO_OK;
}

static MesoStatus make_room(MesoPlayer *p, MesoArena *arena, const MesoReplicaPlan *plan, MesoError *error)
{
    size_t n = p->count = plan->detail_count;
    p->levels = MESO_NEW(arena, uint32_t, n + 1, error);
    p->details = MESO_NEW(arena, uint32_t, n, error);
    p->corners = MESO_NEW(arena, uint32_t, 3 * n, error);
    p->weights = MESO_NEW(arena, float, 3 * n, error);
    p->begin = MESO_NEW(arena, uint32_t, n + 1, error);
    p->hindrances = MESO_NEW(arena, Hindrance, plan->pair_begin[n], error);
    p->rooms = MESO_NEW(arena, MesoReplicaRoom, n, error);
    p->places = MESO_NEW(arena, MesoVec3, n, error);
    p->shares = MESO_NEW(arena, float, n, error);
    return p->levels && p->details && p->corners && p->weights && p->begin && p->hindrances && p->rooms && p->places
           && p->shares ? MESO_OK : MESO_ERR_MEMORY;
}

static float area_of(const MesoTriangulation *mesh, const MesoVec3 *positions, uint32_t triangle)
{
    const uint32_t *c = mesh->corners + 3 * (size_t)triangle;
    MesoVec3 u = meso_vec3_sub(positions[c[1]], positions[c[0]]), v = meso_vec3_sub(positions[c[2]], positions[c[0]]);
    return 0.5f * meso_vec3_length(meso_vec3_cross(u, v));
}

static MesoStatus sort_plots(MesoPlayer *p, MesoArena *arena, const MesoTriangulation *rest,
                             const MesoReplicaPlan *plan, MesoError *error)
{
    uint32_t n = plan->detail_count, count = 0;
    for (uint32_t k = 0; k < n; k++) {
        p->block_count = plan->rooms[k].block >= p->block_count ? plan->rooms[k].block + 1 : p->block_count;
        count += plan->details[k].born == MESO_DETAIL_ORIGINAL;
    }
    p->block_begin = MESO_NEW(arena, uint32_t, (size_t)p->block_count + 2, error);
    p->plots = MESO_NEW(arena, Plot, count, error);
    p->extents = MESO_NEW(arena, float, p->block_count, error);
    if (!p->block_begin || !p->plots || !p->extents)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < n; k++)
        p->block_begin[plan->rooms[k].block + 2] += plan->details[k].born == MESO_DETAIL_ORIGINAL;
    for (uint32_t b = 2; b < p->block_count + 2; b++)
        p->block_begin[b] += p->block_begin[b - 1];
    for (uint32_t k = 0; k < n; k++) {
        uint32_t triangle = plan->details[k].point.triangle;
        if (plan->details[k].born == MESO_DETAIL_ORIGINAL)
            p->plots[p->block_begin[plan->rooms[k].block + 1]++] =
                (Plot){triangle, area_of(rest, rest->positions, triangle)};
    }
    return MESO_OK;
}

static void fill(MesoPlayer *p, const Slot *slots, const uint32_t *slot_of, const MesoTriangulation *rest,
                 const MesoReplicaPlan *plan)
{
    uint32_t made = 0;
    for (uint32_t s = 0; s < p->count; s++) {
        uint32_t k = slots[s].detail;
        const MesoMeshPoint *point = &plan->details[k].point;
        while (p->level_count <= slots[s].level)
            p->levels[p->level_count++] = s;
        p->details[s] = k;
        for (uint32_t c = 0; c < 3; c++) {
            p->corners[3 * s + c] = rest->corners[3 * (size_t)point->triangle + c];
            p->weights[3 * s + c] = point->weight[c];
        }
        p->rooms[s] = plan->rooms[k];
        p->begin[s] = made;
        for (uint32_t i = plan->pair_begin[k]; i < plan->pair_begin[k + 1]; i++)
            p->hindrances[made++] = (Hindrance){slot_of[plan->pairs[i].other], plan->pairs[i].from,
                                                plan->pairs[i].to};
    }
    p->begin[p->count] = made;
    p->levels[p->level_count] = p->count;
}

/* Where one is not alike in all directions. */
static MesoStatus know_directions(MesoPlayer *p, MesoArena *arena, const MesoTriangulation *rest,
                                  const MesoReplicaPlan *plan, MesoError *error)
{
    bool any = false;
    p->rest = rest;
    for (uint32_t k = 0; k < plan->detail_count && !any; k++)
        any = meso_detail_aspect(&plan->details[k]) != 1;
    p->directions = any ? MESO_NEW(arena, Direction, p->count, error) : NULL;
    for (uint32_t s = 0; s < p->count && p->directions; s++) {
        const MesoDetail *detail = &plan->details[p->details[s]];
        p->directions[s] = (Direction){detail->point.triangle, detail->angle, meso_detail_aspect(detail), {0, 0, 0}};
    }
    return any && !p->directions ? MESO_ERR_MEMORY : MESO_OK;
}

MesoStatus meso_player_build(MesoPlayer **player, MesoArena *arena, const MesoTriangulation *rest,
                             const MesoReplicaPlan *plan, MesoError *error)
{
    MesoPlayer *p = *player = MESO_NEW(arena, MesoPlayer, 1, error);
    MesoStatus status = p ? check(plan, rest, error) : MESO_ERR_MEMORY;
    if (status == MESO_OK)
        status = make_room(p, arena, plan, error);
    if (status == MESO_OK)
        status = sort_plots(p, arena, rest, plan, error);
    if (status != MESO_OK)
        return status;
    MesoArenaMark mark = meso_arena_mark(arena);
    Slot *slots = MESO_NEW(arena, Slot, p->count, error);
    uint32_t *slot_of = MESO_NEW(arena, uint32_t, p->count, error);
    status = slots && slot_of ? order_details(slots, plan, arena, error) : MESO_ERR_MEMORY;
    if (status == MESO_OK) {
        for (uint32_t s = 0; s < p->count; s++)
            slot_of[slots[s].detail] = s;
        fill(p, slots, slot_of, rest, plan);
    }
    meso_arena_rewind(arena, mark);
    return status == MESO_OK ? know_directions(p, arena, rest, plan, error) : status;
}

/* ---- a shape ---- */

typedef struct Playing {
    MesoPlayer *player;
    const MesoVec3 *positions;
    float *grown;
    uint32_t first;     /* slot of the level */
} Playing;

static void place_range(void *context, uint64_t begin, uint64_t end)
{
    const Playing *playing = context;
    const MesoPlayer *p = playing->player;
    for (uint64_t s = begin; s < end; s++) {
        const uint32_t *c = &p->corners[3 * s];
        const float *w = &p->weights[3 * s];
        MesoVec3 at = meso_vec3_scale(playing->positions[c[0]], w[0]);
        at = meso_vec3_mad(at, w[1], playing->positions[c[1]]);
        p->places[s] = meso_vec3_mad(at, w[2], playing->positions[c[2]]);
        if (p->directions && p->directions[s].aspect != 1) {
            MesoDetail detail = {.point = {.triangle = p->directions[s].triangle}, .angle = p->directions[s].angle};
            p->directions[s].heading = meso_detail_heading(p->rest, playing->positions, &detail);
        }
    }
}

static void extent_range(void *context, uint64_t begin, uint64_t end)
{
    const Playing *playing = context;
    const MesoPlayer *p = playing->player;
    for (uint64_t b = begin; b < end; b++) {
        uint32_t first = p->block_begin[b], count = p->block_begin[b + 1] - first;
        double sum = 0;
        for (uint32_t i = first; i < first + count; i++) {
            const Plot *plot = &p->plots[i];
            sum += plot->rest > 0 ? (double)(area_of(p->rest, playing->positions, plot->triangle) / plot->rest) : 1;
        }
        p->extents[b] = count ? (float)(sum / count) : 1;
    }
}

/* 0 where the ramp has no end. */
static float smooth_step(float at, float from, float to)
{
    float x = fminf(fmaxf((at - from) / (to - from), 0), 1);
    return x * x * (3 - 2 * x);
}

/* Squares, so that what lies beyond the ramp asks for no root. */
static float share_beside(float share, float d2, const Hindrance *h)
{
    return d2 <= h->from * h->from ? 1 - share : 1 - share * (1 - smooth_step(sqrtf(d2), h->from, h->to));
}

static void play_range(void *context, uint64_t begin, uint64_t end)
{
    const Playing *playing = context;
    const MesoPlayer *p = playing->player;
    for (uint64_t s = playing->first + begin; s < playing->first + end; s++) {
        MesoVec3 at = p->places[s];
        const MesoReplicaRoom *room = &p->rooms[s];
        float share = smooth_step(p->extents[room->block], room->from, room->to);
        for (uint32_t i = p->begin[s]; i < p->begin[s + 1] && share > 0; i++) {
            const Hindrance *h = &p->hindrances[i];
            MesoVec3 apart = meso_vec3_sub(p->places[h->slot], at);
            float d2 = p->directions ? meso_detail_norm2(apart, p->directions[s].heading, p->directions[s].aspect)
                                     : meso_vec3_dot(apart, apart);
            if (d2 < h->to * h->to)
                share = fminf(share, share_beside(p->shares[h->slot], d2, h));
        }
        p->shares[s] = share;
        playing->grown[p->details[s]] = share;
    }
}

void meso_player_play(MesoPlayer *player, float *grown, const MesoVec3 *positions, uint32_t thread_count)
{
    Playing playing = {player, positions, grown, 0};
    meso_parallel_for(thread_count, player->count, GRAIN, place_range, &playing);
    meso_parallel_for(thread_count, player->block_count, BLOCK_GRAIN, extent_range, &playing);
    for (uint32_t l = 0; l < player->level_count; l++) {
        playing.first = player->levels[l];
        meso_parallel_for(thread_count, player->levels[l + 1] - playing.first, GRAIN, play_range, &playing);
    }
}
