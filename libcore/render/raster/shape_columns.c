#include "libcore/render/raster/shape_columns.h"

#include "libcore/scene/detail.h"

/* Columns while they are chosen; `kept` and `sides` have room for all of the kind's. */
typedef struct Choice {
    const MesoSweepColumn *columns;
    uint32_t *kept, count;
    MesoSweepColumn *stand_ins; /* [count] */
    bool moved;                 /* some stand-in is not the column itself */
    MesoColumnSide *sides;
    uint32_t side_count;
    bool closed;
    bool banded;
} Choice;

/* Of columns that lie in one place, where that is no corner. */
static const float SMOOTH_COSINE = 0.9f;

static bool is_met(const MesoSweepColumn *a, const MesoSweepColumn *b)
{
    return a->start.x == b->start.x && a->start.y == b->start.y && a->end.x == b->end.x && a->end.y == b->end.y;
}

/* ---- loops ---- */

/* Columns [begin, end) of those that detail keeps; closed: the last one lies where the first does. */
typedef struct Loop {
    uint32_t begin, end, side_count;
    bool closed;
} Loop;

/* Runs, each of which begins where the one before ended, as at a corner, up to the first of them or a gap. */
static Loop next_loop(const MesoSweepColumn *columns, const uint32_t *kept, uint32_t count, uint32_t begin)
{
    Loop loop = {.begin = begin, .end = begin};
    while (loop.end < count) {
        uint32_t last = loop.end++;
        if (last + 1 < count && columns[kept[last]].joins_next) {
            loop.side_count++;
            continue;
        }
        loop.closed = is_met(&columns[kept[begin]], &columns[kept[last]]);
        if (loop.closed || last + 1 == count || !is_met(&columns[kept[last]], &columns[kept[last + 1]]))
            break;
    }
    return loop;
}

/* ---- stand-ins ---- */

/*
 * How far columns between two lie outside of the chord, in the mean, at the start (x) and at the end (y): the area
 * between, by its length. They run clockwise.
 */
static MesoVec2 bulge_of(const MesoSweepColumn *columns, uint32_t first, uint32_t last)
{
    const MesoSweepColumn *a = &columns[first], *b = &columns[last];
    float start = 0, end = 0;
    for (uint32_t i = first + 1; i < last; i++) {
        const MesoSweepColumn *c = &columns[i], *d = &columns[i + 1];
        start += meso_vec2_cross(meso_vec2_sub(d->start, a->start), meso_vec2_sub(c->start, a->start));
        end += meso_vec2_cross(meso_vec2_sub(d->end, a->end), meso_vec2_sub(c->end, a->end));
    }
    float start_chord = meso_vec2_length(meso_vec2_sub(b->start, a->start));
    float end_chord = meso_vec2_length(meso_vec2_sub(b->end, a->end));
    return (MesoVec2){start_chord > 0 ? 0.5f * start / start_chord : 0, end_chord > 0 ? 0.5f * end / end_chord : 0};
}

static bool is_smooth(const MesoSweepColumn *a, const MesoSweepColumn *b)
{
    float together = meso_vec2_length(a->start_normal) * meso_vec2_length(b->start_normal);
    return a->start_normal.x * b->start_normal.x + a->start_normal.y * b->start_normal.y > SMOOTH_COSINE * together;
}

static MesoVec2 move_out(MesoVec2 p, MesoVec2 normal, float distance)
{
    float length = meso_vec2_length(normal);
    return length > 0 ? meso_vec2_add(p, meso_vec2_scale(normal, distance / length)) : p;
}

/* Of a loop's columns number i in `kept`: the one before, or MESO_NO_INDEX at a corner and an end. */
static uint32_t before(const Choice *c, const uint32_t *kept, const Loop *loop, uint32_t i)
{
    if (i > loop->begin && c->columns[kept[i - 1]].joins_next)
        return i - 1;
    uint32_t met = i > loop->begin ? i - 1 : loop->closed ? loop->end - 1 : i;
    return met > loop->begin && met != i && is_smooth(&c->columns[kept[met]], &c->columns[kept[i]]) ? met - 1
                                                                                                    : MESO_NO_INDEX;
}

/* What follows it. */
static uint32_t after(const Choice *c, const uint32_t *kept, const Loop *loop, uint32_t i)
{
    if (i + 1 < loop->end && c->columns[kept[i]].joins_next)
        return i + 1;
    uint32_t met = i + 1 < loop->end ? i + 1 : loop->closed ? loop->begin : i;
    return met + 1 < loop->end && met != i && is_smooth(&c->columns[kept[met]], &c->columns[kept[i]]) ? met + 1
                                                                                                      : MESO_NO_INDEX;
}

/*
 * Chords of a bend lie within it, and so a section of few is too thin. Moved by half of what bends are off their chords
 * in the mean, columns make a regular one as wide as its circle, seen from all sides in the mean, to a hundredth.
 */
