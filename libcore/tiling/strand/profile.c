#include "libcore/tiling/strand/profile.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/grow.h"
#include "libcore/tiling/strand/column_thin.h"
#include "libcore/tiling/strand/contour_ring.h"

enum { MIN_CAP_DIVISIONS = 4 };

/*
 * A section that turns by less, in radians, is blended straight, which costs it at most two percent of its width.
 * Drawings that are not each other's image differ by as much, and sets align them so by their `turn`.
 */
static const double LEAST_TURN = 2 * MESO_PI / 16;

typedef struct Builder {
    const MesoTileSet *set;
    const MesoContourSet *contours;
    MesoArena *arena, *scratch;
    MesoProfileSet *out;
    MesoRing *rings;            /* [contour_count] */
    uint32_t *ring_begin;       /* [contour_count + 1] the points of all rings in one row */
    bool spread;                /* rings by parts of the contours, for columns to be chosen from */
    uint32_t divisions;
    uint32_t column_capacity, kind_capacity;
    MesoColumnPlace *places;    /* [column_count of the profiles] */
} Builder;

/* ---- pairing of contours ---- */

static uint32_t contour_begin(const Builder *b, uint32_t section)
{
    return b->contours->section_begin[section];
}

static uint32_t contour_end(const Builder *b, uint32_t section)
{
    return b->contours->section_begin[section + 1];
}

/* The n-th contour of `section` that is (not) a hole, or MESO_NO_INDEX. */
static uint32_t nth_contour(const Builder *b, uint32_t section, bool hole, uint32_t n)
{
    for (uint32_t c = contour_begin(b, section); c < contour_end(b, section); c++)
        if (b->contours->contours[c].hole == hole && n-- == 0)
            return c;
    return MESO_NO_INDEX;
}

/* Pair number `n` of the contours of two sections: outlines, then holes. False when there is none. */
static bool nth_pair(const Builder *b, uint32_t from, uint32_t to, uint32_t n, uint32_t pair[2])
{
    uint32_t outlines[2] = {0, 0}, sections[2] = {from, to};
    for (int k = 0; k < 2; k++)
        for (uint32_t c = contour_begin(b, sections[k]); c < contour_end(b, sections[k]); c++)
            outlines[k] += !b->contours->contours[c].hole;
    uint32_t outline_pairs = outlines[0] > outlines[1] ? outlines[0] : outlines[1];
    bool hole = n >= outline_pairs;
    for (int k = 0; k < 2; k++)
        pair[k] = nth_contour(b, sections[k], hole, hole ? n - outline_pairs : n);
    return pair[0] != MESO_NO_INDEX || pair[1] != MESO_NO_INDEX;
}

static bool is_hole(const Builder *b, const uint32_t pair[2])
{
    return b->contours->contours[pair[0] != MESO_NO_INDEX ? pair[0] : pair[1]].hole;
}

/* Joins the contours that sweeps pair, and gives every class the count of its largest. */
static MesoStatus make_rings(Builder *b, MesoError *error)
{
    uint32_t count = b->contours->contour_count;
    uint32_t *parent = MESO_NEW(b->scratch, uint32_t, count, error);
    uint32_t *most = MESO_NEW(b->scratch, uint32_t, count, error);
    b->rings = MESO_NEW(b->scratch, MesoRing, count, error);
    b->ring_begin = MESO_NEW(b->scratch, uint32_t, (size_t)count + 1, error);
    if (!parent || !most || !b->rings || !b->ring_begin)
        return MESO_ERR_MEMORY;
    meso_sets_init(parent, count);
    for (uint32_t s = 0; s < b->set->sweep_count; s++) {
        uint32_t pair[2];
        const MesoSweep *sweep = &b->set->sweeps[s];
        for (uint32_t n = 0; nth_pair(b, sweep->from_section, sweep->to_section, n, pair); n++)
            if (pair[0] != MESO_NO_INDEX && pair[1] != MESO_NO_INDEX)
                meso_sets_join(parent, pair[0], pair[1]);
    }
    for (uint32_t c = 0; c < count; c++) {
        uint32_t root = meso_sets_root(parent, c), own = b->contours->contours[c].point_count;
        most[root] = most[root] > own ? most[root] : own;
    }
    MesoStatus status = MESO_OK;
    for (uint32_t c = 0; c < count && !status; c++) {
        const MesoContour *contour = &b->contours->contours[c];
        status = (b->spread ? meso_ring_spread : meso_ring_resample)(
            &b->rings[c], b->scratch, b->contours->points + contour->point_begin, contour->point_count,
            most[meso_sets_root(parent, c)], error);
        b->ring_begin[c + 1] = b->ring_begin[c] + b->rings[c].count;
    }
    return status;
}

