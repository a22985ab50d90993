#include "libcore/render/light/light_order.h"

#include <stdlib.h>
#include <string.h>

/* ---- order ---- */

/* A bundle, and a number that is the less, the nearer it is. */
typedef struct Place {
    uint32_t key, bundle;
} Place;

/* Floats as integers in their order, and turned around; 0 is one number. */
static uint32_t key_of(float nearness)
{
    uint32_t bits;
    nearness += 0.0f;
    memcpy(&bits, &nearness, sizeof bits);
    return bits >> 31 ? bits : ~bits & 0x7fffffff;
}

/* By their keys, and where these are one by bundles; byte by byte, from the lowest. `other` [count] is scratch. */
static void sort_places(Place *places, Place *other, uint32_t count)
{
    for (uint32_t shift = 0; shift < 32; shift += 8) {
        uint32_t begin[257] = {0};
        for (uint32_t i = 0; i < count; i++)
            begin[(places[i].key >> shift & 255) + 1]++;
        for (uint32_t k = 0; k < 256; k++)
            begin[k + 1] += begin[k];
        for (uint32_t i = 0; i < count; i++)
            other[begin[places[i].key >> shift & 255]++] = places[i];
        Place *sorted = other;
        other = places;
        places = sorted;
    }
}

/* What lights of all directions share is how far out it is; where they are alike, their direction counts. */
static float nearness_of(const MesoLightMaps *maps, MesoVec3 mean, const MesoBox *box)
{
    MesoVec3 at = meso_vec3_sub(meso_vec3_lerp(box->low, box->high, 0.5f), maps->maps[0].view.eye);
    float nearness = meso_vec3_dot(at, mean) + (1 - meso_vec3_length(mean)) * meso_vec3_length(at);
    return isfinite(nearness) ? nearness : -INFINITY;
}

uint32_t *meso_light_order(const MesoLightMaps *maps, const MesoShapes *shapes, bool *failed)
{
    MesoVec3 mean = {0, 0, 0};
    uint32_t count = shapes->bundle_count;
    if (!shapes->bundle_bounds || count == 0)
        return NULL;
    Place *places = malloc(2 * (size_t)count * sizeof *places);
    uint32_t *order = malloc(count * sizeof *order);
    *failed = *failed || !places || !order;
    for (uint32_t m = 0; m < maps->count; m++)
        mean = meso_vec3_mad(mean, 1 / (float)maps->count, maps->maps[m].toward);
    for (uint32_t b = 0; b < count && places; b++)
        places[b] = (Place){key_of(nearness_of(maps, mean, &shapes->bundle_bounds[b])), b};
    if (places)
        sort_places(places, places + count, count);
    for (uint32_t b = 0; b < count && places && order; b++)
        order[b] = places[b].bundle;
    free(places);
    return order;
}

/* ---- what is hidden ---- */

/* Texels whose middles may be covered, along one axis. */
typedef struct Span {
    int32_t first, last;
} Span;

static Span span_of(float low, float high, uint32_t size)
{
    const float slack = 2.f / MESO_RASTER_UNIT;
    float first = ceilf(low + 0.5f - slack), last = floorf(high - 1.5f + slack);       /* it is a texel wider */
    first = first > 0 ? first : 0;
    last = last < (float)size - 1 ? last : (float)size - 1;
    return last >= first ? (Span){(int32_t)first, (int32_t)last} : (Span){0, -1};
}

bool meso_light_map_hides(const MesoLightMap *map, uint32_t size, const MesoRasterRect *rect)
{
    enum { MOST = 256 };                /* texels: of more, one is soon seen */
    if (!isfinite(rect->left + rect->right + rect->top + rect->bottom + rect->depth))
        return false;
    Span x = span_of(rect->left, rect->right, size), y = span_of(rect->top, rect->bottom, size);
    if ((int64_t)(x.last - x.first + 1) * (y.last - y.first + 1) > MOST)
        return false;
    /* What stands for thin shapes is drawn nearer by up to half a texel (shape_columns.h); what triangles are nearer
     * than their corners by rounding is far less than the rest. */
    float nearest = 0.51f / map->view.focal - rect->depth;
    for (int32_t py = y.first; py <= y.last; py++) {
        const float *row = map->nearness + (size_t)(py >> 2) * 4 * size + 4 * (py & 3);     /* of cells of 4 x 4 */
        for (int32_t px = x.first; px <= x.last; px++)
            if (!(row[(px >> 2) * MESO_RASTER_LANES + (px & 3)] > nearest))
                return false;
    }
    return true;
}

bool meso_light_maps_hide(const MesoLightMaps *maps, const MesoBox *box)
{
    MesoVec3 corners[8];
    for (uint32_t i = 0; i < 8; i++)
        corners[i] = meso_box_corner(box->low, box->high, i);
    for (uint32_t m = 0; m < maps->count; m++) {
        MesoRasterRect rect = meso_raster_rect_around(&maps->maps[m].view, corners, 8, 0);
        if (!meso_light_map_hides(&maps->maps[m], maps->size, &rect))
            return false;
    }
    return true;
}
