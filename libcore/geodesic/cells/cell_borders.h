/* Borders of cells, a range of triangles at a time; for this folder. */
#ifndef MESO_CELL_BORDERS_H
#define MESO_CELL_BORDERS_H

#include "libcore/base/index_map.h"
#include "libcore/geodesic/cells/nearest_seeds.h"
#include "libcore/mesh/cut/cut_lines.h"

/* Triangles of a range: what is known of their sides stays in the nearer caches. */
enum { MESO_BORDER_RANGE = 4096 };

/* What a range has, numbered by itself, in the order in which its triangles come to it. */
typedef struct MesoCellBorders {
    uint32_t node_count, segment_count, shared_count;
    MesoCutNode *nodes;
    MesoCutSegment *segments;
    uint32_t *shared;           /* [shared_count] nodes that another range may have, too; they ascend */
} MesoCellBorders;

/* Scratch for one range after the other. */
typedef struct MesoBorderTracer MesoBorderTracer;

/* For the settled `nearest`, in the arena. NULL with `error` filled where memory is out; the tracer keeps `error`. */
MesoBorderTracer *meso_border_tracer_new(MesoArena *arena, const MesoTriangulation *mesh,
                                         const MesoNearestSeeds *nearest, MesoError *error);

/*
 * Borders in the domain's triangles from number `begin` on, at least one and at most MESO_BORDER_RANGE. An edge between
 * ranges is divided alike by both. O(triangles). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_cell_borders_trace(MesoCellBorders *borders, MesoArena *arena, MesoBorderTracer *tracer,
                                   uint32_t begin, uint32_t end);

#endif
