#include "libcore/scene/sweep.h"

#include <assert.h>

#include "libcore/math/bezier.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/sweep_ring.h"

/* ---- sections ---- */

MesoKindReach meso_sweep_kind_reach(const MesoScene *scene, const MesoSweptKind *kind)
{
    float start = 0, end = 0;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        const MesoSweepColumn *column = &scene->columns[kind->column_begin + c];
        float from = column->start.x * column->start.x + column->start.y * column->start.y;
        float to = column->end.x * column->end.x + column->end.y * column->end.y;
        start = from > start ? from : start;
        end = to > end ? to : end;
    }
    return (MesoKindReach){sqrtf(start), sqrtf(end)};
}

MesoSweepTrack meso_sweep_track(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep)
{
    bool creased = sweep->mitre >= MESO_CREASED;
    float reach = creased ? meso_sweep_reach(scene, sweep, meso_sweep_kind_reach(scene, kind)) : 0;
    return (MesoSweepTrack){.kind = kind, .sweep = sweep, .frames = meso_sweep_frames(scene->frame_rule, sweep),
                            .back = meso_sweep_angle(-kind->turn),
                            .middle = {meso_vec2_scale(kind->middle[0], sweep->size[0]),
                                       meso_vec2_scale(kind->middle[1], sweep->size[1])},
                            .reach = reach};
}

MesoSweepMeeting meso_sweep_meet_turned(const MesoSweepTrack *track, const MesoSweepBlend *blend,
                                        const MesoSweepLine *line)
{
    const MesoVec2 *middle = track->middle;
    MesoVec2 q0 = meso_vec2_sub(line->start, middle[0]);
    MesoVec2 q1 = meso_sweep_turned(meso_vec2_sub(line->end, middle[1]), track->back);
    MesoVec2 q = meso_sweep_turned(meso_vec2_lerp(q0, q1, blend->w), blend->turn);
    MesoVec2 end_normal = meso_sweep_turned(line->end_normal, track->back);
    MesoVec2 n = meso_sweep_turned(meso_vec2_lerp(line->start_normal, end_normal, blend->w), blend->turn);
    MesoVec2 change = meso_vec2_add(meso_vec2_sub(middle[1], middle[0]),
                                    meso_sweep_turned(meso_vec2_sub(q1, q0), blend->turn));
    MesoVec2 at = meso_vec2_add(meso_vec2_lerp(middle[0], middle[1], blend->w), q);
    float slope = change.x * n.x + change.y * n.y + track->kind->turn * meso_vec2_cross(q, n) +
                  track->sweep->twist * meso_vec2_cross(at, n);
    return (MesoSweepMeeting){meso_sweep_turned(at, blend->twist), meso_sweep_turned(n, blend->twist), slope};
}

/* Of the way to where rings meet: up to where sections may reach as they are, and what they never do. */
static const float CREASE_FROM = 0.2f, CREASE_TO = 0.75f;

/* Nearer to an end than that a crease is weaker, and not there at it. */
static const float CREASE_WITHIN = 1.0f / 16;

void meso_sweep_crease(MesoSweepBlend *blend, const MesoSweepTrack *track, MesoVec2 bend)
{
    const float room = CREASE_TO - CREASE_FROM;
    float length = meso_vec2_length(bend), reach = length * track->reach, over = (reach - CREASE_FROM) / room;
    blend->kept = 1;
    if (!(over > 0))
        return;
    blend->inwards = meso_vec2_scale(bend, 1 / length);
    float kept = (CREASE_FROM + room * over / (1 + over)) / reach;
    float left = fmaxf(1 - fminf(blend->v, 1 - blend->v) / CREASE_WITHIN, 0);
    blend->kept = kept + left * left * (1 - kept);
}

/* ---- vertices ---- */

static inline MesoVec3 in_plane(const MesoSweepPlane *plane, MesoVec2 n)
{
    return (MesoVec3){n.x * plane->x.x + n.y * plane->y.x, n.x * plane->x.y + n.y * plane->y.y,
                      n.x * plane->x.z + n.y * plane->y.z};
}

