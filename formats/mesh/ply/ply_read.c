#include "formats/mesh/mesh_kinds.h"
#include "formats/mesh/mesh_text.h"
#include "formats/mesh/ply/ply_body.h"
#include "formats/mesh/ply/ply_layout.h"
#include "formats/mesh/ply/ply_names.h"

MesoStatus meso_ply_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                         MesoError *error)
{
    MesoArena scratch;
    *mesh = (MesoPolygonMesh){0};
    meso_arena_init(&scratch);
    MesoPly *ply = MESO_NEW(&scratch, MesoPly, 1, error);
    MesoStatus status = ply ? meso_ply_header_read(ply, arena, input, error) : MESO_ERR_MEMORY;
    if (!status)
        status = meso_ply_plan(ply, mesh, arena, error);
    if (!status)
        status = ply->form == MESO_PLY_ASCII ? meso_ply_read_ascii(ply, mesh, arena, input, thread_count, error)
                                             : meso_ply_read_binary(ply, mesh, arena, input, thread_count, error);
    if (!status)
        status = meso_ply_name_numbers(ply, mesh, arena, error);
    meso_arena_release(&scratch);
    return status;
}

/* The line of the item `line` of all, from 0. */
static uint32_t find_line(MesoArena *scratch, const MesoInput *input, size_t body, uint64_t line)
{
    MesoMeshText text;
    if (meso_mesh_text_init(&text, scratch, input, body, 0, false, NULL))
        return 0;
    for (uint32_t p = 0; p < text.piece_count; p++) {
        MesoTextLine at = {.next = text.pieces[p].begin};
        while (meso_text_filled_line(&text, &text.pieces[p], at.next, &at))
            if (line-- == 0)
                return meso_mesh_text_line_number(&text, meso_text_offset(&text.pieces[p], at.begin));
    }
    return 0;
}

uint32_t meso_ply_face_line(MesoArena *scratch, const MesoInput *input, uint32_t face)
{
    uint64_t line = face;
    MesoPly *ply = MESO_NEW(scratch, MesoPly, 1, NULL);
    if (!ply || meso_ply_header_read(ply, scratch, input, NULL) || ply->form != MESO_PLY_ASCII)
        return 0;
    for (uint32_t e = 0; e < ply->element_count && ply->elements[e].kind != MESO_PLY_FACES; e++)
        line += ply->elements[e].count;
    return find_line(scratch, input, ply->body, line);
}
