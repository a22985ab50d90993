#include "libcore/replicate/plan/split_order.h"

#include <string.h>

#include "libcore/base/parallel.h"

enum { GRAIN = 4096, DRAWS = 4096, SAMPLE = 31, CHUNK = 16, NEW_EACH = 32, WANTED_LEAST = 256, WANTED_EACH = 6 };

/* Of a count of excesses. */
enum { STEPS = 1024, STEPS_A_UNIT = 128 };

/* A triangle is not split that is no larger than this much of what it may be. */
static const float LEAST_EXCESS = 1.2f;

/* How fast the power follows, and how much at once; from where to where it goes. */
static const double GAIN = 6, AT_ONCE = 20, LEAST_POWER = 0.0, MOST_POWER = 3;

/* Lengths of edges are counted up to so many mean ones: beyond, most pairs have no edge. */
static const double REACH = 1.35;

/* Of edges of a length that are too many, for those at rest, or a RARE share; and of a length below which NONE are. */
static const double PUSH = 0.3, RARE = 0.01, NONE = 0.001;
static const float WALL = 3;

/* ---- tolerance ---- */

static float ratio_to(MesoVec3 a, MesoVec3 b, MesoVec3 c, float expected)
{
    float twice = meso_vec3_length(meso_vec3_cross(meso_vec3_sub(b, a), meso_vec3_sub(c, a)));
    return expected > 0 ? twice / expected : 0;
}

/*
 * Area over what the corners' originals have. One corner may be no detail, at a border, so that details are born there,
 * too; and counts as if it had none: there is nothing beyond it. 0 where it is more.
 */
static float ratio_of(const MesoReplication *r, uint32_t triangle)
{
    const uint32_t *c = r->web.corners + 3 * (size_t)triangle, first = r->web.fixed_count;
    const MesoVec3 *p = r->web.positions;
    float expected = 0;
    uint32_t fixed = 0;
    for (uint32_t k = 0; k < 3; k++) {
        fixed += c[k] < first;
        expected += c[k] < first ? 0 : r->areas[c[k] - first];
    }
    return fixed > 1 ? 0 : ratio_to(p[c[0]], p[c[1]], p[c[2]], expected / 3);
}

/* The same whichever corner is the first. */
static uint32_t draw_of(const MesoReplication *r, uint32_t triangle)
{
    const uint32_t *c = r->web.corners + 3 * (size_t)triangle;
    uint64_t a = c[0] - r->web.fixed_count, b = c[1] - r->web.fixed_count, d = c[2] - r->web.fixed_count;
    uint64_t x = (a + b + d) * 0x9e3779b97f4a7c15u ^ (a * b + b * d + d * a) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 31) * 0x94d049bb133111ebu;
    return (uint32_t)((uint64_t)(uint32_t)(x ^ x >> 29) * r->tolerance.count >> 32);
}

static float excess_by(const MesoReplication *r, uint32_t triangle, float ratio)
{
    return ratio > 0 && !r->tolerance.plain ? ratio * r->tolerance.weights[draw_of(r, triangle)] : ratio;
}

static float excess_of(const MesoReplication *r, uint32_t triangle)
{
    return excess_by(r, triangle, ratio_of(r, triangle));
}

typedef struct Edges {
    uint32_t count;
    double sum, squares;
    double bins[MESO_EDGE_BINS];    /* share of all */
} Edges;

/* Those between details, of every `stride`th CHUNK of triangles. */
static Edges edges_of(const MesoWeb *web, uint32_t stride, float bins_a_square)
{
    Edges e = {.count = 0};
    for (uint32_t t = 0; t < web->triangle_count; t += t % CHUNK == CHUNK - 1 ? (stride - 1) * CHUNK + 1 : 1)
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            uint32_t a = web->corners[h], b = web->corners[meso_next_corner(h)];
            if (a < web->fixed_count || b < web->fixed_count)
                continue;
            double l2 = meso_web_length2(web, a, b), at = l2 * (double)bins_a_square;
            e.sum += sqrt(l2);
            e.squares += l2;
            e.count++;
            if (at < MESO_EDGE_BINS)
                e.bins[(uint32_t)at]++;
        }
    for (uint32_t i = 0; i < MESO_EDGE_BINS; i++)
        e.bins[i] /= e.count ? e.count : 1;
    return e;
}

/* Deviation over mean. */
static double spread_of(const Edges *e)
{
    return e->sum > 0 ? sqrt(fmax(0, e->squares * e->count / (e->sum * e->sum) - 1)) : 0;
}

