/*
 * Environments on a ball: in one that is white everywhere a white surface gives back what it gets; one bright place
 * lights what faces it as the formula says, casts its shadow, and turns with the map; the sky's directions have the
 * map's colours.
 */
#include "libcore/render/light/ground_shadow.h"

#include "libcore/render/light/ball_fixture.h"

static MesoEnvironment make_environment(MesoVec3 toward, float cosine, float disc, float rest, float turn)
{
    enum { WIDTH = 256, HEIGHT = 128 };
    MesoLatLong map;
    MesoEnvironment e;
    const MesoEnvironmentOptions options = {turn, 1};
    CHECK(meso_lat_long_init(&map, &arena, WIDTH, HEIGHT, &error) == MESO_OK);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        bool in = meso_vec3_dot(meso_lat_long_direction(&map, i % WIDTH, i / WIDTH), toward) > cosine;
        for (size_t c = 0; c < 3; c++)
            map.rgb[3 * i + c] = in ? disc : rest;
    }
    CHECK(meso_environment_init(&e, &arena, &map, &options, 2, &error) == MESO_OK);
    return e;
}

static MesoLightRig make_rig(const Ball *b, const MesoEnvironment *e, MesoVec3 eye)
{
    static const MesoLightQuality quality = {128, 192, 16, 256, 0.5f};
    const MesoCamera camera = {eye, {0, 0, 0}, {0, 1, 0}, 40, 0};
    MesoView view;
    MesoLightRig rig;
    CHECK(meso_view_build(&view, &camera, &error) == MESO_OK);
    MesoShapes shapes = b->shapes;
    CHECK(meso_light_rig_init(&rig, &arena, &shapes, &view, camera.up, e, &quality, 2, &error) == MESO_OK);
    return rig;
}

static float lit(const MesoLightRig *rig, MesoVec3 normal, MesoVec3 to_eye, float albedo, float roughness,
                 float metallic)
{
    MesoLitSurface s = {.position = meso_vec3_scale(normal, 0.51f), .normal = normal, .to_eye = to_eye,
                        .albedo = {albedo, albedo, albedo}, .roughness = roughness, .metallic = metallic};
    float radiance[3];
    meso_light_on(rig, &s, radiance, NULL);
    CHECK(radiance[0] == radiance[1] && radiance[1] == radiance[2]);
    return radiance[0];
}

/* What the base does not get, the facets reflect: white gives back all of it, to the eye at any angle. Metal has no
 * base, and loses what goes from facet to facet. */
static void test_furnace(const Ball *b)
{
    MesoEnvironment e = make_environment((MesoVec3){0, 1, 0}, 2, 0, 1, 0);
    MesoLightRig rig = make_rig(b, &e, (MesoVec3){0, 0, 5});
    CHECK(rig.key.count == 0);
    for (int k = 0; k < 5 * 4 * 3; k++) {
        float cosine = 0.1f + 0.225f * (float)(k % 5), roughness = 0.25f + 0.25f * (float)(k / 5 % 4);
        MesoVec3 n = {k / 20 == 0, k / 20 == 1, k / 20 == 2}, side = {n.y, n.z, n.x};
        MesoVec3 to_eye = meso_vec3_mad(meso_vec3_scale(n, fminf(cosine, 1)), sqrtf(fmaxf(1 - cosine * cosine, 0)),
                                        side);
        float white = lit(&rig, n, to_eye, 1, roughness, 0), metal = lit(&rig, n, to_eye, 1, roughness, 1);
        CHECK(fabsf(white - 1) < 0.02f);
        CHECK(metal > 0.44f && metal < 1.02f);
    }
}