static inline MesoMeshVertex sweep_vertex(const MesoSweepPlane *plane, MesoVec2 s, MesoVec3 normal, float scale,
                                   float u, float v)
{
    return (MesoMeshVertex){meso_vec3_mad(plane->origin, scale, in_plane(plane, s)),
                            meso_vec3_unit(normal, plane->x), {u, v}};
}

/* ---- tubes ---- */

static void crease_ring(MesoSweepRing *ring, const MesoSweepTrack *track, const MesoSweepBeside *beside)
{
    ring->creased = true;
    meso_sweep_crease(&ring->blend, track,
                      meso_sweep_bend_between(&track->frames, &ring->plane, beside, ring->blend.v));
    for (uint32_t side = 0; side < 2; side++) {
        ring->beside[side] = meso_sweep_blend(track, beside->v[side]);
        meso_sweep_crease(&ring->beside[side], track,
                          meso_sweep_bend(&track->frames, &beside->planes[side], beside->v[side]));
    }
}

MesoSweepRing meso_sweep_ring_at(const MesoScene *scene, const MesoSweepTrack *track, float v)
{
    MesoSweepRing ring = {.plane = meso_sweep_plane(&track->frames, v), .blend = meso_sweep_blend(track, v)};
    float speed = ring.plane.speed;
    ring.tilt_scale = speed > 0 ? scene->section_scale * 6 * v * (1 - v) / speed : 0;
    ring.on_side = scene->deform == MESO_SWEEP_SHAPE && (v == 0 || v == 1);
    ring.mitred = track->sweep->mitre > 0 && v > 0 && v < 1;
    if (!ring.mitred)
        return ring;
    MesoSweepBeside beside = meso_sweep_beside(&track->frames, v);
    ring.change = meso_sweep_plane_change(&track->frames, &beside, v);
    if (track->sweep->mitre >= MESO_CREASED)
        crease_ring(&ring, track, &beside);
    return ring;
}

static inline MesoMeshVertex place_vertex(const MesoScene *scene, const MesoSweepRing *ring, const MesoSweepColumn *column,
                                          MesoSweepMeeting m)
{
    MesoVec3 normal = meso_vec3_mad(in_plane(&ring->plane, m.normal), -ring->tilt_scale * m.slope, ring->plane.tangent);
    return sweep_vertex(&ring->plane, m.at, normal, scene->section_scale, column->u, ring->blend.v);
}

/* Of the trajectory's speed: a line that is slower, or runs backwards, has ever more n for its normal. */
static const float LEAST_FORWARDS = 0.05f;

/* How far from an end frames are taken to turn about T as they do; nearer, ever less. */
static const float SPIN_FROM = 0.125f;

/* How fast they do where there is a crease: not at the ends, so that normals go on there, which the neighbours have. */
static float spin_of(const MesoSweepRing *ring)
{
    if (!ring->creased)
        return 0;
    float nearer = fminf(ring->blend.v, 1 - ring->blend.v);
    return fminf(nearer / SPIN_FROM, 1) * meso_vec3_dot(ring->change.x, ring->plane.y);
}

/*
 * The normal lies across the ring's line, as n does, and across the way of the point along the sweep; the slope of `m`
 * times `change` is dot(n, s').
 */
static MesoMeshVertex place_on_way(const MesoScene *scene, const MesoSweepRing *ring, const MesoSweepColumn *column,
                                   MesoSweepMeeting m, float change)
{
    const MesoSweepPlaneChange *plane = &ring->change;
    MesoVec3 n = in_plane(&ring->plane, m.normal);
    MesoVec3 turn = meso_vec3_mad(meso_vec3_scale(plane->x, m.at.x), m.at.y, plane->y);
    MesoVec3 way = meso_vec3_mad(plane->origin, scene->section_scale, turn);
    float forwards = meso_vec3_dot(way, ring->plane.tangent);
    float slope = m.slope + spin_of(ring) * meso_vec2_cross(m.at, m.normal);
    float across = meso_vec3_dot(plane->origin, n) + scene->section_scale * change * slope;
    float least = LEAST_FORWARDS * ring->plane.speed, tilt = forwards < least ? fmaxf(forwards, 0) / least : 1;
    MesoVec3 normal = meso_vec3_mad(meso_vec3_scale(n, fmaxf(forwards, least)), -tilt * across, ring->plane.tangent);
    return sweep_vertex(&ring->plane, m.at, normal, scene->section_scale, column->u, ring->blend.v);
}

