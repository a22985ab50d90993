#include "libcore/replicate/web/detail_web.h"

#include "libcore/base/grow.h"
#include "libcore/base/parallel.h"
#include "libcore/replicate/web/web_edit.h"

enum { GRAIN = 4096 };

/* The angle at a place is not obtuse; by chords, as most are, so that normals need not be read. */
static bool is_acute(MesoVec3 at, MesoVec3 a, MesoVec3 b)
{
    return meso_vec3_dot(meso_vec3_sub(a, at), meso_vec3_sub(b, at)) >= 0;
}

/*
 * Whether an edge is not Delaunay: the cotangents of the angles that face it add up to less than nothing. What is less
 * by rounding alone stays, or flips would have no end.
 */
static bool is_bad(const MesoWeb *web, uint32_t h)
{
    uint32_t g = web->twins[h];
    if (g == MESO_NO_INDEX)
        return false;
    uint32_t a = web->corners[h], b = web->corners[g], c = meso_web_apex(web, h), d = meso_web_apex(web, g);
    const MesoVec3 *p = web->positions;
    if (is_acute(p[c], p[a], p[b]) && is_acute(p[d], p[a], p[b]))
        return false;
    double ab = meso_web_length2(web, a, b);
    double ac = meso_web_length2(web, a, c), bc = meso_web_length2(web, b, c);
    double ad = meso_web_length2(web, a, d), bd = meso_web_length2(web, b, d);
    double cot_c = ac + bc - ab, cot_d = ad + bd - ab;      /* times four of the areas below */
    if (cot_c >= 0 && cot_d >= 0)
        return false;
    double area_c = sqrt(meso_heron(ab, ac, bc)), area_d = sqrt(meso_heron(ab, ad, bd));
    return cot_c * area_d + cot_d * area_c < -1e-9 * ab * (area_c + area_d);
}

/* ---- flips ---- */

enum { STACK = 256, ROUNDS = 8 };

typedef struct EdgeStack {
    uint32_t edges[STACK];
    uint32_t count;
    bool left;      /* what found no room, or no time, is left for another round */
} EdgeStack;

static void push(EdgeStack *stack, uint32_t h)
{
    if (stack->count < STACK)
        stack->edges[stack->count++] = h;
    else
        stack->left = true;
}

static uint32_t settle_stack(MesoWeb *web, EdgeStack *stack, uint32_t limit)
{
    uint32_t flips = 0;
    while (stack->count > 0 && flips < limit) {
        uint32_t h = stack->edges[--stack->count];
        if (!is_bad(web, h) || !meso_web_can_flip(web, h))
            continue;
        uint32_t g = web->twins[h];
        meso_web_flip(web, h);
        flips++;
        push(stack, h);
        push(stack, meso_previous_corner(h));
        push(stack, g);
        push(stack, meso_previous_corner(g));
    }
    stack->left |= stack->count > 0;
    return flips;
}

uint32_t meso_web_settle(MesoWeb *web, uint32_t part, uint32_t parts)
{
    uint32_t flips = 0, begin = (uint32_t)((uint64_t)web->triangle_count * part / parts);
    uint32_t end = (uint32_t)((uint64_t)web->triangle_count * (part + 1) / parts);
    bool left = true;
    for (uint32_t round = 0; round < ROUNDS && left; round++) {
        left = false;
        for (uint32_t t = begin; t < end; t++)
            for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
                if (web->twins[h] == MESO_NO_INDEX || web->twins[h] < h || !is_bad(web, h))
                    continue;
                EdgeStack stack;
                stack.count = 0;
                stack.left = false;
                push(&stack, h);
                flips += settle_stack(web, &stack, STACK);
                left |= stack.left;
            }
    }
    return flips;
}

/* ---- nodes ---- */

static MesoVec3 mix(const uint32_t *corners, const MesoVec3 *values, const MesoMeshPoint *point)
{
    MesoVec3 p = meso_vec3_scale(values[corners[0]], point->weight[0]);
    p = meso_vec3_mad(p, point->weight[1], values[corners[1]]);
    return meso_vec3_mad(p, point->weight[2], values[corners[2]]);
}

typedef struct Placing {
    MesoWeb *web;
    const MesoTriangulation *mesh;
    const MesoVec3 *positions, *normals;
} Placing;

static void place_range(void *context, uint64_t begin, uint64_t end)
{
    const Placing *p = context;
    for (uint64_t n = begin; n < end; n++) {
        const MesoMeshPoint *point = &p->web->points[n];
        const uint32_t *corners = p->mesh->corners + 3 * (size_t)point->triangle;
        p->web->positions[n] = mix(corners, p->positions, point);
        p->web->normals[n] = meso_vec3_unit(mix(corners, p->normals, point), (MesoVec3){0, 0, 1});
    }
}

void meso_web_place(MesoWeb *web, const MesoTriangulation *mesh, const MesoVec3 *positions, const MesoVec3 *normals,
                    uint32_t thread_count)
{
    Placing placing = {web, mesh, positions, normals};
    meso_parallel_for(thread_count, web->node_count, GRAIN, place_range, &placing);
}

MesoStatus meso_web_insert(MesoWeb *web, uint32_t triangle, MesoMeshPoint point, MesoVec3 position, MesoVec3 normal,
                           MesoError *error)
{
    MesoStatus status = meso_web_reserve(web, web->node_count + 1, web->triangle_count + 2, error);
    if (status != MESO_OK)
        return status;
    uint32_t node = web->node_count++, new = 3 * web->triangle_count, h = 3 * triangle;
    web->points[node] = point;
    web->positions[node] = position;
    web->normals[node] = normal;
    meso_web_split(web, triangle, node);
    EdgeStack stack;
    stack.count = 0;
    stack.left = false;
    push(&stack, h);
    push(&stack, new);
    push(&stack, new + 3);
    settle_stack(web, &stack, STACK);
    return MESO_OK;
}

bool meso_web_remove(MesoWeb *web, uint32_t node, uint32_t into)
{
    if (!meso_web_merge(web, node, into))
        return false;
    EdgeStack stack;
    stack.count = 0;
    stack.left = false;
    MesoSpokes s = meso_spokes(web, into);
    do {
        push(&stack, s.now);
        push(&stack, meso_next_corner(s.now));
    } while (meso_spokes_next(web, &s));
    settle_stack(web, &stack, STACK);
    return true;
}

MesoWebEdges meso_web_edges(const MesoWeb *web)
{
    MesoWebEdges edges = {0};
    double sum = 0, squares = 0;
    for (uint32_t h = 0; h < 3 * web->triangle_count; h++) {
        uint32_t a = web->corners[h], b = web->corners[meso_next_corner(h)];
        if (a < web->fixed_count || b < web->fixed_count || (web->twins[h] != MESO_NO_INDEX && web->twins[h] < h))
            continue;
        double l2 = meso_web_length2(web, a, b);
        edges.count++;
        sum += sqrt(l2);
        squares += l2;
    }
    edges.mean = edges.count ? sum / edges.count : 0;
    edges.deviation = edges.count ? sqrt(fmax(0, squares / edges.count - edges.mean * edges.mean)) : 0;
    return edges;
}
