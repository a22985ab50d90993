#include "libcore/quilt/base/base_border.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/cut/border_loops.h"

/* Points of a layer nearer than this share of its thickness become one; edges longer than that are split. */
#define NEAR_SHARE 0.5f
#define LONG_SHARE 1.6f

/* Thickness of a layer by the mean side of the border behind: more than 1 / NEAR_SHARE, so that fine borders become
 * coarse layer by layer. */
#define COARSENING 2.2f

/* Corners that turn by more than acos(0.6) have several points across: no edge across turns more. */
#define FAN_COSINE 0.6f
#define FAN_ANGLE 0.9273f

/* Points at sharp corners of holes move no further than so many times the thickness. */
#define MITRE_LARGEST 1.3f

/* Layers next to fine borders are thin at first; but none is thinner than this share of the reach. */
#define THINNEST 0.02f

/* How often points of a layer are joined anew, and pulled back. */
enum { JOIN_ROUNDS = 8, PULL_ROUNDS = 8 };

/* The border as far as it has come: edge i goes from vertex i to the next one, the surface to the left. */
typedef struct Rim {
    uint32_t count;
    uint32_t *vertices;
    MesoVec3 *normals;          /* of the surface at the border behind */
    uint32_t *half_edges;
} Rim;

/* A vertex of the next rim. */
typedef struct Ahead {
    MesoVec3 position, normal;
    uint32_t owner;             /* first vertex of the rim behind it */
} Ahead;

typedef struct Layer {
    MesoBaseMesh *base;
    const Rim *rim;
    float thickness, depth;
    uint32_t count, room;
    Ahead *ahead;               /* [count] */
    uint32_t *first, *last;     /* [rim->count] those that are across from a vertex; counted on past the end */
    float **depths;
    uint32_t depth_room;
    MesoArena *arena, *scratch;
    MesoError *error;
} Layer;

static MesoVec3 rim_point(const Layer *layer, uint32_t i)
{
    return layer->base->mesh.positions[layer->rim->vertices[i % layer->rim->count]];
}

static MesoVec3 rim_side(const Layer *layer, uint32_t i)
{
    return meso_vec3_sub(rim_point(layer, i + 1), rim_point(layer, i));
}

/* Outward, across edge i of the rim. */
static MesoVec3 conormal(const Layer *layer, uint32_t i)
{
    const Rim *rim = layer->rim;
    MesoVec3 normal = meso_vec3_add(rim->normals[i], rim->normals[(i + 1) % rim->count]);
    return meso_vec3_direction(meso_vec3_cross(rim_side(layer, i), normal), (MesoVec3){0, 0, 0});
}

/* ---- points ahead ---- */

static MesoStatus add_ahead(Layer *layer, uint32_t i, MesoVec3 way)
{
    layer->ahead = MESO_GROW(layer->scratch, layer->ahead, layer->count, layer->room, 64, layer->error);
    if (!layer->ahead)
        return MESO_ERR_MEMORY;
    layer->ahead[layer->count++] = (Ahead){meso_vec3_mad(rim_point(layer, i), layer->thickness, way),
                                           layer->rim->normals[i], i};
    return MESO_OK;
}

/* Around a convex corner, evenly from one conormal to the other. */
static MesoStatus add_fan(Layer *layer, uint32_t i, MesoVec3 before, MesoVec3 after, float angle)
{
    MesoVec3 normal = layer->rim->normals[i];
    uint32_t count = 1 + (uint32_t)(angle / FAN_ANGLE);
    MesoVec3 side = meso_vec3_unit(meso_vec3_cross(normal, before), after);
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; !status && k <= count; k++) {
        float turn = angle * (float)k / (float)count;
        MesoVec3 way = meso_vec3_mad(meso_vec3_scale(before, cosf(turn)), sinf(turn), side);
        status = add_ahead(layer, i, k == count ? after : way);
    }
    return status;
}

