/* Bodies off each other. */
#include "libcore/quilt/seam/bodies_meet.h"
#include "libcore/quilt/settle/settle_work.h"

enum { MOST_CROSSINGS = 48, PART_ROUNDS = 12, DEEP_TRIAL = 8 };

static uint32_t crossings_of_pair(const MesoSettleWork *work, const MesoSettleBody *a, const MesoSettleBody *b,
                                  uint32_t most)
{
    MesoVec3 d = meso_vec3_sub(a->pose.origin, b->pose.origin);
    float reach = work->kinds[a->kind].reach + work->kinds[b->kind].reach;
    if (meso_vec3_dot(d, d) >= reach * reach)
        return 0;
    return meso_sphere_trees_crossings(&work->kinds[a->kind].spheres, &a->pose, &work->kinds[b->kind].spheres, &b->pose,
                                       most);
}

uint32_t meso_settle_crossings(const MesoSettleWork *work, const MesoSettleBody *body, uint32_t itself, uint32_t most)
{
    uint32_t near[MESO_SETTLE_NEAR], count = meso_settle_near(near, MESO_SETTLE_NEAR, work, body->pose.origin), sum = 0;
    for (uint32_t i = 0; i < count && sum < most; i++)
        if (near[i] != itself)
            sum += crossings_of_pair(work, body, &work->bodies[near[i]], most - sum);
    return sum;
}

/* Ways to try: away from what it cuts and aside, near and far, and turned. */
typedef struct Trial {
    MesoVec3 move;
    float turn;
} Trial;

enum { TRIALS = 18 };

static void list_trials(Trial trials[TRIALS], const MesoSettleWork *work, const MesoSettleBody *body, MesoVec3 away)
{
    static const float ways[8][2] = {{1, 0}, {0.7f, 0.7f}, {0.7f, -0.7f}, {0, 1}, {0, -1}, {-0.7f, 0.7f}, {-0.7f, -0.7f}, {-1, 0}};
    MesoVec3 up = meso_settle_up(work, body->place);
    MesoVec3 x = meso_vec3_unit(meso_settle_along(work, body, away), body->pose.x), y = meso_vec3_cross(up, x);
    for (uint32_t i = 0; i < 16; i++) {
        float step = (i < 8 ? 0.03f : 0.1f) * work->spacing;
        MesoVec3 move = meso_vec3_mad(meso_vec3_scale(x, ways[i % 8][0]), ways[i % 8][1], y);
        trials[i] = (Trial){meso_vec3_scale(move, step), 0};
    }
    trials[16] = (Trial){{0, 0, 0}, 0.06f};
    trials[17] = (Trial){{0, 0, 0}, -0.06f};
}

/* What a body may cut after another one near has moved is to be seen anew. */
static void unsettle_near(MesoSettleWork *work, MesoVec3 point)
{
    uint32_t near[MESO_SETTLE_NEAR], count = meso_settle_near(near, MESO_SETTLE_NEAR, work, point);
    for (uint32_t i = 0; i < count; i++)
        work->bodies[near[i]].settled = false;
}

/* Away from all that a body cuts. */
static MesoVec3 way_off(const MesoSettleWork *work, uint32_t a)
{
    const MesoSettleBody *body = &work->bodies[a];
    MesoVec3 away = {0, 0, 0};
    uint32_t near[MESO_SETTLE_NEAR], count = meso_settle_near(near, MESO_SETTLE_NEAR, work, body->pose.origin);
    for (uint32_t i = 0; i < count; i++)
        if (near[i] != a && crossings_of_pair(work, body, &work->bodies[near[i]], 1)) {
            MesoVec3 d = meso_vec3_sub(body->pose.origin, work->bodies[near[i]].pose.origin);
            away = meso_vec3_add(away, meso_vec3_unit(d, (MesoVec3){0, 0, 0}));
        }
    return away;
}

