#include "libcore/tiling/strand/column_thin.h"

#include <math.h>

#include "libcore/base/index.h"

enum { BLENDS = 5 };    /* places where chords are checked, with both ends */

/* Turns in radians: the most of a chord, and of a gap whose height says how many chords it takes. */
static const float MOST_TURN = 1.0472f, TELLING_TURN = 1.75f, PART_TURN = 1.5708f;

typedef struct Thinning {
    const MesoProfileSet *fine;
    const MesoColumnPlace *places;
    bool *kept;                 /* [points of all rings] */
    bool *extra;                /* [column_count] between the ends alone */
    uint32_t *first;            /* [kind_count] column where the kind begins anew */
    MesoColumnLimits limits;
} Thinning;

/* A row of points, of which some are looked at as a curve: a ring, or the columns of a kind at some blend. */
typedef struct Curve {
    const MesoRing *ring;       /* or */
    const MesoSweepColumn *columns;
    const MesoSweptKind *kind;
    uint32_t first, round;      /* the kind's first column, and how many there are before it comes again */
    float cosine, sine, blend;
} Curve;

static uint32_t curve_column(const Curve *curve, uint32_t i)
{
    uint32_t begin = curve->kind->column_begin;
    return begin + (curve->first - begin + i) % curve->round;
}

static MesoVec2 curve_point(const Curve *curve, uint32_t i)
{
    if (curve->ring)
        return curve->ring->points[i % curve->ring->count];
    const MesoSweepColumn *column = &curve->columns[curve_column(curve, i)];
    MesoVec2 start = meso_vec2_sub(column->start, curve->kind->middle[0]);
    MesoVec2 end = meso_vec2_sub(column->end, curve->kind->middle[1]);
    end = (MesoVec2){curve->cosine * end.x + curve->sine * end.y, curve->cosine * end.y - curve->sine * end.x};
    return meso_vec2_lerp(start, end, curve->blend);
}

static float distance_to_chord(MesoVec2 p, MesoVec2 a, MesoVec2 b)
{
    MesoVec2 ab = meso_vec2_sub(b, a), ap = meso_vec2_sub(p, a);
    float square = ab.x * ab.x + ab.y * ab.y;
    float t = square > 0 ? fminf(fmaxf((ap.x * ab.x + ap.y * ab.y) / square, 0), 1) : 0;
    return meso_vec2_length(meso_vec2_sub(ap, meso_vec2_scale(ab, t)));
}

/*
 * Chords that the curve takes between the points a and b: an arc's height falls with the square of their number. One
 * chord is so far `off`, if that is more than before.
 */
static uint32_t pieces_of(const Curve *curve, uint32_t a, uint32_t b, const MesoColumnLimits *limits, float *off)
{
    float turn = 0, height = 0;
    MesoVec2 from = curve_point(curve, a), to = curve_point(curve, b), here = from, before = {0, 0};
    for (uint32_t i = a + 1; i <= b; i++) {
        MesoVec2 next = curve_point(curve, i), along = meso_vec2_sub(next, here);
        if (i > a + 1)
            turn += fabsf(atan2f(meso_vec2_cross(before, along), before.x * along.x + before.y * along.y));
        height = fmaxf(height, distance_to_chord(here, from, to));
        before = along;
        here = next;
    }
    float pieces = turn > TELLING_TURN ? ceilf(turn / PART_TURN)
        : fmaxf(ceilf(sqrtf(height / limits->off)), turn > MOST_TURN ? 2 : 1);
    if (limits->longest > 0)
        pieces = fmaxf(pieces, ceilf(meso_vec2_length(meso_vec2_sub(to, from)) / limits->longest));
    uint32_t count = pieces < (float)(b - a) ? (uint32_t)pieces : b - a;
    if (count <= 1)
        *off = fmaxf(*off, height);
    return count;
}

/* ---- rings ---- */

/* Between its corners; without any, from its last point all around. */
static void divide_ring(const MesoRing *ring, bool *kept, const MesoColumnLimits *limits)
{
    const Curve curve = {.ring = ring};
    float off = 0;
    uint32_t first = ring->count - 1;
    for (uint32_t i = ring->count; i-- > 0;)
        if ((kept[i] = ring->creased[i]))
            first = i;
    kept[first] = true;
    for (bool more = true; more;) {
        more = false;
        for (uint32_t a = first; a < first + ring->count;) {
            uint32_t b = a + 1;
            while (!kept[b % ring->count])
                b++;
            uint32_t pieces = pieces_of(&curve, a, b, limits, &off);
            for (uint32_t k = 1; k < pieces; k++)
                kept[(a + (uint32_t)((uint64_t)(b - a) * k / pieces)) % ring->count] = more = true;
            a = b;
        }
    }
}

/* ---- kinds ---- */

static bool is_kept(const Thinning *t, uint32_t point)
{
    return point == MESO_NO_INDEX || t->kept[point];
}

/* The first column that both rings keep. Where there is none, the other end has to keep one more point. */
static uint32_t find_first(Thinning *t, const MesoSweptKind *kind)
{
    uint32_t end = kind->column_begin + kind->column_count, half = MESO_NO_INDEX;
    for (uint32_t c = kind->column_begin; c < end; c++) {
        const MesoColumnPlace *place = &t->places[c];
        if (!t->fine->columns[c].joins_next || !is_kept(t, place->start))
            continue;
        if (is_kept(t, place->end))
            return c;
        half = half == MESO_NO_INDEX ? c : half;
    }
    t->kept[t->places[half].end] = true;
    return half;
}

