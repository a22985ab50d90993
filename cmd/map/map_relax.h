/* What meso-map says of a relaxation. */
#ifndef MESO_MAP_RELAX_H
#define MESO_MAP_RELAX_H

#include "cmd/common/tool.h"
#include "libcore/tiling/relax/relax.h"

/* In the report as "relaxed", and in a line. */
MesoStatus meso_map_relax_report(MesoTool *tool, const MesoRelaxReport *relaxed);

#endif