static MesoStatus add_across(Layer *layer, uint32_t i)
{
    uint32_t count = layer->rim->count, previous = (i + count - 1) % count;
    MesoVec3 before = conormal(layer, previous), after = conormal(layer, i);
    float cosine = meso_vec3_dot(before, after);
    bool convex = meso_vec3_dot(meso_vec3_cross(before, after), layer->rim->normals[i]) > 0;
    if (convex && cosine < FAN_COSINE)
        return add_fan(layer, i, before, after, acosf(cosine > -1 ? cosine : -1));
    MesoVec3 sum = meso_vec3_add(before, after);
    if (cosine < -0.99f)    /* the end of a slit: along it */
        sum = meso_vec3_sub(meso_vec3_unit(rim_side(layer, i), sum), meso_vec3_unit(rim_side(layer, previous), sum));
    float mitre = cosine > -1 ? sqrtf(2 / (1 + cosine)) : MITRE_LARGEST;
    MesoVec3 way = meso_vec3_unit(sum, after);
    return add_ahead(layer, i, meso_vec3_scale(way, mitre < MITRE_LARGEST ? mitre : MITRE_LARGEST));
}

static MesoStatus begin_layer(Layer *layer)
{
    uint32_t count = layer->rim->count;
    layer->first = MESO_NEW(layer->scratch, uint32_t, (size_t)count + 1, layer->error);
    layer->last = MESO_NEW(layer->scratch, uint32_t, count, layer->error);
    if (!layer->first || !layer->last)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        layer->first[i] = layer->count;
        MesoStatus status = add_across(layer, i);
        if (status)
            return status;
        layer->last[i] = layer->count - 1;
    }
    layer->first[count] = layer->count;
    return MESO_OK;
}

/* ---- points that come too near to each other ---- */

/* Whether two points ahead, the one behind the other, should be one: near, or they have passed each other. */
static bool are_one(const Layer *layer, const Ahead *a, const Ahead *b)
{
    MesoVec3 side = meso_vec3_sub(b->position, a->position);
    if (meso_vec3_length(side) < NEAR_SHARE * layer->thickness)
        return true;
    if (a->owner == b->owner)
        return false;
    MesoVec3 behind = meso_vec3_sub(rim_point(layer, b->owner), rim_point(layer, a->owner));
    return meso_vec3_dot(side, behind) < 0.2f * meso_vec3_length(side) * meso_vec3_length(behind);
}

/* The mean of points from..to - 1, those past the end from the beginning. */
static Ahead mean_of(const Layer *layer, uint32_t from, uint32_t to)
{
    Ahead mean = {.owner = layer->ahead[from % layer->count].owner};
    float share = 1 / (float)(to - from);
    for (uint32_t i = from; i < to; i++) {
        mean.position = meso_vec3_mad(mean.position, share, layer->ahead[i % layer->count].position);
        mean.normal = meso_vec3_mad(mean.normal, share, layer->ahead[i % layer->count].normal);
    }
    mean.normal = meso_vec3_unit(mean.normal, layer->ahead[from % layer->count].normal);
    return mean;
}

/*
 * Joins runs of points once, those at the end with those at the beginning. `group` [count + 1] is the group of each
 * point, counted on past the end for those that go with the first. The number of groups.
 */
static uint32_t find_groups(const Layer *layer, uint32_t *group)
{
    uint32_t groups = 0, begin = 0;
    for (uint32_t i = 0; i < layer->count; i++) {
        if (i > 0 && !are_one(layer, &layer->ahead[begin], &layer->ahead[i])) {
            groups++;
            begin = i;
        }
        group[i] = groups;
    }
    groups++;
    if (groups > 1 && are_one(layer, &layer->ahead[begin], &layer->ahead[0]))
        groups--;   /* the last group keeps its number, which is that past the end */
    group[layer->count] = groups;
    return groups;
}

