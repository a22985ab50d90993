/*
 * Orientation of slots: which side of a face is direction 0, the tile's +X. A
 * face may start its corner list at any of its four corners; its quarter q
 * (0..3) makes corner q of the file the slot's corner 0, and so side q of the
 * file the slot's side 0. For tiles that may not rotate this decides what the
 * structure looks like.
 */
#ifndef MESO_ORIENTATION_H
#define MESO_ORIENTATION_H

#include "libcore/mesh/slot_graph.h"

/*
 * Carries direction 0 across shared edges: a side of direction d meets one of
 * the opposite direction, d + 2, wherever the topology allows. Breadth-first
 * from the smallest slot of each piece, which stays as it is; then slots whose
 * other neighbours outvote that go with the majority, until none is outvoted,
 * which shortens the cut that singular vertices and handles leave.
 *
 * quarters  [slot_count] result; what is in there does not matter
 *
 * Where all slots of a piece can agree, they do. Which cut is taken depends on
 * the numbers of slots and sides alone. O(slot_count). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_orientation_comb(uint8_t *quarters, MesoArena *scratch, const MesoSlotGraph *graph,
                                 MesoError *error);

/*
 * Makes direction 0 the side that `directions` [face_count] points to: by the
 * smallest angle to the line from the middle of the opposite side to that of
 * the side, the first of equals. Lengths do not matter, nor does the part along
 * the face's normal. A face whose direction is zero, not finite or along the
 * normal keeps the file's order. Returns the number of those. O(face_count).
 */
uint32_t meso_orientation_along(uint8_t *quarters, const MesoQuadMesh *mesh,
                                const MesoVec3 *directions);

/*
 * Gradient in space of a number that is given at the corners, at the middle of
 * each face: of a texture coordinate, what direction +u is.
 *
 * values      [4 * face_count] corner i of face f at 4 f + i
 * directions  [face_count] result; zero where the face is degenerate there
 */
void meso_orientation_gradient(MesoVec3 *directions, const MesoQuadMesh *mesh, const float *values);

/* Edges whose sides have no opposite directions under `quarters`. O(slot_count). */
uint32_t meso_orientation_disagreeing(const MesoSlotGraph *graph, const uint8_t *quarters);

/*
 * Singular corners: vertices inside the surface where other than four faces
 * meet, so that a direction carried around them need not come back as it was. Writes
 * up to `room` vertices, ascending, to `vertices`, and returns how many there
 * are; a vertex where several parts of the surface touch counts once for each
 * that is singular. `graph` and `mesh` are of the same corner order. `*count` is
 * the result. O(slot_count). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_orientation_singular(uint32_t *count, uint32_t *vertices, uint32_t room,
                                     MesoArena *scratch, const MesoQuadMesh *mesh,
                                     const MesoSlotGraph *graph, MesoError *error);

/*
 * Start the faces' corner lists, and with them the slots' sides, where `quarters` say. What is turned are copies
 * in `arena`: arrays may be shared with a surface. O(faces). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_orientation_turn_mesh(MesoQuadMesh *mesh, MesoArena *arena, const uint8_t *quarters, MesoError *error);
MesoStatus meso_orientation_turn_graph(MesoSlotGraph *graph, MesoArena *arena, const uint8_t *quarters,
                                       MesoError *error);

#endif
