#include "libcore/render/light/light_map.h"

#include <string.h>

static MesoLightMap make_map(MesoVec3 toward, MesoVec3 middle, float focal, uint32_t size, float *nearness)
{
    MesoVec3 across = fabsf(toward.y) < 0.9f ? (MesoVec3){0, 1, 0} : (MesoVec3){0, 0, 1};
    MesoVec3 right = meso_vec3_unit(meso_vec3_cross(across, toward), (MesoVec3){1, 0, 0});
    return (MesoLightMap){
        .toward = toward, .nearness = nearness,
        .view = {.eye = middle, .right = right, .down = meso_vec3_cross(right, toward),
                 .forward = meso_vec3_scale(toward, -1), .parallel = true, .focal = focal,
                 .middle_x = 0.5f * (float)size, .middle_y = 0.5f * (float)size}};
}

MesoStatus meso_light_maps_init(MesoLightMaps *maps, MesoArena *arena, const MesoVec3 *towards, uint32_t count,
                                MesoVec3 middle, float radius, uint32_t size, MesoError *error)
{
    float focal = (float)(size - 4) / (2 * radius);
    *maps = (MesoLightMaps){.count = count, .size = size, .texel = 1 / focal, .tolerance = 0.5f / focal};
    size_t texels = (size_t)size * size;
    maps->maps = MESO_NEW(arena, MesoLightMap, count, error);
    maps->nearness = MESO_NEW(arena, float, count * texels, error);
    float *rows = MESO_NEW(arena, float, 9 * (size_t)count, error);
    if (!maps->maps || !maps->nearness || !rows)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < 9; k++)
        maps->rows[k] = rows + (size_t)k * count;
    for (uint32_t i = 0; i < count; i++) {
        const MesoLightMap map = make_map(towards[i], middle, focal, size, maps->nearness + i * texels);
        const float row[9] = {map.toward.x, map.toward.y, map.toward.z, map.view.right.x, map.view.right.y,
                              map.view.right.z, map.view.down.x, map.view.down.y, map.view.down.z};
        maps->maps[i] = map;
        for (uint32_t k = 0; k < 9; k++)
            maps->rows[k][i] = row[k];
    }
    return MESO_OK;
}

/* ---- looking them up ---- */

enum { LANES = 32 };            /* maps at once */

/* Where a place lies in each map: the texel at its upper left, from there to the next ones, and how near. */
typedef struct Places {
    int32_t texel[LANES], right[LANES], down[LANES];
    float share_x[LANES], share_y[LANES], nearness[LANES], facing[LANES];
    float lit[4][LANES];        /* 1 at those of the four texels around where nothing is nearer */
} Places;

/* Within a map of which nothing reaches the outermost two texels: beside it is as there. */
static inline float within(float x, float last)
{
    x = x > 0 ? x : 0;
    return x < last ? x : last;
}

__attribute__((always_inline)) static inline void find_places(const MesoLightMaps *maps, uint32_t begin, uint32_t count,
                                                              MesoVec3 p, MesoVec3 n, Places *out)
{
    const float *tx = maps->rows[0] + begin, *ty = maps->rows[1] + begin, *tz = maps->rows[2] + begin;
    const float *rx = maps->rows[3] + begin, *ry = maps->rows[4] + begin, *rz = maps->rows[5] + begin;
    const float *dx = maps->rows[6] + begin, *dy = maps->rows[7] + begin, *dz = maps->rows[8] + begin;
    MesoVec3 eye = maps->maps[0].view.eye;
    float middle = maps->maps[0].view.middle_x, focal = maps->maps[0].view.focal, texel = maps->texel;
    float last = (float)(maps->size - 2);
    int32_t cells = (int32_t)maps->size / 4;
    for (uint32_t i = 0; i < count; i++) {
        float facing = n.x * tx[i] + n.y * ty[i] + n.z * tz[i], lift = texel * (1 + 2 * (1 - facing));
        float qx = p.x + lift * n.x - eye.x, qy = p.y + lift * n.y - eye.y, qz = p.z + lift * n.z - eye.z;
        float x = within(middle + focal * (qx * rx[i] + qy * ry[i] + qz * rz[i]) - 0.5f, last);
        float y = within(middle + focal * (qx * dx[i] + qy * dy[i] + qz * dz[i]) - 0.5f, last);
        int32_t left = (int32_t)x, top = (int32_t)y;
        out->texel[i] = ((top >> 2) * cells + (left >> 2)) * 16 + (top & 3) * 4 + (left & 3);
        out->right[i] = (left & 3) == 3 ? 16 - 3 : 1;
        out->down[i] = (top & 3) == 3 ? 16 * cells - 12 : 4;
        out->share_x[i] = x - (float)left;
        out->share_y[i] = y - (float)top;
        out->nearness[i] = texel + (qx * tx[i] + qy * ty[i] + qz * tz[i]);
        out->facing[i] = facing > 0 ? facing : 0;
    }
}

static inline void look_around(const MesoLightMaps *maps, uint32_t begin, uint32_t count, Places *places)
{
    uint32_t which[LANES], faced = 0;
    for (uint32_t i = 0; i < count; i++) {      /* about every other: nobody could guess */
        which[faced] = i;
        faced += places->facing[i] > 0;
    }
    for (uint32_t k = 0; k < faced; k++) {
        uint32_t i = which[k];
        const float *at = maps->maps[begin + i].nearness + places->texel[i];
        int32_t right = places->right[i], down = places->down[i];
        float mine = places->nearness[i];
        places->lit[0][i] = mine >= at[0];
        places->lit[1][i] = mine >= at[right];
        places->lit[2][i] = mine >= at[down];
        places->lit[3][i] = mine >= at[right + down];
    }
}

__attribute__((always_inline)) static inline void blend(const Places *places, uint32_t count, float *facing, float *lit)
{
    for (uint32_t i = 0; i < count; i++) {
        float x = places->share_x[i], y = places->share_y[i];
        float top = places->lit[0][i] * (1 - x) + places->lit[1][i] * x;
        float bottom = places->lit[2][i] * (1 - x) + places->lit[3][i] * x;
        facing[i] = places->facing[i];
        lit[i] = facing[i] > 0 ? top * (1 - y) + bottom * y : 0;
    }
}

__attribute__((always_inline)) static inline void look_up(const MesoLightMaps *maps, MesoVec3 p, MesoVec3 n,
                                                          float *facing, float *lit)
{
    Places places;
    memset(&places.lit, 0, sizeof places.lit);
    for (uint32_t begin = 0; begin < maps->count; begin += LANES) {
        uint32_t count = maps->count - begin < LANES ? maps->count - begin : LANES;
        find_places(maps, begin, count, p, n, &places);
        look_around(maps, begin, count, &places);
        blend(&places, count, facing + begin, lit + begin);
    }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static void look_up_avx2(const MesoLightMaps *maps, MesoVec3 p, MesoVec3 n,
                                                         float *facing, float *lit)
{
    look_up(maps, p, n, facing, lit);
}
#endif

void meso_light_maps_lit(const MesoLightMaps *maps, MesoVec3 p, MesoVec3 n, float *facing, float *lit)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        look_up_avx2(maps, p, n, facing, lit);
        return;
    }
#endif
    look_up(maps, p, n, facing, lit);
}
