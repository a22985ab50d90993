/*
 * Leaves out small triangles, as in "Optimizing the Graphics Pipeline with Compute" (Wihlidal, GDC 2016), but by their
 * edges, and apart for each sample; and those behind others, as in "Masked Software Occlusion Culling" (Hasselgren,
 * Andersson and Akenine-Moeller 2016), where each small triangle hides what is behind it.
 */
#include "libcore/render/raster/sift_triangles.h"

#include <math.h>
#include <stdlib.h>

enum { LANES = MESO_RASTER_LANES };

/*
 * Units by which a driver's vertices may lie beside ours along each axis, as both are rounded. So may each point of its
 * triangle lie beside one of ours, whichever way either runs; and so it holds a place that lies farther than that
 * within all of our edges.
 */
int32_t meso_sift_slack(uint32_t bits)
{
    int32_t parts = 1 << (bits < 8 ? bits : 8);
    return (MESO_RASTER_UNIT / 2 + parts - 1) / parts + 2;
}

/* Triangles of more cells, or pixels, or as many units, are kept for all samples: edges of others fit in 32 bits. */
enum { MOST_CELLS = 32, MOST_PIXELS = 64, MOST_UNITS = 1 << 13 };

/*
 * What is nearer by this share, or in a parallel view by these pixels, is so for certain: far more than what depths are
 * rounded by, and far less than a strand is thick.
 */
static const float NEARER_SHARE = 1.0001f, NEARER_PIXELS = 0.01f;

uint32_t meso_sift_side(uint32_t samples)
{
    return samples == 1 ? MESO_SIFT_SIDE : MESO_SIFT_SIDE / 2;
}

static inline int32_t cells_across(const MesoSiftPart *part, int32_t pixels)
{
    return (pixels + (int32_t)part->lanes->pixels - 1) / (int32_t)part->lanes->pixels;
}

void meso_sift_clear(const MesoSiftPart *part)
{
    int32_t count = LANES * cells_across(part, part->wide) * cells_across(part, part->high);
    for (int32_t i = 0; i < count; i++)
        part->nearness[i] = -INFINITY;
}

/* What hides a thing of this nearness is nearer than that. */
static inline float hiding_nearness(const MesoSiftPart *part, float nearness)
{
    return part->parallel ? nearness + NEARER_PIXELS / part->focal : nearness * NEARER_SHARE;
}

static inline int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static inline int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* Cells, or pixels, all included. */
typedef struct Range {
    int32_t left, right, top, bottom;
} Range;

static inline int32_t count_of(const Range *r)
{
    return r->left > r->right || r->top > r->bottom ? 0 : (r->right - r->left + 1) * (r->bottom - r->top + 1);
}

/* The place of a pixel's one sample. */
static inline float *place_of(const MesoSiftPart *part, int32_t cells_x, int32_t x, int32_t y)
{
    return part->nearness + LANES * ((y >> 2) * cells_x + (x >> 2)) + 4 * (y & 3) + (x & 3);
}

/* ---- a rectangle ---- */

static int32_t floor_within(float x, int32_t low, int32_t high)
{
    return x > (float)low ? x < (float)high ? (int32_t)floorf(x) : high : low;
}

/* Pixels whose samples may be in it; it is a pixel wider than what it is of. */
static Range pixels_of(const MesoSiftPart *part, const MesoRasterRect *rect)
{
    const float slack = (float)part->slack / MESO_RASTER_UNIT;
    bool middles = part->lanes->samples == 1;
    float left = middles ? ceilf(rect->left + 0.5f - slack) : floorf(rect->left + 1 - slack);
    float top = middles ? ceilf(rect->top + 0.5f - slack) : floorf(rect->top + 1 - slack);
    float back = middles ? 1.5f - slack : 1 - slack;
    return (Range){floor_within(left, 0, part->wide), floor_within(rect->right - back, -1, part->wide - 1),
                   floor_within(top, 0, part->high), floor_within(rect->bottom - back, -1, part->high - 1)};
}

static bool is_covered(const MesoSiftPart *part, int32_t cells_x, int32_t x, int32_t y, float nearest)
{
    const MesoRasterLanes *lanes = part->lanes;
    int32_t side = (int32_t)lanes->pixels, samples = (int32_t)lanes->samples;
    int32_t lane = (y % side * side + x % side) * samples;
    const float *there = part->nearness + LANES * (y / side * cells_x + x / side) + lane;
    for (int32_t i = 0; i < samples; i++)
        if (!(there[i] > nearest))
            return false;
    return true;
}

bool meso_sift_hides(const MesoSiftPart *part, const MesoRasterRect *rect)
{
    enum { MOST = 1024 };               /* pixels: of more, one is soon seen */
    Range r = pixels_of(part, rect);
    int32_t cells_x = cells_across(part, part->wide);
    if (count_of(&r) == 0)
        return true;
    if (count_of(&r) > MOST || !(part->parallel || rect->depth > 0))
        return false;
    float nearest = hiding_nearness(part, part->parallel ? -rect->depth : 1 / rect->depth);
    for (int32_t y = r.top; y <= r.bottom; y++)
        for (int32_t x = r.left; x <= r.right; x++)
            if (!is_covered(part, cells_x, x, y, nearest))
                return false;
    return true;
}

