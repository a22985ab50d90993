/* The points of sweeps alone, many at once: to the bit those of their vertices. */
#include <assert.h>

#include "libcore/scene/sweep.h"
#include "libcore/scene/sweep_ring.h"

enum { LANES = MESO_SWEEP_LANES };

/* What the places of one ring have in common. */
typedef struct PointRing {
    MesoVec3 origin, x, y;
    float scale, sizes[2];
    MesoVec2 middle[2];
    MesoSweepAngle back;
    MesoSweepBlend blend;
    float radius;           /* of a cap, over that at its end; of a tube 1 */
} PointRing;

/* Sections, each of a lane: as section_point() and cap_place(). */
__attribute__((always_inline)) static inline void blend_lanes(const PointRing *ring, const MesoSweepPlaces *places,
                                                              uint32_t c, bool first, bool last, float *x, float *y)
{
    for (uint32_t l = 0; l < LANES; l++) {
        MesoVec2 start = {places->start_x[c + l] * ring->sizes[0], places->start_y[c + l] * ring->sizes[0]};
        MesoVec2 end = {places->end_x[c + l] * ring->sizes[1], places->end_y[c + l] * ring->sizes[1]};
        MesoVec2 at = first ? start : last ? end : meso_vec2_lerp(start, end, ring->blend.w);
        x[l] = at.x;
        y[l] = at.y;
    }
}

__attribute__((always_inline)) static inline void turn_lanes(const PointRing *ring, const MesoSweepPlaces *places,
                                                             uint32_t c, float *x, float *y)
{
    MesoVec2 axis = meso_vec2_lerp(ring->middle[0], ring->middle[1], ring->blend.w);
    for (uint32_t l = 0; l < LANES; l++) {
        MesoVec2 start = {places->start_x[c + l] * ring->sizes[0], places->start_y[c + l] * ring->sizes[0]};
        MesoVec2 end = {places->end_x[c + l] * ring->sizes[1], places->end_y[c + l] * ring->sizes[1]};
        MesoVec2 q0 = meso_vec2_sub(start, ring->middle[0]);
        MesoVec2 q1 = meso_sweep_turned(meso_vec2_sub(end, ring->middle[1]), ring->back);
        MesoVec2 q = meso_sweep_turned(meso_vec2_lerp(q0, q1, ring->blend.w), ring->blend.turn);
        MesoVec2 at = meso_sweep_turned(meso_vec2_add(axis, q), ring->blend.twist);
        x[l] = at.x;
        y[l] = at.y;
    }
}

__attribute__((always_inline)) static inline void crease_lanes(const MesoSweepBlend *blend, float *x, float *y)
{
    for (uint32_t l = 0; l < LANES; l++) {
        MesoVec2 at = meso_sweep_creased(blend, (MesoVec2){x[l], y[l]});
        x[l] = at.x;
        y[l] = at.y;
    }
}

__attribute__((always_inline)) static inline void put_lanes(const PointRing *ring, const float *at_x,
                                                            const float *at_y, float *x, float *y, float *z)
{
    for (uint32_t l = 0; l < LANES; l++) {
        float right = ring->radius * at_x[l], up = ring->radius * at_y[l];
        x[l] = ring->origin.x + ring->scale * (right * ring->x.x + up * ring->y.x);
        y[l] = ring->origin.y + ring->scale * (right * ring->x.y + up * ring->y.y);
        z[l] = ring->origin.z + ring->scale * (right * ring->x.z + up * ring->y.z);
    }
}

__attribute__((always_inline)) static inline void put_ring(const PointRing *ring, const MesoSweepPlaces *places,
                                                           float *x, float *y, float *z)
{
    const PointRing r = *ring;
    float at_x[LANES], at_y[LANES];
    for (uint32_t c = 0; c < places->count; c += LANES) {
        if (r.blend.turns)
            turn_lanes(&r, places, c, at_x, at_y);
        else if (r.blend.v == 0)
            blend_lanes(&r, places, c, true, false, at_x, at_y);
        else
            blend_lanes(&r, places, c, false, r.blend.v == 1, at_x, at_y);
        if (r.blend.kept != 1)
            crease_lanes(&r.blend, at_x, at_y);
        put_lanes(&r, at_x, at_y, x + c, y + c, z + c);
    }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static void put_ring_avx2(const PointRing *ring, const MesoSweepPlaces *places,
                                                          float *x, float *y, float *z)
{
    put_ring(ring, places, x, y, z);
}
#endif

static void put_ring_plain(const PointRing *ring, const MesoSweepPlaces *places, float *x, float *y, float *z)
{
    put_ring(ring, places, x, y, z);
}

static PointRing point_ring(const MesoScene *scene, const MesoSweepTrack *track, float v)
{
    MesoSweepRing ring = meso_sweep_ring_at(scene, track, v);
    const float *size = track->sweep->size;
    return (PointRing){.origin = ring.plane.origin, .x = ring.plane.x, .y = ring.plane.y, .scale = scene->section_scale,
                       .sizes = {size[0], size[1]}, .middle = {track->middle[0], track->middle[1]},
                       .back = track->back, .blend = ring.blend, .radius = 1};
}

static PointRing cap_ring(const MesoScene *scene, const MesoSweepInstance *cap, float v)
{
    MesoSweepPlane plane = meso_sweep_cap_plane(scene, cap, v);
    return (PointRing){.origin = plane.origin, .x = plane.x, .y = plane.y, .scale = scene->section_scale,
                       .sizes = {cap->size[0], 0}, .blend = {.kept = 1}, .radius = 1 - v * v * v * v};
}

void meso_sweep_points(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                       const MesoSweepPlaces *places, uint32_t ring_count, float *x, float *y, float *z)
{
    void (*put)(const PointRing *, const MesoSweepPlaces *, float *, float *, float *) = put_ring_plain;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2"))
        put = put_ring_avx2;
#endif
    assert(scene->deform == MESO_SWEEP_CURVES);
    MesoSweepTrack track;
    if (!kind->cap)
        track = meso_sweep_track(scene, kind, sweep);
    for (uint32_t r = 0; r < ring_count; r++) {
        float v = (float)r / (float)(ring_count - 1);
        PointRing ring = kind->cap ? cap_ring(scene, sweep, v) : point_ring(scene, &track, v);
        size_t at = (size_t)r * places->count;
        put(&ring, places, x + at, y + at, z + at);
    }
}
