#include <math.h>

#include "libcore/math/bezier.h"
#include "libcore/tiling/relax/relax_work.h"

/* Of what a step wants to change: all of it at once, from the state before, would overshoot. */
static const float ALIGN_SHARE = 0.5f;

/* Of its move, how much a joint goes back a step. */
static const float TETHER = 1.0f / 64;

/* Of what is thin: no joint goes farther at once, unless there is room around its sweeps. */
static const float STEP_OF_THIN = 0.25f, STEP_OF_ROOM = 0.25f;

/*
 * Of the way to the next trajectory: a point of a sweep goes by at most 1.75 steps of its ends, and a little more as
 * handles become longer, so that two never pass through each other. Where they meet, either side will do.
 */
static const float STEP_OF_CLEAR = 0.2f, STEP_LEAST_OF_THIN = 0.005f;

/*
 * Of curvature times how far sections reach: contacts may bend so far what is bent less, and the rest as far as it is.
 * At 1 the inner side of a bend would be a point.
 */
static const float FREE_BEND = 0.5f;

/* The same of the root mean square of curvatures: about that of a bend which is smooth and comes to the above. */
static const float FREE_MEAN = 0.27f;

/*
 * The planes at the ends of a sweep lie behind each other by so many times how far its sections reach, or as well as
 * they did; of sweeps that are not so many times longer than that.
 */
static const float FREE_ORDER = 0.25f, WIDE = 4;

/* Places at which bends are measured along a sweep, at the ends too. */
enum { BEND_PLACES = 17 };

/* ---- how much a trajectory is bent ---- */

/* The square of the curvature, summed along it; the largest curvature to `most`, the length to `length`, or NULL. */
static float bend_of(const MesoVec3 p[4], float *most, float *length)
{
    float sum = 0, along = 0, largest = 0;
    for (uint32_t k = 0; k < BEND_PLACES; k++) {
        float v = (float)k / (BEND_PLACES - 1);
        MesoVec3 first = meso_bezier_derivative(p, v), second = meso_bezier_second_derivative(p, v);
        float speed = meso_vec3_length(first);
        if (!(speed > 0))
            continue;
        float bend = meso_vec3_length(meso_vec3_cross(first, second)) / (speed * speed * speed);
        float part = speed / (BEND_PLACES - 1) * (k == 0 || k + 1 == BEND_PLACES ? 0.5f : 1);
        sum += part * bend * bend;
        along += part;
        largest = fmaxf(largest, bend);
    }
    if (most)
        *most = largest;
    if (length)
        *length = along;
    return sum;
}

/* ---- moves within a wall ---- */

/* The move that takes a node's point by `offset`, seen in its wall: by least squares. */
static void add_offset(const MesoRelaxNode *node, MesoVec3 offset, MesoWallMove *move)
{
    const MesoWall *wall = &node->wall;
    float x = node->place.x + move->along, y = node->place.y + move->rise;
    MesoVec3 dx = meso_vec3_lerp(meso_vec3_sub(wall->low[1], wall->low[0]),
                                 meso_vec3_sub(wall->high[1], wall->high[0]), y);
    MesoVec3 dy = meso_vec3_lerp(meso_vec3_sub(wall->high[0], wall->low[0]),
                                 meso_vec3_sub(wall->high[1], wall->low[1]), x);
    float a = meso_vec3_dot(dx, dx), b = meso_vec3_dot(dx, dy), c = meso_vec3_dot(dy, dy);
    float p = meso_vec3_dot(dx, offset), q = meso_vec3_dot(dy, offset), determinant = a * c - b * b;
    if (!(determinant > 1e-6f * a * c))
        return;
    move->along += (c * p - b * q) / determinant;
    move->rise += (a * q - b * p) / determinant;
}

/* Leans over to `tangent`, as far as it may. */
static void lean_to(const MesoRelaxNode *node, MesoVec3 tangent, MesoWallMove *move)
{
    float ahead = meso_vec3_dot(tangent, node->wall.normal);
    float along = meso_vec3_dot(tangent, node->axes[0]), rise = meso_vec3_dot(tangent, node->axes[1]);
    float most = MESO_RELAX_LEAN * fmaxf(ahead, 0), length = sqrtf(along * along + rise * rise);
    float scale = length > most ? (length > 0 ? MESO_RELAX_LEAN / length : 0) : ahead > 0 ? 1 / ahead : 0;
    move->lean_along = along * scale;
    move->lean_rise = rise * scale;
}

