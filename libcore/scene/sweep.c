#include "libcore/scene/sweep.h"

#include "libcore/math/bezier.h"
#include "libcore/scene/cell.h"

/* The plane of one ring, with lengths scaled from edge lengths to the scene. */
typedef struct Plane {
    MesoVec3 origin, x, y, tangent;
    float speed;    /* |B'| */
} Plane;

/*
 * X and Y span the plane across `tangent`. Where the up direction lies along
 * the tangent there is no such plane; any one across it will do.
 */
static Plane make_plane(MesoVec3 origin, MesoVec3 up, MesoVec3 tangent, float speed)
{
    MesoVec3 axis = fabsf(tangent.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 fallback = meso_vec3_unit(meso_vec3_cross(axis, tangent), axis);
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(up, tangent), fallback);
    return (Plane){origin, x, meso_vec3_cross(tangent, x), tangent, speed};
}

/* ---- frames that turn least ---- */

/* X and T of the trajectory at one place. */
typedef struct Station {
    MesoVec3 point, x, tangent;
} Station;

/* The mirror image of `a` in the plane across `axis`. */
static MesoVec3 reflect(MesoVec3 a, MesoVec3 axis)
{
    float square = meso_vec3_dot(axis, axis);
    return square > 0 ? meso_vec3_mad(a, -2 * meso_vec3_dot(axis, a) / square, axis) : a;
}

static MesoVec3 tangent_at(const MesoSweepInstance *sweep, float v)
{
    if (v == 0 || v == 1)
        return sweep->direction[v == 1];
    return meso_vec3_unit(meso_bezier_derivative(sweep->p, v), sweep->direction[v > 0.5f]);
}

/* Double reflection: in the plane between both points, then in the one that takes the tangent there. */
static Station step_to(const Station *from, const MesoSweepInstance *sweep, float v)
{
    Station to = {.point = meso_bezier_point(sweep->p, v), .tangent = tangent_at(sweep, v)};
    MesoVec3 between = meso_vec3_sub(to.point, from->point);
    MesoVec3 x = reflect(from->x, between), tangent = reflect(from->tangent, between);
    x = reflect(x, meso_vec3_sub(to.tangent, tangent));
    to.x = meso_vec3_unit(meso_vec3_mad(x, -meso_vec3_dot(x, to.tangent), to.tangent), from->x);
    return to;
}

static Station first_station(const MesoSweepInstance *sweep)
{
    Plane start = make_plane(sweep->p[0], sweep->up[0], sweep->direction[0], 0);
    return (Station){start.origin, start.x, start.tangent};
}

static void make_stations(const MesoSweepInstance *sweep, Station stations[MESO_FRAME_STEPS + 1])
{
    stations[0] = first_station(sweep);
    for (uint32_t i = 0; i < MESO_FRAME_STEPS; i++)
        stations[i + 1] = step_to(&stations[i], sweep, (float)(i + 1) / MESO_FRAME_STEPS);
}

float meso_sweep_twist(const MesoSweepInstance *sweep)
{
    Station stations[MESO_FRAME_STEPS + 1];
    make_stations(sweep, stations);
    const Station *last = &stations[MESO_FRAME_STEPS];
    Plane end = make_plane(sweep->p[3], sweep->up[1], sweep->direction[1], 0);
    MesoVec3 y = meso_vec3_cross(last->tangent, last->x);
    return atan2f(meso_vec3_dot(end.x, y), meso_vec3_dot(end.x, last->x));
}

/* ---- planes along a trajectory ---- */

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
    MesoFrameRule rule;
    Station stations[MESO_FRAME_STEPS + 1];     /* of the rule that needs them */
    Angle back;             /* R(-turn) */
    MesoVec2 middle[2];     /* a', b' */
} Track;

static Track make_track(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep)
{
    Track track = {.kind = kind, .sweep = sweep, .rule = scene->frame_rule, .back = make_angle(-kind->turn),
                   .middle = {meso_vec2_scale(kind->middle[0], sweep->size[0]),
                              meso_vec2_scale(kind->middle[1], sweep->size[1])}};
    if (track.rule == MESO_FRAME_MINIMAL)
        make_stations(sweep, track.stations);
    return track;
}

