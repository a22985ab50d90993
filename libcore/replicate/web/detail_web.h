/*
 * Web: a triangulation of details over a surface of any genus, without charts. Details are put into the surface's own
 * triangulation; edges are flipped by their lengths on the surface alone until it is Delaunay ("A Discrete Laplace-
 * Beltrami Operator for Simplicial Surfaces", Bobenko and Springborn 2007), and the surface's vertices are taken out.
 * Those of borders stay, and those that cannot go: without them the web would join a detail to itself.
 *
 * From then on a web follows its details: a length is that of the straight line, corrected by the angle between the
 * normals at its ends to that of an arc.
 */
#ifndef MESO_DETAIL_WEB_H
#define MESO_DETAIL_WEB_H

#include "libcore/replicate/web/web.h"

/*
 * Of details on a surface, in its own shape. Places and normals are those of that shape.
 *
 * normals  [mesh->vertex_count] unit length
 *
 * A surface that has one side only is cut open (oriented_surface.h). MESO_ERR_LIMIT, MESO_ERR_MEMORY. Arrays are in the
 * arena, which lives as long as the web. About O(n) of vertices and details.
 */
MesoStatus meso_web_build(MesoWeb *web, MesoArena *arena, const MesoTriangulation *mesh, const MesoVec3 *normals,
                          const MesoMeshPoint *points, uint32_t count, MesoError *error);

/* Goes to another shape of the surface. O(nodes), on `thread_count` threads (0: all cores). */
void meso_web_place(MesoWeb *web, const MesoTriangulation *mesh, const MesoVec3 *positions, const MesoVec3 *normals,
                    uint32_t thread_count);

/*
 * Flips edges until all are Delaunay, or could not be flipped without joining two nodes twice; of triangles of one part
 * of so many, and what flips there make worse. Returns the number of flips. O(triangles / parts).
 */
uint32_t meso_web_settle(MesoWeb *web, uint32_t part, uint32_t parts);

/*
 * Puts a node into a triangle, and settles around it. Its number is node_count before. MESO_ERR_MEMORY, MESO_ERR_LIMIT;
 * the web is as before then.
 */
MesoStatus meso_web_insert(MesoWeb *web, uint32_t triangle, MesoMeshPoint point, MesoVec3 position, MesoVec3 normal,
                           MesoError *error);

/* meso_web_merge (web_edit.h), and settles around what is left. */
bool meso_web_remove(MesoWeb *web, uint32_t node, uint32_t into);

/* Mean and deviation of the lengths of edges between details. */
typedef struct MesoWebEdges {
    uint32_t count;
    double mean, deviation;
} MesoWebEdges;

MesoWebEdges meso_web_edges(const MesoWeb *web);

#endif
