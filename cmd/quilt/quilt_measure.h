/* What meso-quilt --check says of a quilt: how good it is. */
#ifndef MESO_QUILT_MEASURE_H
#define MESO_QUILT_MEASURE_H

#include "cmd/common/tool.h"
#include "libcore/quilt/check/quilt_check.h"

/* Measures a quilt where it lies, at `positions`; into the report as "check", and in some lines. */
MesoStatus meso_quilt_measure(MesoTool *tool, const MesoQuilt *quilt, const MesoSwatch *swatch,
                              const MesoVec3 *positions, const MesoTriangulation *base,
                              const MesoQuiltCheckOptions *options);

#endif