/* ---- columns ---- */

/* A ring as one end of a sweep walks it: which point at step k, in the sweep's own plane. */
typedef struct Walk {
    const MesoRing *ring;       /* NULL: all in one point */
    MesoVec2 point;         /* that one */
    float x_sign;
    bool backwards;
    uint32_t shift;
} Walk;

/* The plane has x along cross(up, tangent): against the drawing's x at the start, with it at the end. */
static Walk walk_start(const MesoRing *ring, bool flipped)
{
    return (Walk){ring, {0, 0}, flipped ? 1.0f : -1.0f, flipped, 0};
}

static Walk walk_end(const MesoRing *ring, const MesoSweep *sweep, bool start_flipped, bool end_flipped,
                     uint32_t count)
{
    double phase = (start_flipped != end_flipped ? 0.5 : 0) + (sweep->half_turn ? 0 : 0.5) + (double)sweep->turn;
    phase -= floor(phase);
    return (Walk){ring, {0, 0}, end_flipped ? -1.0f : 1.0f, !end_flipped,
                  (uint32_t)lround(phase * count) % count};
}

static uint32_t walk_index(const Walk *walk, uint32_t k)
{
    uint32_t n = walk->ring->count;
    uint32_t i = walk->backwards ? n - 1 - k % n : k % n;
    return (i + walk->shift) % n;
}

static MesoVec2 walk_point(const Walk *walk, uint32_t k)
{
    if (!walk->ring)
        return walk->point;
    MesoVec2 p = walk->ring->points[walk_index(walk, k)];
    return (MesoVec2){walk->x_sign * p.x, p.y};
}

static bool walk_creased(const Walk *walk, uint32_t k)
{
    return walk->ring && walk->ring->creased[walk_index(walk, k)];
}

/*
 * Outward normal of the chord from step `from` to step `to`, as long as the
 * chord: the one of an interpolated profile is then the interpolated one.
 */
static MesoVec2 walk_normal(const Walk *walk, uint32_t from, uint32_t to)
{
    MesoVec2 chord = meso_vec2_sub(walk_point(walk, to), walk_point(walk, from));
    return (MesoVec2){-chord.y, chord.x};   /* walks run clockwise */
}

static MesoVec2 walk_middle(const Walk *walk)
{
    double x = 0, y = 0;
    for (uint32_t k = 0; k < walk->ring->count; k++) {
        x += (double)walk_point(walk, k).x;
        y += (double)walk_point(walk, k).y;
    }
    return (MesoVec2){(float)(x / walk->ring->count), (float)(y / walk->ring->count)};
}

/* ---- turns ---- */

/* How the profiles of a sweep turn, as its kind has it. */
typedef struct Turn {
    float angle;
    MesoVec2 middle[2];
} Turn;

/*
 * The turn about both middles that takes the one walk nearest to the other, from X to Y. Walks are aligned to whole
 * points, so that less than one says nothing: straight tubes stay as they are.
 */
static Turn find_turn(const Walk *start, const Walk *end, bool mirrored)
{
    double cross = 0, dot = 0;
    uint32_t count = start->ring->count;
    Turn turn = {0, {walk_middle(start), walk_middle(end)}};
    for (uint32_t k = 0; k < count; k++) {
        MesoVec2 a = meso_vec2_sub(walk_point(start, k), turn.middle[0]);
        MesoVec2 b = meso_vec2_sub(walk_point(end, k), turn.middle[1]);
        cross += (double)meso_vec2_cross(a, b);
        dot += (double)a.x * (double)b.x + (double)a.y * (double)b.y;
    }
    double angle = atan2(cross, dot), point = 2 * MESO_PI / count;
    if (fabs(angle) < fmax(LEAST_TURN, 1.01 * point))
        return (Turn){0};
    if (fabs(angle) > MESO_PI - 1e-3)   /* half a turn: the side says which way, and mirrors turn the other way */
        angle = mirrored ? -MESO_PI : MESO_PI;
    turn.angle = (float)angle;
    return turn;
}

