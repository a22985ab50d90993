#include <math.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/shell/box_tree.h"
#include "libcore/tiling/relax/relax_work.h"

/* What is pushed apart comes to lie so much farther off than it has to, in parts of that: chords are no arcs. */
static const float CLEARANCE = 0.03f;

/* How readily directions turn, compared with places that move: turned ones bend sweeps on both sides. */
static const float HANDLE_LOAD = 0.5f;

/* What overlaps by less, in parts of the distance that it takes, does not count. */
static const float COUNTED = 0.02f;

/* Where two chords come nearest. `apart` is the unit vector from the second to the first. */
typedef struct Contact {
    float v[2];         /* along each link */
    float distance;
    float needed;       /* for their sections not to overlap */
    MesoVec3 apart;
} Contact;

/* ---- two chords ---- */

static float clamp(float x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* Nearest points of two segments, as parts of each ("Real-Time Collision Detection", Ericson 2005, 5.1.9). */
static void nearest(const MesoVec3 a[2], const MesoVec3 b[2], float *s, float *t)
{
    MesoVec3 d1 = meso_vec3_sub(a[1], a[0]), d2 = meso_vec3_sub(b[1], b[0]), r = meso_vec3_sub(a[0], b[0]);
    float aa = meso_vec3_dot(d1, d1), ee = meso_vec3_dot(d2, d2), f = meso_vec3_dot(d2, r);
    float c = meso_vec3_dot(d1, r), bb = meso_vec3_dot(d1, d2), denominator = aa * ee - bb * bb;
    *s = denominator > 1e-6f * aa * ee ? clamp((bb * f - c * ee) / denominator) : 0.5f;
    *t = ee > 0 ? (bb * *s + f) / ee : 0;
    if (*t < 0 || *t > 1) {
        *t = clamp(*t);
        *s = aa > 0 ? clamp((bb * *t - c) / aa) : 0;
    }
}

/* The angle of a direction, to 3e-4: directions of sections are sampled more coarsely. */
static float angle_of(float x, float y)
{
    float ax = fabsf(x), ay = fabsf(y), high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
    float t = high > 0 ? low / high : 0, square = t * t;
    float angle = t + t * square * (-0.327622764f + square * (0.15931422f - 0.0464964749f * square));
    angle = ay > ax ? (float)MESO_PI / 2 - angle : angle;
    angle = x < 0 ? (float)MESO_PI - angle : angle;
    return y < 0 ? -angle : angle;
}

/* How far the section of a link reaches towards `direction` at v, on its chord `i`. */
static float reach(const MesoRelaxShape *shape, const MesoRelaxLink *link, float v, uint32_t i, MesoVec3 direction)
{
    float w = v * v * (3 - 2 * v);
    float dx = meso_vec3_dot(direction, link->axes[i][0]), dy = meso_vec3_dot(direction, link->axes[i][1]);
    float length = sqrtf(dx * dx + dy * dy), sum = 0;
    if (shape->round)
        return length * ((1 - w) * link->scale[0] * shape->reach[0][0] + w * link->scale[1] * shape->reach[1][0]);
    float direct = angle_of(dx, dy);
    for (uint32_t end = 0; end < 2 && length > 0; end++) {
        float angle = direct - shape->turn * (end ? w - 1 : w);
        float at = angle * MESO_RELAX_DIRECTIONS / (2 * (float)MESO_PI), before = floorf(at);
        uint32_t k = (uint32_t)((int32_t)before & (MESO_RELAX_DIRECTIONS - 1));
        float one = shape->reach[end][k], two = shape->reach[end][(k + 1) % MESO_RELAX_DIRECTIONS];
        sum += (end ? w : 1 - w) * link->scale[end] * (one + (at - before) * (two - one));
    }
    return length * sum;
}

/* Where two trajectories meet in a point, apart is across both, and to the upper side for the link that comes later. */
static MesoVec3 apart_of(const MesoRelaxLink *a, const MesoRelaxLink *b, MesoVec3 offset, MesoVec3 da, MesoVec3 db)
{
    MesoVec3 up = meso_vec3_unit(a->up[0], (MesoVec3){0, 0, 1});
    bool later = a->slot != b->slot ? a->slot > b->slot : a->sweep > b->sweep;
    const MesoRelaxLink *first = later ? b : a;
    MesoVec3 across = meso_vec3_unit(first == a ? meso_vec3_cross(da, db) : meso_vec3_cross(db, da), up);
    bool high = meso_vec3_dot(across, first->up[0]) > 0;
    return meso_vec3_unit(offset, meso_vec3_scale(across, high == later ? 1 : -1));
}

/* The contact of chord i of `a` and k of `b`, if they are within `slack` of touching. */
static bool meet(const MesoRelaxWork *work, const MesoRelaxLink *a, uint32_t i, const MesoRelaxLink *b, uint32_t k,
                 float slack, Contact *out)
{
    float reach_most = a->bound + b->bound + slack, far = reach_most + a->halves[i] + b->halves[k], s, t;
    MesoVec3 middle = meso_vec3_sub(a->middles[i], b->middles[k]);
    if (meso_vec3_dot(middle, middle) > far * far)
        return false;
    const MesoVec3 *pa = a->points + i, *pb = b->points + k;
    MesoVec3 da = meso_vec3_sub(pa[1], pa[0]), db = meso_vec3_sub(pb[1], pb[0]);
    nearest(pa, pb, &s, &t);
    MesoVec3 offset = meso_vec3_sub(meso_vec3_lerp(pa[0], pa[1], s), meso_vec3_lerp(pb[0], pb[1], t));
    out->distance = meso_vec3_length(offset);
    if (out->distance > reach_most)
        return false;
    out->v[0] = ((float)i + s) / MESO_RELAX_CHORDS;
    out->v[1] = ((float)k + t) / MESO_RELAX_CHORDS;
    out->apart = apart_of(a, b, out->distance > 1e-6f * reach_most ? offset : (MesoVec3){0, 0, 0}, da, db);
    out->needed = reach(&work->shapes[a->shape], a, out->v[0], i, meso_vec3_scale(out->apart, -1)) +
                  reach(&work->shapes[b->shape], b, out->v[1], k, out->apart);
    return out->distance < out->needed + slack;
}

static bool boxes_within(const MesoBox *a, const MesoBox *b, float distance)
{
    return a->low.x - distance <= b->high.x && b->low.x - distance <= a->high.x &&
           a->low.y - distance <= b->high.y && b->low.y - distance <= a->high.y &&
           a->low.z - distance <= b->high.z && b->low.z - distance <= a->high.z;
}

static float width_of(const MesoRelaxWork *work, const MesoRelaxLink *link)
{
    return 2 * work->shapes[link->shape].thin * fminf(link->scale[0], link->scale[1]);
}

/* Whether a chord may come within a distance of what is in a box. */
static bool chord_within(const MesoRelaxLink *link, uint32_t i, const MesoBox *box, float distance)
{
    const MesoBox point = {link->middles[i], link->middles[i]};
    return boxes_within(&point, box, distance + link->halves[i]);
}

MesoRelaxNearness meso_relax_nearness(const MesoRelaxWork *work, const MesoRelaxLink *a, const MesoRelaxLink *b)
{
    Contact contact;
    MesoRelaxNearness out = {1, 0, 0};
    float width = fminf(width_of(work, a), width_of(work, b));
    if (!boxes_within(&a->box, &b->box, a->bound + b->bound))
        return out;
    for (uint32_t i = 0; i < MESO_RELAX_CHORDS; i++)
        for (uint32_t k = 0; k < MESO_RELAX_CHORDS; k++)
            if (meet(work, a, i, b, k, 0, &contact)) {
                if (contact.distance < out.distance * contact.needed)
                    out.needed = contact.needed;
                out.distance = fminf(out.distance, contact.distance / contact.needed);
                out.depth = fmaxf(out.depth, (contact.needed - contact.distance) / width);
            }
    return out;
}

float meso_relax_depth_within(const MesoRelaxWork *work, const MesoRelaxLink *link, MesoVec3 point)
{
    float most = 0;
    for (uint32_t i = 0; i < MESO_RELAX_CHORDS; i++) {
        MesoVec3 along = meso_vec3_sub(link->points[i + 1], link->points[i]);
        MesoVec3 offset = meso_vec3_sub(point, link->points[i]);
        float square = meso_vec3_dot(along, along);
        float part = square > 0 ? clamp(meso_vec3_dot(offset, along) / square) : 0;
        offset = meso_vec3_mad(offset, -part, along);
        float distance = meso_vec3_length(offset), v = ((float)i + part) / MESO_RELAX_CHORDS;
        if (distance > 0 && distance < link->bound)
            most = fmaxf(most, reach(&work->shapes[link->shape], link, v, i,
                                     meso_vec3_scale(offset, 1 / distance)) - distance);
    }
    return most;
}

/* ---- what they ask ---- */

static MesoVec3 across(MesoVec3 a, MesoVec3 unit)
{
    return meso_vec3_mad(a, -meso_vec3_dot(a, unit), unit);
}

/* How the point of a link at v moves with its ends and its handles. */
typedef struct Lever {
    float end[2], handle[2];
    MesoVec3 push[2], turn[2];  /* where these can go towards a direction */
} Lever;

static Lever lever_of(const MesoRelaxWork *work, const MesoRelaxLink *link, float v, MesoVec3 direction)
{
    float u = 1 - v;
    Lever lever = {.handle = {3 * u * u * v, 3 * u * v * v}};
    lever.end[0] = u * u * u + lever.handle[0];
    lever.end[1] = v * v * v + lever.handle[1];
    for (uint32_t e = 0; e < 2; e++) {
        const MesoRelaxNode *node = &work->nodes[link->node[e]];
        if (!node->free)
            continue;
        lever.push[e] = across(direction, node->wall.normal);
        lever.turn[e] = meso_vec3_scale(across(direction, node->tangent), HANDLE_LOAD);
    }
    return lever;
}

static float lever_sum(const Lever *lever)
{
    float sum = 0;
    for (uint32_t e = 0; e < 2; e++)
        sum += lever->end[e] * lever->end[e] * meso_vec3_dot(lever->push[e], lever->push[e]) +
               lever->handle[e] * lever->handle[e] * meso_vec3_dot(lever->turn[e], lever->turn[e]);
    return sum;
}

/* Position-based: each end goes by its part in the least move of all that parts the two. Deep contacts weigh more. */
static void ask(const MesoRelaxWork *work, MesoRelaxLink *link, const MesoRelaxLink *other, const Contact *contact,
                float depth)
{
    Lever own = lever_of(work, link, contact->v[0], contact->apart);
    Lever its = lever_of(work, other, contact->v[1], contact->apart);
    float sum = lever_sum(&own) + lever_sum(&its);
    if (!(sum > 1e-4f))
        return;
    float much = depth / sum;
    for (uint32_t e = 0; e < 2; e++) {
        float push = own.end[e] * depth, turn = own.handle[e] * depth;
        link->push[e] = meso_vec3_mad(link->push[e], push * much * own.end[e], own.push[e]);
        link->turn[e] = meso_vec3_mad(link->turn[e], turn * much * own.handle[e], own.turn[e]);
        link->push_weight[e] += push;
        link->turn_weight[e] += turn;
    }
}

/* They are to be apart by `part` of what it takes. */
static void meet_link(const MesoRelaxWork *work, MesoRelaxLink *link, const MesoRelaxLink *other, float part)
{
    float reach_most = link->bound + other->bound, least = CLEARANCE * reach_most, slack = fmaxf(link->room, least);
    if (!boxes_within(&link->box, &other->box, reach_most + slack))
        return;
    for (uint32_t i = 0; i < MESO_RELAX_CHORDS; i++) {
        if (!chord_within(link, i, &other->box, reach_most + slack))
            continue;
        for (uint32_t k = 0; k < MESO_RELAX_CHORDS; k++) {
            Contact contact;
            if (!meet(work, link, i, other, k, slack, &contact))
                continue;
            float depth = part * contact.needed * (1 + CLEARANCE) - contact.distance;
            link->room = fminf(link->room, fmaxf(-depth, 0));
            link->clear = fminf(link->clear, contact.distance);
            if (depth > 0)
                ask(work, link, other, &contact, depth);
            slack = fmaxf(link->room, least);
        }
    }
}

void meso_relax_contacts(void *context, uint64_t begin, uint64_t end)
{
    MesoRelaxWork *work = context;
    for (uint64_t i = begin; i < end; i++) {
        MesoRelaxLink *link = &work->links[i];
        memset(link->push, 0, sizeof link->push);
        memset(link->turn, 0, sizeof link->turn);
        memset(link->push_weight, 0, sizeof link->push_weight);
        memset(link->turn_weight, 0, sizeof link->turn_weight);
        /* One without room gets it slowly: looking far costs most. */
        link->room = fminf(work->room, 2 * link->room + CLEARANCE * link->bound);
        link->clear = INFINITY;
        for (uint64_t k = work->near_begin[i]; k < work->near_begin[i + 1]; k++)
            meet_link(work, link, &work->links[work->near[k]], work->near_part[k]);
    }
}

uint64_t meso_relax_count(const MesoRelaxWork *work)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < work->link_count; i++)
        for (uint64_t k = work->near_begin[i]; k < work->near_begin[i + 1]; k++) {
            float part = (1 - COUNTED) * work->near_part[k];
            const MesoRelaxLink *one = &work->links[i], *other = &work->links[work->near[k]];
            count += other > one && meso_relax_nearness(work, one, other).distance < part;
        }
    return count;
}

