#include "libcore/replicate/plan/replicate_state.h"

#include <string.h>

#include "libcore/replicate/plan/replicate_work.h"
#include "libcore/replicate/web/web_edit.h"

MesoReplicaState meso_replicate_state(const MesoReplication *r)
{
    return (MesoReplicaState){
        .step_count = r->step_count, .power = r->tolerance.power, .detail_count = r->detail_count,
        .details = r->details, .blocks = r->blocks, .near_begin = r->near_begin, .near = r->near,
        .last_frame = r->last_frame, .grown = r->grown, .fates = r->fates, .merging_count = r->merging_count,
        .mergings = (const uint32_t (*)[2])r->mergings, .node_count = r->web.node_count,
        .triangle_count = r->web.triangle_count, .node_corner = r->web.node_corner, .corners = r->web.corners,
        .twins = r->web.twins,
    };
}

/* ---- is it one ---- */

static MesoStatus no_state(MesoError *error, const char *why)
{
    return meso_fail(error, MESO_ERR_INPUT, "the state is of another surface or other details: %s", why);
}

static bool is_detail(const MesoReplication *r, const MesoReplicaState *s, uint32_t i)
{
    const MesoDetail *d = &s->details[i];
    const MesoMeshPoint *p = &d->point;
    MesoDetail original = i < r->options.original_count ? r->details[i] : (MesoDetail){0};
    original.point = *p;    /* the paper's rule moves them */
    bool inside = p->triangle < r->rest->triangle_count && p->weight[0] >= 0 && p->weight[1] >= 0 && p->weight[2] >= 0
                  && fabsf(p->weight[0] + p->weight[1] + p->weight[2] - 1) < 1e-3f;
    bool born = d->copied < r->options.original_count && d->rank == i && d->born >= 0;
    return inside && isfinite(d->angle)
           && (i < r->options.original_count ? memcmp(d, &original, sizeof *d) == 0 : born);
}

/* Those alone are out of the web that have died. */
static bool has_died(const MesoReplicaState *s, uint32_t detail)
{
    return s->node_corner[s->node_count - s->detail_count + detail] == MESO_NO_INDEX;
}

static bool is_life(const MesoReplicaState *s, uint32_t i)
{
    bool died = has_died(s, i);
    if (s->grown && !(s->grown[i] >= 0 && s->grown[i] <= 1))
        return false;
    return !s->fates || ((s->fates[i].died != MESO_DETAIL_LIVES) == died
                         && (s->fates[i].into == MESO_NO_INDEX || (died && s->fates[i].into < s->detail_count)));
}

static MesoStatus check_lives(const MesoReplicaState *s, MesoError *error)
{
    if (s->merging_count > 0 && !s->mergings)
        return no_state(error, "mergings");
    for (uint32_t i = 0; i < s->detail_count; i++)
        if (!is_life(s, i))
            return no_state(error, "shares");
    for (uint32_t m = 0; m < s->merging_count; m++)
        for (uint32_t k = 0; k < 2; k++)
            if (s->mergings[m][k] >= s->detail_count || s->mergings[m][0] == s->mergings[m][1]
                || has_died(s, s->mergings[m][k]))
                return no_state(error, "mergings");
    return s->last_frame >= -1 && s->last_frame <= UINT32_MAX ? MESO_OK : no_state(error, "frames");
}

static MesoStatus check_details(const MesoReplication *r, const MesoReplicaState *s, MesoError *error)
{
    if (s->detail_count < r->options.original_count || s->node_count < r->web.fixed_count
        || s->node_count - r->web.fixed_count != s->detail_count || !isfinite(s->power) || s->near_begin[0] != 0)
        return no_state(error, "counts");
    for (uint32_t i = 0; i < s->detail_count; i++) {
        if (!is_detail(r, s, i) || s->blocks[i] >= r->block_count)
            return no_state(error, "details");
        if (s->near_begin[i + 1] < s->near_begin[i] || s->near_begin[i + 1] - s->near_begin[i] > MESO_BIRTH_NEAR)
            return no_state(error, "neighbours");
        for (uint32_t k = s->near_begin[i]; k < s->near_begin[i + 1]; k++)
            if (s->near[k].detail >= i || !(s->near[k].distance >= 0))
                return no_state(error, "neighbours");
    }
    return MESO_OK;
}

