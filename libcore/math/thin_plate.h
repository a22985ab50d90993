/*
 * Smoothing thin plate splines from the plane to space (Duchon 1977; Wahba,
 * "Spline Models for Observational Data", 1990): of all f, the one of least
 *
 *     sum |f(point) - value|^2 + smoothing * integral |f_xx|^2 + 2 |f_xy|^2 + |f_yy|^2
 */
#ifndef MESO_THIN_PLATE_H
#define MESO_THIN_PLATE_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef struct MesoThinPlate {
    uint32_t count;         /* of different points */
    const MesoVec2 *points; /* [count] a copy */
    double *places;         /* [2 * count] the same in units of `scale` from `centre`: all x, then all y */
    double *weights;        /* [3 * (count + 3)] of the points, then of 1, x, y in units of `scale` from `centre` */
    double centre[2], scale;
} MesoThinPlate;

/*
 * count, points, values   what to come near to; where smoothing is 0, to meet (to 1e-6 of the values' range). Points
 *                         may coincide: between their values, the mean
 * smoothing               in units of the points' length squared, >= 0
 *
 * Where points do not tell it, f is the plainest: 0 without points, constant from one, along their line alone from
 * collinear ones. Results go to `arena`. MESO_ERR_INPUT where numbers are not finite, or too large for the squares of
 * floats; MESO_ERR_MEMORY. O(count^3), and 8 count^2 bytes of scratch: for hundreds of points.
 */
MesoStatus meso_thin_plate_fit(MesoThinPlate *plate, MesoArena *arena, uint32_t count, const MesoVec2 *points,
                               const MesoVec3 *values, double smoothing, MesoError *error);

/* f(point). O(count). The same bytes everywhere: logarithms are our own. */
MesoVec3 meso_thin_plate_at(const MesoThinPlate *plate, MesoVec2 point);

#endif
