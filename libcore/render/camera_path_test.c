/* Paths: at keys, on straight and even ones, beyond their ends; full turns, quarter turns, lengths kept. */
#include "libcore/render/camera_path.h"

#include <string.h>

#include "libcore/base/check.h"

static bool near(MesoVec3 a, MesoVec3 b)
{
    return meso_vec3_length(meso_vec3_sub(a, b)) < 1e-5f;
}

static void test_keys(void)
{
    MesoCameraKey keys[4];
    for (int i = 0; i < 4; i++)
        keys[i] = (MesoCameraKey){10 * i, {{(float)i, 2 * (float)i, 5}, {0, (float)i, 0}, {0, 1, 0}, 30 + (float)i, 0}};
    for (int32_t frame = -5; frame <= 40; frame++) {     /* even keys on a line: even steps on it */
        MesoCamera c = meso_camera_at(keys, 4, frame);
        float at = frame < 0 ? 0 : frame > 30 ? 3 : (float)frame / 10;
        CHECK(near(c.eye, (MesoVec3){at, 2 * at, 5}) && near(c.target, (MesoVec3){0, at, 0}));
        CHECK(fabsf(c.fov_degrees - 30 - at) < 1e-5f && near(c.up, (MesoVec3){0, 1, 0}));
    }
    keys[2].camera.eye.x = 7;
    for (int i = 0; i < 4; i++) {
        MesoCamera c = meso_camera_at(keys, 4, keys[i].frame);
        CHECK(memcmp(&c, &keys[i].camera, sizeof c) == 0);
    }
    MesoCamera before = meso_camera_at(keys, 4, 9), at = meso_camera_at(keys, 4, 10), after = meso_camera_at(keys, 4, 11);
    float into = at.eye.x - before.eye.x, out = after.eye.x - at.eye.x;     /* no corner at a key */
    CHECK(fabsf(into - out) < 0.2f && into > 0 && out > 0);
    MesoCamera one = meso_camera_at(keys, 1, 77);
    CHECK(memcmp(&one, &keys[0].camera, sizeof one) == 0);
}

static void test_turns(void)
{
    const MesoCamera camera = {{3, 1, 1}, {1, 0, 1}, {0, 2, 0}, 30, 0};
    const MesoVec3 eyes[4] = {{3, 1, 1}, {1, 1, -1}, {-1, 1, 1}, {1, 1, 3}};
    for (int i = -4; i < 8; i++) {
        MesoCamera turned = meso_camera_turn(&camera, (float)i / 4);
        CHECK(near(turned.eye, eyes[(i + 4) % 4]) && near(turned.target, camera.target));
    }
    MesoCamera whole = meso_camera_turn(&camera, 5);
    CHECK(memcmp(&whole, &camera, sizeof whole) == 0);
}

int main(void)
{
    test_keys();
    test_turns();
    return 0;
}