/* Whole turns more, the other way in mirrors. */
static Turn add_turns(Turn turn, const MesoSweep *sweep, bool mirrored, const Walk *start, const Walk *end)
{
    if (sweep->turns == 0)
        return turn;
    if (turn.angle == 0)
        turn = (Turn){0, {walk_middle(start), walk_middle(end)}};
    turn.angle += (float)(2 * MESO_PI * (mirrored ? -sweep->turns : sweep->turns));
    return turn;
}

/* Which neighbours a column takes its normal from. */
typedef enum Facing { BOTH, PREVIOUS, NEXT } Facing;

static MesoVec2 own_normal(const Walk *walk, uint32_t k, Facing facing)
{
    uint32_t count = walk->ring->count;
    return walk_normal(walk, facing == NEXT ? k : k + count - 1, facing == PREVIOUS ? k : k + 1);
}

/*
 * An end is round where its own ring is, so that it meets its neighbour's, and as long as the chord that it speaks for,
 * so that the blend keeps to the chords. One in a point goes by the other end.
 */
static MesoVec2 end_normal(const Walk *walk, uint32_t k, Facing facing)
{
    uint32_t count = walk->ring->count;
    MesoVec2 own = own_normal(walk, k, facing);
    if (facing == BOTH || walk_creased(walk, k))
        return own;
    MesoVec2 both = walk_normal(walk, k + count - 1, k + 1);
    float length = meso_vec2_length(both);
    return length > 0 ? meso_vec2_scale(both, meso_vec2_length(own) / length) : own;
}

/*
 * Of a section that turns: whether the chord from point k on is reversed on the way, seen in the frame that turns
 * along. It turns inside out where its neighbours may not, and has normals of its own.
 */
static bool is_reversed(const Walk *start, const Walk *end, uint32_t k, float angle)
{
    if (angle == 0)
        return false;
    MesoVec2 a = walk_normal(start, k, k + 1), b = walk_normal(end, k, k + 1);
    float c = cosf(angle), s = sinf(angle);
    return a.x * (c * b.x + s * b.y) + a.y * (c * b.y - s * b.x) <= 0;
}

/* One of a reversed chord alone lies across it between the ends, however round these are. */
static MesoSweepColumn make_column(const Walk *start, const Walk *end, uint32_t k, uint32_t count, Facing facing,
                                   float angle)
{
    MesoSweepColumn column = {.start = walk_point(start, k), .end = walk_point(end, k),
                              .start_normal = end_normal(start->ring ? start : end, k, facing),
                              .end_normal = end_normal(end->ring ? end : start, k, facing),
                              .u = (float)k / (float)count, .joins_next = facing != PREVIOUS && k < count};
    if (facing != BOTH && start->ring && end->ring &&
        is_reversed(start, end, facing == NEXT ? k : k + count - 1, angle)) {
        column.own = 1;
        column.own_normals[0] = own_normal(start, k, facing);
        column.own_normals[1] = own_normal(end, k, facing);
    }
    return column;
}

static uint32_t place_of(const Builder *b, const Walk *walk, uint32_t k)
{
    return walk->ring ? b->ring_begin[walk->ring - b->rings] + walk_index(walk, k) : MESO_NO_INDEX;
}

static MesoStatus push_column(Builder *b, MesoSweepColumn column, MesoColumnPlace place, MesoError *error)
{
    MesoProfileSet *out = b->out;
    uint32_t capacity = b->column_capacity;
    out->columns = MESO_GROW(b->scratch, out->columns, out->column_count, b->column_capacity, 64, error);
    b->places = MESO_GROW(b->scratch, b->places, out->column_count, capacity, 64, error);
    if (!out->columns || !b->places)
        return MESO_ERR_MEMORY;
    b->places[out->column_count] = place;
    out->columns[out->column_count++] = column;
    return MESO_OK;
}

