/* Curves from files: polylines in space. */
#ifndef MESO_CURVE_FILE_H
#define MESO_CURVE_FILE_H

#include "formats/file/input.h"
#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef struct MesoCurves {
    uint32_t count;
    const MesoVec3 *points;     /* [count] corners, polyline after polyline */
    const uint8_t *breaks;      /* [count] 1: a polyline begins here */
} MesoCurves;

/*
 * Of an OBJ with "l" statements these, joined where one begins where the last one ends; of other files that
 * point_file.h reads one polyline, through all points in their order. MESO_ERR_INPUT as there, and for statements that
 * name no vertices. O(size).
 */
MesoStatus meso_curves_read(MesoCurves *curves, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