static MesoStatus join_once(Layer *layer, bool *changed)
{
    uint32_t *group = MESO_NEW(layer->scratch, uint32_t, (size_t)layer->count + 1, layer->error);
    Ahead *joined = MESO_NEW(layer->scratch, Ahead, (size_t)layer->count + 1, layer->error);
    if (!group || !joined)
        return MESO_ERR_MEMORY;
    uint32_t groups = find_groups(layer, group), tail = layer->count, head = 0;
    *changed = groups < layer->count;
    if (!*changed)
        return MESO_OK;
    while (tail > 0 && group[tail - 1] == groups)
        tail--;
    while (head < layer->count && group[head] == 0)
        head++;
    joined[0] = mean_of(layer, tail, layer->count + head);
    joined[0].owner = 0;
    for (uint32_t from = head, to; from < tail; from = to) {
        for (to = from; to < tail && group[to] == group[from]; to++)
            ;
        joined[group[from]] = mean_of(layer, from, to);
    }
    for (uint32_t i = 0; i < layer->rim->count; i++) {
        uint32_t past_first = layer->first[i] / layer->count * groups;
        uint32_t past_last = layer->last[i] / layer->count * groups;
        layer->first[i] = past_first + group[layer->first[i] % layer->count];
        layer->last[i] = past_last + group[layer->last[i] % layer->count];
    }
    layer->first[layer->rim->count] = layer->first[0] + groups;
    layer->ahead = joined;
    layer->room = layer->count + 1;
    layer->count = groups;
    return MESO_OK;
}

static MesoStatus join_points(Layer *layer)
{
    MesoStatus status = MESO_OK;
    bool changed = true;
    for (int round = 0; !status && changed && layer->count > 2 && round < JOIN_ROUNDS; round++)
        status = join_once(layer, &changed);
    return status;
}

/* Points between those that have come far apart. */
static MesoStatus split_long(Layer *layer)
{
    uint32_t count = layer->count, made = 0;
    uint32_t *place = MESO_NEW(layer->scratch, uint32_t, (size_t)count + 1, layer->error);
    if (!place)
        return MESO_ERR_MEMORY;
    Ahead *from = layer->ahead, *to = NULL;
    uint32_t room = 0;
    for (uint32_t i = 0; i < count; i++) {
        Ahead a = from[i], b = from[(i + 1) % count];
        float length = meso_vec3_length(meso_vec3_sub(b.position, a.position)) / layer->thickness;
        uint32_t pieces = length > LONG_SHARE ? (uint32_t)fminf(ceilf(length / LONG_SHARE), 1 << 20) : 1;
        place[i] = made;
        for (uint32_t k = 0; k < pieces; k++) {
            float share = (float)k / (float)pieces;
            to = MESO_GROW(layer->scratch, to, made, room, 64, layer->error);
            if (!to)
                return MESO_ERR_MEMORY;
            MesoVec3 normal = meso_vec3_unit(meso_vec3_lerp(a.normal, b.normal, share), a.normal);
            to[made++] = (Ahead){meso_vec3_lerp(a.position, b.position, share), normal, a.owner};
        }
    }
    place[count] = made;
    for (uint32_t i = 0; i <= layer->rim->count; i++)
        layer->first[i] = layer->first[i] / count * made + place[layer->first[i] % count];
    for (uint32_t i = 0; i < layer->rim->count; i++)
        layer->last[i] = layer->last[i] / count * made + place[layer->last[i] % count];
    layer->ahead = to;
    layer->count = made;
    layer->room = room;
    return MESO_OK;
}

/* ---- triangles between two rims ---- */

/* A step along the strip: the next vertex of the rim (or ahead) after these. */
typedef struct StripStep {
    uint32_t rim, ahead;
    bool along_rim;
} StripStep;

/* All steps: [rim->count + count] of them. */
static uint32_t plan_strip(const Layer *layer, StripStep *steps)
{
    uint32_t n = 0, at = layer->first[0];
    for (uint32_t i = 0; i < layer->rim->count; i++) {
        while (at < layer->last[i])
            steps[n++] = (StripStep){i, at++, false};
        uint32_t next = layer->first[i + 1], middle = at + (next - at) / 2;
        while (at < middle)
            steps[n++] = (StripStep){i, at++, false};
        steps[n++] = (StripStep){i, at, true};
        while (at < next)
            steps[n++] = (StripStep){i + 1, at++, false};
    }
    return n;
}

