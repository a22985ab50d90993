#include "libcore/scene/sweep.h"

#include "libcore/math/bezier.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/sweep_plane.h"

/* An angle, by its cosine and sine. */
typedef struct Angle {
    float c, s;
} Angle;

static Angle make_angle(float angle)
{
    return angle == 0 ? (Angle){1, 0} : (Angle){cosf(angle), sinf(angle)};
}

static MesoVec2 turned(MesoVec2 p, Angle angle)
{
    return (MesoVec2){angle.c * p.x - angle.s * p.y, angle.s * p.x + angle.c * p.y};
}

/* What the rings of one sweep share. */
typedef struct Track {
    const MesoSweptKind *kind;
    const MesoSweepInstance *sweep;
    MesoSweepFrames frames;
    Angle back;             /* R(-turn) */
    MesoVec2 middle[2];     /* a', b' */
} Track;

static Track make_track(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep)
{
    return (Track){.kind = kind, .sweep = sweep, .frames = meso_sweep_frames(scene->frame_rule, sweep),
                   .back = make_angle(-kind->turn),
                   .middle = {meso_vec2_scale(kind->middle[0], sweep->size[0]),
                              meso_vec2_scale(kind->middle[1], sweep->size[1])}};
}

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

/* A ring: how far along, and how far turned. */
typedef struct Ring {
    MesoSweepPlane plane;
    MesoSweepPlaneChange change;     /* where it is mitred */
    bool mitred;
    float v, w, tilt_scale;
    bool turns;
    bool on_side;           /* of a cell, where points lie on the grain */
    Angle turn, twist;
} Ring;

static Ring ring_at(const MesoScene *scene, const Track *track, float v)
{
    Ring ring = {.plane = meso_sweep_plane(&track->frames, v), .v = v, .w = v * v * (3 - 2 * v)};
    float speed = ring.plane.speed;
    ring.tilt_scale = speed > 0 ? scene->section_scale * 6 * v * (1 - v) / speed : 0;
    ring.turns = (track->kind->turn != 0 || track->sweep->twist != 0) && v > 0 && v < 1;
    ring.on_side = scene->deform == MESO_SWEEP_SHAPE && (v == 0 || v == 1);
    ring.mitred = track->sweep->mitre > 0 && v > 0 && v < 1;
    if (ring.mitred)
        ring.change = meso_sweep_plane_change(&track->frames, v);
    if (ring.turns) {
        ring.turn = make_angle(track->kind->turn * ring.w);
        ring.twist = make_angle(track->sweep->twist * ring.w);
    }
    return ring;
}

/* Where a ring meets a column, in its plane: s, n, and dot(n, s') without w'. */
typedef struct Meeting {
    MesoVec2 at, normal;
    float slope;
} Meeting;

static inline Meeting meet(const Ring *ring, MesoVec2 start, MesoVec2 end, MesoVec2 start_normal, MesoVec2 end_normal)
{
    MesoVec2 at = ring->v == 0 ? start : ring->v == 1 ? end : meso_vec2_lerp(start, end, ring->w);
    MesoVec2 n = meso_vec2_lerp(start_normal, end_normal, ring->w), change = meso_vec2_sub(end, start);
    return (Meeting){at, n, change.x * n.x + change.y * n.y};
}

static Meeting meet_turned(const Track *track, const Ring *ring, MesoVec2 start, MesoVec2 end, MesoVec2 start_normal,
                           MesoVec2 end_normal)
{
    const MesoVec2 *middle = track->middle;
    MesoVec2 q0 = meso_vec2_sub(start, middle[0]), q1 = turned(meso_vec2_sub(end, middle[1]), track->back);
    MesoVec2 q = turned(meso_vec2_lerp(q0, q1, ring->w), ring->turn);
    MesoVec2 n = turned(meso_vec2_lerp(start_normal, turned(end_normal, track->back), ring->w), ring->turn);
    MesoVec2 change = meso_vec2_add(meso_vec2_sub(middle[1], middle[0]), turned(meso_vec2_sub(q1, q0), ring->turn));
    MesoVec2 at = meso_vec2_add(meso_vec2_lerp(middle[0], middle[1], ring->w), q);
    float slope = change.x * n.x + change.y * n.y + track->kind->turn * meso_vec2_cross(q, n) +
                  track->sweep->twist * meso_vec2_cross(at, n);
    return (Meeting){turned(at, ring->twist), turned(n, ring->twist), slope};
}

static inline MesoMeshVertex place_vertex(const MesoScene *scene, const Ring *ring, const MesoSweepColumn *column,
                                          Meeting m)
{
    MesoVec3 normal = meso_vec3_mad(in_plane(&ring->plane, m.normal), -ring->tilt_scale * m.slope, ring->plane.tangent);
    return sweep_vertex(&ring->plane, m.at, normal, scene->section_scale, column->u, ring->v);
}

