/*
 * The step of front_kernel.h where all fronts are circular, in twice four lanes
 * of the compiler's own vectors: any machine has these, or does without. Each
 * line has its twin there; what is told is the same to the last bit.
 *
 * A lane is a spoke, and the lane behind it the next. Behind the last comes
 * the first again, where there is room: so shifts are the same for all rings,
 * and what reaches the first spoke from the last is found in that lane.
 */
#ifndef MESO_FRONT_KERNEL_FOUR_H
#define MESO_FRONT_KERNEL_FOUR_H

#include <string.h>

#include "libcore/geodesic/front_kernel.h"
#include "libcore/math/four.h"

#ifdef MESO_HAS_FOUR
#define MESO_HAS_FRONT_STEP_FOUR 1

typedef struct MesoEight {
    MesoFour low, high;
} MesoEight;

/* Four of a ring's spokes, seen from the vertex, and their sides of triangles. */
typedef struct MesoFourSides {
    MesoFour x, y, z, di;
    MesoFour squared, l, inverse, sx, sy;
    MesoFourBits counts;        /* d(u), d(i) and l make a triangle */
} MesoFourSides;

/* Each lane has what the next has, and the last what the first has. */
MESO_FOUR MesoEight meso_eight_next(MesoFour low, MesoFour high)
{
    return (MesoEight){MESO_FOUR_SHUFFLE(low, high, 1, 2, 3, 4), MESO_FOUR_SHUFFLE(high, low, 1, 2, 3, 4)};
}

MESO_FOUR MesoEight meso_eight_before(MesoFour low, MesoFour high)
{
    return (MesoEight){MESO_FOUR_SHUFFLE(high, low, 3, 4, 5, 6), MESO_FOUR_SHUFFLE(low, high, 3, 4, 5, 6)};
}

MESO_FOUR MesoFour meso_four_row(const MesoGeodesicRow *row)
{
    MesoFour values;
    memcpy(&values, row, sizeof values);
    return values;
}

/* x, y, z and distance of four rows; `told` has the sign that planar fronts have. */
MESO_FOUR MesoFourSides meso_four_spokes(MesoFour a, MesoFour b, MesoFour c, MesoFour d, const MesoGeodesicRow *u,
                                         MesoFour *told)
{
    MesoFour ab_xy = MESO_FOUR_SHUFFLE(a, b, 0, 4, 1, 5), ab_zd = MESO_FOUR_SHUFFLE(a, b, 2, 6, 3, 7);
    MesoFour cd_xy = MESO_FOUR_SHUFFLE(c, d, 0, 4, 1, 5), cd_zd = MESO_FOUR_SHUFFLE(c, d, 2, 6, 3, 7);
    MesoFourSides spokes = {
        .x = MESO_FOUR_SHUFFLE(ab_xy, cd_xy, 0, 1, 4, 5) - u->x,
        .y = MESO_FOUR_SHUFFLE(ab_xy, cd_xy, 2, 3, 6, 7) - u->y,
        .z = MESO_FOUR_SHUFFLE(ab_zd, cd_zd, 0, 1, 4, 5) - u->z,
    };
    *told = MESO_FOUR_SHUFFLE(ab_zd, cd_zd, 2, 3, 6, 7);
    spokes.di = meso_four_absolute(*told);
    return spokes;
}

MESO_FOUR bool meso_four_any_negative(MesoFour low, MesoFour high)
{
    MesoFourWords words = (MesoFourWords)low | (MesoFourWords)high;
    return (words[0] | words[1]) & 0x8000000080000000u;
}

MESO_FOUR void meso_four_sides(MesoFourSides *side, float du)
{
    side->squared = (side->x * side->x + side->y * side->y) + side->z * side->z;
    side->l = meso_four_root(side->squared);
    side->inverse = 1 / side->l;
    MesoFour difference = du - side->di, sum = du + side->di;
    side->counts = (meso_four_absolute(difference) <= side->l) & (side->l * MESO_FRONT_SLACK <= sum);
    side->sx = (side->squared + difference * sum) * (0.5f * side->inverse);
    MesoFour rest = (du - side->sx) * (du + side->sx);
    side->sy = meso_four_root((MesoFour)((MesoFourBits)rest & (rest > meso_four_all(0))));
}

/* Twice the area of the triangles from each spoke to the next. */
MESO_FOUR MesoFour meso_four_area(const MesoFourSides *side, MesoFour x, MesoFour y, MesoFour z)
{
    MesoFour cx = side->y * z - side->z * y, cy = side->z * x - side->x * z, cz = side->x * y - side->y * x;
    return meso_four_root((cx * cx + cy * cy) + cz * cz);
}

