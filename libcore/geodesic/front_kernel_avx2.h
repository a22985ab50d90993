/*
 * The step of front_kernel.h, a lane a spoke. Each line has its twin there,
 * with the same operations in the same order: what is told is the same to the
 * last bit. Lanes behind the last spoke hold vertices that have nothing to do
 * with the ring, and are masked at the end.
 */
#ifndef MESO_FRONT_KERNEL_AVX2_H
#define MESO_FRONT_KERNEL_AVX2_H

#include "libcore/geodesic/front_kernel.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define MESO_HAS_FRONT_STEP_AVX2 1

#include <immintrin.h>

#define MESO_AVX2 static inline __attribute__((always_inline, target("avx2")))

/* By number of spokes: the lane of the next and of the one before, around. */
static const int32_t meso_front_next[9][8] __attribute__((aligned(32))) = {
    {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {1, 0, 2, 3, 4, 5, 6, 7},
    {1, 2, 0, 3, 4, 5, 6, 7}, {1, 2, 3, 0, 4, 5, 6, 7}, {1, 2, 3, 4, 0, 5, 6, 7},
    {1, 2, 3, 4, 5, 0, 6, 7}, {1, 2, 3, 4, 5, 6, 0, 7}, {1, 2, 3, 4, 5, 6, 7, 0},
};
static const int32_t meso_front_before[9][8] __attribute__((aligned(32))) = {
    {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {1, 0, 2, 3, 4, 5, 6, 7},
    {2, 0, 1, 3, 4, 5, 6, 7}, {3, 0, 1, 2, 4, 5, 6, 7}, {4, 0, 1, 2, 3, 5, 6, 7},
    {5, 0, 1, 2, 3, 4, 6, 7}, {6, 0, 1, 2, 3, 4, 5, 7}, {7, 0, 1, 2, 3, 4, 5, 6},
};

/* By number of triangles: the lanes whose spoke has a triangle behind it. */
static const int32_t meso_front_sides[9][8] __attribute__((aligned(32))) = {
    {0}, {-1}, {-1, -1}, {-1, -1, -1}, {-1, -1, -1, -1}, {-1, -1, -1, -1, -1}, {-1, -1, -1, -1, -1, -1},
    {-1, -1, -1, -1, -1, -1, -1}, {-1, -1, -1, -1, -1, -1, -1, -1},
};

typedef struct MesoFrontLanes {
    __m256 x, y, z, told;
} MesoFrontLanes;

/* What stands on both sides of each spoke's side of triangles. */
typedef struct MesoFrontSides {
    __m256 du, l, inverse, sx, sy, gx, gy;
    __m256 planar_u, planar_i;      /* sign bits */
} MesoFrontSides;

/* What reaches the corners that face the sides, and whether it has crossed the side. */
typedef struct MesoFrontFound {
    __m256 distance, crosses;
    __m256 planar;                  /* sign bits */
} MesoFrontFound;

MESO_AVX2 __m256 meso_front_absolute(__m256 a)
{
    return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a);
}

MESO_AVX2 __m256 meso_front_pair(const MesoGeodesicRow *low, const MesoGeodesicRow *high)
{
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(&low->x)), _mm_loadu_ps(&high->x), 1);
}

/* What stands behind the last spoke would be far away in memory: lanes that are often empty take the first again. */
MESO_AVX2 MesoFrontLanes meso_front_gather(const MesoGeodesicRow *rows, const uint32_t *spokes, uint32_t count)
{
    __m256 a = meso_front_pair(&rows[spokes[0]], &rows[spokes[count > 4 ? 4 : 0]]);
    __m256 b = meso_front_pair(&rows[spokes[1]], &rows[spokes[count > 5 ? 5 : 0]]);
    __m256 c = meso_front_pair(&rows[spokes[2]], &rows[spokes[count > 6 ? 6 : 0]]);
    __m256 d = meso_front_pair(&rows[spokes[3]], &rows[spokes[count > 7 ? 7 : 0]]);
    __m256 ab_xy = _mm256_unpacklo_ps(a, b), cd_xy = _mm256_unpacklo_ps(c, d);
    __m256 ab_zd = _mm256_unpackhi_ps(a, b), cd_zd = _mm256_unpackhi_ps(c, d);
    return (MesoFrontLanes){
        _mm256_shuffle_ps(ab_xy, cd_xy, 0x44), _mm256_shuffle_ps(ab_xy, cd_xy, 0xee),
        _mm256_shuffle_ps(ab_zd, cd_zd, 0x44), _mm256_shuffle_ps(ab_zd, cd_zd, 0xee)};
}

/* (ax bx + ay by) + az bz */
MESO_AVX2 __m256 meso_front_dot(__m256 ax, __m256 ay, __m256 az, __m256 bx, __m256 by, __m256 bz)
{
    return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(ax, bx), _mm256_mul_ps(ay, by)), _mm256_mul_ps(az, bz));
}

/* a b - c d */
MESO_AVX2 __m256 meso_front_minor(__m256 a, __m256 b, __m256 c, __m256 d)
{
    return _mm256_sub_ps(_mm256_mul_ps(a, b), _mm256_mul_ps(c, d));
}

