/*
 * On a map by latitude and longitude the weights of the texels around a direction are the same for all directions of a
 * row, but shifted: they are found once a row.
 */
#include "libcore/render/environment/glossy_levels.h"

#include <stdlib.h>

#include "libcore/base/parallel.h"

/* Heights, half of the widths; and those of what is read for them. */
static const uint32_t HEIGHTS[MESO_GLOSSY_LEVELS] = {128, 64, 64, 32, 32, 32, 32, 32};
static const uint32_t READ[MESO_GLOSSY_LEVELS] = {128, 128, 64, 64, 32, 32, 32, 32};

/* Of the greatest weight, below which one is left out. */
static const float LEAST_WEIGHT = 1e-3f;

MesoStatus meso_glossy_levels_alloc(MesoLatLong levels[MESO_GLOSSY_LEVELS], MesoArena *arena, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < MESO_GLOSSY_LEVELS && !status; i++)
        status = meso_lat_long_init(&levels[i], arena, 2 * HEIGHTS[i], HEIGHTS[i], error);
    return status;
}

/* A texel of what is read, by its row and its distance in columns. */
typedef struct Tap {
    uint32_t row, shift;
    float weight;
} Tap;

typedef struct Filling {
    const MesoLatLong *from[2];
    MesoLatLong *to[2];
    const MesoVec3 *directions; /* of the texels of `from` */
    float alpha2;
    bool failed;
} Filling;

/* The distribution of GGX, over its peak, times the cosine. */
static float weight_of(float alpha2, float cosine)
{
    float half2 = 0.5f * (1 + cosine), d = half2 * (alpha2 - 1) + 1;       /* of the angle to the facet's normal */
    float ndf = alpha2 / d;
    return cosine > 0 && ndf * ndf > LEAST_WEIGHT ? ndf * ndf * cosine : 0;
}

static uint32_t list_taps(const Filling *f, uint32_t row, Tap *taps)
{
    const MesoLatLong *from = f->from[0], *to = f->to[0];
    uint32_t count = 0;
    double whole = 0;
    MesoVec3 toward = meso_lat_long_direction(to, 0, row);
    for (uint32_t y = 0; y < from->height; y++) {
        float solid_angle = meso_lat_long_solid_angle(from, y);
        for (uint32_t x = 0; x < from->width; x++) {
            float weight = weight_of(f->alpha2, meso_vec3_dot(toward, f->directions[y * from->width + x]));
            if (weight > 0)
                taps[count++] = (Tap){y, x, weight * solid_angle};
        }
    }
    for (uint32_t i = 0; i < count; i++)
        whole += (double)taps[i].weight;
    for (uint32_t i = 0; i < count; i++)
        taps[i].weight = (float)((double)taps[i].weight / whole);
    return count;
}

static void fill_row(const Filling *f, uint32_t row, const Tap *taps, uint32_t count)
{
    uint32_t width = f->to[0]->width, from_width = f->from[0]->width, step = from_width / width;
    for (uint32_t x = 0; x < width; x++) {
        float sums[2][3] = {{0}};
        for (uint32_t i = 0; i < count; i++) {
            size_t at = 3 * ((size_t)taps[i].row * from_width + (taps[i].shift + x * step) % from_width);
            for (int k = 0; k < 2; k++)
                for (size_t c = 0; c < 3; c++)
                    sums[k][c] += taps[i].weight * f->from[k]->rgb[at + c];
        }
        for (int k = 0; k < 2; k++)
            for (size_t c = 0; c < 3; c++)
                f->to[k]->rgb[3 * ((size_t)row * width + x) + c] = sums[k][c];
    }
}

static void fill_rows(void *context, uint64_t begin, uint64_t end)
{
    Filling *f = context;
    Tap *taps = malloc((size_t)f->from[0]->width * f->from[0]->height * sizeof *taps);
    if (!taps)
        __atomic_store_n(&f->failed, true, __ATOMIC_RELAXED);
    for (uint64_t row = begin; taps && row < end; row++)
        fill_row(f, (uint32_t)row, taps, list_taps(f, (uint32_t)row, taps));
    free(taps);
}

/* A pair of maps that is read, and where its texels lie. */
typedef struct Source {
    MesoLatLong maps[2];
    MesoVec3 *directions;
} Source;

static MesoStatus make_source(Source *source, MesoLatLong *const sets[2], uint32_t height, MesoArena *arena,
                              MesoError *error)
{
    for (int k = 0; k < 2; k++) {
        source->maps[k] = sets[k][0];
        if (height == sets[k][0].height)
            continue;
        MesoStatus status = meso_lat_long_init(&source->maps[k], arena, 2 * height, height, error);
        if (status)
            return status;
        meso_lat_long_resample(&sets[k][0], &source->maps[k]);
    }
    uint32_t width = 2 * height;
    source->directions = MESO_NEW(arena, MesoVec3, (size_t)width * height, error);
    for (uint32_t i = 0; source->directions && i < width * height; i++)
        source->directions[i] = meso_lat_long_direction(&source->maps[0], i % width, i / width);
    return source->directions ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_glossy_levels_fill(MesoLatLong a[MESO_GLOSSY_LEVELS], MesoLatLong b[MESO_GLOSSY_LEVELS],
                                   MesoArena *arena, uint32_t thread_count, MesoError *error)
{
    MesoLatLong *const sets[2] = {a, b};
    Source source = {0};
    for (uint32_t level = 1; level < MESO_GLOSSY_LEVELS; level++) {
        float roughness = (float)level / (MESO_GLOSSY_LEVELS - 1), alpha = roughness * roughness;
        if (READ[level] != source.maps[0].height) {
            MesoStatus status = make_source(&source, sets, READ[level], arena, error);
            if (status)
                return status;
        }
        Filling f = {.from = {&source.maps[0], &source.maps[1]}, .to = {&a[level], &b[level]},
                     .directions = source.directions, .alpha2 = alpha * alpha};
        meso_parallel_for(thread_count, HEIGHTS[level], 4, fill_rows, &f);
        if (f.failed)
            return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the light");
    }
    return MESO_OK;
}
