#include "formats/model/model_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/file/packed_chunk.h"
#include "formats/json/json_text.h"
#include "formats/model/model_mapping.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/mesh/slot_graph.h"
#include "libcore/tiling/problem/strand_joints.h"
#include "libcore/tiling/tile/tile_set_check.h"

/* 1 is of models of bodies (model_body.h); 2 has the chunk 'mapping', 3 had 'joint', 4 has packed chunks. */
enum { MINOR = 0, MINOR_MAPPING = 2, MINOR_PACKED = 4 };

/* What a relaxed model packs: half of one are its joints. */
enum { FACE, FACE_NORMAL, TILE, JOINT, PACKED_COUNT };
static const struct {
    const char *packed, *name;
    MesoPacking packing;
} PACKED[PACKED_COUNT] = {
    [FACE] = {"zface", "face", {4, 4, true}},
    [FACE_NORMAL] = {"zfacenrm", "facenorm", {4, 4, true}},
    [TILE] = {"ztile", "tile", {4, 1, false}},
    [JOINT] = {"zjoint", "joint", {2, 4, false}},
};

/* How options lie in the file. */
typedef struct StoredOptions {
    float thickness, offset, section_scale, tangent_scale, section_step;
    uint32_t divisions;
} StoredOptions;

/* All inner meshes, one after the other. */
typedef struct InnerArrays {
    uint32_t *counts;       /* [2 * inner_count] vertices, triangles */
    MesoVec3 *positions, *normals;
    uint32_t *triangles;
    uint64_t vertex_count, triangle_count;
} InnerArrays;

static StoredOptions store_options(const MesoModel *model)
{
    MesoMapOptions o = meso_map_options_resolve(model->options, model->surface.mean_edge_length);
    return (StoredOptions){o.thickness, o.offset, o.section_scale, o.tangent_scale, o.section_step,
                           o.divisions};
}

static MesoStatus join_inners(InnerArrays *all, const MesoModel *model, MesoArena *arena,
                              MesoError *error)
{
    uint32_t count = model->tile_set.inner_count;
    *all = (InnerArrays){0};
    for (uint32_t i = 0; i < count; i++) {
        all->vertex_count += model->inner_meshes[i].vertex_count;
        all->triangle_count += model->inner_meshes[i].triangle_count;
    }
    all->counts = MESO_NEW(arena, uint32_t, 2 * (size_t)count, error);
    all->positions = MESO_NEW(arena, MesoVec3, all->vertex_count, error);
    all->normals = MESO_NEW(arena, MesoVec3, all->vertex_count, error);
    all->triangles = MESO_NEW(arena, uint32_t, 3 * all->triangle_count, error);
    if (!all->counts || !all->positions || !all->normals || !all->triangles)
        return MESO_ERR_MEMORY;

    uint64_t vertex = 0, corner = 0;
    for (uint32_t i = 0; i < count; i++) {
        const MesoTriangleMesh *mesh = &model->inner_meshes[i];
        all->counts[2 * i] = mesh->vertex_count;
        all->counts[2 * i + 1] = mesh->triangle_count;
        for (uint32_t v = 0; v < mesh->vertex_count; v++, vertex++) {
            all->positions[vertex] = mesh->positions[v];
            all->normals[vertex] = mesh->normals[v];
        }
        for (uint64_t t = 0; t < 3 * (uint64_t)mesh->triangle_count; t++)
            all->triangles[corner++] = mesh->triangles[t];
    }
    return MESO_OK;
}

static uint16_t minor_of(const MesoModel *model, const char *mapping)
{
    return model->joints ? MINOR_PACKED : mapping || model->factors || model->lifts ? MINOR_MAPPING : MINOR;
}

/* Packed where the model is relaxed. */
static MesoStatus add_numbers(MesoContainer *file, const MesoModel *model, uint32_t which, const void *data,
                              uint64_t size, MesoArena *arena, MesoError *error)
{
    if (model->joints)
        return meso_packed_add(file, arena, PACKED[which].packed, data, size, PACKED[which].packing, error);
    meso_container_add(file, PACKED[which].name, data, size);
    return MESO_OK;
}

