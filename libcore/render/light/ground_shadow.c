#include "libcore/render/light/ground_shadow.h"

#include <string.h>

#include "libcore/base/parallel.h"

static const float PI = 3.14159265f;

/* Where what stands in the way is looked for, in radii of the scene: the side of a texel of the level. */
static const float REACH = 0.25f;

/* Of a pyramid of boxes under a quadratic B-spline, in texels: both have a variance, 1/12 and 1/4. */
static const float DEVIATION = 0.577f;

/* Deviation of the blur, in angles that lights stand for. Half of one leaves no step between neighbours; the sky's is
 * less, as what is blurred past the horizon is lost. */
static const float SKY_BLUR = 0.2f, KEY_BLUR = 0.5f;

/* From where on the shadow fades, and where it has ended, in radii of the scene. */
static const float FADE_BEGIN = 2, FADE_END = 4;

/* ---- pyramids ---- */

/* Texels of nothing around each level, so that a place may be asked for that is beside it. */
enum { MARGIN = 3 };

static uint32_t row_of(const MesoGroundMaps *g, uint32_t level)
{
    return g->sizes[level] + 2 * MARGIN;
}

/* Texel (0, 0) of a level. */
static MesoGroundTexel *level_of(const MesoGroundMaps *g, uint64_t m, uint32_t level)
{
    return g->levels[m] + g->starts[level] + MARGIN * (row_of(g, level) + 1);
}

static void plan_levels(MesoGroundMaps *g)
{
    uint32_t size = (g->maps->size + 1) / 2, start = 0;
    g->level_count = 0;
    for (; ; size = (size + 1) / 2) {
        g->sizes[g->level_count] = size;
        g->starts[g->level_count++] = start;
        start += (size + 2 * MARGIN) * (size + 2 * MARGIN);
        if (size == 1)
            break;
    }
    g->starts[g->level_count] = start;
}

static float nearness_at(const MesoLightMaps *maps, const float *map, uint32_t x, uint32_t y)
{
    return map[((y >> 2) * (maps->size / 4) + (x >> 2)) * 16 + (y & 3) * 4 + (x & 3)];
}

static void put(MesoGroundTexel *texel, float cover, float nearness)
{
    *texel = (MesoGroundTexel){(uint16_t)(65535 * cover + 0.5f), (uint16_t)(65535 * nearness + 0.5f)};
}

static void make_first(const MesoGroundMaps *g, uint64_t m)
{
    const float *map = g->maps->maps[m].nearness;
    uint32_t size = g->maps->size / 2, row = row_of(g, 0);
    MesoGroundTexel *level = level_of(g, m, 0);
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++) {
            float cover = 0, near = 0;
            for (uint32_t k = 0; k < 4; k++) {
                float nearness = nearness_at(g->maps, map, 2 * x + (k & 1), 2 * y + (k >> 1));
                if (nearness > -INFINITY) {
                    cover += 0.25f;
                    near += 0.25f * fminf(fmaxf((nearness - g->low) / g->range, 0), 1);
                }
            }
            put(&level[y * row + x], cover, near);
        }
}

static void make_next(const MesoGroundMaps *g, uint64_t m, uint32_t l)
{
    const MesoGroundTexel *from = level_of(g, m, l - 1);
    uint32_t size = g->sizes[l], row = row_of(g, l), from_row = row_of(g, l - 1);
    MesoGroundTexel *level = level_of(g, m, l);
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++) {
            const MesoGroundTexel *a = &from[2 * y * from_row + 2 * x], *b = a + from_row;
            uint32_t cover = (uint32_t)a[0].cover + a[1].cover + b[0].cover + b[1].cover;
            uint32_t near = (uint32_t)a[0].nearness + a[1].nearness + b[0].nearness + b[1].nearness;
            level[y * row + x] = (MesoGroundTexel){(uint16_t)((cover + 2) / 4), (uint16_t)((near + 2) / 4)};
        }
}