MESO_AVX2 __m256 meso_front_root(__m256 a)
{
    return _mm256_sqrt_ps(_mm256_max_ps(a, _mm256_setzero_ps()));
}

MESO_AVX2 __m256 meso_front_between(__m256 t, __m256 whole)
{
    return _mm256_and_ps(_mm256_cmp_ps(_mm256_setzero_ps(), t, _CMP_LE_OQ), _mm256_cmp_ps(t, whole, _CMP_LE_OQ));
}

/* Distances are squared. */
MESO_AVX2 MesoFrontFound meso_front_circular(const MesoFrontSides *side, __m256 px, __m256 py)
{
    __m256 x = _mm256_sub_ps(px, side->sx), y = _mm256_add_ps(py, side->sy);
    __m256 t = _mm256_add_ps(_mm256_mul_ps(side->sx, py), _mm256_mul_ps(px, side->sy));
    __m256 squared = _mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y));
    return (MesoFrontFound){squared, meso_front_between(t, _mm256_mul_ps(side->l, y)), _mm256_setzero_ps()};
}

MESO_AVX2 MesoFrontFound meso_front_planar(const MesoFrontSides *side, __m256 px, __m256 py)
{
    __m256 t = meso_front_minor(side->gy, px, side->gx, py), whole = _mm256_mul_ps(side->l, side->gy);
    __m256 along = _mm256_add_ps(side->du, _mm256_mul_ps(side->gx, px));
    __m256 nearer_u = _mm256_cmp_ps(t, _mm256_mul_ps(_mm256_set1_ps(0.5f), whole), _CMP_LT_OQ);
    return (MesoFrontFound){_mm256_add_ps(along, _mm256_mul_ps(side->gy, py)), meso_front_between(t, whole),
                            _mm256_blendv_ps(side->planar_i, side->planar_u, nearer_u)};
}

/* `planar_lanes`: a bit for each, not none. Where it is all, the other half is left out. */
MESO_AVX2 MesoFrontFound meso_front_across_avx2(const MesoFrontSides *side, __m256 dot, __m256 area, int planar_lanes)
{
    __m256 px = _mm256_mul_ps(dot, side->inverse), py = _mm256_mul_ps(area, side->inverse);
    MesoFrontFound front = meso_front_planar(side, px, py);
    if (planar_lanes == 255)
        return front;
    MesoFrontFound circular = meso_front_circular(side, px, py);
    __m256 planar = _mm256_or_ps(side->planar_u, side->planar_i);
    return (MesoFrontFound){_mm256_blendv_ps(_mm256_sqrt_ps(circular.distance), front.distance, planar),
                            _mm256_blendv_ps(circular.crosses, front.crosses, planar),
                            _mm256_and_ps(front.planar, planar)};
}

/* What of the two triangles at each spoke is told, and where. */
typedef struct MesoFrontAround {
    __m256i next, before;
    __m256 ahead_counts, behind_counts;
} MesoFrontAround;

/*
 * What circular fronts tell through triangles. Squares are compared, and one root is drawn: roots that are rounded are in
 * the order of what is under them.
 */
MESO_AVX2 __m256 meso_front_all_circular(const MesoFrontSides *side, const MesoFrontAround *around, __m256 dot,
                                         __m256 area)
{
    __m256 px = _mm256_mul_ps(dot, side->inverse), py = _mm256_mul_ps(area, side->inverse);
    MesoFrontFound ahead = meso_front_circular(side, px, py);
    px = _mm256_mul_ps(_mm256_permutevar8x32_ps(dot, around->before), side->inverse);
    py = _mm256_mul_ps(_mm256_permutevar8x32_ps(area, around->before), side->inverse);
    MesoFrontFound behind = meso_front_circular(side, px, py);
    __m256 none = _mm256_set1_ps(INFINITY);
    __m256 from_before = _mm256_blendv_ps(none, ahead.distance, _mm256_and_ps(ahead.crosses, around->ahead_counts));
    __m256 from_next = _mm256_blendv_ps(none, behind.distance, _mm256_and_ps(behind.crosses, around->behind_counts));
    from_before = _mm256_permutevar8x32_ps(from_before, around->before);
    from_next = _mm256_permutevar8x32_ps(from_next, around->next);
    return _mm256_sqrt_ps(_mm256_min_ps(from_before, from_next));
}