static uint32_t stride_of(const MesoWeb *web)
{
    return web->triangle_count > SAMPLE * DRAWS ? SAMPLE : 1;
}

static void know_edges(MesoTolerance *tolerance, const MesoWeb *web)
{
    Edges edges = edges_of(web, stride_of(web), 0);
    tolerance->spread = spread_of(&edges);
    if (!(edges.sum > 0))
        return;
    double reach = REACH * edges.sum / edges.count;
    tolerance->edges.bins_a_square = (float)(MESO_EDGE_BINS / (reach * reach));
    edges = edges_of(web, stride_of(web), tolerance->edges.bins_a_square);
    memcpy(tolerance->edges.rest, edges.bins, sizeof edges.bins);
}

MesoStatus meso_tolerance_build(MesoTolerance *tolerance, MesoReplication *r, MesoError *error)
{
    *tolerance = (MesoTolerance){.rest = MESO_NEW(&r->arena, float, DRAWS, error),
                                 .weights = MESO_NEW(&r->arena, float, DRAWS, error)};
    if (!tolerance->rest || !tolerance->weights)
        return MESO_ERR_MEMORY;
    uint32_t n = r->web.triangle_count;
    for (uint32_t i = 0; i < DRAWS && i < n; i++) {
        float ratio = ratio_of(r, n > DRAWS ? (uint32_t)((uint64_t)i * n / DRAWS) : i);
        if (ratio > 0)
            tolerance->rest[tolerance->count++] = fmaxf(ratio, 0.05f);
    }
    if (tolerance->count == 0)
        tolerance->rest[tolerance->count++] = 1;
    know_edges(tolerance, &r->web);
    return MESO_OK;
}

/* As much as there are too many, for those that there are at rest. */
static void push_by(MesoEdgePush *push, const Edges *now)
{
    double below = 0;
    for (uint32_t i = 0; i < MESO_EDGE_BINS; i++) {
        push->push[i] = (float)(PUSH * (now->bins[i] - push->rest[i]) / fmax(push->rest[i], RARE));
        below += push->rest[i];
        if (below >= NONE)
            continue;
        push->push[i] += WALL;
        push->least2 = (i + 1) / (double)push->bins_a_square;
    }
}

void meso_tolerance_adapt(MesoTolerance *tolerance, const MesoWeb *web)
{
    Edges edges = edges_of(web, stride_of(web), tolerance->edges.bins_a_square);
    double spread = spread_of(&edges);
    push_by(&tolerance->edges, &edges);
    double error = tolerance->spread > 0 ? 1 - spread / tolerance->spread : 0;
    tolerance->power = fmin(MOST_POWER, fmax(LEAST_POWER, tolerance->power + GAIN * error));
    double power = fmin(MOST_POWER, fmax(LEAST_POWER, tolerance->power + AT_ONCE * error));
    tolerance->plain = power == 0;
    for (uint32_t i = 0; i < tolerance->count; i++)
        tolerance->weights[i] = (float)pow((double)tolerance->rest[i], -power);
}

/* ---- order ---- */

static bool is_before(MesoSplitCandidate a, MesoSplitCandidate b)
{
    return a.excess != b.excess ? a.excess > b.excess : a.triangle < b.triangle;
}

static void exchange(MesoSplitOrder *order, uint32_t i, uint32_t k)
{
    MesoSplitCandidate kept = order->heap[i];
    order->heap[i] = order->heap[k];
    order->heap[k] = kept;
}

static void push(MesoSplitOrder *order, uint32_t triangle, float excess)
{
    if (order->count == order->room || !(excess > LEAST_EXCESS))
        return;
    uint32_t at = order->count++;
    order->heap[at] = (MesoSplitCandidate){excess, triangle};
    for (; at > 0 && is_before(order->heap[at], order->heap[(at - 1) / 2]); at = (at - 1) / 2)
        exchange(order, at, (at - 1) / 2);
}

void meso_split_push(MesoSplitOrder *order, uint32_t triangle)
{
    push(order, triangle, excess_of(order->r, triangle));
}

static MesoSplitCandidate take_first(MesoSplitOrder *order)
{
    MesoSplitCandidate first = order->heap[0];
    order->heap[0] = order->heap[--order->count];
    for (uint32_t at = 0, child = 1; child < order->count; child = 2 * at + 1) {
        if (child + 1 < order->count && is_before(order->heap[child + 1], order->heap[child]))
            child++;
        if (!is_before(order->heap[child], order->heap[at]))
            break;
        exchange(order, at, child);
        at = child;
    }
    return first;
}