static float between(float x, float low, float high)
{
    return x > low ? x < high ? x : high : low;     /* `low` for what is no number */
}

static void keep_bounds(const MesoRelaxNode *node, MesoWallMove *move)
{
    move->along = between(move->along, node->low.x, node->high.x);
    move->rise = between(move->rise, node->low.y, node->high.y);
}

static MesoVec3 at_most(MesoVec3 a, float length)
{
    float own = meso_vec3_length(a);
    return own > length ? meso_vec3_scale(a, length / own) : a;
}

/* How far a node may go at once. */
static float step_of(const MesoRelaxWork *work, uint32_t n)
{
    float room = INFINITY, clear = INFINITY, thin = work->nodes[n].thin;
    for (uint32_t i = work->end_begin[n]; i < work->end_begin[n + 1]; i++) {
        const MesoRelaxLink *link = &work->links[work->ends[i] / 2];
        room = fminf(room, link->room);
        clear = fminf(clear, link->clear);
    }
    float step = fmaxf(STEP_OF_THIN * thin, STEP_OF_ROOM * room);
    return fminf(step, fmaxf(STEP_OF_CLEAR * clear, STEP_LEAST_OF_THIN * thin));
}

/* ---- alignment ---- */

typedef struct Wish {
    MesoVec3 offset, tangent;   /* weighted sums */
    MesoVec3 push, turn;        /* what contacts ask */
    float weight, handle;
} Wish;

/* What a link wants of the node at its end `e`. */
static void add_wish(const MesoRelaxWork *work, const MesoRelaxLink *link, uint32_t e, Wish *wish)
{
    const MesoRelaxNode *here = &work->nodes[link->node[e]], *there = &work->nodes[link->node[1 - e]];
    MesoVec3 chord = meso_vec3_sub(there->point, here->point);
    float length = meso_vec3_length(chord), weight = 1 / length;
    wish->push = meso_vec3_add(wish->push, link->push[e]);
    wish->turn = meso_vec3_mad(wish->turn, link->sign[e], link->turn[e]);
    if (!(length > 0) || link->node[0] == link->node[1])
        return;
    MesoVec3 direction = meso_vec3_scale(chord, weight);
    MesoVec3 out = meso_vec3_scale(here->tangent, link->sign[e]);
    MesoVec3 on = meso_vec3_scale(there->tangent, -link->sign[1 - e]);
    MesoVec3 both = meso_vec3_add(out, on), halved = meso_vec3_unit(both, direction);
    float sure = meso_vec3_dot(both, both) / 4;     /* one that turns back has no such direction */
    wish->offset = meso_vec3_mad(wish->offset, weight * sure, meso_vec3_mad(chord, -length, halved));
    wish->tangent = meso_vec3_mad(wish->tangent, weight * link->sign[e], meso_vec3_add(on, direction));
    wish->weight += weight;
    wish->handle = fmaxf(wish->handle, meso_vec3_length(meso_vec3_sub(link->p[e ? 2 : 1], link->p[e ? 3 : 0])));
}

/* A node's move when it goes on by `offset` and turns by `turn`, and a part of it goes back. */
static MesoWallMove moved(const MesoRelaxNode *node, MesoVec3 offset, MesoVec3 turn, float back)
{
    MesoWallMove move = node->move;
    lean_to(node, meso_vec3_add(node->tangent, turn), &move);
    move.along *= 1 - back;
    move.rise *= 1 - back;
    move.lean_along *= 1 - back;
    move.lean_rise *= 1 - back;
    add_offset(node, offset, &move);
    keep_bounds(node, &move);
    return move;
}

/* What links of a node come to with it moved, all else where it is. */
typedef struct Outcome {
    float bend, length;     /* sums of squared curvatures, and of lengths */
    float curve;            /* the largest */
    float order;            /* how well planes at their ends lie behind each other; below 0, they cross in a section */
} Outcome;

/*
 * Points of the planes at the ends, as far from the middle as sections reach, lie behind each other along the sum of
 * both directions, by what the middles do less the sine between the planes for each. In parts of that reach; only where
 * that is long beside the sweep.
 */