static MesoSweepColumn stand_in(Choice *c, const uint32_t *kept, const Loop *loop, uint32_t i)
{
    MesoSweepColumn column = c->columns[kept[i]];
    uint32_t last = before(c, kept, loop, i), next = after(c, kept, loop, i);
    if (last == MESO_NO_INDEX || next == MESO_NO_INDEX)
        return column;
    MesoVec2 a = bulge_of(c->columns, kept[last], kept[last + 1]), b = bulge_of(c->columns, kept[next - 1], kept[next]);
    if (a.x == 0 && a.y == 0 && b.x == 0 && b.y == 0)
        return column;
    c->moved = true;
    column.start = move_out(column.start, column.start_normal, 0.25f * (a.x + b.x));
    column.end = move_out(column.end, column.end_normal, 0.25f * (a.y + b.y));
    return column;
}

static void add_column(Choice *c, uint32_t column, MesoSweepColumn stand_in)
{
    c->stand_ins[c->count] = stand_in;
    c->kept[c->count++] = column;
}

/* All of its columns; `merged`: those alone that lie where no other does. */
static void add_loop(Choice *c, const uint32_t *kept, const Loop *loop, bool merged)
{
    uint32_t first = c->count;
    for (uint32_t i = loop->begin; i < loop->end; i++) {
        bool joined = i > loop->begin && c->columns[kept[i - 1]].joins_next;
        bool again = merged && i > loop->begin && !joined;
        bool around = merged && loop->closed && i + 1 == loop->end && i > loop->begin;
        if (joined)
            c->sides[c->side_count++] = (MesoColumnSide){c->count - 1, around ? first : c->count};
        if (!again && !around)
            add_column(c, kept[i], stand_in(c, kept, loop, i));
    }
    c->closed = c->closed && loop->closed;
}

/* ---- bands ---- */

enum { FEW_SIDES = 5 };         /* four corners, and a side that is cut where the loop begins */

static float square_between(const MesoSweepColumn *a, const MesoSweepColumn *b)
{
    MesoVec2 d = meso_vec2_sub(b->start, a->start), e = meso_vec2_sub(b->end, a->end);
    return d.x * d.x + d.y * d.y + e.x * e.x + e.y * e.y;
}

/* How far `c` lies from `a` along (x) and to the left of (y) the way to `b`, at the start and at the end together. */
static MesoVec2 place_by(const MesoSweepColumn *a, const MesoSweepColumn *b, const MesoSweepColumn *c)
{
    MesoVec2 d = meso_vec2_sub(b->start, a->start), e = meso_vec2_sub(b->end, a->end);
    MesoVec2 p = meso_vec2_sub(c->start, a->start), q = meso_vec2_sub(c->end, a->end);
    return (MesoVec2){d.x * p.x + d.y * p.y + e.x * q.x + e.y * q.y, meso_vec2_cross(d, p) + meso_vec2_cross(e, q)};
}

/* The larger of what is between them at the start and at the end. */
static float between(const MesoSweepColumn *a, const MesoSweepColumn *b)
{
    return fmaxf(meso_vec2_length(meso_vec2_sub(a->start, b->start)), meso_vec2_length(meso_vec2_sub(a->end, b->end)));
}

static bool is_small(const Choice *c, const uint32_t *kept, const Loop *loop, float size)
{
    for (uint32_t i = loop->begin; i < loop->end; i++)
        if (between(&c->columns[kept[loop->begin]], &c->columns[kept[i]]) > size)
            return false;
    return true;
}

static void find_farthest(const Choice *c, const uint32_t *kept, const Loop *loop, uint32_t ends[2])
{
    float most = 0;
    ends[0] = ends[1] = kept[loop->begin];
    for (uint32_t i = loop->begin; i < loop->end; i++)
        for (uint32_t j = i + 1; j < loop->end; j++) {
            float square = square_between(&c->columns[kept[i]], &c->columns[kept[j]]);
            if (square <= most)
                continue;
            most = square;
            ends[0] = kept[i];
            ends[1] = kept[j];
        }
}

static void add_band(Choice *c, const uint32_t ends[2])
{
    c->sides[c->side_count++] = (MesoColumnSide){c->count, c->count + 1};
    add_column(c, ends[0], c->columns[ends[0]]);
    add_column(c, ends[1], c->columns[ends[1]]);
}

/*
 * From one column to the farthest, and between those farthest along directions turned from that: seen from any side,
 * two reach as far as a loop of four corners does, and no gap is between them, for they cross; three fall short of a
 * round one by a twentieth in the mean.
 */
