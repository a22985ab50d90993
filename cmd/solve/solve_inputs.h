/* What meso-solve and meso-suggest share: their inputs, the solve itself, JSON products. */
#ifndef MESO_SOLVE_INPUTS_H
#define MESO_SOLVE_INPUTS_H

#include "cmd/solve/solve_engine.h"
#include "formats/file/output.h"
#include "libcore/tiling/solve/solve.h"

/* Most dead ends that a report keeps: a few hundred bytes each. */
enum { MESO_REPORT_DEAD_ENDS = 1000 };

/* Reads a tile set, and notes it in the provenance. `hash` may be NULL. */
MesoStatus meso_tool_read_tiles(MesoTool *tool, const char *path, MesoTileSet *set,
                                uint64_t hash[2]);

/*
 * Solves, with progress, by `engine` (NULL: the
 * search alone); with -v says how long it took.
 */
MesoStatus meso_tool_solve(MesoTool *tool, const MesoTilingProblem *problem, const MesoEngineArguments *engine,
                           uint32_t max_attempts, MesoSolveResult *result);

/* Writes `value`, or says that memory is out where it is NULL; frees it. Does not commit. */
MesoStatus meso_tool_write_json(json_t *value, MesoOutput *output, MesoError *error);

#endif
