/*
 * Maps: places and directions, light kept by resampling; a constant map is itself at any roughness and has no key
 * light; one with a disc has its light there and no other; what is lit by a cosine is as a sum over the map says;
 * turns; the built-in ones; the same for any number of threads.
 */
#include "libcore/render/environment/environment.h"

#include <string.h>

#include "libcore/base/check.h"
#include "libcore/render/environment/built_in.h"

static MesoArena arena;
static MesoError error;

static MesoLatLong constant(uint32_t width, uint32_t height, float r, float g, float b)
{
    MesoLatLong map;
    CHECK(meso_lat_long_init(&map, &arena, width, height, &error) == MESO_OK);
    for (size_t i = 0; i < (size_t)width * height; i++)
        map.rgb[3 * i] = r, map.rgb[3 * i + 1] = g, map.rgb[3 * i + 2] = b;
    return map;
}

static void add_disc(MesoLatLong *map, MesoVec3 toward, float cosine, float radiance)
{
    for (uint32_t y = 0; y < map->height; y++)
        for (uint32_t x = 0; x < map->width; x++)
            for (size_t c = 0; c < 3; c++)
                if (meso_vec3_dot(meso_lat_long_direction(map, x, y), toward) > cosine)
                    map->rgb[3 * ((size_t)y * map->width + x) + c] += radiance;
}

static MesoEnvironment ready(const MesoLatLong *map, float turn, float strength, uint32_t threads)
{
    MesoEnvironment e;
    const MesoEnvironmentOptions options = {turn, strength};
    MesoLatLong copy = constant(map->width, map->height, 0, 0, 0);
    memcpy(copy.rgb, map->rgb, 12 * (size_t)map->width * map->height);
    CHECK(meso_environment_init(&e, &arena, &copy, &options, threads, &error) == MESO_OK);
    return e;
}

/* All light of a channel. */
static double flux(const MesoLatLong *map, size_t c)
{
    double sum = 0;
    for (uint32_t y = 0; y < map->height; y++)
        for (uint32_t x = 0; x < map->width; x++)
            sum += (double)meso_lat_long_solid_angle(map, y) * (double)map->rgb[3 * ((size_t)y * map->width + x) + c];
    return sum;
}

static void test_places(void)
{
    MesoLatLong map = constant(64, 32, 1, 1, 1), small = constant(24, 12, 0, 0, 0);
    CHECK(fabs(flux(&map, 0) - 4 * 3.14159265358979) < 1e-4);
    MesoVec3 top = meso_lat_long_direction(&map, 5, 0), middle = meso_lat_long_direction(&map, 32, 16);
    MesoVec3 left = meso_lat_long_direction(&map, 16, 16);
    CHECK(top.y > 0.99f && middle.z > 0.99f && left.x > 0.99f);
    for (uint32_t i = 0; i < 64 * 32; i++)
        for (size_t c = 0; c < 3; c++)
            map.rgb[3 * i + c] = (float)(i * 37 % 101 + c);
    for (uint32_t i = 0; i < 64 * 32; i++) {
        float out[3];
        meso_lat_long_at(&map, meso_lat_long_direction(&map, i % 64, i / 64), out);
        CHECK(fabsf(out[0] - map.rgb[3 * i]) < 0.02f && fabsf(out[2] - map.rgb[3 * i + 2]) < 0.02f);
    }
    meso_lat_long_resample(&map, &small);
    CHECK(fabs(flux(&map, 1) - flux(&small, 1)) < 1e-4 * flux(&map, 1));
    map = constant(3, 2, 4, 5, 6);
    meso_lat_long_resample(&map, &small);
    for (uint32_t i = 0; i < 24 * 12; i++)
        CHECK(fabsf(small.rgb[3 * i] - 4) < 1e-5f && fabsf(small.rgb[3 * i + 2] - 6) < 1e-5f);
}

