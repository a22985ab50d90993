#include "libcore/tiling/strand/column_thin.h"

#include <math.h>

#include "libcore/base/index.h"

enum { BLENDS = 5, HALVINGS = 8 };      /* places where chords are checked, with both ends */

/* Turns in radians: the most of a chord, and of a gap whose height says how many chords it takes. */
static const float MOST_TURN = 1.0472f, TELLING_TURN = 1.75f, PART_TURN = 1.5708f;

/* A column that stays, as places along the row of its kind's: where its start is, and its end. */
typedef struct Post {
    uint32_t start, end;
} Post;

typedef struct Thinning {
    const MesoProfileSet *fine;
    const MesoColumnPlace *places;
    bool *kept;                 /* [points of all rings] */
    bool *extra;                /* [column_count] between the ends alone */
    uint32_t *first;            /* [kind_count] column where the kind begins anew */
    MesoVec2 *shifts;           /* [points of all rings] of those that are kept, to where they go */
    Post *posts;                /* of one kind, and the first again */
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
 * Chords that the curve takes between its points a and b, which one chord `from` `to` stands for: an arc's height falls
 * with the square of their number. One chord is so far `off`, if that is more than before.
 */
static float pieces_of(const Curve *curve, uint32_t a, uint32_t b, MesoVec2 from, MesoVec2 to,
                       const MesoColumnLimits *limits, float *off)
{
    float turn = 0, height = 0;
    MesoVec2 here = curve_point(curve, a), before = {0, 0};
    for (uint32_t i = a + 1; i <= b; i++) {
        MesoVec2 next = curve_point(curve, i), along = meso_vec2_sub(next, here);
        if (along.x == 0 && along.y == 0)   /* the second of two columns at one place */
            continue;
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
    if (pieces <= 1 || b - a <= 1)
        *off = fmaxf(*off, height);
    return pieces;
}

/* ---- rings ---- */

/* A ring while it is divided. */
typedef struct Division {
    const MesoRing *ring;
    bool *kept;
    MesoVec2 *shifts;
    const MesoColumnLimits *limits;
} Division;

static uint32_t next_kept(const Division *d, uint32_t i)
{
    i++;
    while (!d->kept[i % d->ring->count])
        i++;
    return i;
}

static MesoVec2 ring_point(const Division *d, uint32_t i)
{
    return d->ring->points[i % d->ring->count];
}

static MesoVec2 shifted_point(const Division *d, uint32_t i)
{
    return meso_vec2_add(ring_point(d, i), d->shifts[i % d->ring->count]);
}

/* The farthest that the ring lies to the left of the chord from a to b, or to the right, below 0. */
static float side_height(const Division *d, uint32_t a, uint32_t b)
{
    MesoVec2 from = ring_point(d, a), chord = meso_vec2_sub(ring_point(d, b), from);
    float most = 0, length = meso_vec2_length(chord);
    for (uint32_t i = a + 1; i < b && length > 0; i++) {
        float height = meso_vec2_cross(chord, meso_vec2_sub(ring_point(d, i), from)) / length;
        most = fabsf(height) > fabsf(most) ? height : most;
    }
    return most;
}

/* Half of what the chords beside a point are off it, to their side; a corner stays where it is. */
static void shift_points(const Division *d, uint32_t first)
{
    uint32_t count = d->ring->count;
    for (uint32_t a = first, b; a < first + count; a = b) {
        b = next_kept(d, a);
        uint32_t c = next_kept(d, b);
        MesoVec2 chord = meso_vec2_sub(ring_point(d, c), ring_point(d, a));
        float length = meso_vec2_length(chord), before = side_height(d, a, b), behind = side_height(d, b, c);
        float height = before * behind < 0 ? 0 : (fabsf(before) > fabsf(behind) ? before : behind) / 2;
        bool stays = d->ring->creased[b % count] || !(length > 0);
        d->shifts[b % count] = stays ? (MesoVec2){0, 0} : (MesoVec2){-chord.y * height / length,
                                                                     chord.x * height / length};
    }
}

static float chord_turn(const Division *d, uint32_t a, uint32_t b)
{
    float turn = 0;
    for (uint32_t i = a + 1; i < b; i++) {
        MesoVec2 before = meso_vec2_sub(ring_point(d, i), ring_point(d, i - 1));
        MesoVec2 along = meso_vec2_sub(ring_point(d, i + 1), ring_point(d, i));
        turn += fabsf(atan2f(meso_vec2_cross(before, along), before.x * along.x + before.y * along.y));
    }
    return turn;
}

/* A chord from a shifted end to another may be off by twice the tolerance, one from a corner by half as much again. */
static bool chord_fits(const Division *d, uint32_t a, uint32_t b, float tolerance)
{
    float length = meso_vec2_length(meso_vec2_sub(ring_point(d, b), ring_point(d, a)));
    if (d->limits->longest > 0 && length > d->limits->longest)
        return false;
    uint32_t count = d->ring->count;
    uint32_t corners = (uint32_t)d->ring->creased[a % count] + d->ring->creased[b % count];
    return fabsf(side_height(d, a, b)) <= (2 - 0.5f * (float)corners) * tolerance && chord_turn(d, a, b) <= MOST_TURN;
}

/* The farthest point from a on, at most `end`, that a chord goes to; a search by doubled and halved steps. */
static uint32_t farthest(const Division *d, uint32_t a, uint32_t end, float tolerance)
{
    uint32_t step = 1, b = a + 1;
    while (b < end && chord_fits(d, a, b + step < end ? b + step : end, tolerance)) {
        b = b + step < end ? b + step : end;
        step *= 2;
    }
    for (; step > 0; step /= 2)
        if (b + step <= end && chord_fits(d, a, b + step, tolerance))
            b += step;
    return b;
}

/* Chords from `begin` to `end`, each as far as it goes; `keep` keeps their ends. */
static uint32_t walk_chords(const Division *d, uint32_t begin, uint32_t end, float tolerance, bool keep)
{
    uint32_t count = 0;
    for (uint32_t a = begin; a < end; count++) {
        a = farthest(d, a, end, tolerance);
        d->kept[a % d->ring->count] = d->kept[a % d->ring->count] || keep;
    }
    return count;
}

/* As few chords as the tolerance allows, and then all as near as so many can be. */
static void divide_between(const Division *d, uint32_t begin, uint32_t end, float tolerance)
{
    uint32_t count = walk_chords(d, begin, end, tolerance, false);
    float enough = tolerance, less = 0;
    for (uint32_t i = 0; i < HALVINGS; i++) {
        float middle = (less + enough) / 2;
        *(walk_chords(d, begin, end, middle, false) <= count ? &enough : &less) = middle;
    }
    walk_chords(d, begin, end, enough, true);
}

/* Chords that are off by more, now that their ends have moved. */
static bool divide_again(const Division *d, uint32_t first)
{
    const Curve curve = {.ring = d->ring};
    bool more = false;
    float off = 0;
    for (uint32_t a = first, b; a < first + d->ring->count; a = b) {
        b = next_kept(d, a);
        float wanted = pieces_of(&curve, a, b, shifted_point(d, a), shifted_point(d, b), d->limits, &off);
        if (wanted > 1 && b - a > 1)
            d->kept[(a + (b - a) / 2) % d->ring->count] = more = true;
    }
    return more;
}

/* Between its corners; without any, from its last point all around. */
static void divide_ring(const MesoRing *ring, bool *kept, MesoVec2 *shifts, const MesoColumnLimits *limits)
{
    const Division d = {ring, kept, shifts, limits};
    uint32_t first = ring->count - 1;
    for (uint32_t i = ring->count; i-- > 0;)
        if ((kept[i] = ring->creased[i]))
            first = i;
    kept[first] = true;
    for (uint32_t a = first, b; a < first + ring->count; a = b) {
        b = next_kept(&d, a);
        divide_between(&d, a, b, limits->off);
    }
    do
        shift_points(&d, first);
    while (divide_again(&d, first));
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

/* Whether a column stays for the one ring alone. */
static bool stays_for(const Thinning *t, uint32_t column, bool end)
{
    const MesoColumnPlace *place = &t->places[column];
    return !t->extra[column] && is_kept(t, end ? place->end : place->start) &&
           !is_kept(t, end ? place->start : place->end);
}

static Curve kind_curve(const Thinning *t, const MesoSweptKind *kind, uint32_t first)
{
    uint32_t seam = kind->column_begin + kind->column_count - 1;
    return (Curve){.columns = t->fine->columns, .kind = kind, .first = first, .cosine = cosf(kind->turn),
                   .sine = sinf(kind->turn), .round = kind->column_count - !t->places[seam].doubled};
}

/* Of a column at one of its ends. */
static MesoVec2 column_shift(const Thinning *t, uint32_t column, bool end)
{
    const MesoColumnPlace *place = &t->places[column];
    uint32_t point = end ? place->end : place->start;
    if (point == MESO_NO_INDEX || !t->kept[point])
        return (MesoVec2){0, 0};
    return (MesoVec2){place->signs[end] * t->shifts[point].x, t->shifts[point].y};
}

static MesoVec2 post_point(const Thinning *t, const Curve *curve, const Post *post)
{
    Curve start = *curve, end = *curve;
    start.blend = 0;
    end.blend = 1;
    MesoVec2 here = column_shift(t, curve_column(curve, post->start), false);
    MesoVec2 there = column_shift(t, curve_column(curve, post->end), true);
    there = (MesoVec2){curve->cosine * there.x + curve->sine * there.y,
                       curve->cosine * there.y - curve->sine * there.x};
    return meso_vec2_lerp(meso_vec2_add(curve_point(&start, post->start), here),
                          meso_vec2_add(curve_point(&end, post->end), there), curve->blend);
}

/* Whether a column from the one's start to the other's end lies on the surface, wherever it blends. */
static bool is_near(const Thinning *t, Curve *curve, const Post *post)
{
    uint32_t low = post->start < post->end ? post->start : post->end, high = post->start + post->end - low;
    bool near = true;
    for (uint32_t k = 1; k + 1 < BLENDS && near; k++) {
        curve->blend = (float)k / (BLENDS - 1);
        MesoVec2 p = post_point(t, curve, post);
        float least = INFINITY;
        for (uint32_t i = low; i < high; i++)
            least = fminf(least, distance_to_chord(p, curve_point(curve, i), curve_point(curve, i + 1)));
        near = least <= t->limits.off;
    }
    return near;
}

/*
 * The columns that stay. Two neighbours, of which one is there for the start and one for the end, become one where
 * none is nearer to them.
 */
static uint32_t set_posts(Thinning *t, const MesoSweptKind *kind, Curve *curve)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < curve->round; i++) {
        uint32_t column = curve_column(curve, i);
        if (t->fine->columns[column].joins_next && stays(t, column))
            t->posts[count++] = (Post){i, i};
    }
    t->posts[count] = (Post){curve->round, curve->round};
    uint32_t left = 1;
    for (uint32_t p = 1; p < count; p++, left++) {
        Post both = t->posts[p], next = t->posts[p + 1];
        bool end = stays_for(t, curve_column(curve, both.start), true);
        t->posts[left] = both;
        if (kind->cap || p + 1 == count || !stays_for(t, curve_column(curve, both.start), end) ||
            !stays_for(t, curve_column(curve, next.start), !end))
            continue;
        uint32_t gap = next.start - both.start;
        both = end ? (Post){next.start, both.end} : (Post){both.start, next.end};
        uint32_t before = t->posts[left - 1].start > t->posts[left - 1].end ? t->posts[left - 1].start
                                                                            : t->posts[left - 1].end;
        if (t->posts[p].start - before >= gap && t->posts[p + 2].start - next.start >= gap &&
            is_near(t, curve, &both)) {
            t->posts[left] = both;
            p++;
        }
    }
    t->posts[left] = t->posts[count];
    return left;
}

/* Both where there are two. */
static void keep_between(Thinning *t, const MesoSweptKind *kind, uint32_t column)
{
    uint32_t last = kind->column_begin + kind->column_count - 1;
    t->extra[column] = true;
    if (t->places[column].doubled && t->fine->columns[column].joins_next)
        t->extra[column == kind->column_begin ? last : column - 1] = true;
    else if (t->places[column].doubled)
        t->extra[column == last ? kind->column_begin : column + 1] = true;
}

/* Where the columns of a post begin; of two at one place it has the second. */
static uint32_t place_before(const Thinning *t, const Curve *curve, const Post *post)
{
    uint32_t start = post->start - t->places[curve_column(curve, post->start)].doubled;
    uint32_t end = post->end - t->places[curve_column(curve, post->end)].doubled;
    return start < end ? start : end;
}

/* Whether what lies between the ends of a post is near to the chords before and behind it, wherever it blends. */
static bool is_covered(const Thinning *t, Curve *curve, const Post *post, float *off)
{
    uint32_t low = post->start < post->end ? post->start : post->end, high = post->start + post->end - low;
    float height = 0;
    for (uint32_t k = 0; k < BLENDS; k++) {
        curve->blend = (float)k / (BLENDS - 1);
        MesoVec2 before = post_point(t, curve, post - 1), here = post_point(t, curve, post);
        MesoVec2 next = post_point(t, curve, post + 1);
        for (uint32_t i = low; i <= high; i++) {
            MesoVec2 p = curve_point(curve, i);
            height = fmaxf(height, fminf(distance_to_chord(p, before, here), distance_to_chord(p, here, next)));
        }
    }
    if (height > t->limits.off)
        return false;
    *off = fmaxf(*off, height);
    return true;
}

/* Chords of a kind wherever it blends. Returns whether it took more columns; `off` gets what they are off. */
static bool divide_kind(Thinning *t, const MesoSweptKind *kind, Curve *curve, uint32_t post_count, float *off)
{
    bool more = false;
    for (const Post *a = t->posts; a < t->posts + post_count; a++) {
        const Post *b = a + 1;
        uint32_t low = a->start > a->end ? a->start : a->end, high = place_before(t, curve, b);
        float wanted = 1;
        for (uint32_t i = 0; i < (kind->cap ? 1 : BLENDS); i++) {
            curve->blend = (float)i / (BLENDS - 1);
            wanted = fmaxf(wanted, pieces_of(curve, low, high, post_point(t, curve, a), post_point(t, curve, b),
                                             &t->limits, off));
        }
        uint32_t pieces = high <= low ? 1 : wanted < (float)(high - low) ? (uint32_t)wanted : high - low;
        for (uint32_t k = 1; k < pieces; k++)
            keep_between(t, kind, curve_column(curve, low + (uint32_t)((uint64_t)(high - low) * k / pieces)));
        more = more || pieces > 1;
        if (a->start == a->end || is_covered(t, curve, a, off))
            continue;
        keep_between(t, kind, curve_column(curve, a->start));
        keep_between(t, kind, curve_column(curve, a->end));
        more = true;
    }
    return more;
}

/* ---- new columns ---- */

/* Of two columns at one place, the one before. */
static uint32_t column_before(const Thinning *t, const MesoSweptKind *kind, uint32_t column)
{
    if (!t->places[column].doubled)
        return column;
    return (column == kind->column_begin ? column + kind->column_count : column) - 1;
}

static void put_column(const Thinning *t, MesoProfileSet *out, const Curve *curve, const Post *post, bool before,
                       bool joins)
{
    uint32_t start = curve_column(curve, post->start), end = curve_column(curve, post->end);
    if (before) {
        start = column_before(t, curve->kind, start);
        end = column_before(t, curve->kind, end);
    }
    const MesoSweepColumn *from = &t->fine->columns[start], *to = &t->fine->columns[end];
    float first = t->fine->columns[curve->first].u, u = from == to ? from->u : (from->u + to->u) / 2;
    bool last = post->start == curve->round;
    uint32_t absent = (is_kept(t, t->places[start].start) ? 0 : MESO_ABSENT_START) |
                      (is_kept(t, t->places[end].end) ? 0 : MESO_ABSENT_END);
    out->columns[out->column_count++] = (MesoSweepColumn){
        meso_vec2_add(from->start, column_shift(t, start, false)), meso_vec2_add(to->end, column_shift(t, end, true)),
        from->start_normal, to->end_normal, last ? 1 : u < first ? u - first + 1 : u - first, joins, absent};
}

/* From the first column on and around to it. */
static void put_columns(const Thinning *t, MesoProfileSet *out, const Curve *curve, uint32_t post_count)
{
    for (uint32_t p = 0; p <= post_count; p++) {
        const Post *post = &t->posts[p];
        bool doubled = t->places[curve_column(curve, post->start)].doubled ||
                       t->places[curve_column(curve, post->end)].doubled;
        if (p > 0 && doubled)
            put_column(t, out, curve, post, true, false);
        if (p == 0 || p < post_count || !doubled)
            put_column(t, out, curve, post, false, p < post_count);
    }
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
                  MESO_NEW(scratch, uint32_t, fine.kind_count, error),
                  MESO_NEW(scratch, MesoVec2, point_count, error),
                  MESO_NEW(scratch, Post, (size_t)fine.column_count + 1, error), limits};
    profiles->columns = MESO_NEW(scratch, MesoSweepColumn, (size_t)fine.column_count + fine.kind_count, error);
    if (!t.kept || !t.extra || !t.first || !t.shifts || !t.posts || !profiles->columns)
        return MESO_ERR_MEMORY;

    size_t point = 0;
    for (uint32_t r = 0; r < ring_count; point += rings[r++].count)
        divide_ring(&rings[r], t.kept + point, t.shifts + point, &limits);
    for (uint32_t k = 0; k < fine.kind_count; k++)
        t.first[k] = find_first(&t, &fine.kinds[k]);
    profiles->column_count = 0;
    for (uint32_t k = 0; k < fine.kind_count; k++) {
        MesoSweptKind *kind = &profiles->kinds[k];
        Curve curve = kind_curve(&t, &fine.kinds[k], t.first[k]);
        float *off = &profiles->origins[k].off;
        uint32_t post_count;
        do {
            *off = 0;
            post_count = set_posts(&t, kind, &curve);
        } while (divide_kind(&t, kind, &curve, post_count, off));
        uint32_t begin = profiles->column_count;
        put_columns(&t, profiles, &curve, post_count);
        kind->column_begin = begin;
        kind->column_count = profiles->column_count - begin;
        count_kind(kind, profiles->columns + begin);
    }
    return MESO_OK;
}
