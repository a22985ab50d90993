/* Cubic Bezier curves. */
#ifndef MESO_BEZIER_H
#define MESO_BEZIER_H

#include "libcore/math/vec.h"

/* Point and both derivatives of the curve with control points `p` at v in [0,1]. */
MesoVec3 meso_bezier_point(const MesoVec3 p[4], float v);
MesoVec3 meso_bezier_derivative(const MesoVec3 p[4], float v);
MesoVec3 meso_bezier_second_derivative(const MesoVec3 p[4], float v);

#endif