bool meso_split_pop(MesoSplitOrder *order, uint32_t *triangle)
{
    while (order->count > 0) {
        MesoSplitCandidate first = take_first(order);
        if (order->r->due[meso_block_of(order->r, first.triangle)] < 0.5)   /* and none will be */
            continue;
        float excess = excess_of(order->r, first.triangle);
        *triangle = first.triangle;
        if (excess == first.excess)
            return true;
        if (excess < first.excess)      /* it is another triangle by now; where it has grown, it is there twice */
            push(order, first.triangle, excess);
    }
    return false;
}

/* What a triangle is told by, of one corner, in one place of memory. */
typedef struct Corner {
    MesoVec3 position;
    float area;             /* 0: no detail */
} Corner;

typedef struct Excesses {
    const MesoReplication *r;
    uint8_t *bearing;       /* [node_count] whether details are due in its block */
    Corner *corners;        /* [node_count] */
    float *excesses;        /* [triangle_count] 0 where none are */
} Excesses;

static void corner_range(void *context, uint64_t begin, uint64_t end)
{
    const Excesses *e = context;
    const MesoReplication *r = e->r;
    for (uint64_t n = begin; n < end; n++) {
        bool fixed = n < r->web.fixed_count;
        e->corners[n] = (Corner){r->web.positions[n], fixed ? 0 : r->areas[n - r->web.fixed_count]};
        e->bearing[n] = !fixed && r->due[r->blocks[n - r->web.fixed_count]] >= 0.5;
    }
}

/* To the bit as excess_of. */
static float excess_in_block(const Excesses *e, uint32_t triangle)
{
    const MesoReplication *r = e->r;
    const uint32_t *c = r->web.corners + 3 * (size_t)triangle, fixed = r->web.fixed_count;
    if (c[0] < fixed || c[1] < fixed || c[2] < fixed) {
        uint32_t node = c[0] >= fixed ? c[0] : c[1] >= fixed ? c[1] : c[2];
        return e->bearing[node] ? excess_of(r, triangle) : 0;
    }
    if (!e->bearing[c[0]])
        return 0;
    const Corner *p = &e->corners[c[0]], *q = &e->corners[c[1]], *s = &e->corners[c[2]];
    float expected = 0 + p->area + q->area + s->area;
    return excess_by(r, triangle, ratio_to(p->position, q->position, s->position, expected / 3));
}

static void excess_range(void *context, uint64_t begin, uint64_t end)
{
    const Excesses *e = context;
    for (uint64_t t = begin; t < end; t++)
        e->excesses[t] = excess_in_block(e, (uint32_t)t);
}

/* An excess above which there are so many as may be needed, of those that count: not all have to be put in order. */
static float threshold_of(const float *excesses, uint32_t count, uint32_t wanted)
{
    uint32_t steps[STEPS] = {0}, step = STEPS - 1, found = 0;
    for (uint32_t t = 0; t < count; t++) {
        float at = (excesses[t] - LEAST_EXCESS) * STEPS_A_UNIT;
        if (at > 0)
            steps[at < STEPS - 1 ? (uint32_t)at : STEPS - 1]++;
    }
    while (step > 0 && (found += steps[step]) < wanted)
        step--;
    return LEAST_EXCESS + (float)step / STEPS_A_UNIT;
}

MesoStatus meso_split_order(MesoSplitOrder *order, MesoArena *arena, MesoReplication *r, uint32_t due,
                            MesoError *error)
{
    uint32_t n = r->web.triangle_count, wanted = WANTED_LEAST + WANTED_EACH * due, count = 0;
    *order = (MesoSplitOrder){.r = r};
    Excesses all = {r, MESO_NEW(arena, uint8_t, r->web.node_count, error),
                    MESO_NEW(arena, Corner, r->web.node_count, error), MESO_NEW(arena, float, n, error)};
    if (!all.bearing || !all.corners || !all.excesses)
        return MESO_ERR_MEMORY;
    meso_parallel_for(r->options.thread_count, r->web.node_count, GRAIN, corner_range, &all);
    meso_parallel_for(r->options.thread_count, n, GRAIN, excess_range, &all);
    float threshold = threshold_of(all.excesses, n, wanted);
    for (uint32_t t = 0; t < n; t++)
        count += all.excesses[t] > threshold;
    order->room = count + NEW_EACH * (due + 2);
    order->heap = MESO_NEW(arena, MesoSplitCandidate, order->room, error);
    if (!order->heap)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < n; t++)
        if (all.excesses[t] > threshold)
            push(order, t, all.excesses[t]);
    return MESO_OK;
}
