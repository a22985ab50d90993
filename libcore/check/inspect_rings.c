/* Continuity from slot to slot: joints, and open rings with those that face them. */
#include <stdlib.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/index_map.h"
#include "libcore/check/inspect_tree.h"
#include "libcore/check/inspect_work.h"

/* Normals that differ by less are the same on either side: floats of unit length know 1e-5 degrees. */
#define SAME_ANGLE 0.001
/* Rings that face each other end in opposite directions, give or take 75 degrees. */
#define FACING_COSINE -0.25
/* What is torn apart lies beside the other, as where shells differ, give or take 30 degrees; straight ahead it lies no
 * further than half the ring's own size, beyond which there are the two sides of a hole. */
#define AHEAD_COSINE 0.5
#define AHEAD_SHARE 0.5
/* And not as far away as across half of what is in its slot. */
#define REACH_SHARE 0.5
/* A point is on a line that passes it by less than this share of its length. */
#define ON_LINE 1e-5

/* Leaves of rings that are asked for the one that a ring faces: where more are nearer, there is no telling. */
enum { MOST_FACING = 64 };

typedef struct Ring {
    uint32_t slot, first, count;    /* first of the open half-edges */
    MesoVec3d middle;               /* of the corners; a sum at first */
    MesoVec3d outward;              /* where the surface ends */
    MesoVec3d plane;                /* twice the area vector of the ring itself */
    MesoBox box;
    double reach;                   /* square of how far another one may be */
    uint32_t facing;                /* ring, or MESO_NO_INDEX */
    MesoInspectEnd end;
} Ring;

typedef struct Rings {
    MesoInspectWork *work;
    uint32_t count, half_count;
    Ring *rings;            /* [count] */
    uint32_t *halves;       /* [half_count] open ones, ascending */
    uint32_t *ring_of;      /* [half_count] */
    MesoInspectTree lines;  /* over the half-edges */
} Rings;

static double angle_between(MesoVec3 a, MesoVec3 b)
{
    MesoVec3d x = meso_vec3d(a), y = meso_vec3d(b);
    return atan2(meso_vec3d_length(meso_vec3d_cross(x, y)), meso_vec3d_dot(x, y)) * (180 / MESO_PI);
}

/* Between the normals of two corners, in degrees; 0 where one has none. */
static double corner_angle(const MesoInspectedMesh *mesh, uint32_t a, uint32_t b)
{
    uint32_t i = meso_inspect_normal_at(mesh, a), k = meso_inspect_normal_at(mesh, b);
    if (i == MESO_NO_INDEX || k == MESO_NO_INDEX)
        return 0;
    double angle = angle_between(mesh->normals[i], mesh->normals[k]);
    return isfinite(angle) ? angle : 0;
}

static void note_angle(MesoInspectWork *work, uint32_t half, uint32_t other, double angle)
{
    if (angle > SAME_ANGLE) {
        meso_inspect_note(work, MESO_FAULT_ANGLE, half / 3, angle);
        work->result->marks[other / 3] |= 1u << MESO_FAULT_ANGLE;
    }
}

void meso_inspect_joint(MesoInspectWork *work, uint32_t half, uint32_t other)
{
    const MesoInspectedMesh *mesh = work->mesh;
    bool same = work->places[half] == work->places[other];
    double begin = corner_angle(mesh, half, same ? other : meso_half_next(other));
    double end = corner_angle(mesh, meso_half_next(half), same ? meso_half_next(other) : other);
    work->result->slot_joints++;
    note_angle(work, half, other, fmax(begin, end));
}

static void measure_joints(MesoInspectWork *work)
{
    const MesoInspectedMesh *mesh = work->mesh;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        uint32_t mate = work->mates[h];
        if (mate >= MESO_MATE_OUT || h > mate || meso_inspect_slot(work, h) == meso_inspect_slot(work, mate))
            continue;
        meso_inspect_joint(work, h, mate);
    }
}

/* ---- rings ---- */

/* An end of an open half-edge. */
typedef struct RingEnd {
    uint32_t place, slot, open;
} RingEnd;

