/*
 * Linked bodies off each other: of all ways there are few that lead off what goes through others, and where it cuts them
 * tells which. Each goes there by small steps, along the layer and up and down.
 */
#include "libcore/base/team.h"
#include "libcore/quilt/settle/settle_work.h"

/* Shares of the spacing: a step; how near bodies are in each other's place, but such as are meant to be there; how far off
 * what is meant may be, and friends. */
#define STEP 0.02f
#define TOO_NEAR 0.85f
#define MEANT 0.4f
#define FRIEND 0.2f

enum { ROUNDS = 16, MOST_CROSSINGS = 64 };

/* ---- bodies in each other's place ---- */

static void count_friends(MesoSettleWork *work, uint32_t a)
{
    MesoSettleBody *body = &work->bodies[a];
    uint32_t near[MESO_SETTLE_NEAR], count = meso_settle_near(near, MESO_SETTLE_NEAR, work, body->pose.origin);
    body->friends = 0;
    for (uint32_t i = 0; i < count; i++)
        if (near[i] != a && meso_settle_same_side(body, &work->bodies[near[i]]))
            body->friends += meso_settle_is_meant(work, body, &work->bodies[near[i]], FRIEND);
}

/* Whether a body has another one in its place that has more friends. */
static bool is_displaced(const MesoSettleWork *work, uint32_t a)
{
    const MesoSettleBody *body = &work->bodies[a];
    uint32_t near[MESO_SETTLE_NEAR], count = meso_settle_near(near, MESO_SETTLE_NEAR, work, body->pose.origin);
    for (uint32_t i = 0; i < count; i++) {
        const MesoSettleBody *other = &work->bodies[near[i]];
        float apart = meso_vec3_length(meso_vec3_sub(other->root, body->root));
        if (near[i] != a && body->friends < other->friends && apart < TOO_NEAR * work->spacing &&
            meso_settle_same_side(body, other) && !meso_settle_is_meant(work, other, body, MEANT) &&
            !meso_settle_is_meant(work, body, other, MEANT))
            return true;
    }
    return false;
}

static void weed(MesoSettleWork *work)
{
    for (uint32_t b = 0; b < work->body_count; b++)
        count_friends(work, b);
    for (uint32_t b = 0; b < work->body_count; b++)
        work->bodies[b].gone |= !work->bodies[b].stays && is_displaced(work, b);
}

/* ---- pushes ---- */

/* Those around a body that it may cut, and what comes of each: side by side. */
typedef struct Pushes {
    const MesoSettleWork *work;
    const MesoSettleBody *body;
    uint32_t count;
    uint32_t others[MESO_SETTLE_NEAR];
    MesoVec3 offs[MESO_SETTLE_NEAR];
    bool cuts[MESO_SETTLE_NEAR];
} Pushes;

static void push_range(void *context, uint64_t begin, uint64_t end)
{
    Pushes *p = context;
    const MesoSettleKind *kinds = p->work->kinds;
    for (uint64_t i = begin; i < end; i++) {
        const MesoSettleBody *other = &p->work->bodies[p->others[i]];
        p->cuts[i] = meso_sphere_trees_push(&p->offs[i], &kinds[p->body->kind].spheres, &p->body->pose,
                                            &kinds[other->kind].spheres, &other->pose, MOST_CROSSINGS) > 0;
    }
}

/* In the first round what comes before a body and is settled is known not to cut it. */
static void list_others(Pushes *p, uint32_t a, bool first)
{
    const MesoSettleWork *work = p->work;
    uint32_t near[MESO_SETTLE_NEAR], count = meso_settle_near(near, MESO_SETTLE_NEAR, work, p->body->pose.origin);
    for (uint32_t i = 0; i < count; i++) {
        const MesoSettleBody *other = &work->bodies[near[i]];
        MesoVec3 d = meso_vec3_sub(p->body->pose.origin, other->pose.origin);
        float reach = work->kinds[p->body->kind].reach + work->kinds[other->kind].reach;
        if (near[i] != a && meso_vec3_dot(d, d) < reach * reach && !(first && near[i] < a && other->settled))
            p->others[p->count++] = near[i];
    }
}

/* The way off all that a body cuts, at most of length 1; false where it cuts nothing. */
static bool find_push(MesoVec3 *push, MesoSettleWork *work, uint32_t a, bool first, MesoTeam *team)
{
    Pushes p;
    bool any = false;
    p.work = work;
    p.body = &work->bodies[a];
    p.count = 0;
    *push = (MesoVec3){0, 0, 0};
    list_others(&p, a, first);
    meso_team_for(team, p.count, 1, push_range, &p);
    for (uint32_t i = 0; i < p.count; i++)
        if (p.cuts[i]) {
            *push = meso_vec3_add(*push, meso_vec3_direction(p.offs[i], (MesoVec3){0, 0, 0}));
            work->bodies[p.others[i]].settled = false;
            any = true;
        }
    float length = meso_vec3_length(*push);
    if (length > 1)
        *push = meso_vec3_scale(*push, 1 / length);
    return any;
}

static void push_body(MesoSettleWork *work, uint32_t a, bool first, MesoTeam *team)
{
    MesoSettleBody *body = &work->bodies[a];
    MesoVec3 push;
    body->settled = !find_push(&push, work, a, first, team) || body->stays;
    if (body->settled)
        return;
    MesoVec3 step = meso_vec3_scale(push, STEP * work->spacing);
    body->place.height += meso_vec3_dot(step, meso_settle_up(work, body->place));
    meso_settle_move(work, body, meso_vec3_add(body->root, meso_settle_along(work, body, step)));
    meso_settle_list(work, a);
}

void meso_settle_push(MesoSettleWork *work)
{
    weed(work);
    MesoTeam *team = meso_team_begin(work->options.thread_count);
    bool all = false;
    for (uint32_t round = 0; round < ROUNDS && !all; round++) {
        all = true;
        for (uint32_t b = 0; b < work->body_count; b++)
            if (!work->bodies[b].gone && !work->bodies[b].settled) {
                push_body(work, b, round == 0, team);
                all &= work->bodies[b].settled;
            }
    }
    meso_team_end(team);
}
