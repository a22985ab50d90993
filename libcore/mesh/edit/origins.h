/*
 * Origins: what the elements of a new mesh come from. Every operation on
 * polygon meshes says this, and positions and attributes are carried along in
 * one way: numbers are combined, names and whole numbers come from one place.
 */
#ifndef MESO_ORIGINS_H
#define MESO_ORIGINS_H

#include "libcore/mesh/polygon_mesh.h"

typedef struct MesoOrigins {
    uint64_t *begin;            /* [new elements + 1] into sources and weights; NULL: one source each */
    uint32_t *sources;          /* elements of the old mesh; with `begin` also new ones: old elements + i stands for
                                   new element i, which must have a higher number than what it is a source of */
    float *weights;             /* of each source; their sum over an element is not 0. NULL without `begin` */
} MesoOrigins;

typedef struct MesoMeshOrigins {
    MesoOrigins of[3];          /* by MesoAttributeDomain */
} MesoMeshOrigins;

/*
 * Fills the rest of `mesh`, whose counts, face_begin or side_count, and corners (all in `arena`) are there already:
 * positions, attributes, and side_count where all faces have as many sides.
 *
 * Floats and normalized integers become the weighted means of those sources that have an entry; names and other
 * integers those of the source with the most weight, the first of equals. An attribute without entry_of stays so.
 * One with entry_of keeps it: entries of equal bytes are one, so that what was joined in the old mesh is in the new
 * one. Names, and values that need no change, are shared with `from`, which must outlive `mesh`.
 *
 * O(sources * width). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_mesh_carry(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                           const MesoMeshOrigins *origins, MesoError *error);

/*
 * Copies to `arena`, where `mesh` is, what it shares with `from`, which it was made of as above: then `from` may go.
 * O(what is shared). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_mesh_detach(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, MesoError *error);

/*
 * A new mesh whose elements are all copies: filled face by face by whoever makes it, in arrays with room
 * for what may come.
 */
typedef struct MesoMeshCopies {
    uint32_t vertex_count, face_count, corner_count;
    uint32_t *vertex_sources;   /* [vertex_count] vertices of the old mesh; NULL: vertex v from vertex v, all of them */
    uint32_t *face_sources;     /* [face_count] */
    uint32_t *face_begin;       /* [face_count + 1] */
    uint32_t *corner_sources;   /* [corner_count] */
    uint32_t *corners;          /* [corner_count] vertices of the new mesh */
} MesoMeshCopies;

/* Room for so many faces and corners; MESO_ERR_LIMIT where they cannot be counted. */
MesoStatus meso_mesh_copies_init(MesoMeshCopies *copies, MesoArena *scratch, uint64_t face_room, uint64_t corner_room,
                                 MesoError *error);

static inline void meso_mesh_copies_corner(MesoMeshCopies *copies, uint32_t source, uint32_t vertex)
{
    copies->corner_sources[copies->corner_count] = source;
    copies->corners[copies->corner_count++] = vertex;
}

/* Ends the face that the last corners belong to. */
static inline void meso_mesh_copies_face(MesoMeshCopies *copies, uint32_t source)
{
    copies->face_sources[copies->face_count++] = source;
    copies->face_begin[copies->face_count] = copies->corner_count;
}

/* The mesh of these copies, with attributes as above. */
MesoStatus meso_mesh_copies_build(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                                  const MesoMeshCopies *copies, MesoError *error);

/* MESO_ERR_LIMIT where one of these is more than 2^32 - 2; `what` is the operation. */
MesoStatus meso_mesh_counts_check(const char *what, uint64_t vertices, uint64_t faces, uint64_t corners,
                                  MesoError *error);

#endif
