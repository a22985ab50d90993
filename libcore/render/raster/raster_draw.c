#include "libcore/render/raster/raster_draw.h"

#include <string.h>

#include "libcore/render/raster/raster_fill_wide.h"

/* ---- a step ---- */

static inline size_t place_of(const MesoRasterTarget *target, int32_t px, int32_t py)
{
    return (size_t)LANES * (size_t)((py >> 2) * target->cells_x + (px >> 2)) + (size_t)((py & 3) * 4 + (px & 3));
}

static inline void put(const MesoRasterTarget *target, int32_t px, int32_t py, float nearness, uint32_t id)
{
    size_t place = place_of(target, px, py);
    if (!(nearness > target->nearness[place]))
        return;
    target->nearness[place] = nearness;
    if (target->ids)
        target->ids[place] = id;
}

static inline MesoRasterVertex corner_of(const MesoRasterQueue *q, uint32_t l, uint32_t k)
{
    return (MesoRasterVertex){q->x[k][l], q->y[k][l], q->nearness[k][l]};
}

/* Draws triangle `l` at the middles that it covers. */
MESO_RASTER_INLINE void draw_middles(const MesoRasterQueue *q, const Middles *middles, uint32_t l)
{
    MesoRasterVertex a = corner_of(q, l, 0), b = corner_of(q, l, 1), c = corner_of(q, l, 2);
    Outline o = {.a = &a, .b = &b, .c = &c, .area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)};
    float along_x, along_y;
    find_slope(&o, &along_x, &along_y);
    uint32_t wide = (uint32_t)middles->wide[l];
    for (uint32_t left = (uint32_t)middles->covered[l]; left; left &= left - 1) {
        uint32_t k = (uint32_t)__builtin_ctz(left), row = k / wide;
        int32_t px = middles->first_x[l] + (int32_t)(k - row * wide), py = middles->first_y[l] + (int32_t)row;
        float x = (float)(px * MESO_RASTER_UNIT + HALF - a.x), y = (float)(py * MESO_RASTER_UNIT + HALF - a.y);
        put(&q->target, px, py, a.nearness + along_x * x + along_y * y, q->ids[l]);
    }
}

MESO_RASTER_INLINE void draw_lane(const MesoRasterQueue *q, uint32_t l)
{
    MesoRasterVertex a = corner_of(q, l, 0), b = corner_of(q, l, 1), c = corner_of(q, l, 2);
    draw_one(&q->target, &a, &b, &c, q->ids[l], q->one_sided[l]);
}

MESO_RASTER_INLINE void draw_single(const MesoRasterQueue *q)
{
    Middles middles;
    uint32_t kept = sift_middles(&middles, q);
    for (uint32_t left = kept; left; left &= left - 1) {       /* maps are larger than caches */
        uint32_t l = (uint32_t)__builtin_ctz(left);
        __builtin_prefetch(&q->target.nearness[place_of(&q->target, middles.first_x[l], middles.first_y[l])]);
    }
    for (uint32_t left = kept; left; left &= left - 1) {
        uint32_t l = (uint32_t)__builtin_ctz(left);
        if (middles.covered[l])
            draw_middles(q, &middles, l);
        else
            draw_lane(q, l);
    }
}

/* Small ones between large ones are drawn together. */
MESO_RASTER_INLINE void draw_several(const MesoRasterQueue *q, FillCells *fill)
{
    Cells cells;
    uint32_t bits = find_cells(&cells, q), kept = bits & 0xffff, large = bits >> 16;
    for (; large; large &= large - 1) {
        uint32_t before = (large & -large) - 1;
        fill(q, &cells, kept & before);
        kept &= ~before;
        draw_lane(q, (uint32_t)__builtin_ctz(large));
    }
    fill(q, &cells, kept);
}

/* Lanes behind the last have no area. */
MESO_RASTER_INLINE void draw_step(MesoRasterQueue *q, FillCells *fill)
{
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t l = q->count; l < STEP; l++)
            q->x[k][l] = q->y[k][l] = 0;
    if (q->target.lanes->samples == 1)
        draw_single(q);
    else
        draw_several(q, fill);
    q->count = 0;
}

/* ---- triangles ---- */

typedef void DrawStep(MesoRasterQueue *q);

MESO_RASTER_INLINE void put_corner(MesoRasterQueue *q, uint32_t k, const MesoRasterPoints *points, uint32_t i)
{
    q->x[k][q->count] = points->x[i];
    q->y[k][q->count] = points->y[i];
    q->nearness[k][q->count] = points->nearness[i];
}