static MesoStatus check_indices(const MesoReplicaState *s, MesoError *error)
{
    for (uint32_t h = 0; h < 3 * s->triangle_count; h++)
        if (s->corners[h] >= s->node_count || (s->twins[h] != MESO_NO_INDEX && s->twins[h] >= 3 * s->triangle_count))
            return no_state(error, "triangles");
    for (uint32_t n = 0; n < s->node_count; n++)
        if (s->node_corner[n] >= 3 * s->triangle_count && s->node_corner[n] != MESO_NO_INDEX)
            return no_state(error, "nodes");
    return MESO_OK;
}

/* Vertices - edges + triangles: a web keeps what it had at rest. */
static int64_t euler_of(const MesoWeb *web)
{
    int64_t sides = 0;
    for (uint32_t h = 0; h < 3 * web->triangle_count; h++)
        sides += web->twins[h] == MESO_NO_INDEX ? 2 : 1;
    int64_t nodes = 0;
    for (uint32_t n = 0; n < web->node_count; n++)
        nodes += web->node_corner[n] != MESO_NO_INDEX;
    return nodes - sides / 2 + web->triangle_count;
}

/* ---- going there ---- */

static void *copy(MesoArena *arena, const void *array, size_t count, size_t size, MesoError *error)
{
    void *own = meso_arena_alloc(arena, count, size, error);
    if (own && count)
        memcpy(own, array, count * size);
    return own;
}

static MesoStatus take_details(MesoReplication *r, const MesoReplicaState *s, MesoError *error)
{
    size_t n = s->detail_count;
    uint32_t near_count = s->near_begin[n];
    r->details = copy(&r->arena, s->details, n, sizeof *r->details, error);
    r->blocks = copy(&r->arena, s->blocks, n, sizeof *r->blocks, error);
    r->near_begin = copy(&r->arena, s->near_begin, n + 1, sizeof *r->near_begin, error);
    r->near = copy(&r->arena, s->near, near_count, sizeof *r->near, error);
    r->grown = MESO_NEW(&r->arena, float, n, error);
    r->fates = MESO_NEW(&r->arena, MesoDetailFate, n, error);
    r->mergings = copy(&r->arena, s->mergings, s->merging_count, sizeof *r->mergings, error);
    float *areas = MESO_NEW(&r->arena, float, n, error);
    if (!r->details || !r->blocks || !r->near_begin || !r->near || !r->grown || !r->fates || !r->mergings || !areas)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < n; i++) {
        bool died = has_died(s, i);
        r->grown[i] = s->grown ? s->grown[i] : died ? 0 : 1;
        r->fates[i] = s->fates ? s->fates[i] : (MesoDetailFate){died ? 0 : MESO_DETAIL_LIVES, MESO_NO_INDEX};
    }
    for (uint32_t i = 0; i < n; i++)
        areas[i] = r->exemplars.originals[r->details[i].copied].area;
    for (uint32_t i = r->options.original_count; i < n; i++)
        r->copies[r->details[i].copied]++;
    r->areas = areas;
    r->detail_count = r->detail_room = (uint32_t)n;
    r->near_room = near_count;
    r->merging_count = r->merging_room = s->merging_count;
    return MESO_OK;
}

static MesoStatus take_web(MesoReplication *r, const MesoReplicaState *s, MesoError *error)
{
    MesoWeb *web = &r->web;
    int64_t euler = euler_of(web);
    MesoStatus status = meso_web_reserve(web, s->node_count, s->triangle_count, error);
    if (status != MESO_OK)
        return status;
    web->node_count = s->node_count;
    web->triangle_count = s->triangle_count;
    memcpy(web->node_corner, s->node_corner, s->node_count * sizeof *web->node_corner);
    memcpy(web->corners, s->corners, 3 * (size_t)s->triangle_count * sizeof *web->corners);
    memcpy(web->twins, s->twins, 3 * (size_t)s->triangle_count * sizeof *web->twins);
    for (uint32_t i = 0; i < s->detail_count; i++)
        web->points[web->fixed_count + i] = s->details[i].point;
    return meso_web_check(web, euler, NULL) == MESO_OK ? MESO_OK : no_state(error, "triangles");
}

MesoStatus meso_replicate_resume(MesoReplication *r, const MesoReplicaState *state, MesoError *error)
{
    MesoStatus status = check_details(r, state, error);
    if (status == MESO_OK)
        status = check_indices(state, error);
    if (status == MESO_OK)
        status = check_lives(state, error);
    if (status == MESO_OK)
        status = take_web(r, state, error);
    if (status == MESO_OK)
        status = take_details(r, state, error);
    r->step_count = state->step_count;
    r->tolerance.power = state->power;
    r->last_frame = state->last_frame;
    return status;
}