/* The normal of what a crease makes of a line with the normal n there. */
static MesoVec2 creased_normal(const MesoSweepBlend *blend, MesoVec2 s, MesoVec2 n)
{
    MesoVec2 b = blend->inwards;
    if (!meso_sweep_is_creased_at(blend, s))
        return n;
    return meso_vec2_add(meso_vec2_scale(n, blend->kept),
                         meso_vec2_scale(b, (1 - blend->kept) * (n.x * b.x + n.y * b.y)));
}

/* As that of a mitre, of the creased section, which changes as the crease does, too. */
static MesoMeshVertex place_creased(const MesoScene *scene, const MesoSweepTrack *track, const MesoSweepRing *ring,
                                    const MesoSweepColumn *column, const MesoSweepLine *line, MesoSweepMeeting m)
{
    const MesoSweepBlend *beside = ring->beside;
    MesoVec2 before = meso_sweep_creased(&beside[0], meso_sweep_place_on(track, &beside[0], line->start, line->end));
    MesoVec2 after = meso_sweep_creased(&beside[1], meso_sweep_place_on(track, &beside[1], line->start, line->end));
    MesoVec2 at = meso_sweep_creased(&ring->blend, m.at), n = creased_normal(&ring->blend, m.at, m.normal);
    MesoVec2 change = meso_vec2_scale(meso_vec2_sub(after, before), 1 / (beside[1].v - beside[0].v));
    float slope = change.x * n.x + change.y * n.y;
    return place_on_way(scene, ring, column, (MesoSweepMeeting){at, n, slope}, 1);
}

static MesoVec2 on_grain(MesoVec2 p)
{
    return (MesoVec2){meso_cell_round(p.x), meso_cell_round(p.y)};
}

static inline MesoMeshVertex tube_vertex(const MesoScene *scene, const MesoSweepTrack *track, const MesoSweepRing *ring,
                                         const MesoSweepColumn *column)
{
    MesoSweepLine line = meso_sweep_line(track->sweep, column, ring->blend.turns);
    MesoSweepMeeting m = meso_sweep_meet(track, &ring->blend, &line);
    if (ring->on_side)
        m.at = on_grain(m.at);
    if (ring->creased)
        return place_creased(scene, track, ring, column, &line, m);
    return ring->mitred ? place_on_way(scene, ring, column, m, 6 * ring->blend.v * (1 - ring->blend.v))
                        : place_vertex(scene, ring, column, m);
}

static inline MesoVec2 section_point(const MesoSweepTrack *track, const MesoSweepRing *ring, const MesoSweepColumn *column)
{
    const MesoVec2 start = meso_vec2_scale(column->start, track->sweep->size[0]);
    const MesoVec2 end = meso_vec2_scale(column->end, track->sweep->size[1]);
    MesoVec2 at = meso_sweep_place_on(track, &ring->blend, start, end);
    return ring->on_side ? on_grain(at) : meso_sweep_creased(&ring->blend, at);
}

static inline MesoVec3 tube_point(const MesoScene *scene, const MesoSweepTrack *track, const MesoSweepRing *ring,
                                  const MesoSweepColumn *column)
{
    MesoVec2 at = section_point(track, ring, column);
    return meso_vec3_mad(ring->plane.origin, scene->section_scale, in_plane(&ring->plane, at));
}

static inline const MesoSweepColumn *grid_column(const MesoSweepColumn *columns, const MesoSweepGrid *grid, uint32_t c)
{
    return grid->stand_ins ? &grid->stand_ins[c] : &columns[grid->columns ? grid->columns[c] : c];
}