MESO_RASTER_INLINE void push(MesoRasterQueue *q, DrawStep *draw, const MesoRasterPoints *points, uint32_t a,
                             uint32_t b, uint32_t c, uint32_t id, bool one_sided)
{
    put_corner(q, 0, points, a);
    put_corner(q, 1, points, b);
    put_corner(q, 2, points, c);
    q->ids[q->count] = id;
    q->one_sided[q->count] = one_sided;
    if (++q->count == STEP)
        draw(q);
}

MESO_RASTER_INLINE void add(MesoRasterQueue *q, DrawStep *draw, const MesoRasterPoints *points,
                            const uint32_t *corners, uint32_t triangle_count, uint32_t first_id, bool one_sided)
{
    for (uint32_t t = 0; t < triangle_count; t++, corners += 3)
        push(q, draw, points, corners[0], corners[1], corners[2], first_id + t, one_sided);
}

/* ---- rings ---- */

/* Where a box has to lie to hold a place: of low + before to high + behind, by 2^shift, is something of 0 to last. */
typedef struct Gauge {
    uint32_t before, behind;
    int32_t shift, last_x, last_y;
    int32_t two_sided;
} Gauge;

static inline Gauge gauge_of(const MesoRasterTarget *target, bool one_sided)
{
    int32_t cell = target->lanes->cell;
    if (target->lanes->samples == 1)
        return (Gauge){HALF - 1, 0u - HALF, 8, 4 * target->cells_x - 1, 4 * target->cells_y - 1, !one_sided};
    return (Gauge){0, 0, __builtin_ctz((unsigned)cell), target->cells_x - 1, target->cells_y - 1, !one_sided};
}

/* Of a spare point, anything. */
MESO_RASTER_INLINE int32_t moved(int32_t a, uint32_t by)
{
    return (int32_t)((uint32_t)a + by);
}

MESO_RASTER_INLINE int32_t minus(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a - (uint32_t)b);
}

MESO_RASTER_INLINE int32_t area_of(int32_t bx, int32_t by, int32_t cx, int32_t cy)
{
    return (int32_t)((uint32_t)bx * (uint32_t)cy - (uint32_t)by * (uint32_t)cx);
}

/* Whether a triangle with such a box and area, if it is not large, may show at some place. */
MESO_RASTER_INLINE int32_t may_show(const Gauge *g, int32_t low_x, int32_t high_x, int32_t low_y, int32_t high_y,
                                    int32_t area)
{
    int32_t left = most(moved(low_x, g->before) >> g->shift, 0);
    int32_t right = least(moved(high_x, g->behind) >> g->shift, g->last_x);
    int32_t top = most(moved(low_y, g->before) >> g->shift, 0);
    int32_t bottom = least(moved(high_y, g->behind) >> g->shift, g->last_y);
    int32_t large = ((minus(high_x, low_x) | minus(high_y, low_y)) >> SMALL_BITS) != 0;
    return (left <= right) & (top <= bottom) & (large | (area < 0) | ((area > 0) & g->two_sided));
}

/* Of the two triangles at each of sixteen points: bits of the first ones, and from bit 16 on of the second ones. */
MESO_RASTER_INLINE uint32_t look_at(const int32_t *x, const int32_t *y, uint32_t width, const Gauge *gauge)
{
    const Gauge g = *gauge;
    const int32_t *behind_x = x + width, *behind_y = y + width;
    uint32_t bits = 0;
    for (int i = 0; i < STEP; i++) {
        int32_t ax = x[i], ay = y[i], bx = x[i + 1], by = y[i + 1];
        int32_t cx = behind_x[i], cy = behind_y[i], dx = behind_x[i + 1], dy = behind_y[i + 1];
        int32_t low_x = least(ax, dx), high_x = most(ax, dx), low_y = least(ay, dy), high_y = most(ay, dy);
        int32_t ad_x = minus(dx, ax), ad_y = minus(dy, ay);
        int32_t acd = area_of(minus(cx, ax), minus(cy, ay), ad_x, ad_y);
        int32_t adb = area_of(ad_x, ad_y, minus(bx, ax), minus(by, ay));
        int32_t first = may_show(&g, least(low_x, cx), most(high_x, cx), least(low_y, cy), most(high_y, cy), acd);
        int32_t second = may_show(&g, least(low_x, bx), most(high_x, bx), least(low_y, by), most(high_y, by), adb);
        bits |= ((uint32_t)first | (uint32_t)second << 16) << i;
    }
    return bits;
}