/* ---- which may come near ---- */

/* The same for what goes on from `a` into the slot of `b`: beside their joint it is as far from it as `a`. */
static float part_beyond(const MesoRelaxWork *work, const MesoRelaxLink *a, const MesoRelaxLink *b)
{
    float part = 1;
    for (uint32_t e = 0; e < 2; e++)
        for (uint32_t i = work->end_begin[a->node[e]]; i < work->end_begin[a->node[e] + 1]; i++) {
            const MesoRelaxLink *next = &work->links[work->ends[i] / 2];
            if (next != a && next != b && next->slot == b->slot)
                part = fminf(part, meso_relax_meant(work, next, b));
        }
    return part;
}

/* By which part of what it takes two links are to be apart; 0 for what is one thing, as what shares a joint is. */
static float part_to_keep(const MesoRelaxWork *work, const MesoRelaxLink *a, const MesoRelaxLink *b)
{
    float part = a->slot == b->slot ? meso_relax_meant(work, a, b)
                                    : fminf(part_beyond(work, a, b), part_beyond(work, b, a));
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t m = a->node[i / 2], n = b->node[i % 2];
        part = fminf(part, m == n ? 0 : meso_relax_drawn(work, &work->nodes[m], &work->nodes[n]));
    }
    return part;
}

typedef struct Finder {
    MesoRelaxWork *work;
    MesoArena *arena;
    MesoError *error;
    uint32_t link;
    uint64_t count, room;
    bool failed;            /* memory is out */
} Finder;

