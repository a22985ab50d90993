#include "libcore/render/camera_path.h"

enum { NUMBERS = 11 };

static void unpack(const MesoCamera *c, float out[NUMBERS])
{
    const float all[NUMBERS] = {c->eye.x, c->eye.y, c->eye.z, c->target.x, c->target.y, c->target.z,
                                c->up.x, c->up.y, c->up.z, c->fov_degrees, c->height};
    for (int i = 0; i < NUMBERS; i++)
        out[i] = all[i];
}

static MesoCamera pack(const float n[NUMBERS])
{
    return (MesoCamera){{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}, n[9], n[10]};
}

/* Change a frame at key i; none at the ends of a path of two. */
static void find_slope(const MesoCameraKey *keys, uint32_t count, uint32_t i, float out[NUMBERS])
{
    uint32_t before = i > 0 ? i - 1 : i, after = i + 1 < count ? i + 1 : i;
    float a[NUMBERS], b[NUMBERS], frames = (float)keys[after].frame - (float)keys[before].frame;
    unpack(&keys[before].camera, a);
    unpack(&keys[after].camera, b);
    for (int k = 0; k < NUMBERS; k++)
        out[k] = frames > 0 ? (b[k] - a[k]) / frames : 0;
}

MesoCamera meso_camera_at(const MesoCameraKey *keys, uint32_t count, int32_t frame)
{
    uint32_t low = 0, high = count;
    if (frame <= keys[0].frame)
        return keys[0].camera;
    if (frame >= keys[count - 1].frame)
        return keys[count - 1].camera;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (keys[middle].frame <= frame)
            low = middle;
        else
            high = middle;
    }
    float from[NUMBERS], to[NUMBERS], from_slope[NUMBERS], to_slope[NUMBERS], out[NUMBERS];
    float length = (float)(keys[low + 1].frame - keys[low].frame), t = (float)(frame - keys[low].frame) / length;
    unpack(&keys[low].camera, from);
    unpack(&keys[low + 1].camera, to);
    find_slope(keys, count, low, from_slope);
    find_slope(keys, count, low + 1, to_slope);
    float t2 = t * t, t3 = t2 * t;
    for (int k = 0; k < NUMBERS; k++)       /* Hermite's form */
        out[k] = (2 * t3 - 3 * t2 + 1) * from[k] + (t3 - 2 * t2 + t) * length * from_slope[k] +
                 (3 * t2 - 2 * t3) * to[k] + (t3 - t2) * length * to_slope[k];
    /* a height that a curve takes to nothing would be another sort of view */
    out[NUMBERS - 1] = fmaxf(out[NUMBERS - 1], 0.5f * fminf(from[NUMBERS - 1], to[NUMBERS - 1]));
    return pack(out);
}

/* Rodrigues' formula. */
static MesoVec3 turn_about(MesoVec3 v, MesoVec3 axis, float angle)
{
    float c = cosf(angle), s = sinf(angle);
    MesoVec3 turned = meso_vec3_mad(meso_vec3_scale(v, c), s, meso_vec3_cross(axis, v));
    return meso_vec3_mad(turned, (1 - c) * meso_vec3_dot(axis, v), axis);
}

MesoCamera meso_camera_turn(const MesoCamera *camera, float share)
{
    MesoCamera turned = *camera;
    MesoVec3 axis = meso_vec3_unit(camera->up, (MesoVec3){0, 1, 0});
    float angle = (share - floorf(share)) * (float)(2 * 3.14159265358979323846);
    if (angle != 0)
        turned.eye = meso_vec3_add(camera->target, turn_about(meso_vec3_sub(camera->eye, camera->target), axis, angle));
    return turned;
}
