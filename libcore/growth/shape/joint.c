#include "libcore/growth/shape/joint.h"

/* Any direction across `n`. */
static MesoVec3 across(MesoVec3 n)
{
    MesoVec3 axis = fabsf(n.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    return meso_vec3_unit(meso_vec3_cross(axis, n), axis);
}

static MesoVec3 laid_flat(MesoVec3 a, MesoVec3 normal)
{
    MesoVec3 unit = meso_vec3_direction(a, (MesoVec3){0, 0, 0});
    return meso_vec3_unit(meso_vec3_mad(unit, -meso_vec3_dot(unit, normal), normal), (MesoVec3){0, 0, 0});
}

/* Where growth turns back, it goes on as it came. */
MesoJoint meso_joint(MesoVec3 position, MesoVec3 normal, MesoVec3 in, MesoVec3 out, float width, float lift)
{
    MesoVec3 a = laid_flat(in, normal), b = laid_flat(out, normal), sum = meso_vec3_add(a, b);
    if (meso_vec3_length(sum) < 1e-4f)
        sum = meso_vec3_dot(a, a) > 0 ? a : across(normal);
    MesoVec3 tangent = laid_flat(sum, normal);
    return (MesoJoint){meso_vec3_mad(position, lift, normal), tangent, normal, width, 0};
}

MesoJoint meso_joint_roll(MesoJoint joint, float angle)
{
    MesoVec3 left = meso_vec3_cross(joint.normal, joint.tangent);
    MesoVec3 up = meso_vec3_scale(joint.normal, cosf(angle));
    joint.normal = meso_vec3_unit(meso_vec3_mad(up, -sinf(angle), left), joint.normal);
    return joint;
}
