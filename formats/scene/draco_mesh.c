#include "formats/scene/draco_mesh.h"

#include <assert.h>

enum { POSITION_BITS = 14, NORMAL_BITS = 10, UV_BITS = 12 };

MesoStatus meso_draco_options_make(MesoDracoOptions *draco, const MesoSceneParts *parts,
                                   const MesoMeshWriteOptions *options, MesoError *error)
{
    const MesoScene *scene = parts->scene;
    for (uint32_t c = 0; c < scene->channel_count; c++)
        if (scene->channels[c].count > MESO_DRACO_ID_LIMIT)
            return meso_fail(error, MESO_ERR_LIMIT, "too many %ss for Draco: %u, at most %u",
                             scene->channels[c].name, scene->channels[c].count, MESO_DRACO_ID_LIMIT);
    MesoBox box;
    MesoStatus status = meso_scene_parts_box(parts, options->thread_count, &box, error);
    if (status)
        return status;
    if (options->box)
        box = *options->box;
    *draco = (MesoDracoOptions){
        .position_bits = options->position_bits ? options->position_bits : POSITION_BITS,
        .normal_bits = options->normal_bits ? options->normal_bits : NORMAL_BITS,
        .uv_bits = UV_BITS,
        .speed = options->speed,
        .box = box,
        .colored = meso_scene_is_colored(scene),
    };
    return MESO_OK;
}

typedef struct PartArrays {
    MesoMeshVertex *vertices;
    MesoMeshColor *colors;
    MesoMeshFace *faces;
    MesoPart *parts;
    uint32_t *part_end;
} PartArrays;

static MesoStatus allocate(PartArrays *arrays, MesoArena *arena, const MesoSceneParts *parts,
                           uint32_t range_count, const MesoPartRange *ranges, bool colored, MesoError *error)
{
    uint64_t vertices = 0, faces = 0, count = 0;
    for (uint32_t i = 0; i < range_count; i++) {
        vertices += parts->vertex_begin[ranges[i].end] - parts->vertex_begin[ranges[i].begin];
        faces += parts->face_begin[ranges[i].end] - parts->face_begin[ranges[i].begin];
        count += ranges[i].end - ranges[i].begin;
    }
    assert(vertices > 0 && vertices < UINT32_MAX && faces > 0 && faces < UINT32_MAX);
    arrays->vertices = MESO_NEW(arena, MesoMeshVertex, vertices, error);
    arrays->colors = MESO_NEW(arena, MesoMeshColor, colored ? vertices : 0, error);
    arrays->faces = MESO_NEW(arena, MesoMeshFace, faces, error);
    arrays->parts = MESO_NEW(arena, MesoPart, count, error);
    arrays->part_end = MESO_NEW(arena, uint32_t, count, error);
    bool complete = arrays->vertices && arrays->colors && arrays->faces && arrays->parts && arrays->part_end;
    return complete ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoDracoMesh fill(const PartArrays *arrays, const MesoSceneParts *parts, uint32_t range_count,
                          const MesoPartRange *ranges, bool colored)
{
    MesoDracoMesh mesh = {.scene = parts->scene, .vertices = arrays->vertices,
                          .colors = colored ? arrays->colors : NULL, .faces = arrays->faces,
                          .parts = arrays->parts, .part_end = arrays->part_end};
    for (uint32_t i = 0; i < range_count; i++) {
        uint32_t begin = ranges[i].begin, end = ranges[i].end;
        meso_scene_vertices(parts, begin, end, arrays->vertices + mesh.vertex_count);
        if (colored)
            meso_scene_colors(parts, begin, end, arrays->colors + mesh.vertex_count);
        meso_scene_faces(parts, begin, end, mesh.vertex_count, arrays->faces + mesh.face_count);
        for (uint32_t part = begin; part < end; part++) {
            arrays->parts[mesh.part_count] = meso_scene_part(parts, part);
            mesh.vertex_count += (uint32_t)(parts->vertex_begin[part + 1] - parts->vertex_begin[part]);
            arrays->part_end[mesh.part_count++] = mesh.vertex_count;
        }
        mesh.face_count += (uint32_t)(parts->face_begin[end] - parts->face_begin[begin]);
    }
    return mesh;
}

MesoStatus meso_draco_encode_parts(const MesoSceneParts *parts, uint32_t range_count,
                                   const MesoPartRange *ranges, const MesoDracoOptions *draco,
                                   MesoDracoResult *result, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    PartArrays arrays;
    MesoStatus status = allocate(&arrays, &arena, parts, range_count, ranges, draco->colored, error);
    if (!status) {
        MesoDracoMesh mesh = fill(&arrays, parts, range_count, ranges, draco->colored);
        status = meso_draco_encode(&mesh, draco, result, error);
    }
    meso_arena_release(&arena);
    return status;
}
