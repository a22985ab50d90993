#include "libcore/tiling/strand/column_thin.h"

#include <math.h>
#include <string.h>

#include "libcore/base/index.h"
#include "libcore/scene/sweep.h"
#include "libcore/tiling/strand/curve_thin.h"

enum { BLENDS = MESO_KIND_BLENDS };

/* Columns of their own between the ends are for a kind that then has so much less. */
static const float GAIN = 0.9f;

/* Two corners that lie nearer than this part of the way around are one. */
enum { NEAR_PART = 64 };

/* A column that stays, as places along the row of its kind's: where its start is, and its end. */
typedef struct Post {
    uint32_t start, end;
    uint32_t absent;
    MesoVec2 shifts[2];         /* where its ring does not keep it */
} Post;

typedef struct Thinning {
    const MesoProfileSet *fine;
    const MesoColumnPlace *places;
    bool *kept;                 /* [points of all rings] */
    bool *extra;                /* [column_count] between the ends alone */
    uint32_t *first;            /* [kind_count] column where the kind begins anew */
    Post *firsts;               /* [kind_count] and the post there, which may lie at two places */
    MesoVec2 *shifts;           /* [points of all rings] of those that are kept, to where they go */
    Post *posts;                /* of one kind, and the first again */
    MesoVec2 *points;           /* [BLENDS * (columns of a kind)] of one kind */
    bool *fixed, *inner;        /* [columns of a kind] */
    MesoVec2 *inner_shifts[2];  /* [columns of a kind] */
    MesoColumnLimits limits;
} Thinning;

/* The columns of a kind, from the first on, as points of a curve at each of the blends. */
typedef struct Row {
    const MesoSweptKind *kind;
    uint32_t first, round;      /* the kind's first column, and how many there are before it comes again */
    float cosine, sine;
    MesoClosedCurve curves[BLENDS];
} Row;

/* ---- kinds ---- */