static void make_pyramids(void *context, uint64_t begin, uint64_t end)
{
    const MesoGroundMaps *g = context;
    for (uint64_t m = begin; m < end; m++) {
        if (!g->levels[m])
            continue;
        memset(g->levels[m], 0, g->starts[g->level_count] * sizeof *g->levels[m]);
        make_first(g, m);
        for (uint32_t l = 1; l < g->level_count; l++)
            make_next(g, m, l);
    }
}

static MesoStatus make_maps(MesoGroundMaps *g, MesoArena *arena, const MesoLightRig *rig, const MesoLightMaps *maps,
                            float spread, uint32_t thread_count, MesoError *error)
{
    *g = (MesoGroundMaps){.maps = maps, .spread = spread, .low = -rig->radius, .range = 2 * rig->radius};
    if (maps->count == 0)
        return MESO_OK;
    plan_levels(g);
    while (g->wide + 1 < g->level_count && (float)(2u << g->wide) * maps->texel < REACH * rig->radius)
        g->wide++;
    g->levels = MESO_NEW(arena, MesoGroundTexel *, maps->count, error);
    if (!g->levels)
        return MESO_ERR_MEMORY;
    for (uint32_t m = 0; m < maps->count; m++) {
        if (meso_vec3_dot(maps->maps[m].toward, rig->up) <= 0)
            continue;
        g->levels[m] = MESO_NEW(arena, MesoGroundTexel, g->starts[g->level_count], error);
        if (!g->levels[m])
            return MESO_ERR_MEMORY;
    }
    meso_parallel_for(thread_count, maps->count, 1, make_pyramids, g);
    return MESO_OK;
}

MesoStatus meso_ground_shadow_init(MesoGroundShadow *shadow, MesoArena *arena, const MesoLightRig *rig,
                                   uint32_t thread_count, MesoError *error)
{
    float key_angle = rig->key.count ? rig->key_extent * sqrtf(PI / (float)rig->key.count) : 0;
    float sky_angle = sqrtf(4 * PI / (float)rig->sky.count);
    shadow->rig = rig;
    MesoStatus status = make_maps(&shadow->sky, arena, rig, &rig->sky, SKY_BLUR * sky_angle, thread_count, error);
    return status ? status : make_maps(&shadow->key, arena, rig, &rig->key, KEY_BLUR * key_angle, thread_count, error);
}

/* ---- looking them up ---- */

typedef struct Cover {
    float share, nearness;      /* the second times the first */
} Cover;

/* By quadratic B-splines, at a place in texels of the maps. Outside of a level there is nothing. */
static inline Cover cover_at(const MesoGroundMaps *g, uint32_t m, uint32_t level, float x, float y)
{
    float side = (float)(2u << level), end = (float)g->sizes[level] + 1.5f;
    x = fminf(fmaxf(x / side, -1.5f), end) + 2;
    y = fminf(fmaxf(y / side, -1.5f), end) + 2;
    int32_t i = (int32_t)x, j = (int32_t)y, row = (int32_t)row_of(g, level);
    float fx = x - (float)i - 0.5f, fy = y - (float)j - 0.5f;
    const float wx[3] = {0.5f * (0.5f - fx) * (0.5f - fx), 0.75f - fx * fx, 0.5f * (0.5f + fx) * (0.5f + fx)};
    const float wy[3] = {0.5f * (0.5f - fy) * (0.5f - fy), 0.75f - fy * fy, 0.5f * (0.5f + fy) * (0.5f + fy)};
    const MesoGroundTexel *t = level_of(g, m, level) + (j - 3) * row + i - 3;
    float share = 0, nearness = 0;
    for (int v = 0; v < 3; v++, t += row) {
        share += wy[v] * (wx[0] * (float)t[0].cover + wx[1] * (float)t[1].cover + wx[2] * (float)t[2].cover);
        nearness += wy[v] * (wx[0] * (float)t[0].nearness + wx[1] * (float)t[1].nearness +
                             wx[2] * (float)t[2].nearness);
    }
    return (Cover){share / 65535, nearness / 65535};
}