static void found(void *context, uint32_t number)
{
    Finder *f = context;
    MesoRelaxWork *work = f->work;
    float part = number == f->link ? 0 : part_to_keep(work, &work->links[f->link], &work->links[number]);
    if (part == 0 || f->failed)
        return;
    uint64_t room = f->room;
    uint32_t *near = MESO_GROW(f->arena, work->near, f->count, room, 1024, f->error);
    float *parts = MESO_GROW(f->arena, work->near_part, f->count, f->room, 1024, f->error);
    f->failed = !near || !parts;
    if (f->failed)
        return;
    work->near = near;
    work->near_part = parts;
    near[f->count] = number;
    parts[f->count++] = part;
}

MesoStatus meso_relax_find_near(MesoRelaxWork *work, MesoArena *arena, MesoError *error)
{
    MesoArena scratch;
    MesoBoxTree tree;
    Finder f = {.work = work, .arena = arena, .error = error};
    meso_arena_init(&scratch);
    MesoBox *boxes = MESO_NEW(&scratch, MesoBox, work->link_count, error);
    work->near_begin = MESO_NEW(arena, uint64_t, (size_t)work->link_count + 1, error);
    MesoStatus status = boxes && work->near_begin ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < work->link_count && !status; i++) {
        const MesoRelaxLink *link = &work->links[i];
        float margin = link->bound + work->reach;
        boxes[i] = meso_box_empty();
        meso_box_add_around(&boxes[i], link->box.low, margin);
        meso_box_add_around(&boxes[i], link->box.high, margin);
    }
    if (!status)
        status = meso_box_tree_build(&tree, &scratch, boxes, work->link_count, error);
    for (uint32_t i = 0; i < work->link_count && !status; i++) {
        f.link = i;
        meso_box_tree_query(&tree, boxes[i], found, &f);
        work->near_begin[i + 1] = f.count;
        status = f.failed ? MESO_ERR_MEMORY : MESO_OK;
    }
    meso_arena_release(&scratch);
    return status;
}