static bool is_kept(const Thinning *t, uint32_t point)
{
    return point == MESO_NO_INDEX || t->kept[point];
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

static uint32_t row_column(const Row *row, uint32_t i)
{
    uint32_t begin = row->kind->column_begin;
    return begin + (row->first - begin + i) % row->round;
}

/* A vector of the end's plane, turned back to how the start's lies. */
static MesoVec2 turned_back(const Row *row, MesoVec2 p)
{
    return (MesoVec2){row->cosine * p.x + row->sine * p.y, row->cosine * p.y - row->sine * p.x};
}

static MesoVec2 turned_on(const Row *row, MesoVec2 p)
{
    return (MesoVec2){row->cosine * p.x - row->sine * p.y, row->cosine * p.y + row->sine * p.x};
}

/* Its points lie in `t` until the next one's. */
static Row make_row(const Thinning *t, const MesoSweptKind *kind, uint32_t first)
{
    uint32_t seam = kind->column_begin + kind->column_count - 1;
    Row row = {.kind = kind, .first = first, .cosine = cosf(kind->turn), .sine = sinf(kind->turn),
               .round = kind->column_count - !t->places[seam].doubled};
    for (uint32_t k = 0; k < BLENDS; k++)
        row.curves[k] = (MesoClosedCurve){t->points + (size_t)k * row.round, row.round};
    for (uint32_t i = 0; i < row.round; i++) {
        const MesoSweepColumn *column = &t->fine->columns[row_column(&row, i)];
        MesoVec2 start = meso_vec2_sub(column->start, kind->middle[0]);
        MesoVec2 end = turned_back(&row, meso_vec2_sub(column->end, kind->middle[1]));
        for (uint32_t k = 0; k < BLENDS; k++)
            t->points[(size_t)k * row.round + i] = meso_vec2_lerp(start, end, (float)k / (BLENDS - 1));
    }
    return row;
}

/* Of a post at one of its ends. */
static MesoVec2 post_shift(const Thinning *t, const Row *row, const Post *post, bool end)
{
    const MesoColumnPlace *place = &t->places[row_column(row, end ? post->end : post->start)];
    uint32_t point = end ? place->end : place->start;
    if (point == MESO_NO_INDEX || !t->kept[point])
        return post->shifts[end];
    return (MesoVec2){place->signs[end] * t->shifts[point].x, t->shifts[point].y};
}

static MesoVec2 post_point(const Thinning *t, const Row *row, const Post *post, uint32_t blend)
{
    MesoVec2 start = meso_vec2_add(row->curves[0].points[post->start % row->round], post_shift(t, row, post, false));
    MesoVec2 end = meso_vec2_add(row->curves[BLENDS - 1].points[post->end % row->round],
                                 turned_back(row, post_shift(t, row, post, true)));
    return meso_vec2_lerp(start, end, (float)blend / (BLENDS - 1));
}

static uint32_t least_place(const Post *post)
{
    return post->start < post->end ? post->start : post->end;
}

static uint32_t most_place(const Post *post)
{
    return post->start > post->end ? post->start : post->end;
}

/* Whether a column from the one's start to the other's end lies on the surface, wherever it blends. */
static bool is_near(const Thinning *t, const Row *row, const Post *post)
{
    bool near = true;
    for (uint32_t k = 1; k + 1 < BLENDS && near; k++) {
        const MesoVec2 *points = row->curves[k].points;
        MesoVec2 p = post_point(t, row, post, k);
        float least = INFINITY;
        for (uint32_t i = least_place(post); i < most_place(post); i++)
            least = fminf(least, meso_distance_to_chord(p, points[i % row->round], points[(i + 1) % row->round]));
        near = least <= t->limits.off;
    }
    return near;
}

/* How far what lies between the ends of a post is from the chords before and behind it, at each blend; and at most. */
static float height_at(const Thinning *t, const Row *row, const Post *before, const Post *post, float heights[BLENDS])
{
    float most = 0;
    for (uint32_t k = 0; k < BLENDS; k++) {
        float height = 0;
        MesoVec2 from = post_point(t, row, before, k), here = post_point(t, row, post, k);
        MesoVec2 next = post_point(t, row, post + 1, k);
        for (uint32_t i = least_place(post); i <= most_place(post); i++) {
            MesoVec2 p = row->curves[k].points[i % row->round];
            height = fmaxf(height, fminf(meso_distance_to_chord(p, from, here), meso_distance_to_chord(p, here, next)));
        }
        heights[k] = height;
        most = fmaxf(most, height);
    }
    return most;
}

/* ---- where kinds begin anew ---- */

/* Whether a column from the one's start to the other's end, `gap` apart, will do for all between, at each blend. */
static bool will_do(const Thinning *t, const Row *row, const Post *post, uint32_t gap)
{
    uint32_t before = least_place(post) - gap, behind = most_place(post) + gap;
    const Post posts[3] = {{.start = before, .end = before}, *post, {.start = behind, .end = behind}};
    float heights[BLENDS];
    return is_near(t, row, post) && height_at(t, row, &posts[0], &posts[1], heights) <= t->limits.off;
}

/* The nearest column to one that the start keeps, and that the end does, as a post; where there is none, both at 0. */
static Post nearest_pair(const Thinning *t, const Row *row)
{
    uint32_t most = row->round / NEAR_PART, least = most + 1;
    Post best = {0};
    for (uint32_t i = 0; i < row->round && least > 0; i++) {
        uint32_t column = row_column(row, i);
        if (!t->fine->columns[column].joins_next || !is_kept(t, t->places[column].start))
            continue;
        for (uint32_t j = i + row->round - most; j <= i + row->round + most; j++) {
            uint32_t other = row_column(row, j), gap = j > i + row->round ? j - i - row->round : i + row->round - j;
            Post pair = {.start = i + row->round, .end = j};
            if (gap >= least || !t->fine->columns[other].joins_next || !is_kept(t, t->places[other].end) ||
                (gap > 0 && !will_do(t, row, &pair, gap)))
                continue;
            least = gap;
            best = pair;
        }
    }
    return best;
}

/* A column that both rings keep, or near ones. Where there are none, the end has to keep one more point. */
static void find_first(Thinning *t, uint32_t k)
{
    const MesoSweptKind *kind = &t->fine->kinds[k];
    const Row row = make_row(t, kind, kind->column_begin);
    Post pair = nearest_pair(t, &row);
    if (pair.start > 0) {
        uint32_t first = least_place(&pair);
        t->first[k] = row_column(&row, first);
        t->firsts[k] = (Post){.start = pair.start - first, .end = pair.end - first};
        return;
    }
    uint32_t half = kind->column_begin;
    while (!t->fine->columns[half].joins_next || !is_kept(t, t->places[half].start))
        half++;
    t->kept[t->places[half].end] = true;
    t->first[k] = half;
}

/* ---- columns that stay for the rings ---- */

static uint32_t absent_of(const Thinning *t, const Row *row, const Post *post)
{
    return (is_kept(t, t->places[row_column(row, post->start)].start) ? 0 : MESO_ABSENT_START) |
           (is_kept(t, t->places[row_column(row, post->end)].end) ? 0 : MESO_ABSENT_END);
}

static bool is_clear(const Thinning *t, uint32_t left, const Post *next, const Post *behind, uint32_t gap)
{
    return t->posts[left].start - most_place(&t->posts[left - 1]) >= gap && behind->start - next->start >= gap;
}

/*
 * Two neighbours, of which one is there for the start and one for the end, become one where none is nearer to them.
 * Returns how many posts are left.
 */
static uint32_t join_posts(Thinning *t, const Row *row, uint32_t count)
{
    uint32_t left = 1;
    for (uint32_t p = 1; p < count; p++, left++) {
        Post both = t->posts[p], next = t->posts[p + 1];
        bool end = stays_for(t, row_column(row, both.start), true);
        t->posts[left] = both;
        if (row->kind->cap || p + 1 == count || !stays_for(t, row_column(row, both.start), end) ||
            !stays_for(t, row_column(row, next.start), !end))
            continue;
        uint32_t gap = next.start - both.start;
        both = end ? (Post){.start = next.start, .end = both.end} : (Post){.start = both.start, .end = next.end};
        if (is_clear(t, left, &next, &t->posts[p + 2], gap) && is_near(t, row, &both)) {
            t->posts[left] = both;
            p++;
        }
    }
    t->posts[left] = t->posts[count];
    return left;
}

static uint32_t set_posts(Thinning *t, const Row *row, Post first)
{
    uint32_t count = 1;
    t->posts[0] = first;
    for (uint32_t i = 1; i < row->round; i++) {
        uint32_t column = row_column(row, i);
        if (t->fine->columns[column].joins_next && stays(t, column) && i != most_place(&first))
            t->posts[count++] = (Post){.start = i, .end = i};
    }
    t->posts[count] = (Post){.start = row->round + first.start, .end = row->round + first.end};
    count = join_posts(t, row, count);
    for (uint32_t p = 0; p <= count; p++)
        t->posts[p].absent = absent_of(t, row, &t->posts[p]);
    return count;
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
static uint32_t place_before(const Thinning *t, const Row *row, const Post *post)
{
    uint32_t start = post->start - t->places[row_column(row, post->start)].doubled;
    uint32_t end = post->end - t->places[row_column(row, post->end)].doubled;
    return start < end ? start : end;
}

/* Chords of a kind wherever it blends. Returns whether it took more columns; `off` gets what they are off. */
static bool divide_kind(Thinning *t, const Row *row, uint32_t post_count, float *off)
{
    bool more = false;
    for (const Post *a = t->posts; a < t->posts + post_count; a++) {
        uint32_t low = most_place(a), high = place_before(t, row, a + 1);
        float wanted = 1;
        for (uint32_t k = 0; k < (row->kind->cap ? 1 : BLENDS); k++)
            wanted = fmaxf(wanted, meso_chord_pieces(&row->curves[k], low, high, post_point(t, row, a, k),
                                                     post_point(t, row, a + 1, k), &t->limits, &off[k]));
        uint32_t pieces = high <= low ? 1 : wanted < (float)(high - low) ? (uint32_t)wanted : high - low;
        for (uint32_t k = 1; k < pieces; k++)
            keep_between(t, row->kind, row_column(row, low + (uint32_t)((uint64_t)(high - low) * k / pieces)));
        more = more || pieces > 1;
        if (a->start == a->end)
            continue;
        float heights[BLENDS], most = height_at(t, row, a == t->posts ? a + post_count - 1 : a - 1, a, heights);
        for (uint32_t k = 0; k < BLENDS; k++)
            off[k] = fmaxf(off[k], heights[k]);
        if (most <= t->limits.off)
            continue;
        /* What the kind begins with stays one; it is as near as its neighbours are. */
        uint32_t gap = a == t->posts ? most_place(a) - least_place(a) : 0;
        uint32_t before = row_column(row, least_place(a) + row->round - gap);
        uint32_t behind = row_column(row, most_place(a) + gap);
        if (gap > 0 && t->extra[before] && t->extra[behind])
            continue;
        keep_between(t, row->kind, before);
        keep_between(t, row->kind, behind);
        more = true;
    }
    return more;
}

/* ---- columns of their own between the ends ---- */

static bool is_corner(const Thinning *t, uint32_t column)
{
    return t->places[column].creased && t->fine->columns[column].joins_next;
}

/* What a column is there for, as a post; absent everywhere is none. */
static Post inner_post(const Thinning *t, const Row *row, uint32_t i)
{
    Post post = {.start = i, .end = i};
    post.absent = absent_of(t, row, &post) | (t->inner[i] ? 0 : MESO_ABSENT_BETWEEN);
    post.shifts[0] = t->inner_shifts[0][i];
    post.shifts[1] = turned_on(row, t->inner_shifts[1][i]);
    return post;
}

static uint32_t set_inner_posts(Thinning *t, const Row *row)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < row->round; i++) {
        Post post = inner_post(t, row, i);
        if (t->fine->columns[row_column(row, i)].joins_next &&
            post.absent != (MESO_ABSENT_START | MESO_ABSENT_END | MESO_ABSENT_BETWEEN))
            t->posts[count++] = post;
    }
    t->posts[count] = t->posts[0];
    t->posts[count].start = t->posts[count].end = row->round;
    return count;
}