/* ---- a triangle ---- */

/* The part as a loop needs it. */
typedef struct Frame {
    const MesoSiftPart *part;
    int32_t cells_x, cells_y;
    int32_t shift;              /* of a cell's units */
} Frame;

/* The box around a triangle, as wide as it may be drawn. */
typedef struct Reach {
    int32_t low_x, high_x, low_y, high_y;
} Reach;

/*
 * (bx - ax)(y - ay) - (by - ay)(x - ax) + slack, at least 0 inside, and at least `sure` for certain: as a sum of x and
 * y times these, and a constant.
 */
typedef struct Side {
    int32_t along_x, along_y, constant, sure;
} Side;

static inline Side make_side(const MesoRasterVertex *a, const MesoRasterVertex *b, int32_t turn, int32_t slack)
{
    int32_t dx = turn * (b->x - a->x), dy = turn * (b->y - a->y), wide = slack * (abs(dx) + abs(dy));
    return (Side){-dy, dx, wide, 2 * wide + 1};
}

/* Its value at (x, y), where it begins at `a`. */
static inline int32_t value_at(const Side *side, const MesoRasterVertex *a, int32_t x, int32_t y)
{
    return side->constant + side->along_x * (x - a->x) + side->along_y * (y - a->y);
}

/* How near its corners are, and what hides the nearest. What may be cut off hides nothing. */
typedef struct Nearness {
    float hiding, farthest;
} Nearness;

static inline Nearness nearness_of(const MesoSiftPart *part, const MesoRasterVertex *a, const MesoRasterVertex *b,
                                   const MesoRasterVertex *c)
{
    float ab = a->nearness > b->nearness ? a->nearness : b->nearness;
    float nearest = ab > c->nearness ? ab : c->nearness;
    float low = a->nearness < b->nearness ? a->nearness : b->nearness;
    float hiding = hiding_nearness(part, nearest);
    return (Nearness){hiding, hiding > part->cut ? -INFINITY : low < c->nearness ? low : c->nearness};
}

/* Bits of the places in the cell whose corner is (x, y) that may see it. */
__attribute__((always_inline)) static inline uint32_t places_in(const MesoRasterLanes *lanes, const Side sides[3],
                                                                const MesoRasterVertex *const v[3], Nearness near,
                                                                int32_t x, int32_t y, float *there)
{
    uint32_t bits = 0;
    int32_t e0 = value_at(&sides[0], v[0], x, y), e1 = value_at(&sides[1], v[1], x, y);
    int32_t e2 = value_at(&sides[2], v[2], x, y);
    for (int32_t l = 0; l < LANES; l++) {
        int32_t px = lanes->x[l], py = lanes->y[l];
        int32_t s0 = e0 + sides[0].along_x * px + sides[0].along_y * py;
        int32_t s1 = e1 + sides[1].along_x * px + sides[1].along_y * py;
        int32_t s2 = e2 + sides[2].along_x * px + sides[2].along_y * py;
        int32_t outside = s0 | s1 | s2, unsure = (s0 - sides[0].sure) | (s1 - sides[1].sure) | (s2 - sides[2].sure);
        float is = there[l], becomes = unsure >= 0 && near.farthest > is ? near.farthest : is;
        there[l] = becomes;
        bits |= (uint32_t)((outside >= 0) & !(is > near.hiding)) << l;
    }
    return bits;
}

/* Samples whose places are among those bits. */
static inline uint32_t fold(uint32_t bits, uint32_t samples)
{
    if (samples == 16)
        return bits;
    bits |= bits >> 8;
    bits |= bits >> 4;
    return samples == 4 ? bits & 15 : (bits | bits >> 1 | bits >> 2 | bits >> 3) & 1;
}

static inline Reach reach_of(const MesoRasterVertex *a, const MesoRasterVertex *b, const MesoRasterVertex *c,
                             int32_t slack)
{
    return (Reach){least(a->x, least(b->x, c->x)) - slack, most(a->x, most(b->x, c->x)) + slack,
                   least(a->y, least(b->y, c->y)) - slack, most(a->y, most(b->y, c->y)) + slack};
}

static inline bool is_large(const Reach *r)
{
    return r->high_x - r->low_x >= MOST_UNITS || r->high_y - r->low_y >= MOST_UNITS;
}

/* 1 or -1, as a triangle that is not large runs. */
static inline int32_t turn_of(const MesoRasterVertex *a, const MesoRasterVertex *b, const MesoRasterVertex *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x) > 0 ? 1 : -1;
}