MESO_AVX2 uint32_t meso_front_step_avx2(const MesoFrontStep *step, float *found)
{
    const MesoGeodesicRow *u = &step->rows[step->vertex];
    MesoFrontLanes ring = meso_front_gather(step->rows, step->spokes, step->count);
    __m256 sign = _mm256_set1_ps(-0.0f), own = _mm256_set1_ps(u->distance);
    __m256 x = _mm256_sub_ps(ring.x, _mm256_set1_ps(u->x));
    __m256 y = _mm256_sub_ps(ring.y, _mm256_set1_ps(u->y));
    __m256 z = _mm256_sub_ps(ring.z, _mm256_set1_ps(u->z));
    __m256 squared = meso_front_dot(x, y, z, x, y, z);
    __m256 di = meso_front_absolute(ring.told);
    __m256 planar = _mm256_or_ps(ring.told, own);
    int planar_lanes = _mm256_movemask_ps(planar);

    __m256i next = _mm256_load_si256((const __m256i *)meso_front_next[step->count]);
    __m256i before = _mm256_load_si256((const __m256i *)meso_front_before[step->count]);
    __m256 nx = _mm256_permutevar8x32_ps(x, next), ny = _mm256_permutevar8x32_ps(y, next);
    __m256 nz = _mm256_permutevar8x32_ps(z, next);
    __m256 cx = meso_front_minor(y, nz, z, ny), cy = meso_front_minor(z, nx, x, nz), cz = meso_front_minor(x, ny, y, nx);
    __m256 dot = meso_front_dot(x, y, z, nx, ny, nz);
    __m256 area = _mm256_sqrt_ps(meso_front_dot(cx, cy, cz, cx, cy, cz));

    MesoFrontSides side = {.planar_u = _mm256_and_ps(own, sign), .planar_i = _mm256_and_ps(ring.told, sign)};
    side.du = meso_front_absolute(own);
    side.l = _mm256_sqrt_ps(squared);
    side.inverse = _mm256_div_ps(_mm256_set1_ps(1), side.l);
    __m256 difference = _mm256_sub_ps(side.du, di), sum = _mm256_add_ps(side.du, di);
    __m256 valid = _mm256_cmp_ps(meso_front_absolute(difference), side.l, _CMP_LE_OQ);
    __m256 meets = _mm256_cmp_ps(_mm256_mul_ps(side.l, _mm256_set1_ps(MESO_FRONT_SLACK)), sum, _CMP_LE_OQ);
    valid = _mm256_and_ps(valid, _mm256_or_ps(meets, planar));
    if (planar_lanes != 255) {
        __m256 doubled = _mm256_add_ps(squared, _mm256_mul_ps(difference, sum));
        side.sx = _mm256_mul_ps(doubled, _mm256_mul_ps(_mm256_set1_ps(0.5f), side.inverse));
        side.sy = meso_front_root(_mm256_mul_ps(_mm256_sub_ps(side.du, side.sx), _mm256_add_ps(side.du, side.sx)));
    }
    if (planar_lanes != 0) {
        side.gx = _mm256_mul_ps(_mm256_xor_ps(difference, sign), side.inverse);
        side.gy = meso_front_root(_mm256_sub_ps(_mm256_set1_ps(1), _mm256_mul_ps(side.gx, side.gx)));
    }

    uint32_t sides = step->closed ? step->count : step->count - 1;
    __m256 has_ahead = _mm256_castsi256_ps(_mm256_load_si256((const __m256i *)meso_front_sides[sides]));
    MesoFrontAround around = {next, before, _mm256_and_ps(valid, has_ahead),
                              _mm256_and_ps(valid, _mm256_permutevar8x32_ps(has_ahead, before))};
    __m256 least = _mm256_set1_ps(step->floor), best = _mm256_add_ps(side.du, side.l);
    uint32_t spokes = (1u << step->count) - 1;
    if (planar_lanes == 0) {
        __m256 through = _mm256_max_ps(meso_front_all_circular(&side, &around, dot, area), least);
        best = _mm256_min_ps(through, best);
        _mm256_storeu_ps(found, best);
        return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(best, di, _CMP_LT_OQ)) & spokes;
    }
    MesoFrontFound ahead = meso_front_across_avx2(&side, dot, area, planar_lanes);
    MesoFrontFound behind = meso_front_across_avx2(&side, _mm256_permutevar8x32_ps(dot, before),
                                                   _mm256_permutevar8x32_ps(area, before), planar_lanes);
    __m256 none = _mm256_set1_ps(INFINITY);
    __m256 ahead_counts = _mm256_and_ps(ahead.crosses, around.ahead_counts);
    __m256 behind_counts = _mm256_and_ps(behind.crosses, around.behind_counts);
    __m256 from_before = _mm256_blendv_ps(none, _mm256_max_ps(ahead.distance, least), ahead_counts);
    __m256 from_next = _mm256_blendv_ps(none, _mm256_max_ps(behind.distance, least), behind_counts);
    from_before = _mm256_permutevar8x32_ps(from_before, before);
    from_next = _mm256_permutevar8x32_ps(from_next, next);

    __m256 best_planar = side.planar_u;
    __m256 nearer = _mm256_cmp_ps(from_before, best, _CMP_LT_OQ);
    best = _mm256_blendv_ps(best, from_before, nearer);
    best_planar = _mm256_blendv_ps(best_planar, _mm256_permutevar8x32_ps(ahead.planar, before), nearer);
    nearer = _mm256_cmp_ps(from_next, best, _CMP_LT_OQ);
    best = _mm256_blendv_ps(best, from_next, nearer);
    best_planar = _mm256_blendv_ps(best_planar, _mm256_permutevar8x32_ps(behind.planar, next), nearer);
    _mm256_storeu_ps(found, _mm256_or_ps(best, best_planar));
    return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(best, di, _CMP_LT_OQ)) & spokes;
}

#endif
#endif