/*
 * Where two drawings need different points, what lies between the ends has others than either: as few as the surface
 * there needs, and the corners of both. Returns how many posts there are then; as before, if that gains little.
 */
static uint32_t divide_inner(Thinning *t, const Row *row, uint32_t post_count, float *off)
{
    const MesoColumnPlace *place = &t->places[row->first];
    uint32_t inner_count = 0;
    if (row->kind->cap || t->posts[0].start != t->posts[0].end || place->start == MESO_NO_INDEX ||
        place->end == MESO_NO_INDEX)
        return post_count;
    for (uint32_t i = 0; i < row->round; i++)
        t->fixed[i] = i == 0 || is_corner(t, row_column(row, i));
    memset(t->inner_shifts[0], 0, row->round * sizeof *t->inner_shifts[0]);
    memset(t->inner_shifts[1], 0, row->round * sizeof *t->inner_shifts[1]);
    const MesoCurveRow curves = {row->curves, BLENDS, t->fixed, t->inner, {t->inner_shifts[0], t->inner_shifts[1]}};
    float inner_off[BLENDS];
    meso_curves_thin(&curves, 0, t->limits, inner_off);
    for (uint32_t i = 0; i < row->round; i++)
        inner_count += t->inner[i];
    if ((float)inner_count > GAIN * (float)post_count)
        return post_count;
    memcpy(off, inner_off, sizeof inner_off);
    return set_inner_posts(t, row);
}