/* `mapping` is NULL where no option asks for it. */
static MesoStatus write_chunks(const MesoModel *model, const char *provenance, const char *tiles, const char *mapping,
                               MesoOutput *output, MesoArena *arena, MesoError *error)
{
    InnerArrays inner;
    MesoStatus status = join_inners(&inner, model, arena, error);
    if (status)
        return status;
    const MesoQuadMesh *surface = &model->surface;
    const uint64_t faces = surface->face_count, vector = sizeof(MesoVec3), index = sizeof(uint32_t);
    StoredOptions options = store_options(model);

    MesoContainer file = {.kind = "model", .major = MESO_MODEL_MAJOR, .minor = minor_of(model, mapping)};
    meso_container_add(&file, "prov", provenance, strlen(provenance));
    meso_container_add(&file, "tiles", tiles, strlen(tiles));
    meso_container_add(&file, "options", &options, sizeof options);
    if (mapping)
        meso_container_add(&file, "mapping", mapping, strlen(mapping));
    if (model->factors)
        meso_container_add(&file, "factor", model->factors, surface->vertex_count * sizeof(float));
    if (model->lifts)
        meso_container_add(&file, "lift", model->lifts, surface->vertex_count * sizeof(float));
    if (model->joints)
        status = add_numbers(&file, model, JOINT, model->joints, model->joint_count * sizeof *model->joints, arena,
                             error);
    meso_container_add(&file, "position", surface->positions, surface->vertex_count * vector);
    meso_container_add(&file, "normal", surface->normals, surface->normal_count * vector);
    if (!status)
        status = add_numbers(&file, model, FACE, surface->face_vertices, 4 * faces * index, arena, error);
    if (!status)
        status = add_numbers(&file, model, FACE_NORMAL, surface->face_normals, 4 * faces * index, arena, error);
    if (!status)
        status = add_numbers(&file, model, TILE, model->assignment.tile, faces * index, arena, error);
    meso_container_add(&file, "xform", model->assignment.transform, faces);
    meso_container_add(&file, "inner", inner.counts, 2 * index * model->tile_set.inner_count);
    meso_container_add(&file, "innerpos", inner.positions, inner.vertex_count * vector);
    meso_container_add(&file, "innernrm", inner.normals, inner.vertex_count * vector);
    meso_container_add(&file, "innertri", inner.triangles, 3 * inner.triangle_count * index);
    return status ? status : meso_container_write(&file, output, error);
}

MesoStatus meso_model_write(const MesoModel *model, const MesoProvenance *provenance,
                            MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    const char *text = meso_provenance_text(provenance, &arena, error);
    json_t *root = meso_tiles_to_json(&model->tile_set);
    char *tiles = root ? json_dumps(root, JSON_COMPACT) : NULL;
    json_decref(root);

    char *mapping = NULL;
    MesoStatus status = text ? meso_mapping_text(&mapping, &model->options, error) : MESO_ERR_MEMORY;
    if (!status && !tiles)
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory for the tile set");
    if (!status)
        status = write_chunks(model, text, tiles, mapping, output, &arena, error);
    free(mapping);
    free(tiles);
    meso_arena_release(&arena);
    return status;
}

/* What the reader's steps share. */
typedef struct Reading {
    MesoModel *model;
    const MesoContainer *file;
    MesoArena *arena;
    const char *path;
} Reading;

/* `text` is named after its chunk, which is there. */
static MesoStatus open_text(const Reading *in, const char *name, MesoInput *text, MesoError *error)
{
    uint64_t size;
    const char *shown = meso_arena_print(in->arena, error, "chunk '%s'", name);
    if (!shown)
        return MESO_ERR_MEMORY;
    const void *data = meso_container_find(in->file, name, &size);
    meso_input_wrap(text, shown, data, size);
    return MESO_OK;
}

static MesoStatus read_tiles(const Reading *in, MesoError *error)
{
    MesoInput text;
    if (!meso_container_require(in->file, in->path, "tiles", 0, 0, error))
        return MESO_ERR_INPUT;
    MesoStatus status = open_text(in, "tiles", &text, error);
    if (status)
        return status;
    status = meso_tiles_read(&in->model->tile_set, in->arena, &text, error);
    return status ? meso_fail_prefix(error, in->path) : MESO_OK;
}

