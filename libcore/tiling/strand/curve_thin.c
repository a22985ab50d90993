#include "libcore/tiling/strand/curve_thin.h"

#include <math.h>

enum { HALVINGS = 8 };

/* Turns in radians: the most of a chord, and of a gap whose height says how many chords it takes. */
static const float MOST_TURN = 1.0472f, TELLING_TURN = 1.75f, PART_TURN = 1.5708f;

static MesoVec2 point_of(const MesoClosedCurve *curve, uint32_t i)
{
    return curve->points[i % curve->count];
}

float meso_distance_to_chord(MesoVec2 p, MesoVec2 a, MesoVec2 b)
{
    MesoVec2 ab = meso_vec2_sub(b, a), ap = meso_vec2_sub(p, a);
    float square = ab.x * ab.x + ab.y * ab.y;
    float t = square > 0 ? fminf(fmaxf((ap.x * ab.x + ap.y * ab.y) / square, 0), 1) : 0;
    return meso_vec2_length(meso_vec2_sub(ap, meso_vec2_scale(ab, t)));
}

/* How far the curve turns between its points a and b; the second of two points at one place says nothing. */
static float turn_between(const MesoClosedCurve *curve, uint32_t a, uint32_t b)
{
    float turn = 0;
    MesoVec2 here = point_of(curve, a), before = {0, 0};
    for (uint32_t i = a + 1; i <= b; i++) {
        MesoVec2 next = point_of(curve, i), along = meso_vec2_sub(next, here);
        if (along.x == 0 && along.y == 0)
            continue;
        if (before.x != 0 || before.y != 0)
            turn += fabsf(atan2f(meso_vec2_cross(before, along), before.x * along.x + before.y * along.y));
        before = along;
        here = next;
    }
    return turn;
}

float meso_chord_pieces(const MesoClosedCurve *curve, uint32_t a, uint32_t b, MesoVec2 from, MesoVec2 to,
                        const MesoColumnLimits *limits, float *off)
{
    float turn = turn_between(curve, a, b), height = 0;
    for (uint32_t i = a; i <= b; i++)
        height = fmaxf(height, meso_distance_to_chord(point_of(curve, i), from, to));
    float pieces = turn > TELLING_TURN ? ceilf(turn / PART_TURN)
        : fmaxf(ceilf(sqrtf(height / limits->off)), turn > MOST_TURN ? 2 : 1);
    if (limits->longest > 0)
        pieces = fmaxf(pieces, ceilf(meso_vec2_length(meso_vec2_sub(to, from)) / limits->longest));
    if (pieces <= 1 || b - a <= 1)
        *off = fmaxf(*off, height);
    return pieces;
}

/* ---- chords ---- */

/* A row of curves while it is divided. */
typedef struct Division {
    const MesoCurveRow *row;
    uint32_t first, count;
    MesoColumnLimits limits;
} Division;

static uint32_t next_kept(const Division *d, uint32_t i)
{
    i++;
    while (!d->row->kept[i % d->count])
        i++;
    return i;
}

/* The farthest that the curve lies to the left of the chord from a to b, or to the right, below 0. */
static float side_height(const MesoClosedCurve *curve, uint32_t a, uint32_t b)
{
    MesoVec2 from = point_of(curve, a), chord = meso_vec2_sub(point_of(curve, b), from);
    float most = 0, length = meso_vec2_length(chord);
    for (uint32_t i = a + 1; i < b && length > 0; i++) {
        float height = meso_vec2_cross(chord, meso_vec2_sub(point_of(curve, i), from)) / length;
        most = fabsf(height) > fabsf(most) ? height : most;
    }
    return most;
}

