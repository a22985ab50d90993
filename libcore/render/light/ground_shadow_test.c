/*
 * The shadow of a ball on the ground that it touches. Under a sky of one colour it is the ball's form factor, which is
 * known: of a ball of radius r, wholly above the horizon, D away at an angle t from the zenith, (r / D)^2 cos t. A few
 * directions of light have to come near that, without their edges; and the key light's shadow is as soft as its disc.
 */
#include "libcore/render/light/ground_shadow.h"

#include "libcore/render/light/ball_fixture.h"

static void light(MesoLightRig *rig, const Ball *b, uint32_t samples)
{
    MesoView view;
    MesoCamera camera = {.eye = {0, 0, 5}, .up = {0, 1, 0}, .fov_degrees = 40};
    MesoShapes shapes = b->shapes;
    const MesoLightQuality quality = meso_light_quality(samples);
    CHECK(meso_view_build(&view, &camera, &error) == MESO_OK);
    CHECK(meso_light_rig_init(rig, &arena, &shapes, &view, camera.up, NULL, &quality, 2, &error) == MESO_OK);
    CHECK(fabsf(rig->ground + RADIUS) < 1e-3f);
}

/* A sky of radiance 1 / pi times `sky`, and a key light of so much. */
static void color(MesoLightRig *rig, float sky, float key)
{
    for (int c = 0; c < 3; c++) {
        rig->colors.key[c] = key;
        rig->open_sky[c] = sky;
    }
    for (uint32_t i = 0; i < 3 * rig->sky.count; i++)
        rig->sky_colors[i] = sky;
}

static float form_factor(float aside)
{
    float d = sqrtf(aside * aside + RADIUS * RADIUS);
    return RADIUS * RADIUS * RADIUS / (d * d * d);
}

/* Largest error, root of the mean of squares, and step from place to place; without the blur 12 lights were wrong by
 * .27 and stepped by .17, 64 by .076 and .060. */
static void test_sky(const Ball *b, uint32_t samples, float largest, float mean, float step)
{
    MesoLightRig rig;
    MesoGroundShadow shadow;
    light(&rig, b, samples);
    color(&rig, 1, 0);
    CHECK(meso_ground_shadow_init(&shadow, &arena, &rig, 2, &error) == MESO_OK);
    float most = 0, squares = 0, steepest = 0;
    enum { WAYS = 8, STEPS = 100 };
    for (int way = 0; way < WAYS; way++) {
        float a = 2 * PI * (float)way / WAYS, before = 0;
        for (int k = 0; k < STEPS; k++) {
            float aside = 1.5f * (float)k / STEPS;
            float s = meso_ground_shadow_at(&shadow, (MesoVec3){aside * cosf(a), -RADIUS, aside * sinf(a)});
            float wrong = fabsf(s - form_factor(aside));
            most = fmaxf(most, wrong);
            squares += wrong * wrong / (WAYS * STEPS);
            if (k > 0)
                steepest = fmaxf(steepest, fabsf(s - before));
            before = s;
        }
    }
    CHECK(most < largest && sqrtf(squares) < mean && steepest < step);
}

/* On a line from the middle of the key light's shadow, its edge has no steps, and is as wide as the disc has it. */
static void test_key(const Ball *b)
{
    MesoLightRig rig;
    MesoGroundShadow shadow;
    light(&rig, b, 16);
    color(&rig, 0, 1);
    CHECK(meso_ground_shadow_init(&shadow, &arena, &rig, 2, &error) == MESO_OK);
    MesoVec3 foot = meso_vec3_scale(rig.to_key, -RADIUS / rig.to_key.y);
    MesoVec3 across = meso_vec3_unit(meso_vec3_cross((MesoVec3){0, 1, 0}, rig.to_key), foot);
    float before = 1, dark = 0, clear = 0, steepest = 0;
    for (int k = 0; k < 400; k++) {
        float aside = 0.002f * (float)k;
        float s = meso_ground_shadow_at(&shadow, meso_vec3_mad(foot, aside, across));
        CHECK(s <= before + 1e-3f);
        steepest = fmaxf(steepest, before - s);
        dark = s > 0.95f ? aside : dark;
        clear = s > 0.05f ? aside : clear;
        before = s;
    }
    /* d is how far the ball's middle is from the ground towards the light; a disc's shadow goes from all to nothing
     * over twice its radius, from .95 to .05 over .81 of that. */
    float d = RADIUS / rig.to_key.y, width = 0.81f * 2 * rig.key_extent * d;
    CHECK(dark < RADIUS && RADIUS < clear && fabsf(clear - dark - width) < 0.3f * width);
    CHECK(steepest < 0.04f);
}

/* It is dark under the ball and around the middle of the key light's shadow, and far away it is not. */
static void test_places(const Ball *b)
{
    MesoLightRig rig;
    MesoGroundShadow shadow;
    light(&rig, b, 16);
    CHECK(meso_ground_shadow_init(&shadow, &arena, &rig, 2, &error) == MESO_OK);
    CHECK(meso_ground_shadow_at(&shadow, meso_vec3_scale(rig.to_key, -RADIUS / rig.to_key.y)) > 0.45f);
    CHECK(meso_ground_shadow_at(&shadow, (MesoVec3){0, -RADIUS, 0}) > 0.3f);
    CHECK(meso_ground_shadow_at(&shadow, (MesoVec3){-1.3f, -RADIUS, 1.2f}) < 0.12f);
    CHECK(meso_ground_shadow_at(&shadow, (MesoVec3){-40, -RADIUS, 0}) == 0);
}

int main(void)
{
    static Ball ball;
    make_ball(&ball);
    test_sky(&ball, 1, 0.26f, 0.11f, 0.05f);
    test_sky(&ball, 4, 0.12f, 0.045f, 0.03f);
    test_sky(&ball, 16, 0.065f, 0.024f, 0.03f);
    test_key(&ball);
    test_places(&ball);
    meso_arena_release(&arena);
    return 0;
}
