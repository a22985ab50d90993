#include "libcore/render/environment/environment.h"

static const float PI = 3.14159265f;

/* What is brighter than so many times the mean is key light, as far as it lies within so much of its middle; where that
 * is less than a share of all light there is none. */
static const float KEY_CONTRAST = 4, KEY_SHARE = 0.03f;
static const float KEY_COSINE = 0.91f;      /* 24.5 degrees */
static const float LEAST_EXTENT = 0.0123f;  /* half a texel */

enum { COARSE_WIDTH = 64, COARSE_HEIGHT = 32 };

static const float MOST_RADIANCE = 65504;

static void mend(MesoLatLong *map, float strength)
{
    for (size_t i = 0; i < 3 * (size_t)map->width * map->height; i++) {
        float x = map->rgb[i];
        x = !(x > 0) ? 0 : x > MOST_RADIANCE ? MOST_RADIANCE : x;
        map->rgb[i] = x * strength;
    }
}

/* ---- the key light ---- */

static float mean_luminance(const MesoLatLong *map)
{
    double sum = 0;
    for (uint32_t y = 0; y < map->height; y++) {
        double row = 0;
        for (uint32_t x = 0; x < map->width; x++)
            row += (double)meso_luminance(&map->rgb[3 * ((size_t)y * map->width + x)]);
        sum += row * (double)meso_lat_long_solid_angle(map, y);
    }
    return (float)(sum / (4 * 3.14159265358979));
}

/* Share of a texel that is over the limit. */
static float excess_of(const float *texel, float limit)
{
    float luminance = meso_luminance(texel);
    return luminance > limit ? 1 - limit / luminance : 0;
}

/* Sums of what exceeds the limit around a direction. */
typedef struct KeySums {
    MesoVec3 direction;         /* weighted by luminance, not unit */
    float color[3], luminance;
    float spread;               /* of the squared sine from the direction */
} KeySums;

static KeySums sum_around(const MesoLatLong *map, MesoVec3 middle, float limit)
{
    KeySums sums = {0};
    for (uint32_t y = 0; y < map->height; y++) {
        float solid_angle = meso_lat_long_solid_angle(map, y);
        for (uint32_t x = 0; x < map->width; x++) {
            const float *texel = &map->rgb[3 * ((size_t)y * map->width + x)];
            float share = excess_of(texel, limit) * solid_angle;
            if (share == 0)
                continue;
            MesoVec3 d = meso_lat_long_direction(map, x, y);
            float along = meso_vec3_dot(d, middle), light = share * meso_luminance(texel);
            if (along < KEY_COSINE)
                continue;
            for (int c = 0; c < 3; c++)
                sums.color[c] += share * texel[c];
            sums.direction = meso_vec3_mad(sums.direction, light, d);
            sums.luminance += light;
            sums.spread += light * (1 - along * along);
        }
    }
    return sums;
}

/* The direction around which most light exceeds the limit, as near as a coarse map has it. */
static MesoVec3 find_brightest(const MesoLatLong *map, float limit)
{
    static const MesoVec3 none = {0, 1, 0};
    const MesoLatLong coarse = {COARSE_WIDTH, COARSE_HEIGHT, NULL};
    uint32_t per_x = map->width / COARSE_WIDTH, per_y = map->height / COARSE_HEIGHT, best = 0;
    float light[COARSE_WIDTH * COARSE_HEIGHT] = {0}, most = 0;
    MesoVec3 directions[COARSE_WIDTH * COARSE_HEIGHT];
    for (uint32_t y = 0; y < map->height; y++)
        for (uint32_t x = 0; x < map->width; x++) {
            const float *texel = &map->rgb[3 * ((size_t)y * map->width + x)];
            light[y / per_y * COARSE_WIDTH + x / per_x] +=
                excess_of(texel, limit) * meso_luminance(texel) * meso_lat_long_solid_angle(map, y);
        }
    for (uint32_t i = 0; i < COARSE_WIDTH * COARSE_HEIGHT; i++)
        directions[i] = meso_lat_long_direction(&coarse, i % COARSE_WIDTH, i / COARSE_WIDTH);
    for (uint32_t i = 0; i < COARSE_WIDTH * COARSE_HEIGHT; i++) {
        float sum = 0;
        for (uint32_t k = 0; k < COARSE_WIDTH * COARSE_HEIGHT; k++)
            if (light[k] > 0 && meso_vec3_dot(directions[i], directions[k]) >= KEY_COSINE)
                sum += light[k];
        if (sum > most) {
            most = sum;
            best = i;
        }
    }
    return most > 0 ? directions[best] : none;
}

static void find_key(MesoEnvironment *e, const MesoLatLong *map, float limit, float mean)
{
    MesoVec3 middle = find_brightest(map, limit);
    KeySums sums = sum_around(map, middle, limit);
    for (int i = 0; i < 3; i++) {
        middle = meso_vec3_unit(sums.direction, middle);
        sums = sum_around(map, middle, limit);
    }
    e->to_key = middle;
    if (!(sums.luminance > KEY_SHARE * 4 * PI * mean))
        return;
    for (int c = 0; c < 3; c++)
        e->key[c] = sums.color[c];
    /* of a disc the mean square of the distance is half that of its rim */
    e->key_extent = fmaxf(sqrtf(2 * sums.spread / sums.luminance), LEAST_EXTENT);
}