static void test_constant(void)
{
    MesoLatLong map = constant(40, 20, 0.25f, 0.5f, 1);
    MesoEnvironment e = ready(&map, 70, 2, 2);
    CHECK(e.key_extent == 0 && e.key[0] == 0 && e.key[1] == 0 && e.key[2] == 0);
    for (int i = 0; i < 100; i++) {
        float z = 1 - 0.02f * ((float)i + 0.5f), r = sqrtf(1 - z * z), a = 2.4f * (float)i, out[3];
        MesoVec3 d = {r * cosf(a), z, r * sinf(a)};
        meso_environment_diffuse(&e, d, out);
        CHECK(fabsf(out[0] - 0.5f) < 1e-4f && fabsf(out[1] - 1) < 1e-4f && fabsf(out[2] - 2) < 2e-4f);
        meso_environment_glossy(&e, MESO_LIGHT_REST, d, 0.01f * (float)i, out);
        CHECK(fabsf(out[0] - 0.5f) < 1e-4f && fabsf(out[1] - 1) < 1e-4f && fabsf(out[2] - 2) < 2e-4f);
        meso_environment_glossy(&e, MESO_LIGHT_KEY, d, 0.01f * (float)i, out);
        CHECK(out[0] == 0 && out[1] == 0 && out[2] == 0);
    }
}

/* A disc of 5 degrees in a dim room: its light is the key light but for what is as bright as the limit. */
static void test_disc(void)
{
    const MesoVec3 toward = meso_vec3_unit((MesoVec3){0.6f, 0.5f, -0.4f}, (MesoVec3){0, 1, 0});
    MesoLatLong map = constant(512, 256, 0.1f, 0.1f, 0.1f);
    add_disc(&map, toward, cosf(5 * 3.14159265f / 180), 100);
    MesoEnvironment e = ready(&map, 0, 1, 2);
    double disc = flux(&map, 0) - 0.1 * 4 * 3.14159265358979, rest = flux(&e.glossy[MESO_LIGHT_REST][0], 0);
    CHECK(meso_vec3_dot(e.to_key, toward) > 0.99999f);
    CHECK(fabsf(e.key_extent - tanf(5 * 3.14159265f / 180)) < 0.005f);
    CHECK((double)e.key[0] > 0.96 * disc && (double)e.key[0] < disc);
    CHECK(fabs((double)e.key[0] + rest - flux(&map, 0)) < 1e-3 * flux(&map, 0));
    for (uint32_t level = 0; level < MESO_GLOSSY_LEVELS; level++)
        CHECK(fabs(flux(&e.glossy[MESO_LIGHT_KEY][level], 0) - (double)e.key[0]) < 0.06 * (double)e.key[0]);

    float mirror[3], rough[3], beside[3];       /* the rougher, the wider and the dimmer */
    meso_environment_glossy(&e, MESO_LIGHT_KEY, toward, 0, mirror);
    meso_environment_glossy(&e, MESO_LIGHT_KEY, toward, 0.6f, rough);
    meso_environment_glossy(&e, MESO_LIGHT_KEY, (MesoVec3){-toward.x, -toward.y, -toward.z}, 0.6f, beside);
    CHECK(mirror[0] > 95 && rough[0] < 0.2f * mirror[0] && rough[0] > 0.1f && beside[0] < 1e-3f * rough[0]);
}

