#include "formats/draco_mesh.h"

#include <assert.h>

#include "formats/mesh_window.h"

enum { POSITION_BITS = 14, NORMAL_BITS = 10, UV_BITS = 12 };

MesoStatus meso_draco_options_make(MesoDracoOptions *draco, const MesoTessellation *t,
                                   const MesoMeshWriteOptions *options, MesoError *error)
{
    if (t->structure->model->assignment.slot_count > MESO_DRACO_ID_LIMIT)
        return meso_fail(error, MESO_ERR_LIMIT, "too many slots for Draco: %u, at most %u; write .ply",
                         t->structure->model->assignment.slot_count, MESO_DRACO_ID_LIMIT);
    MesoVec3 low, high;
    MesoStatus status = meso_mesh_bounds(t, options->thread_count, &low, &high, error);
    if (status != MESO_OK)
        return status;
    *draco = (MesoDracoOptions){
        .position_bits = options->position_bits ? options->position_bits : POSITION_BITS,
        .normal_bits = options->normal_bits ? options->normal_bits : NORMAL_BITS,
        .uv_bits = UV_BITS,
        .speed = options->speed,
        .low = low,
        .high = high,
    };
    return MESO_OK;
}

typedef struct PartArrays {
    MesoMeshVertex *vertices;
    MesoMeshFace *faces;
    MesoMeshPart *parts;
    uint32_t *part_end;
} PartArrays;

static MesoStatus allocate(PartArrays *arrays, MesoArena *arena, const MesoTessellation *t,
                           uint32_t range_count, const MesoPartRange *ranges, MesoError *error)
{
    uint64_t vertices = 0, faces = 0, parts = 0;
    for (uint32_t i = 0; i < range_count; i++) {
        vertices += t->vertex_begin[ranges[i].end] - t->vertex_begin[ranges[i].begin];
        faces += t->face_begin[ranges[i].end] - t->face_begin[ranges[i].begin];
        parts += ranges[i].end - ranges[i].begin;
    }
    assert(vertices > 0 && vertices < UINT32_MAX && faces > 0 && faces < UINT32_MAX);
    arrays->vertices = MESO_NEW(arena, MesoMeshVertex, vertices, error);
    arrays->faces = MESO_NEW(arena, MesoMeshFace, faces, error);
    arrays->parts = MESO_NEW(arena, MesoMeshPart, parts, error);
    arrays->part_end = MESO_NEW(arena, uint32_t, parts, error);
    bool complete = arrays->vertices && arrays->faces && arrays->parts && arrays->part_end;
    return complete ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoDracoMesh tessellate(const PartArrays *arrays, const MesoTessellation *t,
                                uint32_t range_count, const MesoPartRange *ranges)
{
    MesoDracoMesh mesh = {0, 0, 0, arrays->vertices, arrays->faces, arrays->parts, arrays->part_end};
    for (uint32_t i = 0; i < range_count; i++) {
        uint32_t begin = ranges[i].begin, end = ranges[i].end;
        meso_tessellation_vertices(t, begin, end, arrays->vertices + mesh.vertex_count);
        meso_tessellation_faces(t, begin, end, mesh.vertex_count, arrays->faces + mesh.face_count);
        for (uint32_t part = begin; part < end; part++) {
            arrays->parts[mesh.part_count] = meso_tessellation_part(t, part);
            mesh.vertex_count += (uint32_t)(t->vertex_begin[part + 1] - t->vertex_begin[part]);
            arrays->part_end[mesh.part_count++] = mesh.vertex_count;
        }
        mesh.face_count += (uint32_t)(t->face_begin[end] - t->face_begin[begin]);
    }
    return mesh;
}

MesoStatus meso_draco_encode_parts(const MesoTessellation *t, uint32_t range_count,
                                   const MesoPartRange *ranges, const MesoDracoOptions *draco,
                                   MesoDracoResult *result, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    PartArrays arrays;
    MesoStatus status = allocate(&arrays, &arena, t, range_count, ranges, error);
    if (status == MESO_OK) {
        MesoDracoMesh mesh = tessellate(&arrays, t, range_count, ranges);
        status = meso_draco_encode(&mesh, draco, result, error);
    }
    meso_arena_release(&arena);
    return status;
}