/* A ring of a grid without what is not wanted; its vertices are where they are without that. */
static MesoMeshVertex *wanted_vertices(const MesoScene *scene, const MesoSweepTrack *track, const MesoSweepRing *ring,
                                       const MesoSweepGrid *grid, const uint8_t *wanted, MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = scene->columns + track->kind->column_begin;
    for (uint32_t c = 0; c < grid->column_count; c++)
        if (wanted[c])
            out[c] = tube_vertex(scene, track, ring, grid_column(columns, grid, c));
    return out + grid->column_count;
}

static bool any_wanted(const uint8_t *wanted, uint32_t count)
{
    uint8_t any = 0;
    for (uint32_t i = 0; i < count; i++)
        any |= wanted[i];
    return any != 0;
}

/* A ring of a grid whose columns with one of the bits `absent` have no vertex. */
static MesoMeshVertex *ring_vertices(const MesoScene *scene, const MesoSweepTrack *track, const MesoSweepRing *ring,
                                     const MesoSweepGrid *grid, uint32_t absent, MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = scene->columns + track->kind->column_begin;
    bool plain = !ring->blend.turns && !ring->on_side && !ring->mitred && track->sweep->size[0] == 1 &&
                 track->sweep->size[1] == 1;
    if (plain && !absent && !grid->columns && !grid->bare) {
        for (uint32_t c = 0; c < grid->column_count; c++)   /* most are so: nothing to decide in the loop */
            *out++ = place_vertex(scene, ring, &columns[c],
                                  meso_sweep_meet_straight(&ring->blend,
                                                           &(MesoSweepLine){columns[c].start, columns[c].end,
                                                                            columns[c].start_normal,
                                                                            columns[c].end_normal}));
        return out;
    }
    for (uint32_t c = 0; c < grid->column_count; c++) {
        const MesoSweepColumn *column = grid_column(columns, grid, c);
        if (column->absent & absent)
            continue;
        if (grid->bare)
            out++->position = tube_point(scene, track, ring, column);
        else
            *out++ = tube_vertex(scene, track, ring, column);
    }
    return out;
}

float meso_sweep_place(const MesoSweptKind *kind, const MesoSweepInstance *sweep, uint32_t ring)
{
    uint32_t last = kind->division_count - 1;
    if (ring == 0 || ring == last)
        return ring == last;
    float nearer = kind->bowed ? MESO_END_NEARER : 0;
    float t = ((float)ring - nearer) / ((float)last - 2 * nearer);
    if (sweep->steps.pace[0] == 0)
        return t;
    uint32_t part = (uint32_t)(t * MESO_PACE_PARTS);
    float from = part > 0 ? (float)sweep->steps.pace[part - 1] : 0;
    float to = part + 1 < MESO_PACE_PARTS ? (float)sweep->steps.pace[part] : 65536;
    return (from + (to - from) * (t * MESO_PACE_PARTS - (float)part)) / 65536;
}

static uint32_t absent_on(const MesoSweptKind *kind, const MesoSweepGrid *grid, uint32_t ring)
{
    if (!grid->own)
        return 0;
    if (ring > 0 && ring + 1 < grid->ring_count)
        return kind->absent[2] ? MESO_ABSENT_BETWEEN : 0;
    return ring == 0 ? (kind->absent[0] ? MESO_ABSENT_START : 0) : kind->absent[1] ? MESO_ABSENT_END : 0;
}

static MesoMeshVertex *tube_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                                     const MesoSweepGrid *grid, MesoMeshVertex *out)
{
    MesoSweepTrack track = meso_sweep_track(scene, kind, sweep);
    for (uint32_t r = 0; r < grid->ring_count; r++) {
        const uint8_t *wanted = grid->wanted ? grid->wanted + (size_t)r * grid->column_count : NULL;
        if (wanted && !any_wanted(wanted, grid->column_count)) {
            out += grid->column_count;
            continue;
        }
        float v = grid->own ? meso_sweep_place(kind, sweep, r) : (float)r / (float)(grid->ring_count - 1);
        MesoSweepRing ring = meso_sweep_ring_at(scene, &track, v);
        if (wanted) {
            out = wanted_vertices(scene, &track, &ring, grid, wanted, out);
            continue;
        }
        out = ring_vertices(scene, &track, &ring, grid, absent_on(kind, grid, r), out);
    }
    return out;
}

