/*
 * Cells of small triangles filled, sixteen places at once; three times, for what machines have, with the same
 * operations on each place. For raster_draw.c alone.
 *
 * An edge at a place is its value at the cell's corner, of up to 30 bits, and an offset: whether it is at least 0 is
 * whether the offset is at least the other's opposite. Offsets are whole numbers of up to 24 bits, which floats hold,
 * and a number of more stays beyond all of them when it is rounded: floats tell.
 */
#ifndef MESO_RASTER_FILL_WIDE_H
#define MESO_RASTER_FILL_WIDE_H

#include "libcore/render/raster/raster_step.h"

/* Draws those of the cells' triangles that `kept` has bits of, in their order. */
typedef void FillCells(const MesoRasterQueue *q, const Cells *cells, uint32_t kept);

/* A triangle's way from cell to cell. */
typedef struct Walk {
    int32_t edges[3], row_edges[3], right[3], down[3];
    float nearness, row_nearness, right_nearness, down_nearness;
} Walk;

MESO_RASTER_INLINE Walk begin_walk(const Cells *cells, uint32_t l, int32_t cell)
{
    Walk w = {.row_nearness = cells->nearness[l], .right_nearness = cells->slope_x[l] * (float)cell,
              .down_nearness = cells->slope_y[l] * (float)cell};
    for (int e = 0; e < 3; e++) {
        w.row_edges[e] = cells->at_corner[e][l];
        w.right[e] = (int32_t)((uint32_t)cells->along_x[e][l] * (uint32_t)cell);
        w.down[e] = (int32_t)((uint32_t)cells->along_y[e][l] * (uint32_t)cell);
    }
    return w;
}

MESO_RASTER_INLINE void begin_row(Walk *w)
{
    for (int e = 0; e < 3; e++)
        w->edges[e] = w->row_edges[e];
    w->nearness = w->row_nearness;
}

MESO_RASTER_INLINE void go_right(Walk *w)
{
    for (int e = 0; e < 3; e++)
        w->edges[e] = (int32_t)((uint32_t)w->edges[e] + (uint32_t)w->right[e]);
    w->nearness += w->right_nearness;
}

MESO_RASTER_INLINE void go_down(Walk *w)
{
    for (int e = 0; e < 3; e++)
        w->row_edges[e] = (int32_t)((uint32_t)w->row_edges[e] + (uint32_t)w->down[e]);
    w->row_nearness += w->down_nearness;
}

/* Whether a triangle that is no nearer is behind all of a cell. */
static inline bool is_behind(const MesoRasterTarget *target, size_t cell, float nearest)
{
    return target->farthest && nearest <= target->farthest[cell];
}

/* ---- plain ---- */

static void fill_cells(const MesoRasterQueue *q, const Cells *cells, uint32_t kept)
{
    const MesoRasterTarget *target = &q->target;
    const MesoRasterLanes *lanes = target->lanes;
    for (; kept; kept &= kept - 1) {
        uint32_t l = (uint32_t)__builtin_ctz(kept);
        float offset[3][LANES], deeper[LANES];
        for (int i = 0; i < LANES; i++) {
            float x = (float)lanes->x[i], y = (float)lanes->y[i];
            for (int e = 0; e < 3; e++)
                offset[e][i] = (float)cells->along_x[e][l] * x + (float)cells->along_y[e][l] * y;
            deeper[i] = cells->slope_x[l] * x + cells->slope_y[l] * y;
        }
        Walk w = begin_walk(cells, l, lanes->cell);
        for (int32_t cy = cells->top[l]; cy <= cells->bottom[l]; cy++, go_down(&w)) {
            begin_row(&w);
            for (int32_t cx = cells->left[l]; cx <= cells->right[l]; cx++, go_right(&w)) {
                size_t cell = (size_t)cy * (size_t)target->cells_x + (size_t)cx;
                if (is_behind(target, cell, cells->nearest[l]))
                    continue;
                float *there = target->nearness + LANES * cell, farthest = __builtin_inff();
                float a = (float)-w.edges[0], b = (float)-w.edges[1], c = (float)-w.edges[2];
                bool any = false;
                for (int i = 0; i < LANES; i++) {
                    float mine = w.nearness + deeper[i];
                    if (offset[0][i] >= a && offset[1][i] >= b && offset[2][i] >= c && mine > there[i]) {
                        there[i] = mine;
                        if (target->ids)
                            target->ids[LANES * cell + (size_t)i] = q->ids[l];
                        any = true;
                    }
                    farthest = there[i] < farthest ? there[i] : farthest;
                }
                if (any && target->farthest)
                    target->farthest[cell] = farthest;
            }
        }
    }
}