/* The move that makes a body cut least, if there is one that makes it cut less. */
static void part_body(MesoSettleWork *work, uint32_t a)
{
    MesoSettleBody *body = &work->bodies[a], before = *body, best = *body;
    uint32_t least = meso_settle_crossings(work, body, a, MOST_CROSSINGS), before_count = least;
    body->settled = true;
    if (!least || body->stays)
        return;
    Trial trials[TRIALS];
    list_trials(trials, work, body, way_off(work, a));
    bool better = least == MOST_CROSSINGS && meso_settle_move(work, body, meso_vec3_add(body->root, trials[DEEP_TRIAL].move));
    if (better)
        best = *body;       /* too deep for a count to tell which way is better */
    for (uint32_t i = 0; i < TRIALS && least && !better; i++) {
        *body = before;
        if (!meso_settle_move(work, body, meso_vec3_add(body->root, trials[i].move)))
            continue;
        meso_settle_turn(body, trials[i].turn);
        uint32_t crossings = meso_settle_crossings(work, body, a, least);
        if (crossings < least) {
            least = crossings;
            best = *body;
        }
    }
    better |= least < before_count;
    *body = best;
    meso_settle_list(work, a);
    if (better)
        unsettle_near(work, before.pose.origin);
    body->settled = !better;
}

static void give_way(MesoSettleWork *work)
{
    bool all = false;
    for (uint32_t round = 0; round < PART_ROUNDS && !all; round++) {
        all = true;
        for (uint32_t b = 0; b < work->body_count; b++)
            if (!work->bodies[b].gone && !work->bodies[b].settled) {
                part_body(work, b);
                all &= work->bodies[b].settled;
            }
    }
}

void meso_settle_part(MesoSettleWork *work)
{
    if (work->linked)
        meso_settle_push(work);
    else
        give_way(work);
    for (uint32_t b = work->body_count; b-- > 0;) {
        MesoSettleBody *body = &work->bodies[b];
        if (!body->gone && body->element == MESO_NO_INDEX && meso_settle_crossings(work, body, b, 1))
            body->gone = true;
    }
}

/* ---- whatever their shape ---- */

static MesoBodyPart part_of(const MesoSettleWork *work, const MesoSettleBody *body, MesoVec3 *points)
{
    const MesoSettleKind *kind = &work->kinds[body->kind];
    for (uint32_t i = 0; i < kind->point_count && points; i++)
        points[i] = meso_settle_body_point(work, body, i);
    return (MesoBodyPart){points, kind->corners, kind->triangle_count, 0, kind->point_count};
}

MesoStatus meso_settle_meets(bool *meets, const MesoSettleWork *work, const MesoSettleBody *body, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->arena);
    uint32_t most = 0;
    for (uint32_t k = 0; k < work->kind_count; k++)
        most = work->kinds[k].point_count > most ? work->kinds[k].point_count : most;
    MesoVec3 *own = MESO_NEW(work->arena, MesoVec3, most, error), *others = MESO_NEW(work->arena, MesoVec3, most, error);
    if (!own || !others)
        return MESO_ERR_MEMORY;
    MesoBodyPart part = part_of(work, body, own);
    uint32_t near[MESO_SETTLE_NEAR], count = meso_settle_near(near, MESO_SETTLE_NEAR, work, body->pose.origin);
    *meets = false;
    for (uint32_t i = 0; i < count && !*meets; i++) {
        const MesoSettleBody *other = &work->bodies[near[i]];
        MesoVec3 d = meso_vec3_sub(body->pose.origin, other->pose.origin);
        float reach = 1.3f * (work->kinds[body->kind].reach + work->kinds[other->kind].reach);
        if (meso_vec3_dot(d, d) > reach * reach)
            continue;
        MesoBodyPart there = part_of(work, other, others);
        *meets = meso_bodies_meet(&part, &there);
    }
    meso_arena_rewind(work->arena, mark);
    return MESO_OK;
}
