#include "libcore/math/bezier.h"

MesoVec3 meso_bezier_point(const MesoVec3 p[4], float v)
{
    float w = 1 - v;
    float b0 = w * w * w, b1 = 3 * w * w * v, b2 = 3 * w * v * v, b3 = v * v * v;
    return (MesoVec3){b0 * p[0].x + b1 * p[1].x + b2 * p[2].x + b3 * p[3].x,
                      b0 * p[0].y + b1 * p[1].y + b2 * p[2].y + b3 * p[3].y,
                      b0 * p[0].z + b1 * p[1].z + b2 * p[2].z + b3 * p[3].z};
}

MesoVec3 meso_bezier_derivative(const MesoVec3 p[4], float v)
{
    float w = 1 - v;
    MesoVec3 a = meso_vec3_scale(meso_vec3_sub(p[1], p[0]), 3 * w * w);
    MesoVec3 b = meso_vec3_scale(meso_vec3_sub(p[2], p[1]), 6 * w * v);
    MesoVec3 c = meso_vec3_scale(meso_vec3_sub(p[3], p[2]), 3 * v * v);
    return meso_vec3_add(a, meso_vec3_add(b, c));
}

MesoVec3 meso_bezier_second_derivative(const MesoVec3 p[4], float v)
{
    MesoVec3 a = meso_vec3_add(meso_vec3_mad(p[0], -2, p[1]), p[2]);
    MesoVec3 b = meso_vec3_add(meso_vec3_mad(p[1], -2, p[2]), p[3]);
    return meso_vec3_scale(meso_vec3_lerp(a, b, v), 6);
}
