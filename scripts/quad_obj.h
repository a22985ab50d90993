/*
 * Quad meshes for the demo's surfaces: growing arrays, a disk made of quads,
 * smoothing, smooth normals, and an OBJ writer. Generators end at the first
 * failure, with a line to standard error.
 */
#ifndef MESO_QUAD_OBJ_H
#define MESO_QUAD_OBJ_H

#include <stdbool.h>
#include <stdint.h>

#include "libcore/math/vec.h"

typedef struct ObjMesh {
    uint32_t vertex_count, face_count;
    uint32_t vertex_room, face_room;
    MesoVec3 *positions;    /* [vertex_count] */
    uint32_t *faces;        /* [4 * face_count] counter-clockwise from outside */
} ObjMesh;

/* Index of the new vertex. */
uint32_t obj_vertex(ObjMesh *mesh, MesoVec3 position);

void obj_face(ObjMesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

/*
 * Appends a unit disk in the plane z = 0, seen from +z: a square grid of
 * `side` x `side` quads inside `ring_count` rings of 4 * side. Its outer vertices are
 * the first 4 * side appended, at the angles 2 pi k / (4 side). Inner vertices
 * are smoothed, so that the four corners of the grid lie where three faces of
 * like angles meet. Returns the index of the first vertex.
 */
uint32_t obj_disk(ObjMesh *mesh, uint32_t side, uint32_t ring_count);

/* Moves all vertices, but for those that are `fixed` ([vertex_count]), to the mean of their neighbours, many times.
 * Each that is not fixed must be in a face. */
void obj_smooth(ObjMesh *mesh, const bool *fixed);

/* Joins vertices from `begin` on that lie within `distance`; those left over are dropped. */
void obj_weld(ObjMesh *mesh, uint32_t begin, float distance);

/* Writes positions, area-weighted smooth normals and faces to standard output, and releases `mesh`. */
void obj_finish(ObjMesh *mesh, const char *title);

#endif