/* The whole ring at an end, of which the kind has no vertices for some columns. */
typedef struct EndRing {
    const MesoScene *scene;
    MesoSweepTrack track;
    MesoSweepRing ring;
} EndRing;

static EndRing end_ring(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep, float v)
{
    EndRing end = {.scene = scene, .track = meso_sweep_track(scene, kind, sweep)};
    end.ring = meso_sweep_ring_at(scene, &end.track, v);
    return end;
}

static MesoVec3 end_point(const EndRing *end, const MesoSweepColumn *column)
{
    MesoVec3 point = tube_point(end->scene, &end->track, &end->ring, column);
    return end->scene->deform == MESO_SWEEP_SHAPE ? meso_cell_point(&end->scene->cages[end->track.sweep->cage], point)
                                                  : point;
}

/*
 * Moves what lies between the ends of a column out of its bends. `parts` [count] says how far along each is from the
 * ring before to the one behind.
 */
static void bow_column(MesoMeshVertex *first, uint32_t stride, uint32_t count, const float *parts, MesoVec3 before,
                       MesoVec3 last)
{
    for (uint32_t i = 0; i < count; i++) {
        MesoVec3 *at = &first[(size_t)i * stride].position, here = *at;
        MesoVec3 next = i + 1 < count ? first[(size_t)(i + 1) * stride].position : last;
        MesoVec3 bend = meso_vec3_sub(meso_vec3_lerp(before, next, parts[i]), here);
        *at = meso_vec3_mad(here, -1.0f / 8, bend);
        before = here;
    }
}

static void find_parts(const MesoSweptKind *kind, const MesoSweepInstance *sweep, float *parts)
{
    float before = 0, here = meso_sweep_place(kind, sweep, 1);
    for (uint32_t r = 1; r + 1 < kind->division_count; r++) {
        float next = meso_sweep_place(kind, sweep, r + 1);
        parts[r - 1] = next > before ? (here - before) / (next - before) : 0.5f;
        before = here;
        here = next;
    }
}

static void bow_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                         MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t width = kind->column_count - kind->absent[2], between = kind->division_count - 2;
    MesoMeshVertex *start = out, *inner = out + kind->column_count - kind->absent[0];
    MesoMeshVertex *end = inner + (size_t)between * width;
    float parts[MESO_MOST_BOWED];
    EndRing whole[2];
    assert(kind->division_count <= MESO_MOST_BOWED);
    find_parts(kind, sweep, parts);
    for (uint32_t k = 0; k < 2; k++)
        if (kind->absent[k])
            whole[k] = end_ring(scene, kind, sweep, (float)k);
    for (uint32_t c = 0; c < kind->column_count; c++) {
        uint32_t absent = columns[c].absent;
        MesoMeshVertex *first = absent & MESO_ABSENT_START ? NULL : start++;
        MesoMeshVertex *last = absent & MESO_ABSENT_END ? NULL : end++;
        if (!(absent & MESO_ABSENT_BETWEEN))
            bow_column(inner++, width, between, parts, first ? first->position : end_point(&whole[0], &columns[c]),
                       last ? last->position : end_point(&whole[1], &columns[c]));
    }
}

/* Of the ring at v. */
MesoSweepPlane meso_sweep_cap_plane(const MesoScene *scene, const MesoSweepInstance *cap, float v)
{
    MesoSweepPlane plane = meso_sweep_plane_across(cap->p[0], cap->up[0], cap->direction[0], 0);
    float rise = scene->section_scale * (MESO_CAP_RISE * cap->size[0]);
    plane.origin = meso_vec3_mad(plane.origin, rise * v, plane.tangent);
    return plane;
}