/* ---- new columns ---- */

/* Of two columns at one place, the one before. */
static uint32_t column_before(const Thinning *t, const MesoSweptKind *kind, uint32_t column)
{
    if (!t->places[column].doubled)
        return column;
    return (column == kind->column_begin ? column + kind->column_count : column) - 1;
}

/* How far around a column is from the first one on. */
static float way_of(const Row *row, const MesoSweepColumn *columns, uint32_t column)
{
    float way = columns[column].u - columns[row->first].u;
    return way < 0 ? way + 1 : way;
}

static float post_way(const Thinning *t, const Row *row, const Post *post)
{
    return (way_of(row, t->fine->columns, row_column(row, post->start)) +
            way_of(row, t->fine->columns, row_column(row, post->end))) / 2;
}

static void put_column(const Thinning *t, MesoProfileSet *out, const Row *row, const Post *post, float u, bool before,
                       bool joins)
{
    uint32_t start = row_column(row, post->start), end = row_column(row, post->end);
    if (before) {
        start = column_before(t, row->kind, start);
        end = column_before(t, row->kind, end);
    }
    const MesoSweepColumn *from = &t->fine->columns[start], *to = &t->fine->columns[end];
    out->columns[out->column_count++] = (MesoSweepColumn){
        meso_vec2_add(from->start, post_shift(t, row, post, false)),
        meso_vec2_add(to->end, post_shift(t, row, post, true)), from->start_normal, to->end_normal, u, joins,
        post->absent, from->own & to->own, {from->own_normals[0], to->own_normals[1]}};
}

/* From the first column on and around to it. What is on one ring alone has the normals of both sides at most. */
static void put_columns(const Thinning *t, MesoProfileSet *out, const Row *row, uint32_t post_count)
{
    float begin = post_way(t, row, &t->posts[0]);
    for (uint32_t p = 0; p <= post_count; p++) {
        const Post *post = &t->posts[p];
        bool doubled = !(post->absent & MESO_ABSENT_BETWEEN) &&
                       (t->places[row_column(row, post->start)].doubled ||
                        t->places[row_column(row, post->end)].doubled);
        float u = p == 0 ? 0 : p == post_count ? 1 : fmaxf(0, post_way(t, row, post) - begin);
        if (p > 0 && doubled)
            put_column(t, out, row, post, u, true, false);
        if (p == 0 || p < post_count || !doubled)
            put_column(t, out, row, post, u, false, p < post_count);
    }
}

