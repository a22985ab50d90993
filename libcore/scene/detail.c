/*
 * Bounds for the rings: a curve cut into n equal steps of its parameter lies
 * within max |C''| / (8 n n) of its chords. For a cubic Bezier |B''| <= 6 times
 * the largest second difference of its control points; the profile adds the
 * second derivative of its blend (6 times its change) and of the frame's turn
 * (radius times the square of the turning angle). What is spread by the blend's weight turns 1.5 times as fast
 * in the middle, and 6 times its angle faster and slower.
 */
#include "libcore/scene/detail.h"

/* Columns that one kept column may stand for: bounds the look-ahead. */
enum { MAX_SKIP = 64 };

/* Normals of neighbours turn by less than this: 5 columns around a thread of a pixel or two. */
static const float NORMAL_COSINE = 0.2588f;         /* 75 degrees */

/* Where nobody sees the normals: a thread is a prism of three sides. */
static const float SILHOUETTE_COSINE = -0.55f;      /* 123 degrees */

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

static bool turns_little(MesoVec2 a, MesoVec2 b, float cosine)
{
    return a.x * b.x + a.y * b.y >= cosine * meso_vec2_length(a) * meso_vec2_length(b);
}

/* True if the columns between `first` and `last` may go. */
static bool may_skip(const MesoSweepColumn *columns, uint32_t first, uint32_t last, float tolerance,
                     float cosine)
{
    const MesoSweepColumn *a = &columns[first], *b = &columns[last];
    if (!turns_little(a->start_normal, b->start_normal, cosine) ||
        !turns_little(a->end_normal, b->end_normal, cosine))
        return false;
    for (uint32_t i = first + 1; i < last; i++) {
        const MesoSweepColumn *c = &columns[i];
        if (distance_to_chord(c->start, a->start, b->start) > tolerance
            || distance_to_chord(c->end, a->end, b->end) > tolerance
            || !turns_little(a->start_normal, c->start_normal, cosine)
            || !turns_little(a->end_normal, c->end_normal, cosine))
            return false;
    }
    return true;
}

/* Of a run, to its end, as far as each goes; returns how many. */
static uint32_t keep_run(const MesoSweepColumn *columns, uint32_t begin, uint32_t end, float tolerance, float cosine,
                         uint32_t *kept)
{
    uint32_t kept_count = 0;
    for (uint32_t i = begin; i < end;) {
        kept[kept_count++] = i;
        uint32_t next = i + 1;
        while (next + 1 < end && next + 1 - i <= MAX_SKIP && may_skip(columns, i, next + 1, tolerance, cosine))
            next++;
        i = next;
    }
    return kept_count;
}

/* As many, evenly: what is left for the last is no less than for others. As they were, where that is too far. */
static void keep_evenly(const MesoSweepColumn *columns, float tolerance, float cosine, uint32_t *kept, uint32_t count)
{
    uint32_t steps = count - 1, first = kept[0], width = kept[steps] - first;
    for (uint32_t k = 0; k < steps; k++) {
        uint32_t from = first + (2 * k * width + steps) / (2 * steps);
        uint32_t to = first + (2 * (k + 1) * width + steps) / (2 * steps);
        if (to > from + 1 && !may_skip(columns, from, to, tolerance, cosine))
            return;
    }
    for (uint32_t k = 1; k < steps; k++)
        kept[k] = first + (2 * k * width + steps) / (2 * steps);
}

static uint32_t keep_columns(const MesoSweepColumn *columns, uint32_t count, float tolerance, float cosine,
                             uint32_t *kept)
{
    uint32_t kept_count = 0;
    if (!(tolerance > 0)) {
        for (uint32_t i = 0; i < count; i++)
            kept[i] = i;
        return count;
    }
    for (uint32_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && columns[end - 1].joins_next;)
            end++;
        uint32_t *of_run = kept + kept_count, run = keep_run(columns, begin, end, tolerance, cosine, of_run);
        if (run > 2)
            keep_evenly(columns, tolerance, cosine, of_run, run);
        kept_count += run;
    }
    return kept_count;
}

uint32_t meso_detail_columns(const MesoSweepColumn *columns, uint32_t count, float tolerance,
                             uint32_t *kept)
{
    return keep_columns(columns, count, tolerance, NORMAL_COSINE, kept);
}

uint32_t meso_detail_silhouette(const MesoSweepColumn *columns, uint32_t count, float tolerance, uint32_t *kept)
{
    return keep_columns(columns, count, tolerance, SILHOUETTE_COSINE, kept);
}

/* `change` is where the sweep is not turned, of instances of size 1. */
static float largest_radius(const MesoSweptKind *kind, const MesoSweepColumn *columns, float *change)
{
    float radius = 0, most = 0, c = cosf(kind->turn), s = sinf(kind->turn);
    for (uint32_t i = 0; i < kind->column_count; i++) {
        MesoVec2 end = meso_vec2_sub(columns[i].end, kind->middle[1]);
        MesoVec2 start = meso_vec2_sub(columns[i].start, kind->middle[0]);
        end = (MesoVec2){c * end.x + s * end.y, c * end.y - s * end.x};
        radius = fmaxf(radius, fmaxf(meso_vec2_length(columns[i].start), meso_vec2_length(columns[i].end)));
        most = fmaxf(most, meso_vec2_length(meso_vec2_sub(end, start)));
    }
    *change = most + meso_vec2_length(meso_vec2_sub(kind->middle[1], kind->middle[0]));
    return radius;
}