/* Zero is a value that stands for a default; a model has none of these left. */
static MesoStatus read_options(const Reading *in, MesoError *error)
{
    const StoredOptions *o = meso_container_require(in->file, in->path, "options", 1, sizeof *o, error);
    if (!o)
        return MESO_ERR_INPUT;
    const MesoMapOptions options = {
        .thickness = o->thickness, .offset = o->offset, .section_scale = o->section_scale,
        .tangent_scale = o->tangent_scale, .section_step = o->section_step, .divisions = o->divisions};
    const char *wrong = meso_map_options_problem(&options);
    if (wrong)
        return meso_fail(error, MESO_ERR_INPUT, "%s: chunk 'options': the %s is out of range",
                         in->path, wrong);
    in->model->options = options;
    return MESO_OK;
}

static MesoStatus read_mapping(const Reading *in, MesoError *error)
{
    MesoInput text;
    uint64_t size;
    if (!meso_container_find(in->file, "mapping", &size))
        return MESO_OK;
    MesoStatus status = open_text(in, "mapping", &text, error);
    if (!status && (status = meso_mapping_read(&in->model->options, &text, in->arena, error)))
        meso_fail_prefix(error, in->path);
    return status;
}

/* Elements of a chunk whose size is free; the chunk must hold whole ones, and at most `most`. */
static const void *take_elements(const Reading *in, const char *name, uint64_t element_size,
                                 uint32_t most, uint32_t *count, MesoError *error)
{
    uint64_t size;
    meso_container_find(in->file, name, &size);
    uint64_t number = size / element_size;
    if (number > most) {
        meso_fail(error, MESO_ERR_INPUT, "%s: chunk '%s' has over %u elements", in->path, name, most);
        return NULL;
    }
    *count = (uint32_t)number;
    return meso_container_require(in->file, in->path, name, number, element_size, error);
}

static MesoStatus read_surface(const Reading *in, MesoError *error)
{
    const uint64_t corners = 4 * sizeof(uint32_t);
    uint32_t vertex_count, normal_count, face_count;
    const MesoVec3 *positions = take_elements(in, "position", sizeof *positions, UINT32_MAX - 1,
                                              &vertex_count, error);
    const MesoVec3 *normals = !positions ? NULL
        : take_elements(in, "normal", sizeof *normals, UINT32_MAX - 1, &normal_count, error);
    const uint32_t *faces = !normals ? NULL
        : take_elements(in, "face", corners, UINT32_MAX / 4, &face_count, error);
    const uint32_t *face_normals = !faces ? NULL
        : meso_container_require(in->file, in->path, "facenorm", face_count, corners, error);
    if (!face_normals)
        return MESO_ERR_INPUT;

    MesoQuadMesh *mesh = &in->model->surface;
    MesoStatus status = meso_quad_mesh_build(mesh, in->arena, vertex_count, positions, normal_count,
                                             normals, face_count, faces, face_normals, error);
    if (status) {
        meso_fail_prefix(error, in->path);
        return status;
    }
    /* A normal of unit length that is made unit length again may change in its
     * last bit; a model must give the same mesh as what it was made from. */
    for (uint32_t i = 0; i < normal_count; i++)
        if (meso_vec3_length(meso_vec3_sub(mesh->normals[i], normals[i])) < 1e-6f)
            mesh->normals[i] = normals[i];
    return MESO_OK;
}

/* A number for each vertex of the surface, or NULL without the chunk. */
static MesoStatus read_numbers(const Reading *in, const char *name, float low, float high, float **numbers,
                               MesoError *error)
{
    uint64_t size;
    uint32_t count = in->model->surface.vertex_count;
    const float *stored = meso_container_find(in->file, name, &size);
    if (!stored)
        return MESO_OK;
    if (!meso_container_require(in->file, in->path, name, count, sizeof *stored, error))
        return MESO_ERR_INPUT;
    *numbers = MESO_NEW(in->arena, float, count, error);
    if (!*numbers)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < count; v++) {
        if (!(stored[v] >= low && stored[v] <= high))
            return meso_fail(error, MESO_ERR_INPUT, "%s: chunk '%s': vertex %u is out of range", in->path, name, v);
        (*numbers)[v] = stored[v];
    }
    return MESO_OK;
}

