#include "formats/quilt/quilt_move.h"

#include <string.h>

#include "libcore/mesh/edit/ear_clip.h"
#include "libcore/quilt/embed/quilt_transfer.h"

/* ---- the same faces ---- */

static MesoStatus compare_counts(const char *what, uint32_t count, uint32_t wanted, MesoError *error)
{
    return count == wanted ? MESO_OK
                           : meso_fail(error, MESO_ERR_INPUT, "has %u %s; the surface of the quilt has %u", count, what,
                                       wanted);
}

static MesoStatus compare_faces(const MesoSurfaceMark *mark, const MesoSurfaceMark *wanted, MesoError *error)
{
    MesoStatus status = compare_counts("vertices", mark->vertex_count, wanted->vertex_count, error);
    if (!status)
        status = compare_counts("faces", mark->face_count, wanted->face_count, error);
    if (!status)
        status = compare_counts("corners", mark->corner_count, wanted->corner_count, error);
    if (!status && memcmp(mark->hash, wanted->hash, sizeof mark->hash) != 0)
        status = meso_fail(error, MESO_ERR_INPUT, "joins its vertices otherwise than the surface of the quilt does");
    return status;
}

/* ---- the same texture coordinates ---- */

MesoStatus meso_corner_uvs(MesoVec2 **uvs, MesoArena *arena, const MesoPolygonMesh *mesh, uint32_t *face,
                           MesoError *error)
{
    const MesoAttribute *uv = meso_polygon_attribute_on(mesh, "uv", MESO_ON_CORNERS);
    uv = uv ? uv : meso_polygon_attribute_on(mesh, "uv", MESO_ON_VERTICES);
    *uvs = NULL;
    *face = MESO_NO_INDEX;
    if (!uv || uv->width < 2)
        return MESO_OK;
    *uvs = MESO_NEW(arena, MesoVec2, mesh->corner_count, error);
    if (!*uvs)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < mesh->corner_count; c++) {
        uint32_t entry = meso_attribute_entry(uv, uv->domain == MESO_ON_CORNERS ? c : mesh->corners[c]);
        MesoVec2 at = entry == MESO_NO_INDEX ? (MesoVec2){NAN, NAN} : meso_attribute_vec2(uv, entry);
        if (!isfinite(at.x) || !isfinite(at.y)) {
            *uvs = NULL;
            *face = c / 3;
            return MESO_OK;
        }
        (*uvs)[c] = at;
    }
    return MESO_OK;
}

/* The face that a triangle of meso_mesh_cut_faces() is part of. */
static uint32_t uncut_face(const MesoPolygonMesh *mesh, uint32_t triangle)
{
    uint32_t face = 0, end = 0;
    if (triangle == MESO_NO_INDEX)
        return MESO_NO_INDEX;
    while (face < mesh->face_count && (end += meso_polygon_sides(mesh, face) - 2) <= triangle)
        face++;
    return face;
}

/* `triangle` gets what an error is about. */
static MesoStatus move_by_texture(MesoQuiltFile *file, MesoArena *arena, const MesoPolygonMesh *cut, uint32_t *triangle,
                                  MesoError *error)
{
    MesoVec2 *uvs;
    MesoStatus status = meso_corner_uvs(&uvs, arena, cut, triangle, error);
    if (!status && *triangle != MESO_NO_INDEX)
        status = meso_fail(error, MESO_ERR_INPUT, "has no texture coordinates here");
    else if (!status && !uvs)
        status = meso_fail(error, MESO_ERR_INPUT, "has no texture coordinates");
    if (status)
        return status;
    const MesoTextureMesh from = {file->base.triangle_count, file->base_uvs}, to = {cut->face_count, uvs};
    status = meso_quilt_transfer(&file->quilt, &from, &to, triangle, error);
    if (status)
        return status;
    file->base = (MesoTriangulation){.vertex_count = cut->vertex_count, .triangle_count = cut->face_count,
                                     .positions = cut->positions, .corners = cut->corners};
    file->base_uvs = uvs;
    return MESO_OK;
}

MesoStatus meso_quilt_move(MesoQuiltFile *file, MesoArena *arena, const MesoPolygonMesh *mesh, uint32_t *face,
                           MesoError *error)
{
    MesoPolygonMesh cut;
    MesoError difference, reason;
    MesoSurfaceMark mark = meso_surface_mark(mesh);
    MesoStatus status = compare_faces(&mark, &file->surface, &difference);
    *face = MESO_NO_INDEX;
    if (status && !file->base_uvs)
        return meso_fail(error, status, "%s", difference.message);
    if (!status) {
        for (uint32_t v = 0; v < file->base.vertex_count; v++)
            if (file->base.origins[v] != MESO_NO_INDEX)
                file->base.positions[v] = mesh->positions[file->base.origins[v]];
        return MESO_OK;
    }
    status = meso_mesh_cut_faces(&cut, arena, mesh, &reason);
    if (!status)
        status = move_by_texture(file, arena, &cut, face, &reason);
    *face = uncut_face(mesh, *face);
    if (status == MESO_ERR_INPUT)
        return meso_fail(error, status, "%s; nor is it the surface of the quilt, moved: it %s", reason.message,
                         difference.message);
    if (status && error)
        *error = reason;
    return status;
}