static MesoVec3 least_turned_x(const Track *track, float v)
{
    uint32_t before = (uint32_t)(v * MESO_FRAME_STEPS);
    return step_to(&track->stations[before], track->sweep, v).x;
}

/* At the ends all comes from the ports alone: the neighbour computes the same floats. */
static Plane plane_at(const Track *track, float v)
{
    const MesoSweepInstance *sweep = track->sweep;
    if (v == 0 || v == 1) {
        uint32_t end = v == 1;
        float speed = 3 * meso_vec3_length(meso_vec3_sub(sweep->p[end ? 3 : 1], sweep->p[end ? 2 : 0]));
        return make_plane(sweep->p[end ? 3 : 0], sweep->up[end], sweep->direction[end], speed);
    }
    MesoVec3 derivative = meso_bezier_derivative(sweep->p, v), point = meso_bezier_point(sweep->p, v);
    MesoVec3 tangent = meso_vec3_unit(derivative, sweep->direction[v > 0.5f]);
    float speed = meso_vec3_length(derivative);
    if (track->rule == MESO_FRAME_PAPER)
        return make_plane(point, meso_vec3_lerp(sweep->up[0], sweep->up[1], v), tangent, speed);
    MesoVec3 x = least_turned_x(track, v);
    return (Plane){point, x, meso_vec3_cross(tangent, x), tangent, speed};
}

static MesoVec3 in_plane(const Plane *plane, MesoVec2 n)
{
    return (MesoVec3){n.x * plane->x.x + n.y * plane->y.x, n.x * plane->x.y + n.y * plane->y.y,
                      n.x * plane->x.z + n.y * plane->y.z};
}

static MesoMeshVertex sweep_vertex(const Plane *plane, MesoVec2 s, MesoVec3 normal, float scale,
                                   float u, float v)
{
    return (MesoMeshVertex){meso_vec3_mad(plane->origin, scale, in_plane(plane, s)),
                            meso_vec3_unit(normal, plane->x), {u, v}};
}

/* ---- tubes ---- */

/* A ring: how far along, and how far turned. */
typedef struct Ring {
    Plane plane;
    float v, w, tilt_scale;
    bool turns;
    bool on_side;           /* of a cell, where points lie on the grain */
    Angle turn, twist;
} Ring;

