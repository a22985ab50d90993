/* Trajectories of sweeps: cubic Beziers between two ports (MesoGen, section 3.5). */
#ifndef MESO_TRAJECTORY_H
#define MESO_TRAJECTORY_H

#include "libcore/shell/hexahedra.h"

/*
 * Control points p[0..3] of the trajectory from `start` to `end`. The handles
 * lie along the inward normals n_i of the ports, so that trajectories run on
 * smoothly into the next slot; together they are as long as those of a
 * half circle through both ends,
 *
 *     m = 8 (sqrt 2 - 1) R / 3
 *
 * with R = |p3 - p0| where both ports lie on one side and R = |p3 - p0| / sqrt 2
 * elsewhere, and they share m by the angles alpha_i between p_{3-i} - p_i and
 * -n_i. (The paper takes the angle with n_i and has to treat opposite sides
 * apart, where the sum vanishes; with -n_i none does.)
 *
 * scale   factor on both handles
 */
void meso_trajectory(const MesoPort *start, const MesoPort *end, bool same_side, float scale,
                     MesoVec3 p[4]);

#endif
