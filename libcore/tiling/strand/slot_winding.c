#include "libcore/tiling/strand/slot_winding.h"

#include <string.h>

/* x and y change places: corners 0 and 2 do, and sides 0 and 1, 2 and 3. */
static const MesoTransform SWAP = 7;
static const uint32_t SWAPPED_CORNER[4] = {2, 1, 0, 3}, SWAPPED_SIDE[4] = {1, 0, 3, 2};

static bool looks_along(const MesoQuadMesh *mesh, uint32_t face)
{
    const uint32_t *v = mesh->face_vertices + 4 * (size_t)face;
    MesoVec3 area = meso_vec3_cross(meso_vec3_sub(mesh->positions[v[2]], mesh->positions[v[0]]),
                                    meso_vec3_sub(mesh->positions[v[3]], mesh->positions[v[1]]));
    float along = 0;
    for (uint32_t i = 0; i < 4; i++)
        along += meso_vec3_dot(mesh->normals[mesh->face_normals[4 * (size_t)face + i]], area);
    return along >= 0;
}

static bool all_look_along(const MesoQuadMesh *mesh)
{
    for (uint32_t face = 0; face < mesh->face_count; face++)
        if (!looks_along(mesh, face))
            return false;
    return true;
}

static MesoStatus copy_arrays(MesoModel *wound, const MesoModel *model, MesoArena *arena, MesoError *error)
{
    size_t faces = model->surface.face_count, corners = 4 * faces;
    wound->surface.face_vertices = MESO_NEW(arena, uint32_t, corners, error);
    wound->surface.face_normals = MESO_NEW(arena, uint32_t, corners, error);
    wound->graph.twin = MESO_NEW(arena, uint32_t, corners, error);
    wound->assignment.transform = MESO_NEW(arena, MesoTransform, faces, error);
    return wound->surface.face_vertices && wound->surface.face_normals && wound->graph.twin &&
           wound->assignment.transform ? MESO_OK : MESO_ERR_MEMORY;
}

static void wind_slots(MesoModel *wound, const MesoModel *model, const uint32_t *piece, const bool *keeps)
{
    for (uint32_t slot = 0; slot < model->surface.face_count; slot++) {
        bool turns = !keeps[piece[slot]];
        size_t first = 4 * (size_t)slot;
        MesoTransform transform = model->assignment.transform[slot];
        wound->assignment.transform[slot] = turns ? meso_transform_compose(SWAP, transform) : transform;
        for (uint32_t i = 0; i < 4; i++) {
            size_t corner = first + (turns ? SWAPPED_CORNER[i] : i);
            uint32_t twin = model->graph.twin[first + (turns ? SWAPPED_SIDE[i] : i)];
            wound->surface.face_vertices[first + i] = model->surface.face_vertices[corner];
            wound->surface.face_normals[first + i] = model->surface.face_normals[corner];
            wound->graph.twin[first + i] = turns && twin != MESO_NO_INDEX ? twin - twin % 4 + SWAPPED_SIDE[twin % 4]
                                                                          : twin;
        }
    }
}

MesoStatus meso_model_wind(MesoModel *wound, const MesoModel *model, MesoArena *arena, MesoError *error)
{
    const MesoQuadMesh *mesh = &model->surface;
    *wound = *model;
    if (all_look_along(mesh))
        return MESO_OK;
    uint32_t *piece = MESO_NEW(arena, uint32_t, mesh->face_count, error);
    bool *keeps = MESO_NEW(arena, bool, mesh->face_count, error);
    if (!piece || !keeps)
        return MESO_ERR_MEMORY;
    meso_slot_graph_components(&model->graph, piece);
    for (uint32_t slot = 0; slot < mesh->face_count; slot++)
        keeps[piece[slot]] |= looks_along(mesh, slot);
    MesoStatus status = copy_arrays(wound, model, arena, error);
    if (!status)
        wind_slots(wound, model, piece, keeps);
    return status;
}