static MesoStatus read_heights(const Reading *in, MesoError *error)
{
    MesoStatus status = read_numbers(in, "factor", MESO_FACTOR_LEAST, MESO_FACTOR_MOST, &in->model->factors, error);
    return status ? status : read_numbers(in, "lift", -MESO_LIFT_MOST, MESO_LIFT_MOST, &in->model->lifts, error);
}

static MesoStatus read_assignment(const Reading *in, MesoError *error)
{
    MesoModel *model = in->model;
    MesoAssignment *out = &model->assignment;
    uint32_t count = model->surface.face_count;
    const void *tiles = meso_container_require(in->file, in->path, "tile", count,
                                               sizeof *out->tile, error);
    const void *transforms = !tiles ? NULL
        : meso_container_require(in->file, in->path, "xform", count, sizeof *out->transform, error);
    if (!transforms)
        return MESO_ERR_INPUT;
    out->slot_count = count;
    out->tile = MESO_NEW(in->arena, uint32_t, count, error);
    out->transform = out->tile ? MESO_NEW(in->arena, MesoTransform, count, error) : NULL;
    if (!out->transform)
        return MESO_ERR_MEMORY;
    memcpy(out->tile, tiles, count * sizeof *out->tile);
    memcpy(out->transform, transforms, count * sizeof *out->transform);

    MesoStatus status = meso_slot_graph_build(&model->graph, in->arena, &model->surface, error);
    if (!status)
        status = meso_assignment_check(out, &model->tile_set, &model->graph, error);
    if (status)
        meso_fail_prefix(error, in->path);
    return status;
}

/* What joints of a relaxed model are moved by: any numbers will do. */
static MesoStatus read_joints(const Reading *in, MesoError *error)
{
    MesoStrandJoints joints;
    MesoModel *model = in->model;
    if (model->options.relax == 0)
        return MESO_OK;
    MesoStatus status = meso_strand_joints_number(&joints, in->arena, &model->assignment, &model->tile_set,
                                                  &model->graph, error);
    if (status)
        return status;
    const void *moves = meso_container_require(in->file, in->path, "joint", joints.count, sizeof *model->joints, error);
    if (!moves)
        return MESO_ERR_INPUT;
    model->joints = MESO_NEW(in->arena, MesoJointMove, joints.count, error);
    if (!model->joints)
        return MESO_ERR_MEMORY;
    memcpy(model->joints, moves, joints.count * sizeof *model->joints);
    model->joint_count = joints.count;
    return MESO_OK;
}

/* Chunks of the inner meshes, checked against the sums of `counts`. */
static MesoStatus find_inners(const Reading *in, const uint32_t *counts, InnerArrays *all,
                              MesoError *error)
{
    static const char *const names[3] = {"innerpos", "innernrm", "innertri"};
    const void *data[3];
    *all = (InnerArrays){0};
    for (uint32_t i = 0; i < in->model->tile_set.inner_count; i++) {
        all->vertex_count += counts[2 * i];
        all->triangle_count += counts[2 * i + 1];
    }
    for (int i = 0; i < 3; i++) {
        uint64_t count = i < 2 ? all->vertex_count : all->triangle_count;
        data[i] = meso_container_require(in->file, in->path, names[i], count,
                                         i < 2 ? sizeof(MesoVec3) : 3 * sizeof(uint32_t), error);
        if (!data[i])
            return MESO_ERR_INPUT;
    }
    all->positions = MESO_NEW(in->arena, MesoVec3, all->vertex_count, error);
    all->normals = MESO_NEW(in->arena, MesoVec3, all->vertex_count, error);
    all->triangles = MESO_NEW(in->arena, uint32_t, 3 * all->triangle_count, error);
    if (!all->positions || !all->normals || !all->triangles)
        return MESO_ERR_MEMORY;
    memcpy(all->positions, data[0], all->vertex_count * sizeof(MesoVec3));
    memcpy(all->normals, data[1], all->vertex_count * sizeof(MesoVec3));
    memcpy(all->triangles, data[2], 3 * all->triangle_count * sizeof(uint32_t));
    return MESO_OK;
}

