#include "cmd/replicate/replicate_kinds.h"

#include <string.h>

#include "formats/mesh/mesh_read.h"
#include "formats/model/scene_of_mesh.h"
#include "libcore/base/grow.h"

typedef struct Maker {
    MesoReplicateKinds *kinds;
    MesoReplicateFiles *files;
    MesoTool *tool;
    uint32_t body_room, material_room;
} Maker;

/* ---- materials ---- */

/* Materials of one name and look are one. */
static MesoStatus add_material(Maker *m, const MesoMaterial *look, const char *name, uint32_t *number)
{
    MesoReplicateKinds *k = m->kinds;
    MesoError *error = &m->tool->error;
    for (*number = 0; *number < k->material_count; ++*number)
        if (strcmp(k->material_names[*number], name) == 0 && memcmp(&k->materials[*number], look, sizeof *look) == 0)
            return MESO_OK;
    uint32_t room = m->material_room;
    k->materials = MESO_GROW(&m->tool->arena, k->materials, k->material_count, room, 16, error);
    room = m->material_room;
    k->material_names = MESO_GROW(&m->tool->arena, k->material_names, k->material_count, room, 16, error);
    m->material_room = room;
    if (!k->materials || !k->material_names)
        return MESO_ERR_MEMORY;
    k->materials[k->material_count] = *look;
    k->material_names[k->material_count++] = name;
    return MESO_OK;
}

/* ---- meshes ---- */

/* The point on the surface is the mesh's origin. */
static MesoStatus scale_to(Maker *m, const MesoDetailKind *kind, MesoBody *body, float scale)
{
    MesoVec3 *positions = MESO_NEW(&m->tool->arena, MesoVec3, body->vertex_count, &m->tool->error);
    if (!positions)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < body->vertex_count; v++) {
        positions[v] = meso_vec3_scale(body->positions[v], scale);
        positions[v].z += kind->lift;
    }
    body->positions = positions;
    return MESO_OK;
}

static MesoStatus find_scale(const Maker *m, const MesoDetailKind *kind, const MesoScene *scene, float *scale)
{
    float low = INFINITY, high = -INFINITY;
    for (uint32_t b = 0; b < scene->body_count; b++)
        for (uint32_t v = 0; v < scene->bodies[b].vertex_count; v++) {
            low = fminf(low, scene->bodies[b].positions[v].x);
            high = fmaxf(high, scene->bodies[b].positions[v].x);
        }
    *scale = 1 / (kind->length > 0 ? kind->length : high - low);
    if (isfinite(*scale))
        return MESO_OK;
    return meso_fail(&m->tool->error, MESO_ERR_INPUT, "%s: kind '%s': '%s' has no length along x; \"length\" says what "
                     "becomes the size", m->tool->operands[0], kind->name, kind->file);
}

static MesoStatus add_bodies(Maker *m, const MesoDetailsFile *details, const MesoDetailKind *kind, MesoScene *scene)
{
    MesoReplicateKinds *k = m->kinds;
    float scale = 1;
    uint32_t count = k->body_begin[kind - k->kinds];
    MesoStatus status = find_scale(m, kind, scene, &scale);
    for (uint32_t p = 0; p < scene->placed_count && !status; p++) {
        const MesoPlacedBody *placed = &scene->placed[p];
        uint32_t own = placed->material, room = m->body_room;
        k->bodies = MESO_GROW(&m->tool->arena, k->bodies, count, room, 16, &m->tool->error);
        room = m->body_room;
        k->body_materials = MESO_GROW(&m->tool->arena, k->body_materials, count, room, 16, &m->tool->error);
        m->body_room = room;
        if (!k->bodies || !k->body_materials)
            return MESO_ERR_MEMORY;
        k->bodies[count] = scene->bodies[placed->body];
        status = kind->own_material
            ? add_material(m, &details->materials[kind->material], details->material_names[kind->material],
                           &k->body_materials[count])
            : add_material(m, &scene->materials[own], scene->material_names[own], &k->body_materials[count]);
        if (!status)
            status = scale_to(m, kind, &k->bodies[count], scale);
        count++;
    }
    k->body_begin[kind - k->kinds + 1] = count;
    return status;
}

