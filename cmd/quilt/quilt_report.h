/* What meso-quilt says of a quilt. */
#ifndef MESO_QUILT_REPORT_H
#define MESO_QUILT_REPORT_H

#include "cmd/common/tool.h"
#include "libcore/quilt/embed/quilt_lay.h"

/* Seconds, beside those of growth. */
typedef struct MesoQuiltTimes {
    double swatch, surface;     /* read, with what is found about periods, and the directions */
    double base, growth, finish, settling, embedding;
} MesoQuiltTimes;

typedef struct MesoQuiltResult {
    MesoQuilt quilt;
    MesoQuiltRoom room;         /* where that lies */
    MesoQuiltLay lay;
    MesoVec3 *positions;        /* [quilt.vertex_count] */
    MesoQuiltTimes times;
} MesoQuiltResult;

/* Counts, costs, deformations and stretch into the report; with -v times too, and two lines. MESO_ERR_MEMORY alone. */
MesoStatus meso_quilt_report(MesoTool *tool, const MesoQuiltResult *result, const MesoSwatch *swatch, float scale);

#endif