static MesoStatus check_inner(const Reading *in, uint32_t inner, const MesoTriangleMesh *mesh,
                              MesoError *error)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 p = mesh->positions[v];
        if (!meso_vec3_finite(p) || !meso_vec3_finite(mesh->normals[v]))
            return meso_fail(error, MESO_ERR_INPUT, "%s: inner mesh %u: vertex %u is not finite",
                             in->path, inner, v);
        if (fmaxf(fmaxf(fabsf(p.x), fabsf(p.y)), fabsf(p.z)) > MESO_COORDINATE_LIMIT)
            return meso_fail(error, MESO_ERR_INPUT,
                             "%s: inner mesh %u: vertex %u lies beyond the largest coordinate, %g",
                             in->path, inner, v, (double)MESO_COORDINATE_LIMIT);
        if (!(fabsf(meso_vec3_length(mesh->normals[v]) - 1) < 1e-3f))
            return meso_fail(error, MESO_ERR_INPUT, "%s: inner mesh %u: normal %u is not of unit length", in->path,
                             inner, v);
    }
    for (uint64_t t = 0; t < 3 * (uint64_t)mesh->triangle_count; t++)
        if (mesh->triangles[t] >= mesh->vertex_count)
            return meso_fail(error, MESO_ERR_INPUT, "%s: inner mesh %u: no vertex %u; it has %u",
                             in->path, inner, mesh->triangles[t], mesh->vertex_count);
    return MESO_OK;
}

static MesoStatus read_inners(const Reading *in, MesoError *error)
{
    uint32_t count = in->model->tile_set.inner_count;
    const uint32_t *counts = meso_container_require(in->file, in->path, "inner", count,
                                                    2 * sizeof *counts, error);
    if (!counts)
        return MESO_ERR_INPUT;
    InnerArrays all;
    MesoStatus status = find_inners(in, counts, &all, error);
    if (status)
        return status;
    MesoTriangleMesh *meshes = MESO_NEW(in->arena, MesoTriangleMesh, count, error);
    if (!meshes)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count && !status; i++) {
        meshes[i] = (MesoTriangleMesh){counts[2 * i], counts[2 * i + 1], all.positions, all.normals,
                                       all.triangles};
        status = check_inner(in, i, &meshes[i], error);
        all.positions += counts[2 * i];
        all.normals += counts[2 * i];
        all.triangles += 3 * (size_t)counts[2 * i + 1];
    }
    in->model->inner_meshes = meshes;
    return status;
}

MesoStatus meso_model_provenance(const char **provenance, MesoArena *arena, const MesoContainer *container,
                                 const char *path, MesoError *error)
{
    uint64_t size;
    if (!meso_container_require(container, path, "prov", 0, 0, error))
        return MESO_ERR_INPUT;
    const void *text = meso_container_find(container, "prov", &size);
    return meso_provenance_copy(provenance, text, size, path, arena, error);
}

MesoStatus meso_model_take(MesoModel *model, MesoArena *arena, const MesoContainer *container, const char *path,
                           MesoError *error)
{
    MesoContainer plain = *container;
    Reading in = {.model = model, .file = &plain, .arena = arena, .path = path};
    *model = (MesoModel){0};
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < PACKED_COUNT && !status; i++)
        status = meso_packed_open(&plain, arena, path, PACKED[i].packed, PACKED[i].name, error);
    if (!status)
        status = read_tiles(&in, error);
    if (!status)
        status = read_options(&in, error);
    if (!status)
        status = read_mapping(&in, error);
    if (!status)
        status = read_surface(&in, error);
    if (!status)
        status = read_heights(&in, error);
    if (!status)
        status = read_assignment(&in, error);
    if (!status)
        status = read_joints(&in, error);
    if (!status)
        status = read_inners(&in, error);
    return status;
}

MesoStatus meso_model_read(MesoModel *model, const char **provenance, MesoArena *arena,
                           const MesoInput *input, MesoError *error)
{
    MesoContainer file;
    const char *text;
    MesoStatus status = meso_container_read(&file, input, "model", MESO_MODEL_MAJOR, error);
    if (!status)
        status = meso_model_provenance(&text, arena, &file, input->path, error);
    if (!status && provenance)
        *provenance = text;
    return status ? status : meso_model_take(model, arena, &file, input->path, error);
}