static int compare_ends(const void *a, const void *b)
{
    const RingEnd *x = a, *y = b;
    if (x->place != y->place)
        return x->place < y->place ? -1 : 1;
    if (x->slot != y->slot)
        return x->slot < y->slot ? -1 : 1;
    return x->open < y->open ? -1 : x->open > y->open;
}

/* Open half-edges of one slot that meet at a place are of one ring. */
static MesoStatus join_ends(Rings *rings, MesoError *error)
{
    MesoInspectWork *work = rings->work;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    size_t count = 2 * (size_t)rings->half_count;
    RingEnd *ends = MESO_NEW(work->scratch, RingEnd, count, error);
    if (!ends)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < rings->half_count; i++) {
        uint32_t half = rings->halves[i], slot = meso_inspect_slot(work, half);
        ends[2 * (size_t)i] = (RingEnd){work->places[half], slot, i};
        ends[2 * (size_t)i + 1] = (RingEnd){work->places[meso_half_next(half)], slot, i};
    }
    qsort(ends, count, sizeof *ends, compare_ends);
    meso_sets_init(rings->ring_of, rings->half_count);
    for (size_t i = 1; i < count; i++)
        if (ends[i].place == ends[i - 1].place && ends[i].slot == ends[i - 1].slot)
            meso_sets_join(rings->ring_of, ends[i].open, ends[i - 1].open);
    meso_arena_rewind(work->scratch, mark);
    for (uint32_t i = 0; i < rings->half_count; i++)
        rings->ring_of[i] = meso_sets_root(rings->ring_of, i);
    for (uint32_t i = 0; i < rings->half_count; i++)
        rings->ring_of[i] = rings->ring_of[i] == i ? rings->count++ : rings->ring_of[rings->ring_of[i]];
    return MESO_OK;
}

static MesoVec3d at(const Rings *rings, uint32_t half)
{
    return meso_vec3d(meso_inspect_corner(rings->work->mesh, half));
}

static MesoStatus describe_rings(Rings *rings, MesoError *error)
{
    rings->rings = MESO_NEW(rings->work->scratch, Ring, rings->count, error);
    if (!rings->rings)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < rings->half_count; i++) {
        uint32_t half = rings->halves[i];
        Ring *ring = &rings->rings[rings->ring_of[i]];
        MesoVec3d along = meso_vec3d_sub(at(rings, meso_half_next(half)), at(rings, half));
        MesoVec3d normal = meso_inspect_area(rings->work->mesh, half / 3);
        double length = meso_vec3d_length(normal);
        if (ring->count++ == 0) {
            ring->first = i;
            ring->facing = MESO_NO_INDEX;
            ring->box = meso_box_empty();
            ring->slot = meso_inspect_slot(rings->work, half);
            meso_inspect_note(rings->work, MESO_FAULT_OPEN, half / 3, 0);
        }
        rings->work->result->marks[half / 3] |= 1u << MESO_FAULT_OPEN;
        ring->middle = meso_vec3d_add(ring->middle, at(rings, half));
        meso_box_add(&ring->box, meso_inspect_corner(rings->work->mesh, half));
        meso_box_add(&ring->box, meso_inspect_corner(rings->work->mesh, meso_half_next(half)));
        MesoVec3d start = at(rings, rings->halves[ring->first]);
        ring->plane = meso_vec3d_add(ring->plane, meso_vec3d_cross(meso_vec3d_sub(at(rings, half), start), along));
        if (length > 0)
            ring->outward = meso_vec3d_mad(ring->outward, 1 / length, meso_vec3d_cross(along, normal));
    }
    for (uint32_t r = 0; r < rings->count; r++)
        rings->rings[r].middle = meso_vec3d_scale(rings->rings[r].middle, 1.0 / rings->rings[r].count);
    return MESO_OK;
}

static double box_width(const MesoBox *box)
{
    return meso_vec3d_length(meso_vec3d_sub(meso_vec3d(box->high), meso_vec3d(box->low)));
}

/* Across the ring, to the side where the surface ends: that of a tube which folds back there looks anywhere. */
static MesoVec3d across_ring(const Ring *ring)
{
    double side = meso_vec3d_dot(ring->plane, ring->outward);
    return side == 0 ? ring->outward : meso_vec3d_scale(ring->plane, side < 0 ? -1 : 1);
}

