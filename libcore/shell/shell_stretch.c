#include "libcore/shell/shell_stretch.h"

double meso_tetrahedron_det(const MesoVec3d corners[4])
{
    return meso_vec3d_det(meso_vec3d_sub(corners[1], corners[0]), meso_vec3d_sub(corners[2], corners[0]),
                          meso_vec3d_sub(corners[3], corners[0]));
}

double meso_tetrahedron_stretch(const MesoVec3d from[4], const MesoVec3d to[4])
{
    MesoVec3d a = meso_vec3d_sub(from[1], from[0]), b = meso_vec3d_sub(from[2], from[0]);
    MesoVec3d c = meso_vec3d_sub(from[3], from[0]), bc = meso_vec3d_cross(b, c);
    double det = meso_vec3d_dot(a, bc);
    if (det == 0)
        return INFINITY;
    /* Coordinate k of the tetrahedron has gradient rows[k] / det. */
    MesoVec3d rows[3] = {bc, meso_vec3d_cross(c, a), meso_vec3d_cross(a, b)}, sides[3];
    for (uint32_t k = 0; k < 3; k++)
        sides[k] = meso_vec3d_sub(to[k + 1], to[0]);
    double sum = 0;
    for (uint32_t k = 0; k < 3; k++) {
        sum += meso_vec3d_dot(rows[k], rows[k]) * meso_vec3d_dot(sides[k], sides[k]);
        for (uint32_t l = 0; l < k; l++)
            sum += 2 * meso_vec3d_dot(rows[k], rows[l]) * meso_vec3d_dot(sides[k], sides[l]);
    }
    return sum / (3 * det * det);
}

void meso_shell_stretch_add(MesoShellStretch *sum, const MesoVec3d from[4], const MesoVec3d to[4])
{
    double from_volume = meso_tetrahedron_det(from) / 6, to_volume = meso_tetrahedron_det(to) / 6;
    if (!(from_volume * to_volume > 0)) {
        sum->inverted_count++;
        return;
    }
    sum->squares += meso_tetrahedron_stretch(from, to) * fabs(from_volume);
    sum->from_volume += fabs(from_volume);
    sum->to_volume += fabs(to_volume);
}

void meso_shell_stretch_sample(MesoShellStretch *sum, const MesoVec3d derivatives[3], double volume, bool back)
{
    double there = 0, minors = 0, det = meso_vec3d_det(derivatives[0], derivatives[1], derivatives[2]);
    if (!(det > 0)) {
        sum->inverted_count++;
        return;
    }
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3d minor = meso_vec3d_cross(derivatives[(k + 1) % 3], derivatives[(k + 2) % 3]);
        there += meso_vec3d_dot(derivatives[k], derivatives[k]);
        minors += meso_vec3d_dot(minor, minor);
    }
    sum->squares += back ? minors / (3 * det) * volume : there / 3 * volume;
    sum->from_volume += back ? det * volume : volume;
    sum->to_volume += back ? volume : det * volume;
}

double meso_shell_stretch_sixth(const MesoShellStretch *sum)
{
    if (!(sum->from_volume > 0 && sum->to_volume > 0))
        return 1;
    double square = sum->squares / sum->from_volume, shrinking = sum->from_volume / sum->to_volume;
    return square * square * square * shrinking * shrinking;
}

double meso_shell_stretch(const MesoShellStretch *sum)
{
    return cbrt(sqrt(meso_shell_stretch_sixth(sum)));
}