/* E = L times the solid angle; a grey surface gives back its share of E / pi, and what facets reflect. */
static void test_bright(const Ball *b)
{
    const MesoVec3 toward = meso_vec3_unit((MesoVec3){-0.5f, 0.7f, 0.4f}, (MesoVec3){0, 1, 0});
    const float cosine = cosf(4 * PI / 180);
    MesoEnvironment e = make_environment(toward, cosine, 200, 1e-4f, 0);
    float disc = 0;
    for (uint32_t i = 0; i < e.map.width * e.map.height; i++)
        disc += e.map.rgb[3 * i] * meso_lat_long_solid_angle(&e.map, i / e.map.width);
    MesoLightRig rig = make_rig(b, &e, (MesoVec3){0, 0, 5});
    CHECK(meso_vec3_dot(rig.to_key, toward) > 0.9999f && fabsf(rig.colors.key[0] / disc - 1) < 0.01f);
    for (int i = 0; i < 5; i++) {
        float facing = 1 - 0.15f * (float)i;
        MesoVec3 side = meso_vec3_unit(meso_vec3_cross(toward, (MesoVec3){0.3f, 0.1f, 0.8f}), toward);
        MesoVec3 n = meso_vec3_mad(meso_vec3_scale(toward, facing), sqrtf(fmaxf(1 - facing * facing, 0)), side);
        MesoVec3 to_eye = meso_vec3_unit(meso_vec3_cross(n, toward), side);
        to_eye = meso_vec3_unit(meso_vec3_mad(to_eye, 1, n), n);    /* 45 degrees aside */
        float radiance = lit(&rig, n, to_eye, 0.5f, 1, 0), expected = 0.5f * rig.colors.key[0] * facing / PI;
        CHECK(radiance > 0.9f * expected && radiance < 1.15f * expected + 0.05f);
        CHECK(lit(&rig, meso_vec3_scale(n, -1), meso_vec3_scale(to_eye, -1), 0.5f, 1, 0) < 1e-2f * expected + 1e-3f);
    }
    /* on the ground its shadow lies on the other side */
    MesoVec3 foot = meso_vec3_scale(toward, -0.5f / toward.y);
    MesoGroundShadow shadow;
    CHECK(meso_ground_shadow_init(&shadow, &arena, &rig, 1, &error) == MESO_OK);
    CHECK(meso_ground_shadow_at(&shadow, foot) > 0.8f);
    CHECK(meso_ground_shadow_at(&shadow, (MesoVec3){-1, -0.5f, 0.5f}) < 0.05f);

    /* Turned, it is elsewhere; seen from elsewhere, it is not. */
    MesoEnvironment turned = make_environment(toward, cosine, 200, 1e-4f, 90);
    MesoLightRig other = make_rig(b, &turned, (MesoVec3){3, 1, 2});
    CHECK(meso_vec3_dot(other.to_key, (MesoVec3){toward.z, toward.y, -toward.x}) > 0.9999f);
    other = make_rig(b, &e, (MesoVec3){3, 1, 2});
    CHECK(meso_vec3_dot(other.to_key, rig.to_key) > 0.9999f);
}

/* Half of the world is bright: a surface between both gets half, and its own half where the other is held off. */
static void test_sky(const Ball *b)
{
    MesoEnvironment e = make_environment((MesoVec3){0, 1, 0}, 0, 1, 0, 0);
    MesoLightRig rig = make_rig(b, &e, (MesoVec3){0, 0, 5});
    CHECK(rig.key.count == 0);
    double up = 0, down = 0;
    for (uint32_t i = 0; i < rig.sky.count; i++)
        *(rig.sky.maps[i].toward.y > 0 ? &up : &down) += (double)rig.sky_colors[3 * i] / rig.sky.count;
    CHECK(fabs(up + down - 0.5) < 0.02 && down < 0.05 && fabsf(rig.open_sky[1] - 1) < 0.05f);
    const MesoVec3 eye = {0, 0, 1};
    CHECK(fabsf(lit(&rig, (MesoVec3){0, 1, 0}, (MesoVec3){0, 1, 0}, 1, 1, 0) - 1) < 0.07f);
    CHECK(fabsf(lit(&rig, eye, eye, 1, 1, 0) - 0.5f) < 0.05f);
    CHECK(lit(&rig, (MesoVec3){0, -1, 0}, (MesoVec3){0, -1, 0}, 1, 1, 0) < 0.05f);
}

int main(void)
{
    static Ball b;
    meso_arena_init(&arena);
    make_ball(&b);
    test_furnace(&b);
    test_bright(&b);
    test_sky(&b);
    meso_arena_release(&arena);
    return 0;
}
