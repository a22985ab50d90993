/*
 * Cutting a triangulation along many lines at once.
 *
 * Nodes belong to vertices, edges and triangles of the mesh before the cut, so that both triangles at an edge see the
 * same ones in the same order: nothing comes apart. What would make slivers is moved first, by rules that see an edge
 * or a triangle alone. A node nearer to an end of its edge than MESO_CUT_SNAP of the edge becomes that vertex, and
 * nodes of an edge that near to each other become one. A node inside a triangle that near to a side, measured by its
 * weight, moves onto it; one that near to another joins it. A segment that passes a node of its triangle that closely
 * goes through it. Segments that cross meet in a vertex of their own. What lies along a side stays there. Where an edge
 * is so short that coordinates would not tell its vertices apart any more, it is not cut: its nodes go to its ends.
 *
 * Each triangle is then split into triangles that have its nodes as vertices and its segments as sides. The splitting
 * sees weights of the triangle's corners alone, on a grid of whole numbers, and so works for flat triangles as well;
 * diagonals are chosen by angles on the surface.
 */
#ifndef MESO_MESH_CUT_H
#define MESO_MESH_CUT_H

#include "libcore/mesh/cut/cut_lines.h"

/* A triangle after the cut that is part of one before; those of one parent stand together. */
typedef struct MesoCutPart {
    uint32_t triangle;
    uint32_t parent;    /* number of the triangle before the cut; the first part takes its place */
    float centre[3];    /* of the part: weights of the parent's corners */
} MesoCutPart;

/* A new vertex as a mean of vertices before the cut. Weights add up to 1 exactly; on an edge the third is 0. */
typedef struct MesoCutOrigin {
    uint32_t vertex[3];
    float weight[3];
} MesoCutOrigin;

typedef struct MesoCutReport {
    uint32_t first_vertex, first_triangle;  /* new ones are from here on */
    uint32_t part_count;
    MesoCutPart *parts;         /* [part_count] of all triangles that were split or have got a wall; parents ascend */
    MesoCutOrigin *origins;     /* [vertex_count - first_vertex] */
    uint32_t *node_vertex;      /* [node_count] vertex that each node has become */
} MesoCutReport;

/*
 * Cuts; segments become walls, on both sides. Parts keep label and face of their parents, new corners and vertices have
 * values between those of their parents, new vertices lie on the parents' edges and planes. No part is turned over, and
 * parts have positive area where their parent has. The result depends on the mesh, nodes and segments alone. The report
 * and scratch go to `arena`. O(nodes + segments), whatever the size of the mesh; in one triangle, its nodes times the
 * lines that pass between them.
 *
 * MESO_ERR_INTERNAL where a node has no place on the mesh or a segment does not lie in its triangle, MESO_ERR_LIMIT,
 * MESO_ERR_MEMORY; the mesh is as before then.
 */
MesoStatus meso_mesh_cut(MesoTriangulation *mesh, const MesoCutLines *lines, MesoCutReport *report, MesoArena *arena,
                         MesoError *error);

#endif
