/*
 * What has grown, brought up from below the surface: a step is kept above it while it grows (growth_depth.c), but its
 * curve still changes when the next one turns, and tilted shapes and such beyond corners are looked at here alone.
 */
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/growth/engine/growth_above.h"

/* Points of an element that are looked at, and of one that goes around a corner. */
enum { SAMPLES = 12, MORE_SAMPLES = 48, WALKS = 2, PASSES = 12, GRAIN = 1024, AHEAD = 8 };

/* Of an element's length; less than what is promised, since only points are looked at. */
static const float tolerance = 0.008f;

typedef struct Lifting {
    const MesoGrown *grown;
    const MesoGrowthGround *ground;
    float *depths;              /* [element_count] of what is too deep, or is to be measured; 0: it is not */
} Lifting;

static float length_of(const MesoGrown *grown, const MesoGrowthElement *element)
{
    return meso_vec3_length(meso_vec3_sub(grown->joints[element->span.to].position,
                                          grown->joints[element->span.from].position));
}

/* ---- depths ---- */

/* Walks to below a point, as the triangle at the tip sees it, where that is more than `least` away. What is left of the
 * way lies beyond a border. */
static double walk_below(const Lifting *lifting, MesoTip *tip, MesoVec3 at, double least)
{
    const MesoWalkOptions options = {.crossing_limit = 1 << 10};
    const double target[3] = {(double)at.x, (double)at.y, (double)at.z};
    double position[3], towards[3], along[3];
    MesoWalk walk = {.tip = *tip};
    meso_tip_position(lifting->ground->mesh, tip, position);
    for (uint32_t k = 0; k < 3; k++)
        towards[k] = target[k] - position[k];
    if (!meso_tip_head(&walk.tip, lifting->ground->mesh, towards))
        return 0;
    meso_walk_direction(lifting->ground->mesh, walk.tip.triangle, walk.tip.heading, along);
    walk.length = along[0] * towards[0] + along[1] * towards[1] + along[2] * towards[2];
    if (!(walk.length > least))
        return 0;
    meso_walks(&lifting->ground->walk, &walk, 1, &options);
    *tip = walk.tip;
    return walk.length;
}

/* The surface below a point, but for `least` of the way there, from one of it that is near; false beyond a border. */
static bool surface_below(const Lifting *lifting, const MesoMeshPoint *from, MesoVec3 at, bool turned, double least,
                          MesoTip *below)
{
    *below = (MesoTip){.triangle = from->triangle, .turned = turned, .heading = {1, 0}};
    for (uint32_t k = 0; k < 3; k++)
        below->weight[k] = (double)from->weight[k];
    double rest = walk_below(lifting, below, at, 0);
    for (uint32_t i = 1; i < WALKS && !(rest > 0); i++)
        rest = walk_below(lifting, below, at, least);
    return !(rest > 0);
}

/* The surface's normal below a joint, on the side that the joint is on. Where surfaces are wound both ways the joint's
 * own normal tells it, for which the joint must not be rolled far. */
static MesoVec3 normal_at(const Lifting *lifting, uint32_t joint, bool *turned)
{
    const MesoMeshPoint *point = &lifting->grown->points[joint];
    const double weight[3] = {(double)point->weight[0], (double)point->weight[1], (double)point->weight[2]};
    MesoVec3 normal = meso_growth_normal(lifting->ground, point->triangle, weight, false);
    *turned = lifting->ground->against && meso_vec3_dot(normal, lifting->grown->joints[joint].normal) < 0;
    return *turned ? meso_vec3_scale(normal, -1) : normal;
}

static MesoVec3 curve_point(const MesoVec3 p[4], float t)
{
    float r = 1 - t;
    MesoVec3 point = meso_vec3_scale(p[0], r * r * r);
    point = meso_vec3_mad(point, 3 * r * r * t, p[1]);
    point = meso_vec3_mad(point, 3 * r * t * t, p[2]);
    return meso_vec3_mad(point, t * t * t, p[3]);
}

static float depth_of(const Lifting *lifting, const MesoGrowthElement *element)
{
    const MesoGrown *grown = lifting->grown;
    const MesoJoint *from = &grown->joints[element->span.from], *to = &grown->joints[element->span.to];
    const MesoMeshPoint *ends[2] = {&grown->points[element->span.from], &grown->points[element->span.to]};
    bool turned[2];
    float deepest = 0;
    MesoVec3 p[4];
    meso_bend_curve(from, to, p);
    double least = 0.02 * (double)length_of(grown, element);
    normal_at(lifting, element->span.from, &turned[0]);
    normal_at(lifting, element->span.to, &turned[1]);
    uint32_t samples = meso_vec3_dot(from->normal, to->normal) < 0.9f ? MORE_SAMPLES : SAMPLES;
    for (uint32_t i = 1; i <= samples; i++) {
        MesoVec3 at = curve_point(p, (float)i / (float)samples);
        uint32_t end = 2 * i > samples;
        MesoTip below;
        if (!surface_below(lifting, ends[end], at, turned[end], least, &below))
            continue;
        MesoVec3 up = meso_vec3_sub(meso_growth_position(lifting->ground, below.triangle, below.weight), at);
        MesoVec3 normal = meso_growth_normal(lifting->ground, below.triangle, below.weight, below.turned);
        deepest = fmaxf(deepest, meso_vec3_dot(up, normal));
    }
    return deepest;
}

/* Of an element that is too deep; of others 0. */
static float depth_beyond(const Lifting *lifting, const MesoGrowthElement *element)
{
    if (meso_growth_is_above(lifting->grown, lifting->ground, element, 0.9f * tolerance))
        return 0;
    float depth = depth_of(lifting, element);
    return depth > tolerance * length_of(lifting->grown, element) ? depth : 0;
}

