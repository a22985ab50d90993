/* What meso-quilt says of a quilt. */
#ifndef MESO_QUILT_REPORT_H
#define MESO_QUILT_REPORT_H

#include "cmd/common/tool.h"
#include "libcore/quilt/quilt.h"

/* Counts, costs and deformations into the report, times too with -v; and one line. */
void meso_quilt_report(MesoTool *tool, const MesoQuilt *quilt, float scale);

#endif
