#include "libcore/replicate/plan/replicate_state.h"

#include <string.h>

#include "libcore/replicate/plan/replicate_work.h"
#include "libcore/replicate/plan/web_edit.h"

MesoReplicaState meso_replicate_state(const MesoReplication *r)
{
    return (MesoReplicaState){r->step_count, r->tolerance.power, r->detail_count, r->details, r->blocks, r->near_begin,
                              r->near, r->web.node_count, r->web.triangle_count, r->web.node_corner, r->web.corners,
                              r->web.twins};
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
    bool original = i < r->options.original_count;
    bool inside = p->triangle < r->rest->triangle_count && p->weight[0] >= 0 && p->weight[1] >= 0 && p->weight[2] >= 0
                  && fabsf(p->weight[0] + p->weight[1] + p->weight[2] - 1) < 1e-3f;
    bool born = d->copied < r->options.original_count && d->rank == i && d->born >= 0;
    return inside && isfinite(d->angle) && (original ? memcmp(d, &r->details[i], sizeof *d) == 0 : born);
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
        if (s->node_corner[n] >= 3 * s->triangle_count)
            return no_state(error, "nodes");
    return MESO_OK;
}

/* Vertices - edges + triangles: a web keeps what it had at rest. */
static int64_t euler_of(const MesoWeb *web)
{
    int64_t sides = 0;
    for (uint32_t h = 0; h < 3 * web->triangle_count; h++)
        sides += web->twins[h] == MESO_NO_INDEX ? 2 : 1;
    return web->node_count - sides / 2 + web->triangle_count;
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
    float *areas = MESO_NEW(&r->arena, float, n, error);
    if (!r->details || !r->blocks || !r->near_begin || !r->near || !areas)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < n; i++)
        areas[i] = r->exemplars.originals[r->details[i].copied].area;
    r->areas = areas;
    r->detail_count = r->detail_room = (uint32_t)n;
    r->near_room = near_count;
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
        status = take_web(r, state, error);
    if (status == MESO_OK)
        status = take_details(r, state, error);
    r->step_count = state->step_count;
    r->tolerance.power = state->power;
    return status;
}