/* Where they end as they are drawn. */
static void find_ends(Rings *rings)
{
    static const MesoFault faults[] = {[MESO_END_BORDER] = MESO_FAULT_BORDER, [MESO_END_LID] = MESO_FAULT_LID};
    MesoInspectWork *work = rings->work;
    for (uint32_t r = 0; r < rings->count; r++) {
        Ring *ring = &rings->rings[r];
        ring->end = meso_inspect_end(work->mesh, ring->slot, ring->middle, across_ring(ring),
                                     box_width(&ring->box));
        if (ring->end != MESO_END_INSIDE)
            meso_inspect_note(work, faults[ring->end], rings->halves[ring->first] / 3, 0);
    }
    for (uint32_t i = 0; i < rings->half_count; i++) {
        MesoInspectEnd end = rings->rings[rings->ring_of[i]].end;
        if (end != MESO_END_INSIDE)
            work->result->marks[rings->halves[i] / 3] |= 1u << faults[end];
    }
}

static MesoStatus find_rings(Rings *rings, MesoError *error)
{
    MesoInspectWork *work = rings->work;
    rings->half_count = 0;
    rings->halves = MESO_NEW(work->scratch, uint32_t, work->result->open_edges, error);
    rings->ring_of = MESO_NEW(work->scratch, uint32_t, work->result->open_edges, error);
    if (!rings->halves || !rings->ring_of)
        return MESO_ERR_MEMORY;
    for (uint32_t h = 0; h < 3 * work->mesh->triangle_count; h++)
        if (work->mates[h] == MESO_MATE_NONE)
            rings->halves[rings->half_count++] = h;
    MesoStatus status = join_ends(rings, error);
    if (!status)
        status = describe_rings(rings, error);
    if (!status)
        find_ends(rings);
    return status;
}

/* ---- rings that face each other ---- */

/* How far a slot reaches is how far the other side of a torn joint may be. */
static MesoStatus measure_reach(Rings *rings, MesoError *error)
{
    const MesoInspectedMesh *mesh = rings->work->mesh;
    MesoIndexMap map = {0};
    MesoBox *boxes = MESO_NEW(rings->work->scratch, MesoBox, rings->count, error);
    if (!boxes)
        return MESO_ERR_MEMORY;
    uint32_t slot_count = 0;
    for (uint32_t r = 0; r < rings->count; r++) {
        uint32_t *number = meso_index_map_at(&map, rings->work->scratch, rings->rings[r].slot, error);
        if (!number)
            return MESO_ERR_MEMORY;
        if (*number == MESO_NO_INDEX) {
            boxes[slot_count] = meso_box_empty();
            *number = slot_count++;
        }
    }
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        uint32_t number = meso_index_map_find(&map, mesh->slots[h / 3]);
        if (number != MESO_NO_INDEX)
            meso_box_add(&boxes[number], meso_inspect_corner(mesh, h));
    }
    for (uint32_t r = 0; r < rings->count; r++) {
        const MesoBox *box = &boxes[meso_index_map_find(&map, rings->rings[r].slot)];
        rings->rings[r].reach = REACH_SHARE * box_width(box) * REACH_SHARE * box_width(box);
    }
    return MESO_OK;
}

typedef struct Facing {
    const Rings *rings;
    const Ring *asking;
} Facing;

static double facing_distance(void *context, uint32_t item)
{
    const Facing *facing = context;
    const Ring *a = facing->asking, *b = &facing->rings->rings[item];
    double lengths = meso_vec3d_length(a->outward) * meso_vec3d_length(b->outward);
    if (a->slot == b->slot || b->end != MESO_END_INSIDE ||
        !(meso_vec3d_dot(a->outward, b->outward) < FACING_COSINE * lengths))
        return INFINITY;
    MesoVec3d way = meso_vec3d_sub(b->middle, a->middle);
    double square = meso_vec3d_dot(way, way), ahead = fabs(meso_vec3d_dot(way, a->outward));
    double near = AHEAD_SHARE * box_width(&a->box);
    bool beside = ahead <= AHEAD_COSINE * meso_vec3d_length(a->outward) * sqrt(square);
    return beside || square <= near * near ? square : INFINITY;
}