static float order_of(const MesoRelaxLink *link, const MesoVec3 p[4], MesoVec3 start, MesoVec3 end)
{
    MesoVec3 chord = meso_vec3_sub(p[3], p[0]);
    float reach = link->bound;
    if (!(reach * WIDE > meso_vec3_length(chord)))
        return INFINITY;
    return meso_vec3_dot(chord, meso_vec3_add(start, end)) / reach -
           2 * meso_vec3_length(meso_vec3_cross(start, end));
}

static Outcome outcome_with(const MesoRelaxWork *work, uint32_t n, const MesoWallMove *move)
{
    float largest, length;
    Outcome outcome = {.order = INFINITY};
    MesoRelaxNode node = work->nodes[n];
    node.move = *move;
    meso_relax_place(&node);
    for (uint32_t i = work->end_begin[n]; i < work->end_begin[n + 1]; i++) {
        const MesoRelaxLink *link = &work->links[work->ends[i] / 2];
        const MesoRelaxNode *ends[2] = {&work->nodes[link->node[0]], &work->nodes[link->node[1]]};
        MesoVec3 p[4];
        for (uint32_t e = 0; e < 2; e++)
            if (link->node[e] == n)
                ends[e] = &node;
        meso_relax_control(link, ends[0], ends[1], p);
        outcome.bend += bend_of(p, &largest, &length);
        outcome.length += length;
        outcome.curve = fmaxf(outcome.curve, largest);
        outcome.order = fminf(outcome.order, order_of(link, p, meso_vec3_scale(ends[0]->tangent, link->sign[0]),
                                                      meso_vec3_scale(ends[1]->tangent, -link->sign[1])));
    }
    return outcome;
}

static bool is_sound(const MesoRelaxNode *node, Outcome outcome)
{
    return outcome.bend <= node->bend_most && outcome.curve <= node->curve_most && outcome.order >= node->order_least;
}

/* What of a wish does not run against what contacts ask. */
static MesoVec3 not_against(MesoVec3 wish, MesoVec3 asked)
{
    MesoVec3 direction = meso_vec3_unit(asked, (MesoVec3){0, 0, 0});
    return meso_vec3_mad(wish, -fminf(meso_vec3_dot(wish, direction), 0), direction);
}

/* The least bent of a few, the node where it is among them. */
static MesoWallMove align(const MesoRelaxWork *work, uint32_t n)
{
    static const float shares[][2] = {{1, 1}, {0, 1}, {1, 0}, {0.3f, 0.3f}};
    const MesoRelaxNode *node = &work->nodes[n];
    MesoWallMove best = node->move;
    Wish wish = {0};
    for (uint32_t i = work->end_begin[n]; i < work->end_begin[n + 1]; i++)
        add_wish(work, &work->links[work->ends[i] / 2], work->ends[i] % 2, &wish);
    if (!(wish.weight > 0))
        return best;
    float step = step_of(work, n);
    MesoVec3 offset = not_against(at_most(meso_vec3_scale(wish.offset, ALIGN_SHARE / wish.weight), step), wish.push);
    MesoVec3 aim = meso_vec3_unit(wish.tangent, node->tangent);
    MesoVec3 turn = at_most(meso_vec3_scale(meso_vec3_sub(aim, node->tangent), ALIGN_SHARE),
                            step / fmaxf(wish.handle, step));
    turn = not_against(turn, wish.turn);
    Outcome here = outcome_with(work, n, &best);
    MesoRelaxNode bounds = {.bend_most = INFINITY, .curve_most = fmaxf(here.curve, node->curve_most),
                            .order_least = fminf(here.order, node->order_least)};
    for (uint32_t k = 0; k < sizeof shares / sizeof *shares; k++) {
        MesoWallMove move = moved(node, meso_vec3_scale(offset, shares[k][0]), meso_vec3_scale(turn, shares[k][1]),
                                  TETHER);
        Outcome there = outcome_with(work, n, &move);
        if (there.bend < here.bend && is_sound(&bounds, there)) {
            here.bend = there.bend;
            best = move;
        }
    }
    return best;
}