static MesoStatus read_mesh(Maker *m, const MesoDetailsFile *details, const MesoDetailKind *kind)
{
    MesoTool *tool = m->tool;
    MesoPolygonMesh mesh;
    MesoScene scene;
    const MesoInput *input = meso_replicate_file(m->files, kind->file, "shape");
    MesoStatus status = input ? meso_polygon_mesh_read(&mesh, &tool->arena, input, tool->threads, &tool->error)
                              : tool->error.status;
    if (!status && meso_scene_of_mesh(&scene, &tool->arena, &mesh, &tool->error))
        status = meso_fail_prefix(&tool->error, input->path);
    return status ? status : add_bodies(m, details, kind, &scene);
}

/* ---- instances ---- */

static uint32_t add_triangles(const MesoBody *body, uint32_t first, uint32_t *corners)
{
    uint32_t count = 0;
    for (uint32_t f = 0; f < body->face_count; f++) {
        const uint32_t *v = body->corners + (size_t)body->face_width * f;
        uint32_t triangles = body->face_width == 4 && v[3] != MESO_NO_INDEX ? 2 : 1;
        for (uint32_t t = 0; t < triangles; t++, count++) {
            corners[3 * count] = first + v[0];
            corners[3 * count + 1] = first + v[t + 1];
            corners[3 * count + 2] = first + v[t + 2];
        }
    }
    return count;
}

/* Instances have one material: the first one. */
static MesoStatus merge(Maker *m, uint32_t kind)
{
    MesoReplicateKinds *k = m->kinds;
    MesoInstanceShape *shape = &k->shapes[kind];
    size_t vertices = 0, faces = 0;
    uint32_t begin = k->body_begin[kind], end = k->body_begin[kind + 1];
    *shape = (MesoInstanceShape){.name = k->names[kind], .material = k->materials};
    for (uint32_t b = begin; b < end; b++) {
        vertices += k->bodies[b].vertex_count;
        faces += k->bodies[b].face_count;
    }
    if (begin == end)
        return MESO_OK;
    MesoVec3 *positions = MESO_NEW(&m->tool->arena, MesoVec3, vertices, &m->tool->error);
    MesoVec3 *normals = MESO_NEW(&m->tool->arena, MesoVec3, vertices, &m->tool->error);
    uint32_t *corners = MESO_NEW(&m->tool->arena, uint32_t, 6 * faces, &m->tool->error);
    if (!positions || !normals || !corners)
        return MESO_ERR_MEMORY;
    for (uint32_t b = begin; b < end; b++) {
        const MesoBody *body = &k->bodies[b];
        memcpy(positions + shape->vertex_count, body->positions, body->vertex_count * sizeof *positions);
        memcpy(normals + shape->vertex_count, body->normals, body->vertex_count * sizeof *normals);
        shape->triangle_count += add_triangles(body, shape->vertex_count, corners + 3 * shape->triangle_count);
        shape->vertex_count += body->vertex_count;
    }
    shape->positions = positions;
    shape->normals = normals;
    shape->corners = corners;
    shape->material = &k->materials[k->body_materials[begin]];
    return MESO_OK;
}

MesoStatus meso_replicate_kinds(MesoReplicateKinds *kinds, MesoReplicateFiles *files, const MesoDetailsFile *details)
{
    MesoTool *tool = files->tool;
    Maker m = {.kinds = kinds, .files = files, .tool = tool};
    uint32_t count = details->kind_count, unused;
    *kinds = (MesoReplicateKinds){
        .kind_count = count, .kinds = details->kinds,
        .names = MESO_NEW(&tool->arena, const char *, count, &tool->error),
        .body_begin = MESO_NEW(&tool->arena, uint32_t, (size_t)count + 1, &tool->error),
        .shapes = MESO_NEW(&tool->arena, MesoInstanceShape, count, &tool->error)};
    if (!kinds->names || !kinds->body_begin || !kinds->shapes)
        return MESO_ERR_MEMORY;
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++) {
        const MesoDetailKind *kind = &details->kinds[i];
        kinds->names[i] = kind->name;
        kinds->body_begin[i + 1] = kinds->body_begin[i];
        if (kind->geometry == MESO_DETAIL_MESH)
            status = read_mesh(&m, details, kind);
        else
            kinds->carved = true;
    }
    if (!status && kinds->material_count == 0)
        status = add_material(&m, &details->materials[0], details->material_names[0], &unused);
    for (uint32_t i = 0; i < count && !status; i++)
        status = merge(&m, i);
    return status;
}