static void add_bands(Choice *c, const uint32_t *kept, const Loop *loop)
{
    uint32_t across[2], bands = loop->side_count > FEW_SIDES ? 3 : 2;
    find_farthest(c, kept, loop, across);
    add_band(c, across);
    for (uint32_t k = 1; k < bands; k++) {
        float angle = (float)MESO_PI * (float)k / (float)bands, low = INFINITY, high = -INFINITY;
        uint32_t ends[2] = {across[0], across[0]};
        for (uint32_t i = loop->begin; i < loop->end; i++) {
            MesoVec2 at = place_by(&c->columns[across[0]], &c->columns[across[1]], &c->columns[kept[i]]);
            float place = cosf(angle) * at.x + sinf(angle) * at.y;
            if (place < low)
                ends[0] = kept[i];
            if (place > high)
                ends[1] = kept[i];
            low = fminf(low, place);
            high = fmaxf(high, place);
        }
        add_band(c, ends);
    }
    c->closed = false;
    c->banded = true;
}

/* ---- places ---- */

/* Behind the last, zero. */
static MesoStatus put_on_ring(MesoShapeColumns *out, const MesoSweepColumn *columns, MesoArena *arena, MesoError *error)
{
    size_t room = ((size_t)out->place_count + MESO_SWEEP_LANES - 1) / MESO_SWEEP_LANES * MESO_SWEEP_LANES;
    float *x = MESO_NEW(arena, float, 4 * room, error), *y = x + room;
    if (!x)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < out->place_count; i++) {
        uint32_t k = out->places[i];
        const MesoSweepColumn *column = out->stand_ins ? &out->stand_ins[k] : &columns[out->kept[k]];
        x[i] = column->start.x;
        y[i] = column->start.y;
        x[2 * room + i] = column->end.x;
        y[2 * room + i] = column->end.y;
    }
    out->on_ring = (MesoSweepPlaces){out->place_count, x, y, x + 2 * room, y + 2 * room};
    return MESO_OK;
}

/* Sides that follow one another share a place; others have both of theirs. */
static MesoStatus put_places(MesoShapeColumns *out, const MesoSweepColumn *columns, MesoArena *arena,
                             MesoError *error)
{
    uint32_t *places = MESO_NEW(arena, uint32_t, 2 * (size_t)out->side_count, error), count = 0;
    uint32_t *sides = MESO_NEW(arena, uint32_t, 2 * (size_t)out->side_count, error);
    uint8_t *joined = MESO_NEW(arena, uint8_t, 2 * (size_t)out->side_count, error);
    if (!places || !sides || !joined)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < out->side_count; s++) {
        if (count == 0 || places[count - 1] != out->sides[s].from)
            places[count++] = out->sides[s].from;
        sides[count - 1] = s;
        joined[count - 1] = 1;
        sides[count] = joined[count] = 0;
        places[count++] = out->sides[s].to;
    }
    out->place_count = count;
    out->places = places;
    out->place_sides = sides;
    out->joined = joined;
    return put_on_ring(out, columns, arena, error);
}

/* ---- all of them ---- */

MesoStatus meso_shape_columns(MesoShapeColumns *out, MesoArena *arena, const MesoScene *scene,
                              const MesoSweptKind *kind, float scale, float tolerance, MesoShapeUse use,
                              MesoError *error)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t *detail = MESO_NEW(arena, uint32_t, 2 * (size_t)kind->column_count + 4, error);
    MesoColumnSide *sides = MESO_NEW(arena, MesoColumnSide, (size_t)kind->column_count + 2, error);
    MesoSweepColumn *stand_ins = MESO_NEW(arena, MesoSweepColumn, (size_t)kind->column_count + 4, error);
    if (!detail || !sides || !stand_ins)
        return MESO_ERR_MEMORY;
    float size = scale > 0 ? tolerance / scale : 0;     /* in units of the profiles */
    uint32_t count = (use == MESO_SHAPE_SHADOW ? meso_detail_silhouette : meso_detail_columns)(
        columns, kind->column_count, size, detail);
    Choice choice = {.columns = columns, .kept = detail + kind->column_count, .stand_ins = stand_ins,
                     .sides = sides, .closed = true};
    for (Loop loop = {0}; loop.end < count;) {
        loop = next_loop(columns, detail, count, loop.end);
        bool bands = use == MESO_SHAPE_SHADOW && loop.closed && loop.side_count >= FEW_SIDES - 1 &&
                     is_small(&choice, detail, &loop, size);
        if (bands)
            add_bands(&choice, detail, &loop);
        else
            add_loop(&choice, detail, &loop, use != MESO_SHAPE_WHOLE);
    }
    *out = (MesoShapeColumns){choice.count, choice.side_count, choice.kept, sides, choice.moved ? stand_ins : NULL,
                              choice.closed, choice.banded ? tolerance : 0, 0, NULL, NULL, NULL, {0}};
    return put_places(out, columns, arena, error);
}
