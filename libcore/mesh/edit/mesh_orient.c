#include "libcore/mesh/edit/mesh_orient.h"

#include "libcore/mesh/edit/mesh_pieces.h"

static void orient_piece(const MesoMeshPieces *pieces, MesoOrientCounts *counts)
{
    MesoMeshPiece piece = meso_mesh_pieces_measure(pieces);
    uint32_t count = pieces->tail - pieces->head;
    bool closed = piece.closed && piece.doubled == 0 && piece.volume != 0;
    if (closed ? piece.volume < 0 : piece.turned > count - piece.turned) {
        meso_mesh_pieces_turn(pieces);
        piece.turned = count - piece.turned;
    }
    counts->faces_turned += piece.turned;
    counts->pieces_turned += closed && piece.turned == count;
    counts->disagreeing += piece.doubled / 2;
    if (piece.doubled && counts->one_sided == MESO_NO_INDEX)
        counts->one_sided = pieces->queue[pieces->head];
}

static MesoStatus orient(MesoPolygonMesh *mesh, MesoArena *arena, MesoArena *scratch, MesoMeshPieces *pieces,
                         MesoOrientCounts *counts, MesoError *error)
{
    MesoStatus status = meso_mesh_pieces_init(pieces, scratch, error);
    for (uint32_t f = 0; f < pieces->mesh->face_count && !status; f++) {
        if (meso_bits_test(pieces->met, f))
            continue;
        meso_mesh_pieces_find(pieces, f);
        orient_piece(pieces, counts);
    }
    const MesoMeshTurning turning = {.turned = pieces->turned, .corners = pieces->mesh->corners,
                                     .vertex_count = pieces->mesh->vertex_count};
    return status ? status : meso_mesh_turn(mesh, arena, scratch, pieces->mesh, &turning, error);
}

MesoStatus meso_mesh_orient(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                            const MesoHalfEdges *edges, MesoOrientCounts *counts, MesoError *error)
{
    MesoArena scratch;
    MesoOrientCounts ignored;
    MesoMeshPieces pieces = {.mesh = from, .edges = edges};
    counts = counts ? counts : &ignored;
    *counts = (MesoOrientCounts){.one_sided = MESO_NO_INDEX};
    meso_arena_init(&scratch);
    MesoStatus status = orient(mesh, arena, &scratch, &pieces, counts, error);
    meso_arena_release(&scratch);
    return status;
}