/* What falls on a surface, by the harmonics and by a sum. */
static void test_diffuse(void)
{
    MesoLatLong map = constant(128, 64, 0, 0, 0);
    for (uint32_t y = 0; y < 64; y++)
        for (uint32_t x = 0; x < 128; x++) {
            MesoVec3 d = meso_lat_long_direction(&map, x, y);
            for (size_t c = 0; c < 3; c++)
                map.rgb[3 * (y * 128 + x) + c] = 1 + 0.5f * d.y + 0.4f * d.x * d.z - 0.3f * d.z;
        }
    MesoEnvironment e = ready(&map, 0, 1, 1);
    CHECK(e.key_extent == 0);
    for (int i = 0; i < 20; i++) {
        float z = 1 - 0.1f * ((float)i + 0.5f), r = sqrtf(1 - z * z), a = 2.4f * (float)i, out[3];
        MesoVec3 n = {r * cosf(a), z, r * sinf(a)};
        double sum = 0;
        for (uint32_t y = 0; y < 64; y++)
            for (uint32_t x = 0; x < 128; x++) {
                double cosine = fmax((double)meso_vec3_dot(n, meso_lat_long_direction(&map, x, y)), 0);
                sum += cosine * (double)meso_lat_long_solid_angle(&map, y) * (double)map.rgb[3 * (y * 128 + x)];
            }
        meso_environment_diffuse(&e, n, out);
        CHECK(fabs((double)out[0] - sum / 3.14159265358979) < 5e-3);
    }
}

static void test_turn(void)
{
    MesoLatLong map = constant(64, 32, 1, 1, 1);
    MesoEnvironment e = ready(&map, 90, 1, 1);
    MesoVec3 axes[3];
    meso_environment_axes(&e, (MesoVec3){0, 1, 0}, axes);       /* what was at the front is a quarter further, at +X */
    CHECK(meso_vec3_length(meso_vec3_sub(axes[2], (MesoVec3){1, 0, 0})) < 1e-6f && axes[1].y == 1);
    CHECK(meso_vec3_length(meso_vec3_sub(axes[0], (MesoVec3){0, 0, -1})) < 1e-6f);
    e.turn = 0;
    meso_environment_axes(&e, (MesoVec3){0, 0, 1}, axes);
    CHECK(axes[2].y == -1 && axes[1].z == 1 && axes[0].x == 1);
}

static void test_wrong_numbers(void)
{
    MesoLatLong map = constant(8, 4, 1, 1, 1);
    map.rgb[0] = NAN, map.rgb[5] = -3, map.rgb[7] = INFINITY;
    MesoEnvironment e = ready(&map, 0, 0.5f, 1);
    CHECK(e.map.rgb[0] == 0 && e.map.rgb[5] == 0 && e.map.rgb[7] == 32752 && e.map.rgb[1] == 0.5f);
    CHECK(isfinite(e.key[1]) && e.key[1] > 0);
    map = constant(2, 1, 0, 0, 0);
    e = ready(&map, 0, 1, 1);
    CHECK(e.key_extent == 0 && e.harmonics[0][0] == 0);
}

/* Light from the upper left of the default camera, half of it at least from a key light. */
static void test_built_in(void)
{
    for (MesoBuiltIn which = MESO_BUILT_IN_SKY; which <= MESO_BUILT_IN_STUDIO; which++) {
        MesoLatLong map;
        CHECK(meso_built_in_draw(&map, &arena, which, &error) == MESO_OK);
        MesoEnvironment one = ready(&map, 0, 1, 1), three = ready(&map, 0, 1, 3);
        float up[3];
        meso_environment_diffuse(&one, (MesoVec3){0, 1, 0}, up);
        CHECK(one.to_key.x < -0.3f && one.to_key.y > 0.5f && one.to_key.z > 0.3f);
        CHECK(one.key[1] > 1.5f && one.key[1] < 4 && up[1] > 0.2f && up[1] < 0.8f);
        CHECK(memcmp(one.harmonics, three.harmonics, sizeof one.harmonics) == 0);
        for (uint32_t part = 0; part < MESO_LIGHT_PARTS; part++)
            for (uint32_t level = 0; level < MESO_GLOSSY_LEVELS; level++) {
                const MesoLatLong *a = &one.glossy[part][level], *b = &three.glossy[part][level];
                CHECK(memcmp(a->rgb, b->rgb, 12 * (size_t)a->width * a->height) == 0);
            }
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_places();
    test_constant();
    test_disc();
    test_diffuse();
    test_turn();
    test_wrong_numbers();
    test_built_in();
    meso_arena_release(&arena);
    return 0;
}