/* Of the trajectory's speed: a line that is slower, or runs backwards, has ever more n for its normal. */
static const float LEAST_FORWARDS = 0.05f;

/*
 * The normal lies across the ring's line, as n does, and across the way of the point along the sweep. That frames turn
 * about the trajectory is left out, as it is elsewhere: so that normals go on at the ends, which are the neighbours',
 * too.
 */
static MesoMeshVertex place_mitred(const MesoScene *scene, const Ring *ring, const MesoSweepColumn *column, Meeting m)
{
    float speed = ring->plane.speed, change = 6 * ring->v * (1 - ring->v);
    MesoVec3 n = in_plane(&ring->plane, m.normal);
    const MesoSweepPlaneChange *plane = &ring->change;
    MesoVec3 turn = meso_vec3_mad(meso_vec3_scale(plane->x, m.at.x), m.at.y, plane->y);
    MesoVec3 way = meso_vec3_mad(plane->origin, scene->section_scale, turn);
    float forwards = meso_vec3_dot(way, ring->plane.tangent);
    float across = meso_vec3_dot(plane->origin, n) + scene->section_scale * change * m.slope;
    float least = LEAST_FORWARDS * speed, tilt = forwards < least ? fmaxf(forwards, 0) / least : 1;
    MesoVec3 normal = meso_vec3_mad(meso_vec3_scale(n, fmaxf(forwards, least)), -tilt * across, ring->plane.tangent);
    return sweep_vertex(&ring->plane, m.at, normal, scene->section_scale, column->u, ring->v);
}

static MesoVec2 on_grain(MesoVec2 p)
{
    return (MesoVec2){meso_cell_round(p.x), meso_cell_round(p.y)};
}

static inline MesoMeshVertex tube_vertex(const MesoScene *scene, const Track *track, const Ring *ring,
                                  const MesoSweepColumn *column)
{
    const float *size = track->sweep->size;
    MesoVec2 start = meso_vec2_scale(column->start, size[0]), end = meso_vec2_scale(column->end, size[1]);
    MesoVec2 start_normal = meso_vec2_scale(column->start_normal, size[0]);
    MesoVec2 end_normal = meso_vec2_scale(column->end_normal, size[1]);
    Meeting m = ring->turns ? meet_turned(track, ring, start, end, start_normal, end_normal)
                            : meet(ring, start, end, start_normal, end_normal);
    if (ring->on_side)
        m.at = on_grain(m.at);
    return ring->mitred ? place_mitred(scene, ring, column, m) : place_vertex(scene, ring, column, m);
}

static inline MesoVec2 section_point(const Track *track, const Ring *ring, const MesoSweepColumn *column)
{
    const MesoVec2 start = meso_vec2_scale(column->start, track->sweep->size[0]), none = {0, 0};
    const MesoVec2 end = meso_vec2_scale(column->end, track->sweep->size[1]);
    Meeting m = ring->turns ? meet_turned(track, ring, start, end, none, none) : meet(ring, start, end, none, none);
    return ring->on_side ? on_grain(m.at) : m.at;
}

static inline MesoVec3 tube_point(const MesoScene *scene, const Track *track, const Ring *ring,
                                  const MesoSweepColumn *column)
{
    MesoVec2 at = section_point(track, ring, column);
    return meso_vec3_mad(ring->plane.origin, scene->section_scale, in_plane(&ring->plane, at));
}

/* ---- which mitre ---- */

enum { MITRE_PLACES = 16, MITRE_COLUMNS = 32, MITRE_LEVELS = 8 };

/* Of the trajectory's speed: how fast lines along a mitred sweep are to run forwards. */
static const float MITRE_FORWARDS = 0.1f;

/* The same backwards: what is left of a line that all but stands still between two places. */
static const float MITRE_BACKWARDS = 0.01f;

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

/*
 * Whether all bends are wider than that, as most sweeps' are, by the control points: no place is slower than the
 * slowest span along the way from end to end, and none bends more than the sharpest of their corners.
 */
static bool is_wide(const MesoSweepInstance *sweep, float radius)
{
    const float rounding = 0.99f;
    const MesoVec3 *p = sweep->p;
    MesoVec3 d0 = meso_vec3_sub(p[1], p[0]), d1 = meso_vec3_sub(p[2], p[1]), d2 = meso_vec3_sub(p[3], p[2]);
    MesoVec3 along = meso_vec3_unit(meso_vec3_sub(p[3], p[0]), (MesoVec3){0, 0, 0});
    MesoVec3 c0 = meso_vec3_sub(d1, d0), c1 = meso_vec3_sub(d2, d1);
    float bend = fmaxf(meso_vec3_dot(c0, c0), meso_vec3_dot(c1, c1));
    float slowest = fminf(fminf(meso_vec3_dot(d0, along), meso_vec3_dot(d1, along)), meso_vec3_dot(d2, along));
    return slowest > 0 && radius * 6 * sqrtf(bend) < rounding * 9 * slowest * slowest;
}