/* Whether the triangle of a step is turned against the surface, or has no area. */
static bool is_turned(const Layer *layer, StripStep step)
{
    MesoVec3 p = rim_point(layer, step.rim), a = layer->ahead[step.ahead % layer->count].position;
    MesoVec3 next = step.along_rim ? rim_point(layer, step.rim + 1)
                                   : layer->ahead[(step.ahead + 1) % layer->count].position;
    MesoVec3 area = meso_vec3_cross(meso_vec3_sub(a, p), meso_vec3_sub(next, p));
    MesoVec3 normal = layer->rim->normals[step.rim % layer->rim->count];
    return meso_vec3_dot(area, normal) <= 1e-3f * layer->thickness * layer->thickness * 0.01f;
}

/* Points of turned triangles go half of their way back. */
static void pull_back(Layer *layer, const StripStep *steps, uint32_t step_count)
{
    for (int round = 0; round < PULL_ROUNDS; round++) {
        bool turned = false;
        for (uint32_t s = 0; s < step_count; s++) {
            if (!is_turned(layer, steps[s]))
                continue;
            turned = true;
            for (uint32_t k = 0; k < (steps[s].along_rim ? 1 : 2); k++) {
                Ahead *a = &layer->ahead[(steps[s].ahead + k) % layer->count];
                a->position = meso_vec3_lerp(a->position, rim_point(layer, a->owner), 0.5f);
            }
        }
        if (!turned)
            return;
    }
}

static MesoStatus add_vertex(Layer *layer, MesoVec3 position)
{
    MesoTriangulation *mesh = &layer->base->mesh;
    MesoStatus status = meso_base_mesh_reserve(layer->base, (uint64_t)mesh->vertex_count + 1, mesh->triangle_count,
                                               layer->error);
    if (status)
        return status;
    *layer->depths = MESO_GROW(layer->arena, *layer->depths, mesh->vertex_count, layer->depth_room, 64, layer->error);
    if (!*layer->depths)
        return MESO_ERR_MEMORY;
    (*layer->depths)[mesh->vertex_count] = layer->depth;
    mesh->positions[mesh->vertex_count] = position;
    mesh->origins[mesh->vertex_count++] = MESO_NO_INDEX;
    return MESO_OK;
}

/* Weights of a triangle's corners 1 and 2 at the foot of a point in its plane. */
static MesoVec2 weights_of(const MesoTriangulation *original, uint32_t triangle, MesoVec3 point)
{
    const uint32_t *corner = &original->corners[3 * (size_t)triangle];
    MesoVec3 o = original->positions[corner[0]], p = meso_vec3_sub(point, o);
    MesoVec3 a = meso_vec3_sub(original->positions[corner[1]], o), b = meso_vec3_sub(original->positions[corner[2]], o);
    double aa = meso_vec3_dot(a, a), ab = meso_vec3_dot(a, b), bb = meso_vec3_dot(b, b);
    double pa = meso_vec3_dot(p, a), pb = meso_vec3_dot(p, b), area = aa * bb - ab * ab;
    if (!(area > 0))
        return (MesoVec2){0, 0};
    return (MesoVec2){(float)((pa * bb - pb * ab) / area), (float)((pb * aa - pa * ab) / area)};
}

/* A triangle of the strip, next to triangle `behind`; its weights come at the end. */
static uint32_t add_triangle(Layer *layer, uint32_t behind, uint32_t a, uint32_t b, uint32_t c)
{
    MesoBaseMesh *base = layer->base;
    uint32_t t = base->mesh.triangle_count++, corner[3] = {a, b, c};
    base->triangles[t] = base->triangles[behind];
    base->mesh.faces[t] = base->mesh.faces[behind];
    for (uint32_t k = 0; k < 3; k++) {
        base->mesh.corners[3 * t + k] = corner[k];
        base->mesh.twins[3 * t + k] = MESO_NO_INDEX;
    }
    return t;
}

static void link_twins(MesoBaseMesh *base, uint32_t a, uint32_t b)
{
    base->mesh.twins[a] = b;
    base->mesh.twins[b] = a;
}

/*
 * One triangle a step, sides 1 or 0 and 2 along the spokes:
 *
 *     r+1 <- r        r
 *       \   /        / \
 *        \ /        /   \
 *         a        a -> a+1
 */
