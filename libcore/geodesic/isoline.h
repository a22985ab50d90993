/*
 * Lines of equal value of a field that is given at vertices and linear between them: the lines to cut along at one
 * level or many.
 *
 * A line is the border, inside a domain, of where the field is at least the level. Hence it is closed or ends at the
 * domain's border, and at every other of its nodes an even number of segments meet. What lies on the level goes with
 * what is above it:
 *
 *   - a vertex on the level is a node of the line where there are triangles above and below, and none where all
 *     neighbours are above, or all below; a saddle is a node of four segments or more
 *   - a plateau at the level is above: the line runs along its sides towards what is below
 *   - an edge on the level is part of the line where one triangle is above, or a plateau, and the other below;
 *     a ridge, a valley, and the domain's border are not
 *
 * A vertex is on every level whose line would cross one of its edges within MESO_CUT_SNAP of the edge's length: the
 * line goes through the vertex then, in all its triangles alike. A vertex without a finite value (no path leads to it)
 * is above all levels, and a line that passes between it and a vertex below goes half-way.
 */
#ifndef MESO_ISOLINE_H
#define MESO_ISOLINE_H

#include "libcore/mesh/cut/mesh_cut.h"

typedef struct MesoIsolineQuery {
    const MesoDomain *domain;   /* NULL: everywhere */
    const float *field;         /* [vertex_count]; only those of the domain's triangles are read */
    const float *levels;        /* [level_count] ascending, finite */
    uint32_t level_count;
} MesoIsolineQuery;

/*
 * Adds the lines of all levels in one pass over the domain's triangles; a segment's `line` is the number of its level,
 * and what is above lies to the left of the way from its first node to its second, as its triangle is wound. A node is
 * added once, and serves both triangles of its edge, or all levels at its vertex. Numbers depend on the input alone.
 * O(triangles + vertices of the domain * log levels + segments). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_isolines_trace(MesoCutLines *lines, MesoArena *arena, const MesoTriangulation *mesh,
                               const MesoIsolineQuery *query, MesoError *error);

#endif
