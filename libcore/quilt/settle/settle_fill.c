/* Bodies where the swatch would have them, and there is room. */
#include "libcore/base/grow.h"
#include "libcore/mesh/cut/triangle_area.h"
#include "libcore/quilt/settle/settle_work.h"

/*
 * Shares of the spacing: nothing stands so near to a place that is empty; and so far from each other bodies may come to
 * be.
 */
#define EMPTY 0.5f
#define ROOM 0.7f

/* Steps around a place in search of one where a body cuts nothing among such as stay. */
#define NUDGE 0.06f

/* No more bodies are added once there are so many times those that the swatch has on the same area. */
#define CROWD 1.04

enum { FILL_ROUNDS = 3, SETTLE_STEPS = 8, THREADINGS = 7 };

/* Whether a body has another one nearer than `far`. */
static bool is_taken(const MesoSettleWork *work, const MesoSettleBody *body, float far)
{
    uint32_t near[MESO_SETTLE_NEAR], count = meso_settle_near(near, MESO_SETTLE_NEAR, work, body->pose.origin);
    for (uint32_t i = 0; i < count; i++) {
        MesoVec3 d = meso_vec3_sub(work->bodies[near[i]].root, body->root);
        if (meso_vec3_dot(d, d) < far * far && meso_vec3_dot(body->pose.z, work->bodies[near[i]].pose.z) > 0)
            return true;
    }
    return false;
}

/* The body that the swatch has around another one; false beyond the surface. */
static bool predict(MesoSettleBody *body, const MesoSettleWork *work, const MesoSettleBody *from,
                    const MesoSettleRelation *relation)
{
    *body = *from;
    body->kind = relation->kind;
    body->element = MESO_NO_INDEX;
    body->stays = body->settled = false;
    body->points = NULL;
    MesoVec3 way = {relation->offset.x, relation->offset.y, 0};
    /* halfway first, so that the way bends with the surface */
    for (int i = 0; i < 2; i++)
        if (!meso_settle_move(work, body, meso_vec3_add(body->root, meso_settle_to_space(&body->pose,
                                                                                     meso_vec3_scale(way, 0.5f)))))
            return false;
    body->place.height = from->place.height + work->kinds[body->kind].height - work->kinds[from->kind].height;
    body->pose.origin = meso_settle_point(work, body->place);
    meso_settle_set_root(work, body);
    return true;
}

/* Whether all of a body lies over the surface. */
static bool is_over_surface(const MesoSettleWork *work, const MesoSettleBody *body)
{
    const MesoSettleKind *kind = &work->kinds[body->kind];
    MesoQuiltVertex place = body->place;
    float beyond;
    for (uint32_t i = 0; i < kind->point_count; i++) {
        if (!meso_settle_locate(&place, &beyond, work, meso_settle_body_point(work, body, i)) ||
            beyond > work->options.overhang)
            return false;
    }
    return true;
}

/* Looks around a place for one where a body cuts nothing. */
static MesoStatus thread_in(bool *meets, MesoSettleBody *body, const MesoSettleWork *work, MesoError *error)
{
    static const float ways[7][2] = {{0, 0}, {1, 0}, {0.5f, 0.87f}, {-0.5f, 0.87f}, {-1, 0}, {-0.5f, -0.87f},
                                     {0.5f, -0.87f}};
    const MesoSettleBody first = *body;
    *meets = true;
    for (uint32_t i = 0; i < THREADINGS && *meets; i++) {
        float step = NUDGE * work->spacing * (float)(1 + i / 7);
        MesoVec3 way = meso_vec3_mad(meso_vec3_scale(first.pose.x, step * ways[i % 7][0]), step * ways[i % 7][1],
                                     first.pose.y);
        *body = first;
        if (i && !meso_settle_move(work, body, meso_vec3_add(first.root, way)))
            continue;
        MesoStatus status = meso_settle_meets(meets, work, body, error);
        if (status)
            return status;
    }
    return MESO_OK;
}

static MesoStatus try_relation(MesoSettleWork *work, uint32_t from, uint32_t relation, uint32_t *added,
                               MesoError *error)
{
    MesoSettleBody body;
    if (!predict(&body, work, &work->bodies[from], &work->relations[relation]) ||
        is_taken(work, &body, EMPTY * work->spacing) || !is_over_surface(work, &body))
        return MESO_OK;
    for (int i = 0; i < SETTLE_STEPS; i++)
        meso_settle_relax_body(work, &body, MESO_NO_INDEX);
    if (is_taken(work, &body, ROOM * work->spacing) || !is_over_surface(work, &body))
        return MESO_OK;
    if (work->careful) {
        bool meets;
        MesoStatus status = thread_in(&meets, &body, work, error);
        if (status || meets)
            return status;
    }
    ++*added;
    if (meso_settle_add_body(work, &body, error) != MESO_NO_INDEX)
        return MESO_OK;
    return error ? error->status : MESO_ERR_MEMORY;
}

/* How many bodies may still be added. */
static uint32_t count_room(const MesoSettleWork *work)
{
    const MesoSwatch *swatch = work->swatch;
    double area = 0, tile = (double)swatch->size.x * swatch->size.y * work->options.scale * work->options.scale;
    uint32_t own = 0, there = 0;
    for (uint32_t t = 0; t < work->surface->triangle_count; t++)
        area += meso_triangle_area(work->surface, t);
    for (uint32_t e = 0; e < swatch->element_count; e++)
        own += work->kind_of[e] != MESO_NO_INDEX;
    for (uint32_t b = 0; b < work->body_count; b++)
        there += !work->bodies[b].gone;
    double most = CROWD * own * area / tile;
    return most > there ? (uint32_t)fmin(most - there, UINT32_MAX) : 0;
}

MesoStatus meso_settle_fill(MesoSettleWork *work, MesoError *error)
{
    uint32_t room = count_room(work);
    for (uint32_t round = 0; round < FILL_ROUNDS && room; round++) {
        uint32_t count = work->body_count, added = 0;
        for (uint32_t b = 0; b < count; b++) {
            const MesoSettleKind *kind = &work->kinds[work->bodies[b].kind];
            if (work->bodies[b].gone)
                continue;
            for (uint32_t r = kind->relation_begin; r < kind->relation_end && added < room; r++) {
                MesoStatus status = try_relation(work, b, r, &added, error);
                if (status)
                    return status;
            }
        }
        room -= added;
        if (!added)
            return MESO_OK;
    }
    return MESO_OK;
}
