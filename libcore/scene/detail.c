/*
 * Bounds for the rings: a curve cut into n equal steps of its parameter lies
 * within max |C''| / (8 n n) of its chords. For a cubic Bezier |B''| <= 6 times
 * the largest second difference of its control points; the profile adds the
 * second derivative of its blend (6 times its change) and of the frame's turn
 * (radius times the square of the turning angle).
 */
#include "libcore/scene/detail.h"

/* Columns that one kept column may stand for: bounds the look-ahead. */
enum { MAX_SKIP = 64 };

/* Normals of neighbours turn by less than this: 5 columns around a thread of a pixel or two. */
static const float NORMAL_COSINE = 0.2588f;         /* 75 degrees */

/* Largest turn of a shading normal between two rings, in radians. */
static const float RING_TURN = 1.0f;

static float distance_to_chord(MesoVec2 p, MesoVec2 a, MesoVec2 b)
{
    MesoVec2 ab = meso_vec2_sub(b, a), ap = meso_vec2_sub(p, a);
    float square = ab.x * ab.x + ab.y * ab.y;
    float t = square > 0 ? (ap.x * ab.x + ap.y * ab.y) / square : 0;
    t = fminf(fmaxf(t, 0), 1);
    return meso_vec2_length(meso_vec2_sub(p, meso_vec2_lerp(a, b, t)));
}

static bool turns_little(MesoVec2 a, MesoVec2 b)
{
    return a.x * b.x + a.y * b.y >= NORMAL_COSINE * meso_vec2_length(a) * meso_vec2_length(b);
}

/* True if the columns between `first` and `last` may go. */
static bool may_skip(const MesoSweepColumn *columns, uint32_t first, uint32_t last, float tolerance)
{
    const MesoSweepColumn *a = &columns[first], *b = &columns[last];
    if (!turns_little(a->start_normal, b->start_normal) || !turns_little(a->end_normal, b->end_normal))
        return false;
    for (uint32_t i = first + 1; i < last; i++) {
        const MesoSweepColumn *c = &columns[i];
        if (distance_to_chord(c->start, a->start, b->start) > tolerance
            || distance_to_chord(c->end, a->end, b->end) > tolerance
            || !turns_little(a->start_normal, c->start_normal)
            || !turns_little(a->end_normal, c->end_normal))
            return false;
    }
    return true;
}

uint32_t meso_detail_columns(const MesoSweepColumn *columns, uint32_t count, float tolerance,
                             uint32_t *kept)
{
    uint32_t kept_count = 0;
    for (uint32_t i = 0; i < count;) {
        kept[kept_count++] = i;
        uint32_t next = i + 1;
        while (tolerance > 0 && columns[i].joins_next && next + 1 < count && columns[next].joins_next
               && next + 1 - i <= MAX_SKIP && may_skip(columns, i, next + 1, tolerance))
            next++;
        i = next;
    }
    return kept_count;
}

static float largest_radius(const MesoSweepColumn *columns, uint32_t count, float *change)
{
    float radius = 0;
    *change = 0;
    for (uint32_t i = 0; i < count; i++) {
        radius = fmaxf(radius, meso_vec2_length(columns[i].start));
        radius = fmaxf(radius, meso_vec2_length(columns[i].end));
        *change = fmaxf(*change, meso_vec2_length(meso_vec2_sub(columns[i].end, columns[i].start)));
    }
    return radius;
}

static float angle_between(MesoVec3 a, MesoVec3 b)
{
    float scale = meso_vec3_length(a) * meso_vec3_length(b);
    return scale > 0 ? acosf(fminf(fmaxf(meso_vec3_dot(a, b) / scale, -1), 1)) : 0;
}

/* The polygon of the handles turns at least as much as the curve. */
static float turn_of(const MesoSweepInstance *instance)
{
    MesoVec3 h0 = meso_vec3_sub(instance->p[1], instance->p[0]);
    MesoVec3 h1 = meso_vec3_sub(instance->p[2], instance->p[1]);
    MesoVec3 h2 = meso_vec3_sub(instance->p[3], instance->p[2]);
    return angle_between(h0, h1) + angle_between(h1, h2) + angle_between(instance->up[0], instance->up[1]);
}

static float bend_of(const MesoSweepInstance *instance)
{
    const MesoVec3 *p = instance->p;
    MesoVec3 d0 = meso_vec3_add(meso_vec3_mad(p[0], -2, p[1]), p[2]);
    MesoVec3 d1 = meso_vec3_add(meso_vec3_mad(p[1], -2, p[2]), p[3]);
    return 6 * fmaxf(meso_vec3_length(d0), meso_vec3_length(d1));
}

uint32_t meso_detail_rings(const MesoScene *scene, const MesoSweptKind *kind, float tolerance)
{
    uint32_t most = kind->division_count < 2 ? 2 : kind->division_count;
    if (!(tolerance > 0))
        return most;

    float change, scale = scene->section_scale;
    float radius = scale * largest_radius(&scene->columns[kind->column_begin],
                                          kind->column_count, &change);
    float steps = 1;
    if (kind->cap) {
        /* The radius falls as 1 - v^4, whose second derivative is 12 at most. */
        steps = fmaxf(sqrtf(12 * radius / (8 * tolerance)), 3);
    } else {
        for (uint32_t i = 0; i < kind->instance_count; i++) {
            const MesoSweepInstance *instance = &scene->sweeps[kind->instance_begin + i];
            float turn = turn_of(instance);
            float second = bend_of(instance) + 6 * change * scale + radius * turn * turn;
            steps = fmaxf(steps, fmaxf(sqrtf(second / (8 * tolerance)), turn / RING_TURN));
        }
    }
    return steps < (float)(most - 1) ? (uint32_t)ceilf(steps) + 1 : most;
}