/* Blurred by a Gaussian of that deviation, in texels of the maps; by not less than the first level's. */
static Cover blurred_at(const MesoGroundMaps *g, uint32_t m, float deviation, float x, float y)
{
    float top = (float)(g->level_count - 1);
    float level = fminf(fmaxf(log2f(deviation / (2 * DEVIATION)), 0), top), floor = floorf(level);
    uint32_t lower = (uint32_t)floor, upper = lower + 1 < g->level_count ? lower + 1 : lower;
    float share = level - floor;
    Cover a = cover_at(g, m, lower, x, y), b = cover_at(g, m, upper, x, y);
    return (Cover){a.share + share * (b.share - a.share), a.nearness + share * (b.nearness - a.nearness)};
}

/* How much of a light is hidden. */
static float hidden(const MesoGroundMaps *g, uint32_t m, MesoVec3 p)
{
    const MesoRasterView *view = &g->maps->maps[m].view;
    MesoVec3 q = meso_vec3_sub(p, view->eye);
    float x = view->middle_x + view->focal * meso_vec3_dot(q, view->right);
    float y = view->middle_y + view->focal * meso_vec3_dot(q, view->down);
    float mine = -meso_vec3_dot(q, view->forward), texel = g->maps->texel;
    Cover cover = cover_at(g, m, g->wide, x, y);
    /* What is around the place at large says how wide to look, and what is there how much to blur. */
    for (int i = 0; i < 2 && cover.share > 0; i++) {
        float ahead = g->low + g->range * cover.nearness / cover.share - mine;
        float deviation = g->spread * fmaxf(ahead, 0) / texel;
        cover = blurred_at(g, m, deviation, x, y);
    }
    return cover.share;
}

static float luminance(const float color[3])
{
    return 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
}

static float key_hidden(const MesoGroundShadow *shadow, MesoVec3 p)
{
    const MesoLightRig *rig = shadow->rig;
    float sum = 0;
    for (uint32_t m = 0; m < rig->key.count; m++)
        sum += shadow->key.levels[m] ? hidden(&shadow->key, m, p) : 1;
    return rig->key.count ? sum / (float)rig->key.count : 1;
}

/* Of the sky's irradiance / pi. */
static float sky_hidden(const MesoGroundShadow *shadow, MesoVec3 p)
{
    const MesoLightRig *rig = shadow->rig;
    float sum = 0;
    for (uint32_t m = 0; m < rig->sky.count; m++) {
        if (!shadow->sky.levels[m])
            continue;
        float facing = meso_vec3_dot(rig->sky.maps[m].toward, rig->up);
        sum += facing * luminance(&rig->sky_colors[3 * (size_t)m]) * hidden(&shadow->sky, m, p);
    }
    return 4 / (float)rig->sky.count * sum;
}

float meso_ground_shadow_at(const MesoGroundShadow *shadow, MesoVec3 p)
{
    const MesoLightRig *rig = shadow->rig;
    float far = meso_vec3_length(meso_vec3_sub(p, rig->middle)) / rig->radius;
    float t = fminf(fmaxf((far - FADE_BEGIN) / (FADE_END - FADE_BEGIN), 0), 1), fade = 1 - t * t * (3 - 2 * t);
    if (fade == 0)
        return 0;
    float from_key = luminance(rig->colors.key) / PI * fmaxf(meso_vec3_dot(rig->up, rig->to_key), 0);
    float whole = from_key + luminance(rig->open_sky);
    float taken = (from_key > 0 ? from_key * key_hidden(shadow, p) : 0) + sky_hidden(shadow, p);
    return whole > 0 ? fade * fminf(taken / whole, 1) : 0;
}