void meso_relax_bound_bends(void *context, uint64_t begin, uint64_t end)
{
    MesoRelaxWork *work = context;
    for (uint64_t n = begin; n < end; n++) {
        MesoRelaxNode *node = &work->nodes[n];
        float widest = 0;
        for (uint32_t i = work->end_begin[n]; i < work->end_begin[n + 1]; i++)
            widest = fmaxf(widest, work->links[work->ends[i] / 2].bound);
        if (!node->free)
            continue;
        Outcome outcome = outcome_with(work, (uint32_t)n, &node->move);
        node->curve_most = fmaxf(outcome.curve, widest > 0 ? FREE_BEND / widest : 0);
        node->order_least = fminf(outcome.order, FREE_ORDER);
        float even = widest > 0 ? FREE_MEAN / widest : INFINITY;
        node->bend_most = fmaxf(outcome.bend, outcome.length * even * even);
    }
}

void meso_relax_align(void *context, uint64_t begin, uint64_t end)
{
    MesoRelaxWork *work = context;
    for (uint64_t n = begin; n < end; n++)
        if (work->nodes[n].free)
            work->next[n] = align(work, (uint32_t)n);
}

/* ---- what contacts ask ---- */

/* What contacts ask of all sweeps of a node, each by its weight: a way for its place and one for its handles' ends. */
static void sum_asked(const MesoRelaxWork *work, uint32_t n, float step, MesoVec3 *push, MesoVec3 *turn)
{
    float push_weight = 0, turn_weight = 0, handle = 0;
    *push = *turn = (MesoVec3){0, 0, 0};
    for (uint32_t i = work->end_begin[n]; i < work->end_begin[n + 1]; i++) {
        const MesoRelaxLink *link = &work->links[work->ends[i] / 2];
        uint32_t e = work->ends[i] % 2;
        *push = meso_vec3_add(*push, link->push[e]);
        *turn = meso_vec3_mad(*turn, link->sign[e], link->turn[e]);
        push_weight += link->push_weight[e];
        turn_weight += link->turn_weight[e];
        handle = fmaxf(handle, meso_vec3_length(meso_vec3_sub(link->p[e ? 2 : 1], link->p[e ? 3 : 0])));
    }
    *push = at_most(meso_vec3_scale(*push, push_weight > 0 ? 1 / push_weight : 0), step);
    *turn = at_most(meso_vec3_scale(*turn, turn_weight > 0 ? 1 / turn_weight : 0), step);
    *turn = meso_vec3_scale(*turn, handle > 0 ? 1 / handle : 0);
}

/* All that is asked, or a part of it that does not bend its sweeps too much. */
static MesoWallMove part(const MesoRelaxWork *work, const MesoRelaxNode *node, uint32_t n)
{
    static const float shares[][2] = {{1, 1}, {1, 0}, {0, 1}, {0.3f, 0.3f}, {0.3f, 0}};
    MesoVec3 push, turn;
    sum_asked(work, n, step_of(work, n), &push, &turn);
    bool asked = meso_vec3_length(push) > 0 || meso_vec3_length(turn) > 0;
    for (uint32_t k = 0; k < sizeof shares / sizeof *shares && asked; k++) {
        MesoWallMove move = moved(node, meso_vec3_scale(push, shares[k][0]), meso_vec3_scale(turn, shares[k][1]), 0);
        if (is_sound(node, outcome_with(work, n, &move)))
            return move;
    }
    return node->move;
}

void meso_relax_part(void *context, uint64_t begin, uint64_t end)
{
    MesoRelaxWork *work = context;
    for (uint64_t n = begin; n < end; n++)
        if (work->nodes[n].free)
            work->next[n] = part(work, &work->nodes[n], (uint32_t)n);
}

/* ---- how much there is ---- */

void meso_relax_bends(const MesoRelaxWork *work, float *mean, float *most)
{
    double sum = 0, all = 0;
    *most = 0;
    for (uint32_t i = 0; i < work->link_count; i++) {
        const MesoRelaxLink *link = &work->links[i];
        float radius = work->shapes[link->shape].mean * (link->scale[0] + link->scale[1]) / 2, largest, length;
        sum += (double)(radius * radius * bend_of(link->p, &largest, &length));
        all += (double)length;
        *most = fmaxf(*most, radius * largest);
    }
    *mean = all > 0 ? (float)sqrt(sum / all) : 0;
}