static Ring ring_at(const MesoScene *scene, const Track *track, float v)
{
    Ring ring = {.plane = plane_at(track, v), .v = v, .w = v * v * (3 - 2 * v)};
    float speed = ring.plane.speed;
    ring.tilt_scale = speed > 0 ? scene->section_scale * 6 * v * (1 - v) / speed : 0;
    ring.turns = (track->kind->turn != 0 || track->sweep->twist != 0) && v > 0 && v < 1;
    ring.on_side = scene->deform == MESO_SWEEP_SHAPE && (v == 0 || v == 1);
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

static MesoVec2 on_grain(MesoVec2 p)
{
    return (MesoVec2){meso_cell_round(p.x), meso_cell_round(p.y)};
}

static MesoMeshVertex tube_vertex(const MesoScene *scene, const Track *track, const Ring *ring,
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
    return place_vertex(scene, ring, column, m);
}

static inline MesoVec3 tube_point(const MesoScene *scene, const Track *track, const Ring *ring,
                                  const MesoSweepColumn *column)
{
    const MesoVec2 start = meso_vec2_scale(column->start, track->sweep->size[0]), none = {0, 0};
    const MesoVec2 end = meso_vec2_scale(column->end, track->sweep->size[1]);
    Meeting m = ring->turns ? meet_turned(track, ring, start, end, none, none) : meet(ring, start, end, none, none);
    MesoVec2 at = ring->on_side ? on_grain(m.at) : m.at;
    return meso_vec3_mad(ring->plane.origin, scene->section_scale, in_plane(&ring->plane, at));
}

/* A ring of a grid without what is not wanted; its vertices are where they are without that. */
static MesoMeshVertex *wanted_vertices(const MesoScene *scene, const Track *track, const Ring *ring,
                                       const MesoSweepGrid *grid, const uint8_t *wanted, MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = scene->columns + track->kind->column_begin;
    for (uint32_t c = 0; c < grid->column_count; c++)
        if (wanted[c])
            out[c] = tube_vertex(scene, track, ring, &columns[grid->columns ? grid->columns[c] : c]);
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
    bool plain = !ring->turns && !ring->on_side && track->sweep->size[0] == 1 && track->sweep->size[1] == 1;
    if (plain && !absent && !grid->columns && !grid->bare) {
        for (uint32_t c = 0; c < grid->column_count; c++)   /* most are so: nothing to decide in the loop */
            *out++ = place_vertex(scene, ring, &columns[c],
                                  meet(ring, columns[c].start, columns[c].end, columns[c].start_normal,
                                       columns[c].end_normal));
        return out;
    }
    for (uint32_t c = 0; c < grid->column_count; c++) {
        const MesoSweepColumn *column = &columns[grid->columns ? grid->columns[c] : c];
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
    EndRing end = {.scene = scene, .track = {.kind = kind, .sweep = sweep, .rule = scene->frame_rule}};
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
static Plane cap_plane(const MesoScene *scene, const MesoSweepInstance *cap, float v)
{
    Plane plane = make_plane(cap->p[0], cap->up[0], cap->direction[0], 0);
    float rise = scene->section_scale * (MESO_CAP_RISE * cap->size[0]);
    plane.origin = meso_vec3_mad(plane.origin, rise * v, plane.tangent);
    return plane;
}

static MesoMeshVertex cap_vertex(const MesoScene *scene, const MesoSweepInstance *cap, const Plane *plane,
                                 const MesoSweepColumn *column, float v)
{
    float rise = MESO_CAP_RISE * cap->size[0], radius = 1 - v * v * v * v;
    MesoVec2 at = meso_vec2_scale(column->start, cap->size[0]), n = column->start_normal;
    if (v == 0 && scene->deform == MESO_SWEEP_SHAPE)
        at = on_grain(at);
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
        Plane plane = cap_plane(scene, cap, v);
        for (uint32_t c = 0; c < grid->column_count; c++)
            *out++ = cap_vertex(scene, cap, &plane, &columns[grid->columns ? grid->columns[c] : c], v);
    }
    return out;
}

static MesoVec3 cap_point(const MesoScene *scene, const MesoSweepInstance *cap, const MesoSweepColumn *column, float v)
{
    Plane plane = cap_plane(scene, cap, v);
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

/* A row of faces from a ring between the ends to the next. */
static MesoMeshFace *inner_row(const MesoSweptKind *kind, const MesoSweepColumn *columns, uint32_t here, bool tip,
                               MesoMeshFace *out)
{
    uint32_t ahead = here + kind->column_count - kind->absent[2];
    bool last = false;      /* whether the column before joins this one */
    for (uint32_t c = 0; c < kind->column_count; c++) {
        if (!(columns[c].absent & MESO_ABSENT_BETWEEN)) {
            if (last)
                *out++ = (MesoMeshFace){{here - 1, ahead - 1, tip ? here : ahead, tip ? MESO_NO_INDEX : here}};
            here++;
            ahead++;
        }
        last = columns[c].joins_next;
    }
    return out;
}

/* From a row's one ring at `a` to its other at `b`, and on along both or one. */
static MesoMeshFace row_face(uint32_t a, uint32_t b, uint32_t b_ahead, uint32_t a_ahead)
{
    if (a_ahead == a)
        return (MesoMeshFace){{a, b, b_ahead, MESO_NO_INDEX}};
    if (b_ahead == b)
        return (MesoMeshFace){{a, b, a_ahead, MESO_NO_INDEX}};
    return (MesoMeshFace){{a, b, b_ahead, a_ahead}};
}

/* A row between the ring at an end, from `ring`, and one between, from `inner`; both walk on by their columns. */
static MesoMeshFace *end_row(const MesoSweptKind *kind, const MesoSweepColumn *columns, uint32_t ring, uint32_t inner,
                             bool end, MesoMeshFace *out)
{
    uint32_t absent = end ? MESO_ABSENT_END : MESO_ABSENT_START;
    for (uint32_t c = 1; c < kind->column_count; c++) {
        uint32_t ring_ahead = ring + !(columns[c].absent & absent);
        uint32_t inner_ahead = inner + !(columns[c].absent & MESO_ABSENT_BETWEEN);
        if (columns[c - 1].joins_next && (ring_ahead > ring || inner_ahead > inner))
            *out++ = end ? row_face(inner, ring, ring_ahead, inner_ahead)
                         : row_face(ring, inner, inner_ahead, ring_ahead);
        ring = ring_ahead;
        inner = inner_ahead;
    }
    return out;
}

static bool row_is_uneven(const MesoSweptKind *kind, bool end)
{
    return kind->absent[end] || kind->absent[2];
}

/* The rings run clockwise around the tangent: along, then around is counter-clockwise from outside. */
void meso_sweep_faces(const MesoScene *scene, const MesoSweptKind *kind, uint32_t base, MesoMeshFace *out)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t last = kind->division_count - 1, width = kind->column_count - kind->absent[2];
    uint32_t first = kind->column_count - kind->absent[0];
    for (uint32_t ring = 0; ring < last; ring++) {
        uint32_t here = ring == 0 ? base : base + first + (ring - 1) * width;
        if (ring == 0 && row_is_uneven(kind, false))
            out = end_row(kind, columns, base, base + first, false, out);
        else if (ring + 1 == last && row_is_uneven(kind, true))
            out = end_row(kind, columns, here + width, here, true, out);
        else
            out = inner_row(kind, columns, here, kind->cap && ring + 1 == last, out);
    }
}

uint64_t meso_sweep_vertex_count(const MesoSweptKind *kind)
{
    uint64_t between = (uint64_t)(kind->division_count - 2) * (kind->column_count - kind->absent[2]);
    return between + 2 * (uint64_t)kind->column_count - kind->absent[0] - kind->absent[1];
}

uint64_t meso_sweep_face_count(const MesoSweptKind *kind)
{
    return (uint64_t)kind->joint_count * (kind->division_count - 1) + kind->more_joints[0] + kind->more_joints[1];
}

uint64_t meso_sweep_triangle_count(const MesoSweptKind *kind)
{
    return 2 * meso_sweep_face_count(kind) - (kind->cap ? kind->joint_count : 0) - kind->fans[0] - kind->fans[1];
}

/* Joins of the columns that lack not all of the bits. */
static uint32_t count_joints(const MesoSweepColumn *columns, uint32_t count, uint32_t absent)
{
    uint32_t joints = 0;
    for (uint32_t c = 1; c < count; c++)
        joints += columns[c - 1].joins_next && (columns[c].absent & absent) != absent;
    return joints;
}

void meso_sweep_count(MesoSweptKind *kind, const MesoSweepColumn *columns)
{
    static const uint32_t bits[3] = {MESO_ABSENT_START, MESO_ABSENT_END, MESO_ABSENT_BETWEEN};
    uint32_t count = kind->column_count;
    for (uint32_t k = 0; k < 3; k++) {
        kind->absent[k] = 0;
        for (uint32_t c = 0; c < count; c++)
            kind->absent[k] += (columns[c].absent & bits[k]) != 0;
    }
    kind->joint_count = count_joints(columns, count, MESO_ABSENT_BETWEEN);
    for (uint32_t end = 0; end < 2; end++) {
        uint32_t both = 0, faces = count_joints(columns, count, bits[end] | MESO_ABSENT_BETWEEN);
        for (uint32_t c = 1; c < count; c++)
            both += columns[c - 1].joins_next && !(columns[c].absent & (bits[end] | MESO_ABSENT_BETWEEN));
        kind->more_joints[end] = faces - kind->joint_count;
        kind->fans[end] = faces - both;
    }
}