/* Whether some bend is narrower than the section reaches. */
static bool is_narrow(const MesoSweepInstance *sweep, float radius)
{
    for (uint32_t i = 0; i <= MITRE_PLACES; i++) {
        float v = (float)i / MITRE_PLACES;
        MesoVec3 first = meso_bezier_derivative(sweep->p, v);
        MesoVec3 bend = meso_vec3_cross(first, meso_bezier_second_derivative(sweep->p, v));
        float square = meso_vec3_dot(first, first);
        if (!(radius * radius * meso_vec3_dot(bend, bend) < square * square * square))
            return true;
    }
    return false;
}

/* Points of some lines along a sweep, in the planes of its rings, which a mitre turns and leaves what they are. */
typedef struct MitreLines {
    uint32_t count;
    MesoVec2 at[MITRE_PLACES + 1][MITRE_COLUMNS];
} MitreLines;

static MitreLines take_lines(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t step = (kind->column_count + MITRE_COLUMNS - 1) / MITRE_COLUMNS;
    Track track = make_track(scene, kind, sweep);
    MitreLines lines = {0};
    for (uint32_t i = 0; i <= MITRE_PLACES; i++) {
        Ring ring = ring_at(scene, &track, (float)i / MITRE_PLACES);
        lines.count = 0;
        for (uint32_t c = 0; c < kind->column_count; c += step)
            lines.at[i][lines.count++] = meso_vec2_scale(section_point(&track, &ring, &columns[c]),
                                                         scene->section_scale);
    }
    return lines;
}

/* Along a direction, from a point of one plane to one of another. */
typedef struct MitreStep {
    float origin, before_x, before_y, after_x, after_y;
} MitreStep;

static MitreStep step_between(const MesoSweepPlane *before, const MesoSweepPlane *after)
{
    MesoVec3 along = meso_vec3_unit(meso_vec3_add(before->tangent, after->tangent), before->tangent);
    return (MitreStep){meso_vec3_dot(meso_vec3_sub(after->origin, before->origin), along),
                       meso_vec3_dot(before->x, along), meso_vec3_dot(before->y, along),
                       meso_vec3_dot(after->x, along), meso_vec3_dot(after->y, along)};
}

/* How far lines go forwards at least, in parts of what the trajectory does; or less than `enough`, if it is that. */
static float least_forwards(const MesoScene *scene, const MesoSweepInstance *sweep, const MitreLines *lines,
                            float enough)
{
    float least = INFINITY;
    MesoSweepFrames frames = meso_sweep_frames(scene->frame_rule, sweep);
    MesoSweepPlane plane = meso_sweep_plane(&frames, 0);
    for (uint32_t i = 1; i <= MITRE_PLACES && least > enough; i++) {
        MesoSweepPlane next = meso_sweep_plane(&frames, (float)i / MITRE_PLACES);
        float length = meso_vec3_length(meso_vec3_sub(next.origin, plane.origin)), shortest = INFINITY;
        MitreStep step = step_between(&plane, &next);
        const MesoVec2 *before = lines->at[i - 1], *after = lines->at[i];
        for (uint32_t c = 0; c < lines->count; c++)
            shortest = fminf(shortest, step.origin + after[c].x * step.after_x + after[c].y * step.after_y -
                                           before[c].x * step.before_x - before[c].y * step.before_y);
        least = fminf(least, shortest / length);
        plane = next;
    }
    return least;
}

float meso_sweep_mitre(const MesoScene *scene, const MesoSweptKind *kind, MesoKindReach reach,
                       const MesoSweepInstance *sweep)
{
    float radius = scene->section_scale * fmaxf(sweep->size[0] * reach.start, sweep->size[1] * reach.end);
    if (is_wide(sweep, radius) || !is_narrow(sweep, radius))
        return 0;
    MesoSweepInstance trial = *sweep;
    trial.mitre = 0;
    MitreLines lines = take_lines(scene, kind, &trial);
    float best = 0, most = least_forwards(scene, &trial, &lines, -INFINITY);
    for (uint32_t i = 1; i <= MITRE_LEVELS && most < (best > 0 ? MITRE_FORWARDS : 0); i++) {
        trial.mitre = (float)i / MITRE_LEVELS;
        float least = least_forwards(scene, &trial, &lines, most);
        if (least > most) {
            most = least;
            best = trial.mitre;
        }
    }
    return most > -MITRE_BACKWARDS ? best : 0;
}

