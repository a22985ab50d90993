/*
 * Cutting a triangulation along many lines at once.
 *
 * Nodes belong to vertices, edges and triangles of the mesh before the cut, and so both triangles at an edge see the same ones: nothing
 * comes apart. A node nearer to the end of its edge than MESO_CUT_SNAP of the edge becomes that vertex; nodes of an edge that near to each other become
 * one; a node inside a triangle that near to a side, measured by its weight, moves onto it. Segments that cross meet in a node of
 * their own. What lies along a side stays there. Each triangle is then split into triangles that have its nodes as vertices and its segments as sides.
 */
#ifndef MESO_MESH_CUT_H
#define MESO_MESH_CUT_H

#include "libcore/mesh/cut/cut_lines.h"

#define MESO_CUT_SNAP 0.004f

/* A triangle after the cut that is part of one before; those of one parent stand together. */
typedef struct MesoCutPart {
    uint32_t triangle;
    uint32_t parent;    /* number of the triangle before the cut; the first part takes its place */
    float centre[3];    /* of the part: weights of the parent's corners */
} MesoCutPart;

/* A new vertex, as a mean of vertices before the cut. */
typedef struct MesoCutOrigin {
    uint32_t vertex[3];
    float weight[3];
} MesoCutOrigin;

typedef struct MesoCutReport {
    uint32_t first_vertex, first_triangle;  /* new ones are from here on */
    uint32_t part_count;
    MesoCutPart *parts;             /* [part_count] of all triangles that were split */
    MesoCutOrigin *origins;         /* [vertex_count - first_vertex] */
    uint32_t *node_vertex;          /* [node_count] vertex that each node has become */
} MesoCutReport;

/*
 * Cuts; segments become walls. Parts keep label, face and values of their parents; new vertices lie on the parents' planes. The result depends on nodes and segments alone, not
 * on their order beyond numbering. Triangles have positive area wherever their parent has. The report and scratch go to
 * `arena`. O(s log s) for s segments, whatever the size of the mesh, but for a word a triangle of scratch. MESO_ERR_LIMIT, MESO_ERR_MEMORY: the mesh is as before then.
 */
MesoStatus meso_mesh_cut(MesoTriangulation *mesh, const MesoCutLines *lines, MesoCutReport *report, MesoArena *arena,
                         MesoError *error);

#endif