/* The lowest bits of bytes; nothing else of them: those behind the last are anything. */
static inline uint32_t bits_of_bytes(const uint8_t *lanes)
{
    uint32_t bits = 0;
    for (uint32_t i = 0; i < STEP; i += 8) {        /* eight are carried to the top by one factor */
        uint64_t bytes;
        memcpy(&bytes, lanes + i, sizeof bytes);
        bits |= (uint32_t)((bytes & 0x0101010101010101u) * 0x0102040810204080u >> 56) << i;
    }
    return bits;
}

MESO_RASTER_INLINE void add_rings(MesoRasterQueue *q, DrawStep *draw, const MesoRasterPoints *points,
                                  const MesoRasterRings *rings, uint32_t first_id, bool one_sided)
{
    const Gauge gauge = gauge_of(&q->target, one_sided);
    uint32_t width = rings->width, count = rings->count;
    for (uint32_t begin = 0; begin < count; begin += STEP) {
        uint32_t bits = look_at(points->x + begin, points->y + begin, width, &gauge);
        uint32_t joined = count - begin < STEP ? (1u << (count - begin)) - 1 : (1u << STEP) - 1;
        joined &= bits_of_bytes(rings->joined + begin);
        uint32_t in_first = bits & joined, in_second = bits >> 16 & joined;
        for (uint32_t left = in_first | in_second; left; left &= left - 1) {
            uint32_t lane = (uint32_t)__builtin_ctz(left), here = begin + lane, ahead = here + width, id = first_id;
            if (rings->sides)
                id += 2 * (here / width * rings->side_count + rings->sides[here % width]);
            if (in_first >> lane & 1)
                push(q, draw, points, here, ahead, ahead + 1, id, one_sided);
            if (in_second >> lane & 1)
                push(q, draw, points, here, ahead + 1, here + 1, id + 1, one_sided);
        }
    }
}

/* ---- for each machine ---- */

#define DRAWING(name, code, fill)                                                                                      \
    code __attribute__((noinline)) static void draw_##name(MesoRasterQueue *q)                                         \
    {                                                                                                                  \
        draw_step(q, fill);                                                                                            \
    }                                                                                                                  \
    code static void add_##name(MesoRasterQueue *q, const MesoRasterPoints *points, const uint32_t *corners,           \
                                uint32_t triangle_count, uint32_t first_id, bool one_sided)                            \
    {                                                                                                                  \
        add(q, draw_##name, points, corners, triangle_count, first_id, one_sided);                                     \
    }                                                                                                                  \
    code static void add_rings_##name(MesoRasterQueue *q, const MesoRasterPoints *points,                              \
                                      const MesoRasterRings *rings, uint32_t first_id, bool one_sided)                 \
    {                                                                                                                  \
        add_rings(q, draw_##name, points, rings, first_id, one_sided);                                                 \
    }

DRAWING(plain, , fill_cells)
#if defined(__x86_64__)
DRAWING(avx2, MESO_RASTER_AVX2_CODE, fill_cells_avx2)
DRAWING(avx512, MESO_RASTER_AVX512_CODE, fill_cells_avx512)
#define BY_MACHINE(name) {name##_plain, name##_avx2, name##_avx512}
#else
#define BY_MACHINE(name) {name##_plain, name##_plain, name##_plain}
#endif

MesoRasterMachine meso_raster_machine(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        return MESO_RASTER_AVX512;
    if (__builtin_cpu_supports("avx2"))
        return MESO_RASTER_AVX2;
#endif
    return MESO_RASTER_PLAIN;
}

void meso_raster_begin(MesoRasterQueue *queue, const MesoRasterTarget *target)
{
    queue->target = *target;
    queue->machine = meso_raster_machine();
    queue->count = 0;
}

void meso_raster_add(MesoRasterQueue *queue, const MesoRasterPoints *points, const uint32_t *corners,
                     uint32_t triangle_count, uint32_t first_id, bool one_sided)
{
    static void (*const by_machine[])(MesoRasterQueue *, const MesoRasterPoints *, const uint32_t *, uint32_t, uint32_t,
                                      bool) = BY_MACHINE(add);
    by_machine[queue->machine](queue, points, corners, triangle_count, first_id, one_sided);
}

void meso_raster_add_rings(MesoRasterQueue *queue, const MesoRasterPoints *points, const MesoRasterRings *rings,
                           uint32_t first_id, bool one_sided)
{
    static void (*const by_machine[])(MesoRasterQueue *, const MesoRasterPoints *, const MesoRasterRings *, uint32_t,
                                      bool) = BY_MACHINE(add_rings);
    by_machine[queue->machine](queue, points, rings, first_id, one_sided);
}

void meso_raster_flush(MesoRasterQueue *queue)
{
    static void (*const by_machine[])(MesoRasterQueue *) = BY_MACHINE(draw);
    if (queue->count)
        by_machine[queue->machine](queue);
}