static MesoStatus pair_rings(Rings *rings, MesoError *error)
{
    MesoInspectTree tree;
    MesoBox *boxes = MESO_NEW(rings->work->scratch, MesoBox, rings->count, error);
    uint32_t *nearest = MESO_NEW(rings->work->scratch, uint32_t, rings->count, error);
    uint32_t *slots = MESO_NEW(rings->work->scratch, uint32_t, rings->count, error);
    if (!boxes || !nearest || !slots)
        return MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < rings->count; r++) {
        MesoVec3 middle = meso_vec3d_narrow(rings->rings[r].middle);
        boxes[r] = (MesoBox){middle, middle};
        slots[r] = rings->rings[r].slot;
    }
    MesoStatus status = meso_inspect_tree_build(&tree, rings->work->scratch, boxes, slots, rings->count, error);
    if (status)
        return status;
    for (uint32_t r = 0; r < rings->count; r++) {
        nearest[r] = MESO_NO_INDEX;
        if (rings->rings[r].end != MESO_END_INSIDE)
            continue;
        Facing facing = {rings, &rings->rings[r]};
        MesoInspectAsking asking = {rings->rings[r].middle, MESO_NO_INDEX, slots[r], MOST_FACING};
        double square = rings->rings[r].reach;
        nearest[r] = meso_inspect_tree_nearest(&tree, &asking, &square, facing_distance, &facing);
    }
    for (uint32_t r = 0; r < rings->count; r++)
        if (nearest[r] != MESO_NO_INDEX && nearest[nearest[r]] == r)
            rings->rings[r].facing = nearest[r];
    return MESO_OK;
}

/* ---- gaps and T-joints ---- */

static MesoStatus build_lines(Rings *rings, MesoError *error)
{
    MesoBox *boxes = MESO_NEW(rings->work->scratch, MesoBox, rings->half_count, error);
    if (!boxes)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < rings->half_count; i++) {
        boxes[i] = meso_box_empty();
        meso_box_add(&boxes[i], meso_inspect_corner(rings->work->mesh, rings->halves[i]));
        meso_box_add(&boxes[i], meso_inspect_corner(rings->work->mesh, meso_half_next(rings->halves[i])));
    }
    return meso_inspect_tree_build(&rings->lines, rings->work->scratch, boxes, rings->ring_of, rings->half_count,
                                   error);
}

/* Where along an open half-edge, in [0,1], it is nearest to a point; and the square of how near that is. */
static double nearest_along(const Rings *rings, uint32_t open, MesoVec3d p, double *square)
{
    uint32_t half = rings->halves[open];
    MesoVec3d a = at(rings, half), along = meso_vec3d_sub(at(rings, meso_half_next(half)), a);
    double length = meso_vec3d_dot(along, along);
    double t = length > 0 ? meso_vec3d_dot(meso_vec3d_sub(p, a), along) / length : 0;
    t = fmin(fmax(t, 0), 1);
    MesoVec3d way = meso_vec3d_sub(p, meso_vec3d_mad(a, t, along));
    *square = meso_vec3d_dot(way, way);
    return t;
}

typedef struct ToRing {
    const Rings *rings;
    uint32_t ring;          /* whose lines are asked */
    MesoVec3d point;
} ToRing;

static double line_distance(void *context, uint32_t item)
{
    const ToRing *to = context;
    double square;
    if (to->rings->ring_of[item] != to->ring)
        return INFINITY;
    nearest_along(to->rings, item, to->point, &square);
    return square;
}

/* From an end of an open half-edge to the ring that its own one faces. */
static void measure_end(Rings *rings, uint32_t open, uint32_t corner)
{
    uint32_t ring = rings->ring_of[open], facing = rings->rings[ring].facing;
    ToRing to = {rings, facing, at(rings, corner)};
    MesoInspectAsking asking = {to.point, facing, MESO_NO_INDEX, 0};
    double square = INFINITY;
    uint32_t line = meso_inspect_tree_nearest(&rings->lines, &asking, &square, line_distance, &to);
    if (line == MESO_NO_INDEX)
        return;
    MesoFinding *gap = &rings->work->result->findings[MESO_FAULT_GAP];
    if (gap->triangle == MESO_NO_INDEX || sqrt(square) > gap->worst) {
        gap->worst = sqrt(square);
        gap->triangle = corner / 3;
    }
}