static MesoStatus push_columns(Builder *b, Walk start, Walk end, uint32_t count, float angle, MesoError *error)
{
    for (uint32_t k = 0; k <= count; k++) {
        bool creased = walk_creased(&start, k) || walk_creased(&end, k);
        bool doubled = creased || is_reversed(&start, &end, k + count - 1, angle) ||
                       is_reversed(&start, &end, k, angle);
        MesoColumnPlace place = {place_of(b, &start, k), place_of(b, &end, k), creased,
                                 {start.x_sign, end.x_sign}, doubled};
        MesoStatus status = MESO_OK;
        if (doubled && k > 0)
            status = push_column(b, make_column(&start, &end, k, count, PREVIOUS, angle), place, error);
        if (!status && (k < count || !doubled))
            status = push_column(b, make_column(&start, &end, k, count, doubled ? NEXT : BOTH, angle), place, error);
        if (status)
            return status;
    }
    return MESO_OK;
}

/* A kind with the columns of two walks; the materials are those of the sections. */
static MesoStatus push_kind(Builder *b, MesoKindOrigin origin, uint32_t divisions, Walk start, Walk end, Turn turn,
                            MesoError *error)
{
    MesoProfileSet *out = b->out;
    uint32_t count = start.ring ? start.ring->count : end.ring->count;
    if (!start.ring)
        start.point = walk_middle(&end);
    if (!end.ring)
        end.point = walk_middle(&start);

    MesoSweptKind kind = {.column_begin = out->column_count, .joint_count = count, .division_count = divisions,
                          .start_material = origin.start_section, .end_material = origin.end_section,
                          .cap = origin.sweep == MESO_NO_INDEX, .turn = turn.angle,
                          .middle = {turn.middle[0], turn.middle[1]}};
    MesoStatus status = push_columns(b, start, end, count, turn.angle, error);
    if (status)
        return status;
    kind.column_count = out->column_count - kind.column_begin;
    uint32_t capacity = b->kind_capacity;
    out->kinds = MESO_GROW(b->scratch, out->kinds, out->kind_count, b->kind_capacity, 64, error);
    out->origins = MESO_GROW(b->scratch, out->origins, out->kind_count, capacity, 64, error);
    if (!out->kinds || !out->origins)
        return MESO_ERR_MEMORY;
    out->origins[out->kind_count] = origin;
    out->kinds[out->kind_count++] = kind;
    return MESO_OK;
}

/* ---- kinds ---- */

static const MesoRing *ring_or_none(const Builder *b, uint32_t contour)
{
    return contour == MESO_NO_INDEX ? NULL : &b->rings[contour];
}

static MesoStatus push_sweep(Builder *b, uint32_t tile, uint32_t sweep_index, bool mirrored, MesoError *error)
{
    const MesoTile *t = &b->set->tiles[tile];
    const MesoSweep *s = &b->set->sweeps[sweep_index];
    bool start_flipped = (t->labels[s->from_side] < 0) != mirrored;
    bool end_flipped = (t->labels[s->to_side] < 0) != mirrored;
    uint32_t pair[2], outline_count = 0;
    Turn turn = {0};

    for (uint32_t n = 0; nth_pair(b, s->from_section, s->to_section, n, pair); n++) {
        const MesoRing *from = ring_or_none(b, pair[0]), *to = ring_or_none(b, pair[1]);
        uint32_t count = from ? from->count : to->count;
        Walk start = walk_start(from, start_flipped), end = walk_end(to, s, start_flipped, end_flipped, count);
        MesoKindOrigin origin = {tile, sweep_index, s->from_side, s->to_side, s->from_section, s->to_section,
                                 mirrored, {0}};
        bool hole = is_hole(b, pair);
        outline_count += !hole;
        if (!hole && from && to)
            turn = add_turns(find_turn(&start, &end, mirrored), s, mirrored, &start, &end);
        else if (!hole || outline_count > 1)    /* nothing to turn, or not known with which outline */
            turn = (Turn){0};
        MesoStatus status = push_kind(b, origin, b->divisions, start, end, turn, error);
        if (status)
            return status;
    }
    return MESO_OK;
}

static bool section_is_swept(const MesoTileSet *set, const MesoTile *tile, uint32_t side, uint32_t section)
{
    for (uint32_t i = 0; i < tile->sweep_count; i++) {
        const MesoSweep *s = &set->sweeps[tile->sweep_begin + i];
        if ((s->from_side == side && s->from_section == section) ||
            (s->to_side == side && s->to_section == section))
            return true;
    }
    return false;
}

