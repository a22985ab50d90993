#include "libcore/render/environment/built_in.h"

static const float PI = 3.14159265f;

enum { HEIGHT = 256 };

static float smoothstep(float low, float high, float x)
{
    float t = (x - low) / (high - low);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

/* From degrees to the right of the front, and above the horizon. */
static MesoVec3 toward(float right, float above)
{
    float a = right * PI / 180, e = above * PI / 180;
    return (MesoVec3){cosf(e) * sinf(a), sinf(e), cosf(e) * cosf(a)};
}

/* ---- the sky ---- */

static const float TURBIDITY = 2.6f;
static const float SUN_RIGHT = -38, SUN_ABOVE = 42;                 /* degrees */
static const float SUN_RADIUS = 1.6f;                               /* of thin haze: soft shadows */
static const float SUN[3] = {3.3f, 2.95f, 2.4f};                    /* irradiance */
static const float SKY_LUMINANCE = 0.052f;                          /* of one kcd / m2 */
static const float GROUND[3] = {0.315f, 0.287f, 0.232f};              /* albedo */

/* One of luminance and chromaticities: the five numbers of Perez's formula, and the value at the zenith. */
typedef struct Perez {
    float a, b, c, d, e, zenith;
} Perez;

static float perez(const Perez *p, float cos_zenith, float cos_sun)
{
    float angle = acosf(fminf(fmaxf(cos_sun, -1), 1));
    return (1 + p->a * expf(p->b / cos_zenith)) * (1 + p->c * expf(p->d * angle) + p->e * cos_sun * cos_sun);
}

/* Linear in turbidity, and cubic in the sun's angle from the zenith where that is square. */
static void find_perez(Perez out[3], float sun)
{
    float t = TURBIDITY, s2 = sun * sun, s3 = s2 * sun, chi = (4.f / 9 - t / 120) * (PI - 2 * sun);
    out[0] = (Perez){0.1787f * t - 1.4630f, -0.3554f * t + 0.4275f, -0.0227f * t + 5.3251f, 0.1206f * t - 2.5771f,
                     -0.0670f * t + 0.3703f, (4.0453f * t - 4.9710f) * tanf(chi) - 0.2155f * t + 2.4192f};
    out[1] = (Perez){-0.0193f * t - 0.2592f, -0.0665f * t + 0.0008f, -0.0004f * t + 0.2125f, -0.0641f * t - 0.8989f,
                     -0.0033f * t + 0.0452f,
                     t * t * (0.00166f * s3 - 0.00375f * s2 + 0.00209f * sun) +
                         t * (-0.02903f * s3 + 0.06377f * s2 - 0.03202f * sun + 0.00394f) +
                         (0.11693f * s3 - 0.21196f * s2 + 0.06052f * sun + 0.25886f)};
    out[2] = (Perez){-0.0167f * t - 0.2608f, -0.0950f * t + 0.0092f, -0.0079f * t + 0.2102f, -0.0441f * t - 1.6537f,
                     -0.0109f * t + 0.0529f,
                     t * t * (0.00275f * s3 - 0.00610f * s2 + 0.00317f * sun) +
                         t * (-0.04214f * s3 + 0.08970f * s2 - 0.04153f * sun + 0.00516f) +
                         (0.15346f * s3 - 0.26756f * s2 + 0.06670f * sun + 0.26688f)};
}

/* CIE's Y, x, y to Rec. 709. */
static void to_rgb(float luminance, float x, float y, float out[3])
{
    float big_x = x / y * luminance, big_z = (1 - x - y) / y * luminance;
    out[0] = fmaxf(3.2404542f * big_x - 1.5371385f * luminance - 0.4985314f * big_z, 0);
    out[1] = fmaxf(-0.9692660f * big_x + 1.8760108f * luminance + 0.0415560f * big_z, 0);
    out[2] = fmaxf(0.0556434f * big_x - 0.2040259f * luminance + 1.0572252f * big_z, 0);
}

typedef struct Sky {
    MesoVec3 to_sun;
    Perez perez[3];
    float ground[3];            /* radiance */
} Sky;

static void sky_above(const Sky *sky, MesoVec3 d, float out[3])
{
    float values[3], cos_zenith = fmaxf(d.y, 0.03f), cos_sun = meso_vec3_dot(d, sky->to_sun);
    for (int i = 0; i < 3; i++)
        values[i] = sky->perez[i].zenith * perez(&sky->perez[i], cos_zenith, cos_sun) /
                    perez(&sky->perez[i], 1, sky->to_sun.y);
    to_rgb(SKY_LUMINANCE * values[0], values[1], values[2], out);
}

static void sky_at(const Sky *sky, MesoVec3 d, float out[3])
{
    float share = smoothstep(-0.04f, 0.02f, d.y), radius = SUN_RADIUS * PI / 180;
    sky_above(sky, d, out);
    for (int c = 0; c < 3; c++)
        out[c] = sky->ground[c] + (out[c] - sky->ground[c]) * share;
    float from_sun = acosf(fminf(meso_vec3_dot(d, sky->to_sun), 1)), edge = 0.7f * radius;
    float disc = 1 - smoothstep(radius - edge, radius + edge, from_sun);
    for (int c = 0; c < 3; c++)
        out[c] += SUN[c] * disc / (PI * radius * radius);
}

/* The ground gives back its share of what comes from above. */
static void light_ground(Sky *sky)
{
    enum { STEPS = 4096 };
    float sums[3] = {0};
    for (uint32_t i = 0; i < STEPS; i++) {
        float up = sqrtf(((float)i + 0.5f) / STEPS), across = sqrtf(1 - up * up), a = 2.39996323f * (float)i, color[3];
        sky_above(sky, (MesoVec3){across * cosf(a), up, across * sinf(a)}, color);
        for (int c = 0; c < 3; c++)
            sums[c] += color[c] / STEPS;
    }
    for (int c = 0; c < 3; c++)
        sky->ground[c] = GROUND[c] * (sums[c] + SUN[c] / PI * sky->to_sun.y);
}

static void draw_sky(MesoLatLong *map)
{
    Sky sky = {.to_sun = toward(SUN_RIGHT, SUN_ABOVE)};
    find_perez(sky.perez, acosf(sky.to_sun.y));
    light_ground(&sky);
    for (uint32_t y = 0; y < map->height; y++)
        for (uint32_t x = 0; x < map->width; x++)
            sky_at(&sky, meso_lat_long_direction(map, x, y), &map->rgb[3 * ((size_t)y * map->width + x)]);
}

/* ---- the studio ---- */

/* A lamp with a soft rim, upright at its place. */
typedef struct Lamp {
    float right, above;         /* degrees from the front, and above the horizon */
    float width, height;        /* degrees, half of each */
    float rim;                  /* share of its size over which it fades */
    float color[3];             /* radiance in its middle */
} Lamp;

static const Lamp LAMPS[] = {
    {-34, 48, 12.5f, 10, 0.3f, {27, 25.2f, 22.4f}},         /* key */
    {78, 8, 20, 30, 0.7f, {0.7f, 0.78f, 0.92f}},            /* fill */
    {27, 84, 28, 16, 0.4f, {2.2f, 2.2f, 2.2f}},             /* above */
    {124, 16, 7, 40, 0.3f, {6.2f, 6.8f, 7.6f}},             /* a rim at the right of what the default camera sees */
    {-104, 18, 6, 38, 0.3f, {4.4f, 4.3f, 4.1f}},            /* and at its left */
};

static const float ROOM[3] = {0.1f, 0.103f, 0.11f}, CEILING[3] = {0.2f, 0.205f, 0.215f};
static const float FLOOR[3] = {0.26f, 0.25f, 0.235f};

static void add_lamp(const Lamp *lamp, MesoVec3 d, float out[3])
{
    MesoVec3 z = toward(lamp->right, lamp->above), x = meso_vec3_unit(meso_vec3_cross((MesoVec3){0, 1, 0}, z), z);
    MesoVec3 y = meso_vec3_cross(z, x);
    float along = meso_vec3_dot(d, z);
    if (along <= 0)
        return;
    float across = fabsf(atanf(meso_vec3_dot(d, x) / along)) * 180 / PI / lamp->width;
    float upward = fabsf(atanf(meso_vec3_dot(d, y) / along)) * 180 / PI / lamp->height;
    float light = (1 - smoothstep(1 - lamp->rim, 1, across)) * (1 - smoothstep(1 - lamp->rim, 1, upward));
    for (int c = 0; c < 3; c++)
        out[c] += light * lamp->color[c];
}

static void draw_studio(MesoLatLong *map)
{
    for (uint32_t y = 0; y < map->height; y++)
        for (uint32_t x = 0; x < map->width; x++) {
            MesoVec3 d = meso_lat_long_direction(map, x, y);
            float *out = &map->rgb[3 * ((size_t)y * map->width + x)];
            float up = smoothstep(0, 1, d.y), down = smoothstep(0.02f, 0.6f, -d.y);
            for (int c = 0; c < 3; c++)
                out[c] = ROOM[c] + (CEILING[c] - ROOM[c]) * up + (FLOOR[c] - ROOM[c]) * down;
            for (size_t i = 0; i < sizeof LAMPS / sizeof *LAMPS; i++)
                add_lamp(&LAMPS[i], d, out);
        }
}

MesoStatus meso_built_in_draw(MesoLatLong *map, MesoArena *arena, MesoBuiltIn which, MesoError *error)
{
    MesoStatus status = meso_lat_long_init(map, arena, 2 * HEIGHT, HEIGHT, error);
    if (status)
        return status;
    if (which == MESO_BUILT_IN_SKY)
        draw_sky(map);
    else
        draw_studio(map);
    return MESO_OK;
}