/* With one sample a pixel: pixel by pixel, which are mostly none or one. */
static inline uint32_t middle_of(const Frame *frame, const MesoRasterVertex *a, const MesoRasterVertex *b,
                                 const MesoRasterVertex *c)
{
    enum { HALF = MESO_RASTER_UNIT / 2 };
    const MesoSiftPart *part = frame->part;
    int32_t slack = part->slack;
    Reach reach = reach_of(a, b, c, slack);
    const Range r = {most((reach.low_x + HALF - 1) >> 8, 0), least((reach.high_x - HALF) >> 8, part->wide - 1),
                     most((reach.low_y + HALF - 1) >> 8, 0), least((reach.high_y - HALF) >> 8, part->high - 1)};
    if (r.left > r.right || r.top > r.bottom)
        return 0;
    if (is_large(&reach) || count_of(&r) > MOST_PIXELS)
        return 1;
    int32_t turn = turn_of(a, b, c);
    const Side ab = make_side(a, b, turn, slack), bc = make_side(b, c, turn, slack);
    const Side ca = make_side(c, a, turn, slack);
    Nearness near = nearness_of(part, a, b, c);
    uint32_t seen = 0;
    for (int32_t y = r.top; y <= r.bottom; y++)
        for (int32_t x = r.left; x <= r.right; x++) {
            int32_t px = MESO_RASTER_UNIT * x + HALF, py = MESO_RASTER_UNIT * y + HALF;
            int32_t s0 = value_at(&ab, a, px, py), s1 = value_at(&bc, b, px, py), s2 = value_at(&ca, c, px, py);
            float *there = place_of(part, frame->cells_x, x, y);
            if ((s0 | s1 | s2) < 0 || *there > near.hiding)
                continue;
            seen = 1;
            if (near.farthest > *there && ((s0 - ab.sure) | (s1 - bc.sure) | (s2 - ca.sure)) >= 0)
                *there = near.farthest;
        }
    return seen;
}

/* Bits of the samples that may see the triangle, of several a pixel. */
__attribute__((always_inline)) static inline uint32_t samples_of(const Frame *frame, const MesoRasterVertex *a,
                                                                 const MesoRasterVertex *b, const MesoRasterVertex *c)
{
    const MesoRasterLanes *lanes = frame->part->lanes;
    const MesoRasterVertex *const v[3] = {a, b, c};
    uint32_t bits = 0;
    int32_t slack = frame->part->slack;
    Reach reach = reach_of(a, b, c, slack);
    const Range r = {most(reach.low_x >> frame->shift, 0), least(reach.high_x >> frame->shift, frame->cells_x - 1),
                     most(reach.low_y >> frame->shift, 0), least(reach.high_y >> frame->shift, frame->cells_y - 1)};
    if (r.left > r.right || r.top > r.bottom)
        return 0;
    if (is_large(&reach) || count_of(&r) > MOST_CELLS)
        return (1u << lanes->samples) - 1;
    int32_t turn = turn_of(a, b, c);
    const Side sides[3] = {make_side(a, b, turn, slack), make_side(b, c, turn, slack), make_side(c, a, turn, slack)};
    Nearness near = nearness_of(frame->part, a, b, c);
    for (int32_t y = r.top; y <= r.bottom; y++)
        for (int32_t x = r.left; x <= r.right; x++)
            bits |= places_in(lanes, sides, v, near, x << frame->shift, y << frame->shift,
                              frame->part->nearness + LANES * (y * frame->cells_x + x));
    return fold(bits, lanes->samples);
}

/* Of each triangle; returns whether any is seen at all. */
__attribute__((always_inline)) static inline bool sift_all(const Frame *frame, const MesoRasterPoints *points,
                                                           const uint32_t *corners, uint32_t count, uint16_t *samples)
{
    uint32_t any = 0;
    bool single = frame->part->lanes->samples == 1;
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t *k = corners + 3 * (size_t)t;
        MesoRasterVertex a = meso_raster_point(points, k[0]), b = meso_raster_point(points, k[1]);
        MesoRasterVertex c = meso_raster_point(points, k[2]);
        uint32_t seen = single ? middle_of(frame, &a, &b, &c) : samples_of(frame, &a, &b, &c);
        samples[t] = (uint16_t)seen;
        any |= seen;
    }
    return any;
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static bool sift_avx2(const Frame *frame, const MesoRasterPoints *points,
                                                      const uint32_t *corners, uint32_t count, uint16_t *samples)
{
    return sift_all(frame, points, corners, count, samples);
}
#endif

bool meso_sift_triangles(const MesoSiftPart *part, const MesoRasterPoints *points, const uint32_t *corners,
                         uint32_t count, uint16_t *samples)
{
    const Frame frame = {part, cells_across(part, part->wide), cells_across(part, part->high),
                         __builtin_ctz((unsigned)part->lanes->cell)};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2"))
        return sift_avx2(&frame, points, corners, count, samples);
#endif
    return sift_all(&frame, points, corners, count, samples);
}