static void measure_range(void *context, uint64_t begin, uint64_t end)
{
    Lifting *lifting = context;
    const MesoGrowthElement *elements = lifting->grown->elements;
    for (uint64_t i = begin; i < end; i++)
        if (lifting->depths[i] > 0)
            lifting->depths[i] = depth_beyond(lifting, &elements[i]);
}

static void measure_all(void *context, uint64_t begin, uint64_t end)
{
    Lifting *lifting = context;
    const MesoGrowthElement *elements = lifting->grown->elements;
    for (uint64_t i = begin; i < end; i++) {
        if (i + AHEAD < end)
            meso_growth_fetch_ends(lifting->grown, lifting->ground, &elements[i + AHEAD]);
        lifting->depths[i] = depth_beyond(lifting, &elements[i]);
    }
}

static bool any_deep(const Lifting *lifting)
{
    bool any = false;
    for (uint32_t i = 0; i < lifting->grown->element_count; i++)
        any |= lifting->depths[i] > 0;
    return any;
}

/* ---- joints ---- */

/* Joints that are two in one place, at the end of a step and the begin of the next, are raised as one. */
static void find_twins(const MesoGrown *grown, uint32_t *twins, uint32_t *last)
{
    memset(twins, 0xff, grown->joint_count * sizeof *twins);
    memset(last, 0xff, grown->branch_count * sizeof *last);
    for (uint32_t i = 0; i < grown->element_count; i++) {
        const MesoGrowthElement *element = &grown->elements[i];
        uint32_t from = element->span.from, before = last[element->branch];
        if (before != MESO_NO_INDEX && before != from &&
            memcmp(&grown->points[before], &grown->points[from], sizeof *grown->points) == 0 &&
            memcmp(&grown->joints[before].position, &grown->joints[from].position, sizeof(MesoVec3)) == 0) {
            twins[before] = from;
            twins[from] = before;
        }
        last[element->branch] = element->span.to;
    }
}

static void want(float *raises, const uint32_t *twins, uint32_t joint, float by)
{
    raises[joint] = fmaxf(raises[joint], by);
    if (twins[joint] != MESO_NO_INDEX)
        raises[twins[joint]] = fmaxf(raises[twins[joint]], by);
}

/* How far each joint may be raised in all: half of the longest element at it. At a fin, which has a surface on both
 * sides of what stands on it, depths would grow with every raise. */
static void find_room(const MesoGrown *grown, float *room, const uint32_t *twins)
{
    memset(room, 0, grown->joint_count * sizeof *room);
    for (uint32_t i = 0; i < grown->element_count; i++) {
        const MesoSpan *span = &grown->elements[i].span;
        float half = 0.5f * length_of(grown, &grown->elements[i]);
        want(room, twins, span->from, half);
        want(room, twins, span->to, half);
    }
}

static void raise_once(const Lifting *lifting, MesoGrown *grown, float *raises, float *room, const uint32_t *twins)
{
    float *depths = lifting->depths;
    memset(raises, 0, grown->joint_count * sizeof *raises);
    for (uint32_t i = 0; i < grown->element_count; i++) {
        const MesoSpan *span = &grown->elements[i].span;
        if (depths[i] > 0) {
            want(raises, twins, span->from, depths[i]);
            want(raises, twins, span->to, depths[i]);
        }
    }
    for (uint32_t i = 0; i < grown->joint_count; i++) {
        bool turned;
        raises[i] = fminf(raises[i], room[i]);
        room[i] -= raises[i];
        if (raises[i] > 0)
            grown->joints[i].position = meso_vec3_mad(grown->joints[i].position, raises[i],
                                                      normal_at(lifting, i, &turned));
    }
    /* what hangs together with what was raised is looked at again */
    for (uint32_t i = 0; i < grown->element_count; i++) {
        const MesoSpan *span = &grown->elements[i].span;
        depths[i] = raises[span->from] > 0 || raises[span->to] > 0 ? 1 : 0;
    }
}

static MesoStatus raise_all(Lifting *lifting, MesoGrown *grown, MesoArena *scratch, uint32_t thread_count,
                            MesoError *error)
{
    float *raises = MESO_NEW(scratch, float, grown->joint_count, error);
    float *room = MESO_NEW(scratch, float, grown->joint_count, error);
    uint32_t *twins = MESO_NEW(scratch, uint32_t, grown->joint_count, error);
    uint32_t *last = MESO_NEW(scratch, uint32_t, grown->branch_count, error);
    if (!raises || !room || !twins || !last)
        return MESO_ERR_MEMORY;
    find_twins(grown, twins, last);
    find_room(grown, room, twins);
    for (uint32_t pass = 1; pass <= PASSES && any_deep(lifting); pass++) {
        raise_once(lifting, grown, raises, room, twins);
        if (pass < PASSES)
            meso_parallel_for(thread_count, grown->element_count, GRAIN, measure_range, lifting);
    }
    return MESO_OK;
}

MesoStatus meso_growth_lift(MesoGrown *grown, MesoArena *scratch, const MesoGrowthGround *ground,
                            uint32_t thread_count, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    meso_arena_reserve(scratch, grown->element_count * sizeof(float));
    Lifting lifting = {grown, ground, MESO_NEW(scratch, float, grown->element_count, error)};
    MesoStatus status = lifting.depths ? MESO_OK : MESO_ERR_MEMORY;
    if (!status)
        meso_parallel_for(thread_count, grown->element_count, GRAIN, measure_all, &lifting);
    if (!status && any_deep(&lifting))
        status = raise_all(&lifting, grown, scratch, thread_count, error);
    meso_arena_rewind(scratch, mark);
    return status;
}
