#include "libcore/tiling/strand/trajectory.h"

/* Angle between two vectors; exact near 0 and pi, where acos is not. */
static double angle_between(MesoVec3 a, MesoVec3 b)
{
    MesoVec3 c = meso_vec3_cross(a, b);
    return atan2((double)meso_vec3_length(c), (double)meso_vec3_dot(a, b));
}

void meso_trajectory(const MesoPort *start, const MesoPort *end, bool same_side, float scale,
                     MesoVec3 p[4])
{
    MesoVec3 chord = meso_vec3_sub(end->point, start->point);
    double radius = (double)meso_vec3_length(chord) * (same_side ? 1 : sqrt(0.5));
    double budget = 8 * (sqrt(2) - 1) * radius / 3 * (double)scale;
    double a0 = MESO_PI - angle_between(chord, start->inward);
    double a3 = MESO_PI - angle_between(meso_vec3_scale(chord, -1), end->inward);
    double share = a0 + a3 > 0 ? a0 / (a0 + a3) : 0.5;

    p[0] = start->point;
    p[3] = end->point;
    p[1] = meso_vec3_mad(p[0], (float)(budget * share), start->inward);
    p[2] = meso_vec3_mad(p[3], (float)(budget * (1 - share)), end->inward);
}