/* Half of what the chords beside a point are off it, to their side; a corner stays where it is. */
static void shift_points(const Division *d, const MesoClosedCurve *curve, MesoVec2 *shifts)
{
    for (uint32_t a = d->first, b; a < d->first + d->count; a = b) {
        b = next_kept(d, a);
        uint32_t c = next_kept(d, b);
        MesoVec2 chord = meso_vec2_sub(point_of(curve, c), point_of(curve, a));
        float length = meso_vec2_length(chord), before = side_height(curve, a, b), behind = side_height(curve, b, c);
        float height = before * behind < 0 ? 0 : (fabsf(before) > fabsf(behind) ? before : behind) / 2;
        bool stays = d->row->fixed[b % d->count] || !(length > 0);
        shifts[b % d->count] = stays ? (MesoVec2){0, 0} : (MesoVec2){-chord.y * height / length,
                                                                     chord.x * height / length};
    }
}

static MesoVec2 shifted_point(const Division *d, uint32_t curve, uint32_t i)
{
    const MesoCurveRow *row = d->row;
    MesoVec2 shift = row->shifts[0][i % d->count];
    if (row->curve_count > 1)
        shift = meso_vec2_lerp(shift, row->shifts[1][i % d->count], (float)curve / (float)(row->curve_count - 1));
    return meso_vec2_add(point_of(&row->curves[curve], i), shift);
}

/* A chord from a shifted end to another may be off by twice the tolerance, one from a corner by half as much again. */
static bool chord_fits(const Division *d, uint32_t a, uint32_t b, float tolerance)
{
    uint32_t corners = (uint32_t)d->row->fixed[a % d->count] + d->row->fixed[b % d->count];
    float most = (2 - 0.5f * (float)corners) * tolerance;
    bool fits = true;
    for (uint32_t k = 0; k < d->row->curve_count && fits; k++) {
        const MesoClosedCurve *curve = &d->row->curves[k];
        float length = meso_vec2_length(meso_vec2_sub(point_of(curve, b), point_of(curve, a)));
        fits = !(d->limits.longest > 0 && length > d->limits.longest) && fabsf(side_height(curve, a, b)) <= most &&
               turn_between(curve, a, b) <= MOST_TURN;
    }
    return fits;
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
        d->row->kept[a % d->count] = d->row->kept[a % d->count] || keep;
    }
    return count;
}

/* As few chords as the tolerance allows, and then all as near as so many can be. */
static void divide_between(const Division *d, uint32_t begin, uint32_t end)
{
    float enough = d->limits.off, less = 0;
    uint32_t count = walk_chords(d, begin, end, enough, false);
    for (uint32_t i = 0; i < HALVINGS; i++) {
        float middle = (less + enough) / 2;
        *(walk_chords(d, begin, end, middle, false) <= count ? &enough : &less) = middle;
    }
    walk_chords(d, begin, end, enough, true);
}

/* Chords that are off by more, now that their ends have moved. */
static bool divide_again(const Division *d, float *off)
{
    bool more = false;
    for (uint32_t k = 0; k < d->row->curve_count; k++)
        off[k] = 0;
    for (uint32_t a = d->first, b; a < d->first + d->count; a = b) {
        float wanted = 1;
        b = next_kept(d, a);
        for (uint32_t k = 0; k < d->row->curve_count; k++)
            wanted = fmaxf(wanted, meso_chord_pieces(&d->row->curves[k], a, b, shifted_point(d, k, a),
                                                     shifted_point(d, k, b), &d->limits, &off[k]));
        if (wanted > 1 && b - a > 1)
            d->row->kept[(a + (b - a) / 2) % d->count] = more = true;
    }
    return more;
}

void meso_curves_thin(const MesoCurveRow *row, uint32_t first, MesoColumnLimits limits, float *off)
{
    const Division d = {row, first, row->curves->count, limits};
    for (uint32_t i = 0; i < d.count; i++)
        row->kept[i] = row->fixed[i];
    row->kept[first] = true;
    for (uint32_t a = first, b; a < first + d.count; a = b) {
        b = next_kept(&d, a);
        divide_between(&d, a, b);
    }
    do {
        shift_points(&d, &row->curves[0], row->shifts[0]);
        if (row->curve_count > 1)
            shift_points(&d, &row->curves[row->curve_count - 1], row->shifts[1]);
    } while (divide_again(&d, off));
}