/* ---- all of it ---- */

static MesoStatus thinning_init(Thinning *t, const MesoProfileSet *fine, size_t point_count, MesoArena *scratch,
                                MesoError *error)
{
    size_t most = 0;
    for (uint32_t k = 0; k < fine->kind_count; k++)
        most = most > fine->kinds[k].column_count ? most : fine->kinds[k].column_count;
    t->kept = MESO_NEW(scratch, bool, point_count, error);
    t->extra = MESO_NEW(scratch, bool, fine->column_count, error);
    t->first = MESO_NEW(scratch, uint32_t, fine->kind_count, error);
    t->firsts = MESO_NEW(scratch, Post, fine->kind_count, error);
    t->shifts = MESO_NEW(scratch, MesoVec2, point_count, error);
    t->posts = MESO_NEW(scratch, Post, most + 2, error);
    t->points = MESO_NEW(scratch, MesoVec2, BLENDS * most, error);
    t->fixed = MESO_NEW(scratch, bool, most, error);
    t->inner = MESO_NEW(scratch, bool, most, error);
    t->inner_shifts[0] = MESO_NEW(scratch, MesoVec2, most, error);
    t->inner_shifts[1] = MESO_NEW(scratch, MesoVec2, most, error);
    bool has = t->kept && t->extra && t->first && t->firsts && t->shifts && t->posts && t->points && t->fixed &&
               t->inner && t->inner_shifts[0] && t->inner_shifts[1];
    return has ? MESO_OK : MESO_ERR_MEMORY;
}

/* Between its corners; without any, from its last point all around. */
static void thin_ring(const MesoRing *ring, bool *kept, MesoVec2 *shifts, MesoColumnLimits limits)
{
    const MesoClosedCurve curve = {ring->points, ring->count};
    const MesoCurveRow row = {&curve, 1, ring->creased, kept, {shifts, NULL}};
    uint32_t first = ring->count - 1;
    for (uint32_t i = ring->count; i-- > 0;)
        if (ring->creased[i])
            first = i;
    float off;
    meso_curves_thin(&row, first, limits, &off);
}

static void thin_kind(Thinning *t, MesoProfileSet *profiles, uint32_t k)
{
    MesoSweptKind *kind = &profiles->kinds[k];
    const Row row = make_row(t, &t->fine->kinds[k], t->first[k]);
    float *off = profiles->origins[k].off;
    uint32_t post_count, begin = profiles->column_count;
    do {
        memset(off, 0, sizeof profiles->origins[k].off);
        post_count = set_posts(t, &row, t->firsts[k]);
    } while (divide_kind(t, &row, post_count, off));
    post_count = divide_inner(t, &row, post_count, off);
    put_columns(t, profiles, &row, post_count);
    kind->column_begin = begin;
    kind->column_count = profiles->column_count - begin;
    meso_sweep_count(kind, profiles->columns + begin);
}

MesoStatus meso_columns_thin(MesoProfileSet *profiles, const MesoColumnPlace *places, const MesoRing *rings,
                             uint32_t ring_count, MesoArena *scratch, MesoColumnLimits limits, MesoError *error)
{
    const MesoProfileSet fine = *profiles;
    size_t point_count = 0;
    for (uint32_t r = 0; r < ring_count; r++)
        point_count += rings[r].count;
    Thinning t = {.fine = &fine, .places = places, .limits = limits};
    MesoStatus status = thinning_init(&t, &fine, point_count, scratch, error);
    profiles->columns = MESO_NEW(scratch, MesoSweepColumn, (size_t)fine.column_count + 2 * fine.kind_count, error);
    if (status || !profiles->columns)
        return MESO_ERR_MEMORY;

    size_t point = 0;
    for (uint32_t r = 0; r < ring_count; point += rings[r++].count)
        thin_ring(&rings[r], t.kept + point, t.shifts + point, limits);
    for (uint32_t k = 0; k < fine.kind_count; k++)
        find_first(&t, k);
    profiles->column_count = 0;
    for (uint32_t k = 0; k < fine.kind_count; k++)
        thin_kind(&t, profiles, k);
    return MESO_OK;
}