/* Where a column meets the cap's end. */
static inline MesoVec2 cap_place(const MesoScene *scene, const MesoSweepInstance *cap, const MesoSweepColumn *column,
                                 float v)
{
    MesoVec2 at = meso_vec2_scale(column->start, cap->size[0]);
    return v == 0 && scene->deform == MESO_SWEEP_SHAPE ? on_grain(at) : at;
}

static MesoMeshVertex cap_vertex(const MesoScene *scene, const MesoSweepInstance *cap, const MesoSweepPlane *plane,
                                 const MesoSweepColumn *column, float v)
{
    float rise = MESO_CAP_RISE * cap->size[0], radius = 1 - v * v * v * v;
    MesoVec2 at = cap_place(scene, cap, column, v), n = column->start_normal;
    float lean = 4 * v * v * v * (at.x * n.x + at.y * n.y);
    MesoVec3 normal = meso_vec3_mad(meso_vec3_scale(in_plane(plane, n), rise), lean, plane->tangent);
    return sweep_vertex(plane, (MesoVec2){radius * at.x, radius * at.y}, normal, scene->section_scale, column->u, v);
}

static MesoMeshVertex *cap_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *cap,
                                    const MesoSweepGrid *grid, MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t last = grid->ring_count - 1;
    for (uint32_t ring = 0; ring <= last; ring++) {
        float v = (float)ring / (float)last;
        MesoSweepPlane plane = meso_sweep_cap_plane(scene, cap, v);
        float radius = 1 - v * v * v * v;
        for (uint32_t c = 0; c < grid->column_count && grid->bare; c++) {
            MesoVec2 at = cap_place(scene, cap, grid_column(columns, grid, c), v);
            MesoVec3 across = in_plane(&plane, (MesoVec2){radius * at.x, radius * at.y});
            out++->position = meso_vec3_mad(plane.origin, scene->section_scale, across);
        }
        for (uint32_t c = 0; c < grid->column_count && !grid->bare; c++)
            *out++ = cap_vertex(scene, cap, &plane, grid_column(columns, grid, c), v);
    }
    return out;
}

static MesoVec3 cap_point(const MesoScene *scene, const MesoSweepInstance *cap, const MesoSweepColumn *column, float v)
{
    MesoSweepPlane plane = meso_sweep_cap_plane(scene, cap, v);
    return cap_vertex(scene, cap, &plane, column, v).position;
}

static MesoVec3 single_point(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                             const MesoSweepColumn *column, float v)
{
    MesoSweepTrack track = meso_sweep_track(scene, kind, sweep);
    MesoSweepRing ring = meso_sweep_ring_at(scene, &track, v);
    return tube_vertex(scene, &track, &ring, column).position;
}

MesoVec3 meso_sweep_point(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                          const MesoSweepColumn *column, float v)
{
    MesoVec3 point = kind->cap ? cap_point(scene, sweep, column, v) : single_point(scene, kind, sweep, column, v);
    return scene->deform == MESO_SWEEP_SHAPE ? meso_cell_point(&scene->cages[sweep->cage], point) : point;
}

void meso_sweep_grid(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                     const MesoSweepGrid *given, MesoMeshVertex *out)
{
    MesoSweepGrid all = *given, *grid = &all;
    if (scene->deform != MESO_SWEEP_CURVES)     /* all vertices are bent together */
        all.wanted = NULL;
    MesoMeshVertex *end = (kind->cap ? cap_vertices : tube_vertices)(scene, kind, sweep, grid, out);
    if (scene->deform == MESO_SWEEP_SHAPE) {
        const MesoCage *cage = &scene->cages[sweep->cage];
        if (!grid->bare)
            meso_cell_bend(cage, out, (uint64_t)(end - out));
        for (MesoMeshVertex *v = out; grid->bare && v < end; v++)
            v->position = meso_cell_point(cage, v->position);
    }
    if (grid->own && kind->bowed)
        bow_vertices(scene, kind, sweep, out);
}

void meso_sweep_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                         MesoMeshVertex *out)
{
    const MesoSweepGrid whole = {.column_count = kind->column_count, .ring_count = kind->division_count,
                                 .own = true};
    meso_sweep_grid(scene, kind, sweep, &whole, out);
}