static void add_strip(Layer *layer, Rim *next, const StripStep *steps, uint32_t step_count, uint32_t first_vertex)
{
    MesoBaseMesh *base = layer->base;
    const Rim *rim = layer->rim;
    uint32_t open = MESO_NO_INDEX, entry = MESO_NO_INDEX;
    for (uint32_t s = 0; s < step_count; s++) {
        StripStep step = steps[s];
        uint32_t r = step.rim % rim->count, a = step.ahead % layer->count, behind = rim->half_edges[r] / 3, in, t;
        uint32_t ahead = first_vertex + a;
        if (step.along_rim) {
            t = add_triangle(layer, behind, rim->vertices[(r + 1) % rim->count], rim->vertices[r], ahead);
            link_twins(base, 3 * t, rim->half_edges[r]);
            in = 3 * t + 1;
        } else {
            t = add_triangle(layer, behind, rim->vertices[r], ahead, first_vertex + (a + 1) % layer->count);
            next->half_edges[a] = 3 * t + 1;
            in = 3 * t;
        }
        if (open != MESO_NO_INDEX)
            link_twins(base, open, in);
        else
            entry = in;
        open = 3 * t + 2;
    }
    link_twins(base, open, entry);
}

static MesoStatus make_rim(Rim *rim, uint32_t count, MesoArena *arena, MesoError *error)
{
    rim->count = count;
    rim->vertices = MESO_NEW(arena, uint32_t, count, error);
    rim->normals = MESO_NEW(arena, MesoVec3, count, error);
    rim->half_edges = MESO_NEW(arena, uint32_t, count, error);
    return rim->vertices && rim->normals && rim->half_edges ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus lay_strip(Layer *layer, Rim *next)
{
    MesoTriangulation *mesh = &layer->base->mesh;
    StripStep *steps = MESO_NEW(layer->scratch, StripStep, (size_t)layer->rim->count + layer->count, layer->error);
    if (!steps)
        return MESO_ERR_MEMORY;
    uint32_t step_count = plan_strip(layer, steps), first = mesh->vertex_count;
    pull_back(layer, steps, step_count);
    MesoStatus status = make_rim(next, layer->count, layer->scratch, layer->error);
    for (uint32_t i = 0; !status && i < layer->count; i++) {
        status = add_vertex(layer, layer->ahead[i].position);
        next->vertices[i] = first + i;
        next->normals[i] = layer->ahead[i].normal;
    }
    if (!status)
        status = meso_base_mesh_reserve(layer->base, mesh->vertex_count, (uint64_t)mesh->triangle_count + step_count,
                                        layer->error);
    if (!status)
        add_strip(layer, next, steps, step_count, first);
    return status;
}

/* A hole that is nearly filled: one point in its middle. */
static MesoStatus close_hole(Layer *layer)
{
    MesoTriangulation *mesh = &layer->base->mesh;
    const Rim *rim = layer->rim;
    MesoVec3 middle = {0, 0, 0};
    for (uint32_t i = 0; i < rim->count; i++)
        middle = meso_vec3_mad(middle, 1 / (float)rim->count, rim_point(layer, i));
    uint32_t v = mesh->vertex_count, first = mesh->triangle_count;
    MesoStatus status = add_vertex(layer, middle);
    if (!status)
        status = meso_base_mesh_reserve(layer->base, mesh->vertex_count, (uint64_t)first + rim->count, layer->error);
    for (uint32_t i = 0; !status && i < rim->count; i++) {
        uint32_t t = add_triangle(layer, rim->half_edges[i] / 3, rim->vertices[(i + 1) % rim->count], rim->vertices[i],
                                  v);
        link_twins(layer->base, 3 * t, rim->half_edges[i]);
    }
    for (uint32_t i = 0; !status && i < rim->count; i++)
        link_twins(layer->base, 3 * (first + i) + 2, 3 * (first + (i + 1) % rim->count) + 1);
    return status;
}

/* ---- loops ---- */

static MesoVec3 normal_of(const MesoTriangulation *mesh, uint32_t triangle)
{
    const uint32_t *corner = &mesh->corners[3 * (size_t)triangle];
    MesoVec3 a = mesh->positions[corner[0]];
    return meso_vec3_direction(meso_vec3_cross(meso_vec3_sub(mesh->positions[corner[1]], a),
                                               meso_vec3_sub(mesh->positions[corner[2]], a)), (MesoVec3){0, 0, 0});
}

static MesoStatus first_rim(Rim *rim, const MesoTriangulation *mesh, const MesoBorderLoops *loops,
                            const MesoBorderLoop *loop, MesoArena *arena, MesoError *error)
{
    MesoStatus status = make_rim(rim, loop->count, arena, error);
    for (uint32_t i = 0; !status && i < loop->count; i++) {
        rim->vertices[i] = loops->vertices[loop->first + i];
        rim->half_edges[i] = loops->half_edges[loop->first + i];
    }
    for (uint32_t i = 0; !status && i < loop->count; i++) {
        MesoVec3 after = normal_of(mesh, rim->half_edges[i] / 3);
        MesoVec3 before = normal_of(mesh, rim->half_edges[(i + loop->count - 1) % loop->count] / 3);
        rim->normals[i] = meso_vec3_unit(meso_vec3_add(before, after), after);
    }
    return status;
}

static float mean_side(const Layer *layer)
{
    double sum = 0;
    for (uint32_t i = 0; i < layer->rim->count; i++)
        sum += meso_vec3_length(rim_side(layer, i));
    return (float)(sum / layer->rim->count);
}

/* Layers beyond one border, until the reach or the middle of a hole. */
static MesoStatus extend_loop(Layer *layer, Rim rim, float edge, float reach)
{
    MesoStatus status = MESO_OK;
    float depth = 0;
    while (!status && depth < reach * 0.999f) {
        layer->rim = &rim;
        float left = reach - depth, wanted = fminf(0.9f * edge, COARSENING * mean_side(layer));
        wanted = fmaxf(wanted, THINNEST * fminf(reach, edge));
        layer->thickness = left / fmaxf(ceilf(left / wanted), 1);
        layer->depth = depth += layer->thickness;
        layer->count = layer->room = 0;
        layer->ahead = NULL;
        Rim next = rim;
        status = begin_layer(layer);
        if (!status)
            status = join_points(layer);
        if (!status && layer->count < 3)
            return close_hole(layer);
        if (!status)
            status = split_long(layer);
        if (!status)
            status = lay_strip(layer, &next);
        rim = next;
    }
    return status;
}

static void weigh_corners(MesoBaseMesh *base, const MesoTriangulation *original, uint32_t first)
{
    for (uint32_t t = first; t < base->mesh.triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++)
            base->corner_weights[3 * t + k] =
                weights_of(original, base->triangles[t], base->mesh.positions[base->mesh.corners[3 * t + k]]);
}

MesoStatus meso_base_extend(MesoBaseMesh *base, float **depths, MesoArena *arena, const MesoTriangulation *original,
                            float edge, float reach, MesoError *error)
{
    MesoArena kept, scratch;
    meso_arena_init(&kept);
    meso_arena_init(&scratch);
    MesoBorderLoops loops;
    uint32_t first = base->mesh.triangle_count, room = base->mesh.vertex_count + 1;
    Layer layer = {.base = base, .depths = depths, .depth_room = room, .arena = arena, .scratch = &scratch,
                   .error = error};
    *depths = MESO_NEW(arena, float, room, error);
    MesoStatus status = *depths ? meso_border_loops_find(&loops, &kept, &base->mesh, NULL, false, error)
                                : MESO_ERR_MEMORY;
    for (uint32_t i = 0; !status && i < loops.loop_count; i++) {
        MesoArenaMark mark = meso_arena_mark(&scratch);
        Rim rim;
        status = first_rim(&rim, &base->mesh, &loops, &loops.loops[i], &scratch, error);
        if (!status)
            status = extend_loop(&layer, rim, edge, reach);
        meso_arena_rewind(&scratch, mark);
    }
    if (!status) {
        weigh_corners(base, original, first);
        meso_base_mesh_settle(base);
    }
    meso_arena_release(&scratch);
    meso_arena_release(&kept);
    return status;
}