static bool stays(const Thinning *t, uint32_t column)
{
    const MesoColumnPlace *place = &t->places[column];
    return place->creased || t->extra[column] || (place->start != MESO_NO_INDEX && t->kept[place->start]) ||
           (place->end != MESO_NO_INDEX && t->kept[place->end]);
}

/* Chords of a kind wherever it blends. Returns whether it took more columns; `off` gets what they are off. */
static bool divide_kind(Thinning *t, const MesoSweptKind *kind, uint32_t first, float *off)
{
    bool more = false;
    const MesoSweepColumn *columns = t->fine->columns;
    uint32_t seam = kind->column_begin + kind->column_count - 1;
    Curve curve = {.columns = columns, .kind = kind, .first = first, .cosine = cosf(kind->turn),
                   .sine = sinf(kind->turn), .round = kind->column_count - !t->places[seam].creased};
    for (uint32_t a = 0; a < curve.round;) {
        uint32_t b = a + 1, pieces = 1;
        bool joined = columns[curve_column(&curve, a)].joins_next;
        while (joined && b < curve.round && !stays(t, curve_column(&curve, b)))
            b++;
        for (uint32_t i = 0; i < (kind->cap ? 1 : BLENDS) && joined; i++) {
            curve.blend = (float)i / (BLENDS - 1);
            uint32_t own = pieces_of(&curve, a, b, &t->limits, off);
            pieces = pieces > own ? pieces : own;
        }
        for (uint32_t k = 1; k < pieces; k++)
            t->extra[curve_column(&curve, a + (uint32_t)((uint64_t)(b - a) * k / pieces))] = more = true;
        a = b;
    }
    return more;
}

/* ---- new columns ---- */

static uint32_t absent_at(const Thinning *t, uint32_t column)
{
    const MesoColumnPlace *place = &t->places[column];
    return (is_kept(t, place->start) ? 0 : MESO_ABSENT_START) | (is_kept(t, place->end) ? 0 : MESO_ABSENT_END);
}

static void put_column(const Thinning *t, MesoProfileSet *out, uint32_t column, float first_u, bool last)
{
    MesoSweepColumn *to = &out->columns[out->column_count++];
    *to = t->fine->columns[column];
    to->absent = absent_at(t, column);
    to->u = last ? 1 : to->u < first_u ? to->u - first_u + 1 : to->u - first_u;
    if (last)
        to->joins_next = 0;
}

/* From the first column on, over the seam where the last of the fine columns is the first again, and around to it. */
static void put_columns(const Thinning *t, MesoProfileSet *out, const MesoSweptKind *kind, uint32_t first)
{
    uint32_t begin = kind->column_begin, seam = begin + kind->column_count - 1;
    float first_u = t->fine->columns[first].u;
    for (uint32_t c = first; c <= seam; c++)
        if (stays(t, c) && (c < seam || t->places[seam].creased))
            put_column(t, out, c, first_u, false);
    uint32_t last = first > begin ? (t->places[first].creased ? first - 1 : first) : seam;
    if (first == begin && t->places[seam].creased) {    /* the seam itself is the last */
        out->columns[out->column_count - 1].u = 1;
        return;
    }
    for (uint32_t c = begin; first > begin && c < last; c++)
        if (stays(t, c))
            put_column(t, out, c, first_u, false);
    put_column(t, out, last, first_u, true);
}

static void count_kind(MesoSweptKind *kind, const MesoSweepColumn *columns)
{
    kind->joint_count = kind->absent[0] = kind->absent[1] = kind->fans[0] = kind->fans[1] = 0;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        kind->joint_count += columns[c].joins_next;
        for (uint32_t end = 0; end < 2; end++) {
            uint32_t bit = end ? MESO_ABSENT_END : MESO_ABSENT_START;
            kind->absent[end] += (columns[c].absent & bit) != 0;
            kind->fans[end] += columns[c].joins_next && (columns[c + 1].absent & bit);
        }
    }
}

MesoStatus meso_columns_thin(MesoProfileSet *profiles, const MesoColumnPlace *places, const MesoRing *rings,
                             uint32_t ring_count, MesoArena *scratch, MesoColumnLimits limits, MesoError *error)
{
    const MesoProfileSet fine = *profiles;
    size_t point_count = 0;
    for (uint32_t r = 0; r < ring_count; r++)
        point_count += rings[r].count;
    Thinning t = {&fine, places, MESO_NEW(scratch, bool, point_count, error),
                  MESO_NEW(scratch, bool, fine.column_count, error),
                  MESO_NEW(scratch, uint32_t, fine.kind_count, error), limits};
    profiles->columns = MESO_NEW(scratch, MesoSweepColumn, (size_t)fine.column_count + fine.kind_count, error);
    if (!t.kept || !t.extra || !t.first || !profiles->columns)
        return MESO_ERR_MEMORY;

    bool *kept = t.kept;
    for (uint32_t r = 0; r < ring_count; kept += rings[r++].count)
        divide_ring(&rings[r], kept, &limits);
    for (uint32_t k = 0; k < fine.kind_count; k++)
        t.first[k] = find_first(&t, &fine.kinds[k]);
    profiles->column_count = 0;
    for (uint32_t k = 0; k < fine.kind_count; k++) {
        MesoSweptKind *kind = &profiles->kinds[k];
        do
            profiles->origins[k].off = 0;
        while (divide_kind(&t, kind, t.first[k], &profiles->origins[k].off));
        uint32_t begin = profiles->column_count;
        put_columns(&t, profiles, kind, t.first[k]);
        kind->column_begin = begin;
        kind->column_count = profiles->column_count - begin;
        count_kind(kind, profiles->columns + begin);
    }
    return MESO_OK;
}