static inline const MesoSweepColumn *grid_column(const MesoSweepColumn *columns, const MesoSweepGrid *grid, uint32_t c)
{
    return grid->stand_ins ? &grid->stand_ins[c] : &columns[grid->columns ? grid->columns[c] : c];
}

/* A ring of a grid without what is not wanted; its vertices are where they are without that. */
static MesoMeshVertex *wanted_vertices(const MesoScene *scene, const Track *track, const Ring *ring,
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
static MesoMeshVertex *ring_vertices(const MesoScene *scene, const Track *track, const Ring *ring,
                                     const MesoSweepGrid *grid, uint32_t absent, MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = scene->columns + track->kind->column_begin;
    bool plain = !ring->turns && !ring->on_side && !ring->mitred && track->sweep->size[0] == 1 &&
                 track->sweep->size[1] == 1;
    if (plain && !absent && !grid->columns && !grid->bare) {
        for (uint32_t c = 0; c < grid->column_count; c++)   /* most are so: nothing to decide in the loop */
            *out++ = place_vertex(scene, ring, &columns[c],
                                  meet(ring, columns[c].start, columns[c].end, columns[c].start_normal,
                                       columns[c].end_normal));
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
    if (sweep->pace[0] == 0)
        return t;
    uint32_t part = (uint32_t)(t * MESO_PACE_PARTS);
    float from = part > 0 ? (float)sweep->pace[part - 1] : 0;
    float to = part + 1 < MESO_PACE_PARTS ? (float)sweep->pace[part] : 65536;
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
    Track track = make_track(scene, kind, sweep);
    for (uint32_t r = 0; r < grid->ring_count; r++) {
        const uint8_t *wanted = grid->wanted ? grid->wanted + (size_t)r * grid->column_count : NULL;
        if (wanted && !any_wanted(wanted, grid->column_count)) {
            out += grid->column_count;
            continue;
        }
        float v = grid->own ? meso_sweep_place(kind, sweep, r) : (float)r / (float)(grid->ring_count - 1);
        Ring ring = ring_at(scene, &track, v);
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
    Track track;
    Ring ring;
} EndRing;

static EndRing end_ring(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep, float v)
{
    EndRing end = {.scene = scene, .track = make_track(scene, kind, sweep)};
    end.ring = ring_at(scene, &end.track, v);
    return end;
}

static MesoVec3 end_point(const EndRing *end, const MesoSweepColumn *column)
{
    MesoVec3 point = tube_point(end->scene, &end->track, &end->ring, column);
    return end->scene->deform == MESO_SWEEP_SHAPE ? meso_cell_point(&end->scene->cages[end->track.sweep->cage], point)
                                                  : point;
}

/* Moves what lies between the ends of a column out of its bends. */
static void bow_column(MesoMeshVertex *first, uint32_t stride, uint32_t count, MesoVec3 before, MesoVec3 last)
{
    for (uint32_t i = 0; i < count; i++) {
        MesoVec3 *at = &first[(size_t)i * stride].position, here = *at;
        MesoVec3 next = i + 1 < count ? first[(size_t)(i + 1) * stride].position : last;
        MesoVec3 bend = meso_vec3_mad(meso_vec3_add(before, next), -2, here);
        *at = meso_vec3_mad(here, -1.0f / 16, bend);
        before = here;
    }
}

static void bow_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                         MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t width = kind->column_count - kind->absent[2], between = kind->division_count - 2;
    MesoMeshVertex *start = out, *inner = out + kind->column_count - kind->absent[0];
    MesoMeshVertex *end = inner + (size_t)between * width;
    EndRing whole[2];
    for (uint32_t k = 0; k < 2; k++)
        if (kind->absent[k])
            whole[k] = end_ring(scene, kind, sweep, (float)k);
    for (uint32_t c = 0; c < kind->column_count; c++) {
        uint32_t absent = columns[c].absent;
        MesoMeshVertex *first = absent & MESO_ABSENT_START ? NULL : start++;
        MesoMeshVertex *last = absent & MESO_ABSENT_END ? NULL : end++;
        if (!(absent & MESO_ABSENT_BETWEEN))
            bow_column(inner++, width, between, first ? first->position : end_point(&whole[0], &columns[c]),
                       last ? last->position : end_point(&whole[1], &columns[c]));
    }
}

/* Of the ring at v. */
static MesoSweepPlane cap_plane(const MesoScene *scene, const MesoSweepInstance *cap, float v)
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
        MesoSweepPlane plane = cap_plane(scene, cap, v);
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
    MesoSweepPlane plane = cap_plane(scene, cap, v);
    return cap_vertex(scene, cap, &plane, column, v).position;
}

static MesoVec3 single_point(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                             const MesoSweepColumn *column, float v)
{
    Track track = make_track(scene, kind, sweep);
    Ring ring = ring_at(scene, &track, v);
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