static float angle_between(MesoVec3 a, MesoVec3 b)
{
    float scale = meso_vec3_length(a) * meso_vec3_length(b);
    float cosine = meso_vec3_dot(a, b) / scale;
    cosine = cosine > -1 ? cosine : -1;         /* fmaxf() is a call */
    return scale > 0 ? acosf(cosine < 1 ? cosine : 1) : 0;
}

/* The polygon of the handles turns at least as much as the curve. */
static float turn_of(const MesoSweepInstance *instance)
{
    MesoVec3 h0 = meso_vec3_sub(instance->p[1], instance->p[0]);
    MesoVec3 h1 = meso_vec3_sub(instance->p[2], instance->p[1]);
    MesoVec3 h2 = meso_vec3_sub(instance->p[3], instance->p[2]);
    return angle_between(h0, h1) + angle_between(h1, h2) + angle_between(instance->up[0], instance->up[1]);
}

/* What ends of different size add to the change. */
static float size_change(const MesoSweepInstance *instance)
{
    float most = fmaxf(instance->size[0], instance->size[1]);
    return most > 0 ? 6 * fabsf(instance->size[1] - instance->size[0]) / most : 0;
}

/* Where sections deform, the trajectory's own bend grows, and its straight parts bend too. */
static float bend_of(const MesoSweepInstance *instance, const MesoKindDetail *detail)
{
    const MesoVec3 *p = instance->p;
    MesoVec3 d0 = meso_vec3_add(meso_vec3_mad(p[0], -2, p[1]), p[2]);
    MesoVec3 d1 = meso_vec3_add(meso_vec3_mad(p[1], -2, p[2]), p[3]);
    float bend = 6 * fmaxf(meso_vec3_length(d0), meso_vec3_length(d1)), speed = 0;
    for (uint32_t i = 0; i < 3 && detail->stretch.bend > 0; i++)
        speed = fmaxf(speed, 3 * meso_vec3_length(meso_vec3_sub(p[i + 1], p[i])));
    return detail->stretch.most * bend + detail->stretch.bend * speed * speed;
}

MesoKindDetail meso_kind_detail(const MesoScene *scene, const MesoSweptKind *kind)
{
    MesoKindDetail detail = {.stretch = meso_kind_stretch(scene, kind)};
    float change;
    float scale = scene->section_scale * meso_scene_kind_size(scene, kind) * detail.stretch.most;
    detail.radius = scale * largest_radius(kind, &scene->columns[kind->column_begin], &change);
    detail.change = scale * change;
    return detail;
}

static uint32_t rings_of(const MesoSweptKind *kind, float steps)
{
    uint32_t most = kind->division_count < 2 ? 2 : kind->division_count;
    return steps < (float)(most - 1) ? (uint32_t)ceilf(steps) + 1 : most;
}

MesoSweepBend meso_detail_bend(const MesoSweptKind *kind, const MesoKindDetail *detail,
                               const MesoSweepInstance *instance)
{
    if (kind->cap)
        return (MesoSweepBend){0, 0};
    float spread = fabsf(kind->turn) + fabsf(instance->twist);
    float most = MESO_CREASE_EASES * MESO_CREASED;  /* rings of creases turn within less than the whole, and change */
    float hurry = instance->mitre < MESO_CREASED ? 1 : instance->mitre < most ? 2 : 3;
    float turn = hurry * (turn_of(instance) + 1.5f * spread);
    float second = bend_of(instance, detail) + 6 * detail->change +
                   detail->radius * (size_change(instance) + turn * turn + 6 * spread);
    return (MesoSweepBend){second, turn};
}

/* Chords that an instance needs, at least one. */
static float steps_of(const MesoSweptKind *kind, const MesoKindDetail *detail, MesoSweepBend bend, float tolerance,
                      bool shaded)
{
    if (!(tolerance > 0))
        return INFINITY;
    if (kind->cap)      /* the radius falls as 1 - v^4, whose second derivative is 12 at most */
        return fmaxf(sqrtf(12 * detail->radius / (8 * tolerance)), shaded ? 3 : 1);
    return fmaxf(fmaxf(sqrtf(bend.second / (8 * tolerance)), shaded ? bend.turn / RING_TURN : 0), 1);
}

uint32_t meso_detail_bend_rings(const MesoSweptKind *kind, const MesoKindDetail *detail, MesoSweepBend bend,
                                float tolerance, bool shaded)
{
    return rings_of(kind, steps_of(kind, detail, bend, tolerance, shaded));
}

uint32_t meso_detail_instance_rings(const MesoSweptKind *kind, const MesoKindDetail *detail,
                                    const MesoSweepInstance *instance, float tolerance, bool shaded)
{
    MesoSweepBend bend = tolerance > 0 ? meso_detail_bend(kind, detail, instance) : (MesoSweepBend){0, 0};
    return meso_detail_bend_rings(kind, detail, bend, tolerance, shaded);
}

uint32_t meso_detail_rings(const MesoScene *scene, const MesoSweptKind *kind, float tolerance)
{
    MesoKindDetail detail = meso_kind_detail(scene, kind);
    float steps = kind->cap || !(tolerance > 0) ? steps_of(kind, &detail, (MesoSweepBend){0, 0}, tolerance, true) : 1;
    for (uint32_t i = 0; !kind->cap && tolerance > 0 && i < kind->instance_count; i++) {
        MesoSweepBend bend = meso_detail_bend(kind, &detail, &scene->sweeps[kind->instance_begin + i]);
        steps = fmaxf(steps, steps_of(kind, &detail, bend, tolerance, true));
    }
    return rings_of(kind, steps);
}