static MesoStatus push_caps(Builder *b, uint32_t tile, uint32_t side, bool mirrored, MesoError *error)
{
    const MesoTile *t = &b->set->tiles[tile];
    const MesoInterface *shown = &b->set->interfaces[meso_label_interface(t->labels[side])];
    uint32_t divisions = b->divisions / 4 < MIN_CAP_DIVISIONS ? MIN_CAP_DIVISIONS : b->divisions / 4;
    bool flipped = (t->labels[side] < 0) != mirrored;

    for (uint32_t i = 0; i < shown->section_count; i++) {
        uint32_t section = shown->section_begin + i;
        if (section_is_swept(b->set, t, side, section))
            continue;
        for (uint32_t c = contour_begin(b, section); c < contour_end(b, section); c++) {
            MesoKindOrigin origin = {tile, MESO_NO_INDEX, side, side, section, section, mirrored, {0}};
            Walk walk = walk_start(&b->rings[c], flipped);
            MesoStatus status = push_kind(b, origin, divisions, walk, walk, (Turn){0}, error);
            if (status)
                return status;
        }
    }
    return MESO_OK;
}

static MesoStatus push_tile(Builder *b, uint32_t tile, bool mirrored, MesoError *error)
{
    const MesoTile *t = &b->set->tiles[tile];
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < t->sweep_count && !status; i++)
        status = push_sweep(b, tile, t->sweep_begin + i, mirrored, error);
    for (uint32_t side = 0; side < t->side_count && !status; side++)
        if (t->labels[side])
            status = push_caps(b, tile, side, mirrored, error);
    return status;
}

static MesoStatus push_all(Builder *b, MesoError *error)
{
    MesoProfileSet *out = b->out;
    out->tile_kinds = MESO_NEW(b->arena, uint32_t, 2 * (size_t)b->set->tile_count + 1, error);
    if (!out->tile_kinds)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < b->set->tile_count; t++)
        for (uint32_t mirrored = 0; mirrored < 2; mirrored++) {
            out->tile_kinds[2 * t + mirrored] = out->kind_count;
            MesoStatus status = push_tile(b, t, mirrored, error);
            if (status)
                return status;
        }
    out->tile_kinds[2 * b->set->tile_count] = out->kind_count;
    return MESO_OK;
}

/* The growing arrays lie in scratch; the result gets copies of their final size. */
static MesoStatus keep(MesoProfileSet *out, MesoArena *arena, MesoError *error)
{
    MesoSweptKind *kinds = MESO_NEW(arena, MesoSweptKind, out->kind_count, error);
    MesoKindOrigin *origins = MESO_NEW(arena, MesoKindOrigin, out->kind_count, error);
    MesoSweepColumn *columns = MESO_NEW(arena, MesoSweepColumn, out->column_count, error);
    if (!kinds || !origins || !columns)
        return MESO_ERR_MEMORY;
    if (out->kind_count) {
        memcpy(kinds, out->kinds, out->kind_count * sizeof *kinds);
        memcpy(origins, out->origins, out->kind_count * sizeof *origins);
    }
    if (out->column_count)
        memcpy(columns, out->columns, out->column_count * sizeof *columns);
    out->kinds = kinds;
    out->origins = origins;
    out->columns = columns;
    return MESO_OK;
}

MesoStatus meso_profile_set_build(MesoProfileSet *profiles, MesoArena *arena, const MesoTileSet *set,
                                  const MesoContourSet *contours, uint32_t divisions, MesoColumnLimits limits,
                                  MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    *profiles = (MesoProfileSet){0};
    Builder builder = {.set = set, .contours = contours, .arena = arena, .scratch = &scratch,
                       .out = profiles, .divisions = divisions, .spread = limits.off > 0};
    MesoStatus status = make_rings(&builder, error);
    if (!status)
        status = push_all(&builder, error);
    if (!status && limits.off > 0)
        status = meso_columns_thin(profiles, builder.places, builder.rings, contours->contour_count, &scratch,
                                   limits, error);
    if (!status)
        status = keep(profiles, arena, error);
    meso_arena_release(&scratch);
    return status;
}