#if defined(__x86_64__)

#include <immintrin.h>

/* ---- two times eight ---- */

#define MESO_RASTER_AVX2_CODE __attribute__((target("avx2")))
#ifdef __clang__
#define MESO_RASTER_AVX512_CODE __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl")))
#else       /* which would rather use half of it */
#define MESO_RASTER_AVX512_CODE __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")))
#endif

/* What a triangle has at eight places of a cell, wherever it is. */
typedef struct Eight {
    __m256 offset[3], deeper;
} Eight;

MESO_RASTER_AVX2_CODE MESO_RASTER_INLINE __m256 along_eight(float along_x, float along_y, __m256 x, __m256 y)
{
    return _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(along_x), x), _mm256_mul_ps(_mm256_set1_ps(along_y), y));
}

MESO_RASTER_AVX2_CODE MESO_RASTER_INLINE Eight put_eight(const Cells *cells, uint32_t l, __m256 x, __m256 y)
{
    Eight eight;
    for (int e = 0; e < 3; e++)
        eight.offset[e] = along_eight((float)cells->along_x[e][l], (float)cells->along_y[e][l], x, y);
    eight.deeper = along_eight(cells->slope_x[l], cells->slope_y[l], x, y);
    return eight;
}

/* All bits of the places in the triangle where it is nearer than what is there, which it takes. */
MESO_RASTER_AVX2_CODE MESO_RASTER_INLINE __m256 pass_eight(const Eight *eight, const Walk *w, __m256 *there)
{
    __m256 a = _mm256_cmp_ps(eight->offset[0], _mm256_set1_ps((float)-w->edges[0]), _CMP_GE_OQ);
    __m256 b = _mm256_cmp_ps(eight->offset[1], _mm256_set1_ps((float)-w->edges[1]), _CMP_GE_OQ);
    __m256 c = _mm256_cmp_ps(eight->offset[2], _mm256_set1_ps((float)-w->edges[2]), _CMP_GE_OQ);
    __m256 mine = _mm256_add_ps(_mm256_set1_ps(w->nearness), eight->deeper);
    __m256 nearer = _mm256_cmp_ps(mine, *there, _CMP_GT_OQ);
    __m256 pass = _mm256_and_ps(_mm256_and_ps(a, b), _mm256_and_ps(c, nearer));
    *there = _mm256_blendv_ps(*there, mine, pass);
    return pass;
}

MESO_RASTER_AVX2_CODE MESO_RASTER_INLINE void put_ids(uint32_t *ids, uint32_t id, __m256 pass)
{
    __m256 there = _mm256_loadu_ps((const float *)ids);
    __m256 mine = _mm256_castsi256_ps(_mm256_set1_epi32((int32_t)id));
    _mm256_storeu_ps((float *)ids, _mm256_blendv_ps(there, mine, pass));
}

MESO_RASTER_AVX2_CODE MESO_RASTER_INLINE float least_of(__m256 v)
{
    __m128 four = _mm_min_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
    __m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 1)));
}

MESO_RASTER_AVX2_CODE MESO_RASTER_INLINE __m256 eight_floats(const int32_t *from)
{
    return _mm256_cvtepi32_ps(_mm256_loadu_si256((const __m256i *)from));
}

