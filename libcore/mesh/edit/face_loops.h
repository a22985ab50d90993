/*
 * Faces whose vertices have become others, or that no reader has checked: none
 * may have a vertex twice.
 */
#ifndef MESO_FACE_LOOPS_H
#define MESO_FACE_LOOPS_H

#include "libcore/mesh/edit/origins.h"

/* Working arrays for all faces of a mesh. */
typedef struct MesoFaceLoops {
    const MesoPolygonMesh *from;
    uint32_t *place;            /* [new vertices] in the stack, where the stack has the vertex there */
    uint32_t *vertices, *sources;   /* [largest face] the stack: new vertex and old corner */
    uint32_t depth;
} MesoFaceLoops;

MesoStatus meso_face_loops_init(MesoFaceLoops *loops, MesoArena *scratch, const MesoPolygonMesh *from,
                                uint32_t new_vertex_count, MesoError *error);

/*
 * Adds face `face` to `copies`, with vertex vertex_of[v] (NULL: v) for v. A face that comes back to a vertex falls into
 * the loops between, of which those with three corners or more become faces: repeated corners and spurs vanish. Returns
 * how many it has become. O(sides).
 */
uint32_t meso_face_loops_add(MesoFaceLoops *loops, MesoMeshCopies *copies, const uint32_t *vertex_of, uint32_t face);

/*
 * `from` with each face as its loops. Of `from`, that its corners are vertices is enough: faces may have vertices
 * twice, and fewer than three corners, and entries of attributes are not looked at. `looped` is how many faces are not
 * as they were. O(corners). MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_mesh_cut_loops(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, uint32_t *looped,
                               MesoError *error);

#endif
