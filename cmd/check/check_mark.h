/* Where the faults are, as a mesh to look at. */
#ifndef MESO_CHECK_MARK_H
#define MESO_CHECK_MARK_H

#include "cmd/check/check_report.h"
#include "formats/file/output.h"

/*
 * Writes all triangles as a binary PLY with a channel "fault": of each triangle the first fault that it has, in the
 * order of the report, by name, and a colour for it; "sound" and grey where it has none. Triangles with a position that
 * is not finite are left out. MESO_ERR_OUTPUT; MESO_ERR_LIMIT; MESO_ERR_MEMORY.
 */
MesoStatus meso_check_mark(const MesoCheckFindings *findings, MesoTool *tool, MesoOutput *output);

#endif
