/*
 * Integral curves of the gradient of a field that is given at vertices and linear between them: straight in each
 * triangle, and at a right angle to its isolines there.
 *
 * Where the gradients on both sides of an edge point into it, a ridge, the curve follows the edge to its higher end;
 * where both point out of it, it goes to the steeper side. From a vertex it goes where the field rises most steeply,
 * inside a triangle or along an edge. A curve that leaves a triangle within MESO_CUT_SNAP of the side's end goes
 * through the vertex, unless that lies lower than where it came in: the field rises from node to node, and so no curve
 * is closed.
 *
 * All of this holds with up and down changed where a curve goes down.
 */
#ifndef MESO_STREAMLINE_H
#define MESO_STREAMLINE_H

#include "libcore/mesh/cut/mesh_cut.h"

typedef enum MesoStreamStop {
    MESO_STREAM_BORDER,     /* of the domain, or of where the field has finite values; a vertex there is enough */
    MESO_STREAM_EXTREMUM,   /* at a vertex, or in what is flat: a seed, or what is farthest from all of them */
    MESO_STREAM_JOINED,     /* at a vertex of a line before it */
    MESO_STREAM_LONG,       /* the limit of steps */
    MESO_STREAM_BLOCKED,    /* no step: it would leave the domain at once, or start where nothing rises */
    MESO_STREAM_STOPS
} MesoStreamStop;

typedef struct MesoStreamQuery {
    const MesoDomain *domain;       /* NULL: everywhere */
    const float *field;             /* [vertex_count]; only those of the domain's triangles are read */
    bool down;
    bool join;                      /* lines end at vertices of lines before them, with which they would go on */
    uint32_t step_limit;            /* of a line; 0: as many as the domain has triangles */
    uint32_t start_count;
    const MesoMeshPoint *starts;    /* [start_count] in triangles of the domain; a point with a weight of 0 is on that
                                       side, one with two at a vertex, and may go on in any triangle there */
} MesoStreamQuery;

typedef struct MesoStreamReport {
    MesoStreamStop *stops;          /* [start_count] why each ended */
    uint32_t counts[MESO_STREAM_STOPS];
} MesoStreamReport;

/*
 * Adds a line for each start that can be walked, in their order; a segment's `line` is the number of its start, and
 * segments lead from start to end, one after another. A vertex is one node for all lines of a call. The report goes to
 * `arena`. O(segments), and more by the triangles around vertices. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_streamlines_trace(MesoCutLines *lines, MesoStreamReport *report, MesoArena *arena,
                                  const MesoTriangulation *mesh, const MesoStreamQuery *query, MesoError *error);

#endif