/* Moves the key light from the rest to a part of its own. */
static void split(const MesoEnvironment *e, MesoLatLong *rest, MesoLatLong *key, float limit)
{
    for (uint32_t y = 0; y < rest->height; y++)
        for (uint32_t x = 0; x < rest->width; x++) {
            size_t at = 3 * ((size_t)y * rest->width + x);
            float share = excess_of(&rest->rgb[at], limit);
            if (share == 0 || meso_vec3_dot(meso_lat_long_direction(rest, x, y), e->to_key) < KEY_COSINE)
                continue;
            for (size_t c = 0; c < 3; c++) {
                key->rgb[at + c] = share * rest->rgb[at + c];
                rest->rgb[at + c] *= 1 - share;
            }
        }
}

/* ---- irradiance ---- */

static void harmonics_at(MesoVec3 d, float out[9])
{
    const float all[9] = {0.282095f, 0.488603f * d.y, 0.488603f * d.z, 0.488603f * d.x, 1.092548f * d.x * d.y,
                          1.092548f * d.y * d.z, 0.315392f * (3 * d.z * d.z - 1), 1.092548f * d.x * d.z,
                          0.546274f * (d.x * d.x - d.y * d.y)};
    for (int i = 0; i < 9; i++)
        out[i] = all[i];
}

static void find_harmonics(MesoEnvironment *e, const MesoLatLong *map)
{
    /* of the clamped cosine, over pi */
    static const double cosine[9] = {1, 2. / 3, 2. / 3, 2. / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
    double sums[9][3] = {{0}};
    for (uint32_t y = 0; y < map->height; y++) {
        double solid_angle = (double)meso_lat_long_solid_angle(map, y);
        for (uint32_t x = 0; x < map->width; x++) {
            const float *texel = &map->rgb[3 * ((size_t)y * map->width + x)];
            float basis[9];
            harmonics_at(meso_lat_long_direction(map, x, y), basis);
            for (int i = 0; i < 9; i++)
                for (int c = 0; c < 3; c++)
                    sums[i][c] += solid_angle * (double)basis[i] * (double)texel[c];
        }
    }
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            e->harmonics[i][c] = (float)(cosine[i] * sums[i][c]);
}

void meso_environment_diffuse(const MesoEnvironment *e, MesoVec3 normal, float out[3])
{
    float basis[9];
    harmonics_at(normal, basis);
    for (int c = 0; c < 3; c++) {
        float sum = 0;
        for (int i = 0; i < 9; i++)
            sum += basis[i] * e->harmonics[i][c];
        out[c] = fmaxf(sum, 0);     /* nine of them swing below it opposite of what is bright */
    }
}

/* ---- all of it ---- */

MesoStatus meso_environment_init(MesoEnvironment *e, MesoArena *arena, const MesoLatLong *map,
                                 const MesoEnvironmentOptions *options, uint32_t thread_count, MesoError *error)
{
    *e = (MesoEnvironment){.map = *map, .turn = options->turn * PI / 180};
    mend(&e->map, options->strength);
    MesoLatLong *rest = &e->glossy[MESO_LIGHT_REST][0], *key = &e->glossy[MESO_LIGHT_KEY][0];
    for (uint32_t part = 0; part < MESO_LIGHT_PARTS; part++) {
        MesoStatus status = meso_glossy_levels_alloc(e->glossy[part], arena, error);
        if (status)
            return status;
    }
    meso_lat_long_resample(&e->map, rest);
    float mean = mean_luminance(rest), limit = KEY_CONTRAST * mean;
    find_key(e, rest, limit, mean);
    if (e->key_extent > 0)
        split(e, rest, key, limit);
    find_harmonics(e, rest);
    return meso_glossy_levels_fill(e->glossy[MESO_LIGHT_REST], e->glossy[MESO_LIGHT_KEY], arena, thread_count, error);
}

void meso_environment_glossy(const MesoEnvironment *e, MesoEnvironmentPart part, MesoVec3 direction, float roughness,
                             float out[3])
{
    float level = fminf(fmaxf(roughness, 0), 1) * (MESO_GLOSSY_LEVELS - 1);
    float low = fminf(floorf(level), MESO_GLOSSY_LEVELS - 2), share = level - low, rough[3];
    meso_lat_long_at(&e->glossy[part][(size_t)low], direction, out);
    meso_lat_long_at(&e->glossy[part][(size_t)low + 1], direction, rough);
    for (int c = 0; c < 3; c++)
        out[c] += (rough[c] - out[c]) * share;
}

void meso_environment_axes(const MesoEnvironment *e, MesoVec3 up, MesoVec3 axes[3])
{
    MesoVec3 front = fabsf(up.z) < 0.9f ? (MesoVec3){0, 0, 1} : (MesoVec3){0, -1, 0};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(up, front), (MesoVec3){1, 0, 0}), z = meso_vec3_cross(x, up);
    float c = cosf(e->turn), s = sinf(e->turn);
    axes[0] = meso_vec3_mad(meso_vec3_scale(x, c), -s, z);
    axes[1] = up;
    axes[2] = meso_vec3_mad(meso_vec3_scale(z, c), s, x);
}
