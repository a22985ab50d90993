/* Rotations as quaternions. */
#ifndef MESO_QUATERNION_H
#define MESO_QUATERNION_H

#include "libcore/math/vec.h"

/* The unit quaternion (x, y, z, w) of a rotation by its columns, with w not below 0. */
void meso_quaternion_of(const MesoVec3 columns[3], float rotation[4]);

#endif