static void measure_gaps(Rings *rings)
{
    MesoInspection *result = rings->work->result;
    for (uint32_t r = 0; r < rings->count; r++)
        result->facing_rings += rings->rings[r].facing != MESO_NO_INDEX;
    result->findings[MESO_FAULT_GAP].count = result->facing_rings;
    for (uint32_t i = 0; i < rings->half_count; i++) {
        if (rings->rings[rings->ring_of[i]].facing == MESO_NO_INDEX)
            continue;
        result->marks[rings->halves[i] / 3] |= 1u << MESO_FAULT_GAP;
        measure_end(rings, i, rings->halves[i]);
        measure_end(rings, i, meso_half_next(rings->halves[i]));
    }
}

typedef struct OnLines {
    const Rings *rings;
    uint32_t place;         /* of the point */
    MesoVec3d point;
    bool found;
} OnLines;

/* Within a line, off its ends, and not more than rounding away from it. */
static void visit_lines(void *context, uint32_t leaf)
{
    OnLines *on = context;
    const Rings *rings = on->rings;
    for (uint32_t i = MESO_INSPECT_LEAF * leaf; i < meso_inspect_leaf_end(&rings->lines, leaf); i++) {
        uint32_t open = rings->lines.order[i], half = rings->halves[open];
        MesoVec3d along = meso_vec3d_sub(at(rings, meso_half_next(half)), at(rings, half));
        double square, t = nearest_along(rings, open, on->point, &square);
        bool apart = rings->work->places[half] != on->place &&
                     rings->work->places[meso_half_next(half)] != on->place;
        on->found |= apart && t > 0 && t < 1 && square <= ON_LINE * ON_LINE * meso_vec3d_dot(along, along);
    }
}

static bool is_within_line(const Rings *rings, uint32_t half, float reach)
{
    OnLines on = {.rings = rings, .place = rings->work->places[half], .point = at(rings, half)};
    MesoBox around = meso_box_empty();
    meso_box_add_around(&around, meso_inspect_corner(rings->work->mesh, half), reach);
    meso_inspect_tree_meet(&rings->lines, around, MESO_NO_INDEX, 0, visit_lines, &on);
    return on.found;
}

/* Any number of lines may end at a place: it is asked for once. */
static MesoStatus find_t_joints(Rings *rings, MesoError *error)
{
    enum { UNTOLD, APART, WITHIN };
    const MesoBox *all = &rings->work->result->box;
    float wide = fmaxf(all->high.x - all->low.x, fmaxf(all->high.y - all->low.y, all->high.z - all->low.z));
    uint8_t *told = MESO_NEW(rings->work->scratch, uint8_t, rings->work->place_count, error);
    for (uint32_t i = 0; told && i < rings->half_count; i++) {
        uint32_t half = rings->halves[i];
        uint8_t *place = &told[rings->work->places[half]];
        if (*place == UNTOLD)
            *place = is_within_line(rings, half, (float)ON_LINE * wide) ? WITHIN : APART;
        if (*place == WITHIN)
            meso_inspect_note(rings->work, MESO_FAULT_T_JOINT, half / 3, 0);
    }
    return told ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_inspect_rings(MesoInspectWork *work, MesoError *error)
{
    Rings rings = {.work = work};
    measure_joints(work);
    if (work->result->open_edges == 0)
        return MESO_OK;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    MesoStatus status = find_rings(&rings, error);
    if (!status)
        status = build_lines(&rings, error);
    if (!status && work->mesh->slots)
        status = measure_reach(&rings, error);
    if (!status && work->mesh->slots)
        status = pair_rings(&rings, error);
    if (status)
        return status;
    measure_gaps(&rings);
    status = find_t_joints(&rings, error);
    meso_arena_rewind(work->scratch, mark);
    return status;
}
