/* What is wrong with a surface, said before the work on it: one line each, with the command that mends it. */
#ifndef MESO_SURFACE_JUDGE_H
#define MESO_SURFACE_JUDGE_H

#include "cmd/common/tool.h"
#include "libcore/mesh/edit/mesh_wind.h"
#include "libcore/mesh/slot_graph.h"
#include "libcore/tiling/tile/tile_set.h"

#define MESO_STRICT_OPTION(strict)                                                            \
    MESO_FLAG(0, "strict", "what is only warned of in a surface is an error", &(strict), \
              .more = MESO_OPTION_SILENT)

#define MESO_PAIRS_OPTION(pairs)                                                              \
    MESO_FLAG(0, "quads-from-triangles", "two triangles in a row of the surface are a quad, as exporters of glTF " \
              "write them", &(pairs))

typedef struct MesoSurfaceJudge {
    const char *path;           /* of the surface, as given */
    const MesoQuadMesh *mesh;
    const MesoSlotGraph *graph;
    const MesoWindCounts *wound;    /* what gave them one side; NULL: nothing */
    const MesoTileSet *set;     /* tiles to come; NULL: they are there, and the walls are the mapping's matter */
    bool strict;
} MesoSurfaceJudge;

/*
 * Counts the flaws of surface_check.h, puts them into the report as "surface",
 * and warns of each kind once. MESO_ERR_INPUT where no structure can be grown:
 * a one-sided piece whose normals cancel, and, with `set`, faces without walls
 * if every interface of it has something to draw there (else it is a warning);
 * with `strict` at the first of any kind.
 */
MesoStatus meso_tool_judge_surface(MesoTool *tool, const MesoSurfaceJudge *judge);

#endif