MESO_FOUR MesoFour meso_four_dot(const MesoFourSides *side, MesoFour x, MesoFour y, MesoFour z)
{
    return (side->x * x + side->y * y) + side->z * z;
}

/* Squares of the distances at the corners that face the sides; INFINITY where the front does not cross. */
MESO_FOUR MesoFour meso_four_across(const MesoFourSides *side, MesoFour dot, MesoFour area, MesoFourBits exists)
{
    MesoFour px = dot * side->inverse, py = area * side->inverse;
    MesoFour x = px - side->sx, y = py + side->sy;
    MesoFour t = side->sx * py + px * side->sy;
    MesoFourBits crosses = (meso_four_all(0) <= t) & (t <= side->l * y);
    return meso_four_choose(crosses & side->counts & exists, x * x + y * y, meso_four_all(INFINITY));
}

MESO_FOUR MesoFour meso_four_best(const MesoFourSides *side, MesoFour squared, float du, float least)
{
    MesoFour through = meso_four_root(squared);
    through = meso_four_choose(through > least, through, meso_four_all(least));
    return meso_four_least(through, du + side->l);
}

MESO_FOUR uint32_t meso_four_lower(MesoFour best, MesoFour di)
{
    MesoFourBits lower = (best < di) & (MesoFourBits){1, 2, 4, 8};
    MesoFourWords words = (MesoFourWords)lower;
    uint64_t both = words[0] | words[1];
    return (uint32_t)(both | both >> 32);
}

/* As meso_front_step_plain(). */
MESO_FOUR uint32_t meso_front_step_four(const MesoFrontStep *step, float *found)
{
    static const int32_t lanes[16] = {-1, -1, -1, -1, -1, -1, -1, -1};
    const MesoGeodesicRow *rows = step->rows, *u = &rows[step->vertex];
    const uint32_t *spokes = step->spokes;
    uint32_t n = step->count;
    MesoFour first = meso_four_row(&rows[spokes[0]]), told[2];
    MesoFourSides low = meso_four_spokes(first, meso_four_row(&rows[spokes[1]]),
                                         meso_four_row(&rows[spokes[n > 2 ? 2 : 0]]),
                                         meso_four_row(&rows[spokes[n > 3 ? 3 : 0]]), u, &told[0]);
    MesoFourSides high = meso_four_spokes(meso_four_row(&rows[spokes[n > 4 ? 4 : 0]]),
                                          meso_four_row(&rows[spokes[n > 5 ? 5 : 0]]),
                                          meso_four_row(&rows[spokes[n > 6 ? 6 : 0]]),
                                          meso_four_row(&rows[spokes[n > 7 ? 7 : 0]]), u, &told[1]);
    if (__builtin_signbit(u->distance) || meso_four_any_negative(told[0], told[1]))
        return meso_front_step_plain(step, found);

    float du = u->distance;
    meso_four_sides(&low, du);
    meso_four_sides(&high, du);
    MesoEight x = meso_eight_next(low.x, high.x), y = meso_eight_next(low.y, high.y), z = meso_eight_next(low.z, high.z);
    MesoEight dot = {meso_four_dot(&low, x.low, y.low, z.low), meso_four_dot(&high, x.high, y.high, z.high)};
    MesoEight area = {meso_four_area(&low, x.low, y.low, z.low), meso_four_area(&high, x.high, y.high, z.high)};

    const int32_t *sides = lanes + 8 - (step->closed ? n : n - 1);
    MesoEight ahead;
    memcpy(&ahead, sides, sizeof ahead);
    MesoEight behind = meso_eight_before(ahead.low, ahead.high);
    MesoEight from_before = meso_eight_before(meso_four_across(&low, dot.low, area.low, (MesoFourBits)ahead.low),
                                              meso_four_across(&high, dot.high, area.high, (MesoFourBits)ahead.high));
    dot = meso_eight_before(dot.low, dot.high);
    area = meso_eight_before(area.low, area.high);
    MesoEight from_next = meso_eight_next(meso_four_across(&low, dot.low, area.low, (MesoFourBits)behind.low),
                                          meso_four_across(&high, dot.high, area.high, (MesoFourBits)behind.high));
    MesoFour best[2] = {
        meso_four_best(&low, meso_four_least(from_before.low, from_next.low), du, step->floor),
        meso_four_best(&high, meso_four_least(from_before.high, from_next.high), du, step->floor)};
    memcpy(found, best, sizeof best);
    uint32_t lower = meso_four_lower(best[0], low.di) | meso_four_lower(best[1], high.di) << 4;
    if (n < 8 && step->closed && found[n] < found[0]) {
        found[0] = found[n];
        lower |= lower >> n & 1;
    }
    return lower & ((1u << n) - 1);
}

#endif
#endif
