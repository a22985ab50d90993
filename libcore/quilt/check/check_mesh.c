#include "libcore/quilt/check/check_mesh.h"

#include "libcore/base/disjoint_sets.h"
#include "libcore/mesh/half_edges.h"

/* Fans are sets of corners, joined across the edges at both of their ends. */
static MesoStatus count_pinched(uint32_t *pinched, MesoArena *arena, const MesoCheckMesh *mesh, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(arena);
    uint32_t corner_count = 3 * mesh->triangle_count, fan_count = corner_count, used_count = 0;
    uint32_t *fans = MESO_NEW(arena, uint32_t, corner_count, error);
    uint8_t *used = MESO_NEW(arena, uint8_t, mesh->vertex_count, error);
    if (!fans || !used)
        return MESO_ERR_MEMORY;
    meso_sets_init(fans, corner_count);
    for (uint32_t c = 0; c < corner_count; c++) {
        uint32_t across = mesh->twins[c], v = mesh->corners[c];
        used_count += !used[v];
        used[v] = 1;
        if (across == MESO_NO_INDEX)
            continue;
        uint32_t there = mesh->corners[across] == v ? across : meso_next_corner(across);
        uint32_t beyond = there == across ? meso_next_corner(across) : across;
        fan_count -= meso_sets_join(fans, c, there);
        fan_count -= meso_sets_join(fans, meso_next_corner(c), beyond);
    }
    *pinched = fan_count - used_count;
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

static void count_faults(MesoMeshFaults *faults, const MesoCheckMesh *mesh, const MesoHalfEdges *joined)
{
    *faults = (MesoMeshFaults){.open_count = joined->border_count, .crowded_count = joined->crowded_count,
                               .reversed_count = joined->reversed_count};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->corners[3 * (size_t)t];
        faults->collapsed_count += v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        faults->unplaced_count += !meso_vec3_finite(mesh->positions[v]);
}

static MesoStatus name_elements(MesoCheckMesh *mesh, MesoArena *arena, MesoError *error)
{
    mesh->elements = MESO_NEW(arena, uint32_t, mesh->triangle_count, error);
    if (!mesh->elements)
        return MESO_ERR_MEMORY;
    for (uint32_t e = 0; e < mesh->element_count; e++)
        for (uint32_t t = mesh->triangle_begin[e]; t < mesh->triangle_begin[e + 1]; t++)
            mesh->elements[t] = e;
    return MESO_OK;
}

MesoStatus meso_check_mesh_of_quilt(MesoCheckMesh *mesh, MesoMeshFaults *faults, MesoArena *arena,
                                    const MesoQuilt *quilt, const MesoVec3 *positions, uint32_t thread_count,
                                    MesoError *error)
{
    *mesh = (MesoCheckMesh){
        .vertex_count = quilt->vertex_count, .triangle_count = quilt->triangle_count,
        .element_count = quilt->element_count, .positions = positions, .corners = quilt->corners,
        .vertex_begin = quilt->vertex_begin, .triangle_begin = quilt->triangle_begin, .patches = quilt->patches,
        .origins = quilt->origins,
    };
    MesoPolygonMesh polygons = {
        .vertex_count = quilt->vertex_count, .face_count = quilt->triangle_count,
        .corner_count = 3 * quilt->triangle_count, .side_count = 3, .corners = quilt->corners,
    };
    MesoHalfEdges joined;
    MesoStatus status = meso_half_edges_join(&joined, arena, &polygons, thread_count, error);
    if (status)
        return status;
    mesh->twins = joined.twin;
    count_faults(faults, mesh, &joined);
    status = count_pinched(&faults->pinched_count, arena, mesh, error);
    return status ? status : name_elements(mesh, arena, error);
}

MesoStatus meso_check_mesh_of_swatch(MesoCheckMesh *mesh, MesoArena *arena, const MesoSwatch *swatch, MesoError *error)
{
    *mesh = (MesoCheckMesh){
        .vertex_count = swatch->vertex_count, .triangle_count = swatch->triangle_count,
        .element_count = swatch->element_count, .positions = swatch->positions, .corners = swatch->corners,
        .vertex_begin = swatch->vertex_begin, .triangle_begin = swatch->triangle_begin, .twins = swatch->twins,
    };
    return name_elements(mesh, arena, error);
}

/* ---- shapes of elements ---- */

static void measure_triangles(MesoElementShape *shape, const MesoCheckMesh *mesh, uint32_t begin, uint32_t end)
{
    uint32_t edge_ends = 0;
    MesoVec3 origin = begin < end ? mesh->positions[mesh->corners[3 * (size_t)begin]] : (MesoVec3){0, 0, 0};
    for (uint32_t t = begin; t < end; t++) {
        const uint32_t *v = &mesh->corners[3 * (size_t)t];
        MesoVec3 a = meso_vec3_sub(mesh->positions[v[0]], origin), b = meso_vec3_sub(mesh->positions[v[1]], origin);
        MesoVec3 c = meso_vec3_sub(mesh->positions[v[2]], origin);
        shape->volume += (double)meso_vec3_dot(a, meso_vec3_cross(b, c)) / 6;
        shape->area += (double)meso_vec3_length(meso_vec3_cross(meso_vec3_sub(b, a), meso_vec3_sub(c, a))) / 2;
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++)
            if (mesh->twins[h] == MESO_NO_INDEX)
                shape->open_count++;
            else
                edge_ends++;
    }
    shape->triangle_count = end - begin;
    shape->euler += (int64_t)shape->triangle_count - (int64_t)(edge_ends / 2) - (int64_t)shape->open_count;
}

MesoStatus meso_check_shapes(MesoElementShape *shapes, MesoArena *scratch, const MesoCheckMesh *mesh, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    uint32_t *pieces = MESO_NEW(scratch, uint32_t, mesh->vertex_count, error);
    uint8_t *used = MESO_NEW(scratch, uint8_t, mesh->vertex_count, error);
    if (!pieces || !used)
        return MESO_ERR_MEMORY;
    meso_sets_init(pieces, mesh->vertex_count);
    for (uint32_t c = 0; c < 3 * mesh->triangle_count; c++) {
        used[mesh->corners[c]] = 1;
        meso_sets_join(pieces, mesh->corners[c], mesh->corners[meso_next_corner(c)]);
    }
    for (uint32_t e = 0; e < mesh->element_count; e++) {
        shapes[e] = (MesoElementShape){0};
        for (uint32_t v = mesh->vertex_begin[e]; v < mesh->vertex_begin[e + 1]; v++) {
            shapes[e].euler += used[v];
            shapes[e].piece_count += used[v] && meso_sets_root(pieces, v) == v;
        }
        measure_triangles(&shapes[e], mesh, mesh->triangle_begin[e], mesh->triangle_begin[e + 1]);
    }
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