MESO_RASTER_AVX2_CODE static void fill_cells_avx2(const MesoRasterQueue *q, const Cells *cells, uint32_t kept)
{
    const MesoRasterTarget *target = &q->target;
    const MesoRasterLanes *lanes = target->lanes;
    __m256 x0 = eight_floats(lanes->x), x1 = eight_floats(lanes->x + 8);
    __m256 y0 = eight_floats(lanes->y), y1 = eight_floats(lanes->y + 8);
    for (; kept; kept &= kept - 1) {
        uint32_t l = (uint32_t)__builtin_ctz(kept);
        Eight low = put_eight(cells, l, x0, y0), high = put_eight(cells, l, x1, y1);
        Walk w = begin_walk(cells, l, lanes->cell);
        for (int32_t cy = cells->top[l]; cy <= cells->bottom[l]; cy++, go_down(&w)) {
            begin_row(&w);
            for (int32_t cx = cells->left[l]; cx <= cells->right[l]; cx++, go_right(&w)) {
                size_t cell = (size_t)cy * (size_t)target->cells_x + (size_t)cx;
                if (is_behind(target, cell, cells->nearest[l]))
                    continue;
                float *at = target->nearness + LANES * cell;
                __m256 there0 = _mm256_loadu_ps(at), there1 = _mm256_loadu_ps(at + 8);
                __m256 pass0 = pass_eight(&low, &w, &there0), pass1 = pass_eight(&high, &w, &there1);
                if (_mm256_movemask_ps(_mm256_or_ps(pass0, pass1)) == 0)
                    continue;
                _mm256_storeu_ps(at, there0);
                _mm256_storeu_ps(at + 8, there1);
                if (target->ids) {
                    put_ids(target->ids + LANES * cell, q->ids[l], pass0);
                    put_ids(target->ids + LANES * cell + 8, q->ids[l], pass1);
                }
                if (target->farthest)
                    target->farthest[cell] = least_of(_mm256_min_ps(there0, there1));
            }
        }
    }
}

/* ---- sixteen ---- */

MESO_RASTER_AVX512_CODE MESO_RASTER_INLINE __m512 along_sixteen(float along_x, float along_y, __m512 x, __m512 y)
{
    return _mm512_add_ps(_mm512_mul_ps(_mm512_set1_ps(along_x), x), _mm512_mul_ps(_mm512_set1_ps(along_y), y));
}

MESO_RASTER_AVX512_CODE static void fill_cells_avx512(const MesoRasterQueue *q, const Cells *cells, uint32_t kept)
{
    const MesoRasterTarget *target = &q->target;
    const MesoRasterLanes *lanes = target->lanes;
    __m512 x = _mm512_cvtepi32_ps(_mm512_loadu_si512(lanes->x)), y = _mm512_cvtepi32_ps(_mm512_loadu_si512(lanes->y));
    for (; kept; kept &= kept - 1) {
        uint32_t l = (uint32_t)__builtin_ctz(kept);
        __m512 offset[3], deeper = along_sixteen(cells->slope_x[l], cells->slope_y[l], x, y);
        for (int e = 0; e < 3; e++)
            offset[e] = along_sixteen((float)cells->along_x[e][l], (float)cells->along_y[e][l], x, y);
        Walk w = begin_walk(cells, l, lanes->cell);
        for (int32_t cy = cells->top[l]; cy <= cells->bottom[l]; cy++, go_down(&w)) {
            begin_row(&w);
            for (int32_t cx = cells->left[l]; cx <= cells->right[l]; cx++, go_right(&w)) {
                size_t cell = (size_t)cy * (size_t)target->cells_x + (size_t)cx;
                if (is_behind(target, cell, cells->nearest[l]))
                    continue;
                float *at = target->nearness + LANES * cell;
                __m512 there = _mm512_loadu_ps(at), mine = _mm512_add_ps(_mm512_set1_ps(w.nearness), deeper);
                __mmask16 pass = _mm512_cmp_ps_mask(offset[0], _mm512_set1_ps((float)-w.edges[0]), _CMP_GE_OQ);
                pass = _mm512_mask_cmp_ps_mask(pass, offset[1], _mm512_set1_ps((float)-w.edges[1]), _CMP_GE_OQ);
                pass = _mm512_mask_cmp_ps_mask(pass, offset[2], _mm512_set1_ps((float)-w.edges[2]), _CMP_GE_OQ);
                pass = _mm512_mask_cmp_ps_mask(pass, mine, there, _CMP_GT_OQ);
                if (!pass)
                    continue;
                there = _mm512_mask_mov_ps(there, pass, mine);
                _mm512_storeu_ps(at, there);
                if (target->ids)
                    _mm512_mask_storeu_epi32(target->ids + LANES * cell, pass, _mm512_set1_epi32((int32_t)q->ids[l]));
                if (target->farthest)
                    target->farthest[cell] = least_of(_mm256_min_ps(_mm512_castps512_ps256(there),
                                                                    _mm512_extractf32x8_ps(there, 1)));
            }
        }
    }
}

#endif
#endif
