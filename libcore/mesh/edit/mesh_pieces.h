/* What mesh_orient.c and mesh_wind.c share: pieces of a mesh, and which of their faces are turned over. */
#ifndef MESO_MESH_PIECES_H
#define MESO_MESH_PIECES_H

#include "libcore/base/bits.h"
#include "libcore/mesh/edit/origins.h"
#include "libcore/mesh/half_edges.h"

typedef struct MesoMeshPieces {
    const MesoPolygonMesh *mesh;
    const MesoHalfEdges *edges;
    uint32_t *face_of;          /* [corner_count] */
    uint32_t *queue;            /* [face_count] faces of the piece, in the order in which they were found */
    uint64_t *met, *turned;     /* bits of faces */
    uint32_t head, tail;        /* of the piece within the queue */
} MesoMeshPieces;

MesoStatus meso_mesh_pieces_init(MesoMeshPieces *pieces, MesoArena *scratch, MesoError *error);

/* Whether the two faces of an edge run along it the same way, as they are turned now. `h` has a twin. */
static inline bool meso_mesh_pieces_disagree(const MesoMeshPieces *pieces, uint32_t h)
{
    uint32_t twin = pieces->edges->twin[h];
    bool alike = pieces->mesh->corners[h] == pieces->mesh->corners[twin];
    return alike ^ meso_bits_test(pieces->turned, pieces->face_of[h]) ^
           meso_bits_test(pieces->turned, pieces->face_of[twin]);
}

/* The faces from `first` on that hang together, as a part of the queue, turned to agree with it. */
void meso_mesh_pieces_find(MesoMeshPieces *pieces, uint32_t first);

typedef struct MesoMeshPiece {
    bool closed;
    uint32_t turned, doubled;   /* faces; edges that disagree, each counted from both sides */
    double volume;              /* that it encloses, six times */
} MesoMeshPiece;

/* Of the piece that was found last; and all of its faces the other way round. */
MesoMeshPiece meso_mesh_pieces_measure(const MesoMeshPieces *pieces);
void meso_mesh_pieces_turn(const MesoMeshPieces *pieces);

/*
 * The mesh with the faces of `turned` turned over; each keeps its first corner. Corner c of the old mesh lies on vertex
 * corners[c] of the new one, which comes from vertex_sources[] (NULL: as in the old one). Normals of corners and
 * vertices that look into their faces are turned too; with `faces` (bits) those of these faces alone.
 */
typedef struct MesoMeshTurning {
    const uint64_t *turned;
    const uint32_t *corners;    /* [corner_count] */
    uint32_t *vertex_sources;   /* [vertex_count] */
    uint32_t vertex_count;
    const uint64_t *faces;
} MesoMeshTurning;

MesoStatus meso_mesh_turn(MesoPolygonMesh *mesh, MesoArena *arena, MesoArena *scratch, const MesoPolygonMesh *from,
                          const MesoMeshTurning *turning, MesoError *error);

#endif
