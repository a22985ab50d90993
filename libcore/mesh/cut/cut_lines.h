/*
 * Lines along which a triangulation is cut: nodes, and straight segments
 * between them, each inside one triangle or along one of
 * its sides. What isolines, streamlines, cells and geodesic paths are made
 * of; one set of lines is cut at once.
 */
#ifndef MESO_CUT_LINES_H
#define MESO_CUT_LINES_H

#include "libcore/mesh/cut/triangulation.h"

/* Shares of an edge below this are none: a node nearer to an end than that becomes that vertex. */
#define MESO_CUT_SNAP 0.00390625f   /* 2^-8 */

typedef enum MesoNodeKind { MESO_AT_VERTEX, MESO_ON_EDGE, MESO_IN_TRIANGLE } MesoNodeKind;

typedef struct MesoCutNode {
    MesoNodeKind kind;
    uint32_t element;   /* vertex; half-edge, either of an edge's two; triangle */
    float share[2];     /* on an edge: share[0] of the way along the half-edge; in a triangle: weights of its second
                           and third corner */
} MesoCutNode;

typedef struct MesoCutSegment {
    uint32_t node[2];
    uint32_t triangle;  /* that it lies in; of a segment along a side, any that has the side */
    uint32_t line;      /* of the caller's; ascending along a line: nothing is promised */
} MesoCutSegment;

/* Grows in an arena. */
typedef struct MesoCutLines {
    uint32_t node_count, node_room, segment_count, segment_room;
    MesoCutNode *nodes;
    MesoCutSegment *segments;
} MesoCutLines;

/* Adds one, and says its number where `node` is not NULL. Amortised O(1). MESO_ERR_MEMORY alone. */
MesoStatus meso_cut_add_node(MesoCutLines *lines, MesoArena *arena, MesoCutNode added, uint32_t *node,
                             MesoError *error);
MesoStatus meso_cut_add_segment(MesoCutLines *lines, MesoArena *arena, MesoCutSegment added, MesoError *error);

/* Room for so many in all. Amortised O(1) for each that is added. MESO_ERR_MEMORY alone. */
MesoStatus meso_cut_lines_reserve(MesoCutLines *lines, MesoArena *arena, uint64_t node_count, uint64_t segment_count,
                                  MesoError *error);

/* Where a node lies. */
MesoVec3 meso_cut_node_position(const MesoTriangulation *mesh, const MesoCutNode *node);

#endif
