#include "cmd/check/check_input.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "formats/mesh/mesh_read.h"
#include "formats/model/model_scene.h"
#include "formats/product/file_kind.h"
#include "libcore/math/vec3d.h"
#include "libcore/scene/parts.h"
#include "libcore/shell/hexahedra.h"

static const char *const THINGS[] = {"strand", "element", "detail"};
enum { THING_COUNT = sizeof THINGS / sizeof *THINGS, MOST_TRIANGLES = 1 << 30 };

/* ---- quads ---- */

static MesoVec3d area_of(const MesoVec3 *positions, uint32_t a, uint32_t b, uint32_t c)
{
    MesoVec3d p = meso_vec3d(positions[a]);
    return meso_vec3d_cross(meso_vec3d_sub(meso_vec3d(positions[b]), p), meso_vec3d_sub(meso_vec3d(positions[c]), p));
}

/* The corner that a quad is cut from: one that is not convex is cut where both halves turn as it does. */
static uint32_t quad_begin(const MesoVec3 *positions, const uint32_t *v)
{
    MesoVec3d a = area_of(positions, v[0], v[1], v[2]), b = area_of(positions, v[0], v[2], v[3]);
    return meso_vec3d_dot(a, b) < 0 ? 1 : 0;
}

/* ---- meshes ---- */

static bool is_of_ids(const MesoAttribute *ids)
{
    bool numbers = ids && ids->width == 1 && ids->scalar != MESO_SCALAR_FLOAT && ids->scalar != MESO_SCALAR_DOUBLE &&
                   !ids->normalized;
    return ids && (ids->width == 0 || numbers);
}

/* Ids of faces under a name, or NULL. */
static const MesoAttribute *find_ids(const MesoPolygonMesh *mesh, const char *name)
{
    const MesoAttribute *ids = meso_polygon_attribute_on(mesh, name, MESO_ON_FACES);
    return is_of_ids(ids) ? ids : NULL;
}

/* Of a face without one it is 0. */
static MesoStatus read_id(const MesoAttribute *ids, uint32_t face, uint32_t *id, MesoError *error)
{
    uint32_t entry = meso_attribute_entry(ids, face);
    double value = entry == MESO_NO_INDEX ? 0 : ids->width ? meso_attribute_number(ids, entry, 0) : (double)entry;
    if (!(value >= 0 && value < UINT32_MAX - 1))
        return meso_fail(error, MESO_ERR_INPUT, "its %s is %.0f; numbers from 0 to 4294967293 are wanted", ids->name,
                         value);
    *id = (uint32_t)value;
    return MESO_OK;
}

static uint32_t fan_begin(const MesoPolygonMesh *mesh, uint32_t begin, uint32_t sides)
{
    return sides == 4 ? quad_begin(mesh->positions, &mesh->corners[begin]) : 0;
}

typedef struct Cutting {
    MesoCheckInput *input;
    const MesoPolygonMesh *mesh;
    const MesoAttribute *normals, *slots, *things;
    uint32_t *corners, *normal_of, *slot_of, *thing_of;
    uint32_t count;
} Cutting;

static void put_corner(Cutting *cutting, size_t at, uint32_t corner)
{
    const MesoAttribute *normals = cutting->normals;
    cutting->corners[at] = cutting->mesh->corners[corner];
    if (normals)
        cutting->normal_of[at] = meso_attribute_entry(normals, normals->domain == MESO_ON_CORNERS
                                                                   ? corner : cutting->mesh->corners[corner]);
}

static MesoStatus cut_face(Cutting *cutting, uint32_t face, MesoError *error)
{
    uint32_t begin = meso_polygon_begin(cutting->mesh, face), sides = meso_polygon_sides(cutting->mesh, face);
    uint32_t first = fan_begin(cutting->mesh, begin, sides), slot = 0, thing = 0;
    MesoStatus status = cutting->slots ? read_id(cutting->slots, face, &slot, error) : MESO_OK;
    if (!status && cutting->things)
        status = read_id(cutting->things, face, &thing, error);
    for (uint32_t i = 1; i + 1 < sides && !status; i++, cutting->count++) {
        size_t at = 3 * (size_t)cutting->count;
        put_corner(cutting, at, begin + first);
        put_corner(cutting, at + 1, begin + (first + i) % sides);
        put_corner(cutting, at + 2, begin + (first + i + 1) % sides);
        cutting->input->faces[cutting->count] = face;
        if (cutting->slots)
            cutting->slot_of[cutting->count] = slot;
        if (cutting->things)
            cutting->thing_of[cutting->count] = thing;
    }
    return status;
}

static MesoStatus take_normals(Cutting *cutting, MesoArena *arena, MesoError *error)
{
    MesoInspectedMesh *mesh = &cutting->input->mesh;
    if (!cutting->normals)
        return MESO_OK;
    MesoVec3 *normals = MESO_NEW(arena, MesoVec3, cutting->normals->entry_count, error);
    for (uint32_t i = 0; normals && i < cutting->normals->entry_count; i++)
        normals[i] = meso_attribute_vec3(cutting->normals, i);
    mesh->normals = normals;
    mesh->normal_of = cutting->normal_of;
    mesh->normal_count = cutting->normals->entry_count;
    return normals ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus allocate(Cutting *cutting, MesoArena *arena, uint64_t count, MesoError *error)
{
    if (count > MOST_TRIANGLES)
        return meso_fail(error, MESO_ERR_LIMIT, "%" PRIu64 " triangles; at most %d are checked at a time", count,
                         MOST_TRIANGLES);
    cutting->corners = MESO_NEW(arena, uint32_t, 3 * count, error);
    cutting->normal_of = cutting->normals ? MESO_NEW(arena, uint32_t, 3 * count, error) : cutting->corners;
    cutting->slot_of = cutting->slots ? MESO_NEW(arena, uint32_t, count, error) : cutting->corners;
    cutting->thing_of = cutting->things ? MESO_NEW(arena, uint32_t, count, error) : cutting->corners;
    cutting->input->faces = MESO_NEW(arena, uint32_t, count, error);
    return cutting->corners && cutting->normal_of && cutting->slot_of && cutting->thing_of && cutting->input->faces
         ? MESO_OK : MESO_ERR_MEMORY;
}

static void name_things(MesoCheckInput *input, const MesoAttribute *things, const char *name)
{
    if (!things)
        return;
    input->thing = name;
    if (things->width == 0) {
        input->thing_names = things->names;
        input->thing_name_count = things->entry_count;
    }
}

static MesoStatus cut_mesh(MesoCheckInput *input, MesoArena *arena, const MesoPolygonMesh *mesh, const MesoInput *file,
                           MesoError *error)
{
    Cutting cutting = {.input = input, .mesh = mesh, .normals = meso_polygon_normals(mesh),
                       .slots = find_ids(mesh, "slot")};
    for (int i = 0; i < THING_COUNT && !cutting.things; i++) {
        cutting.things = find_ids(mesh, THINGS[i]);
        name_things(input, cutting.things, THINGS[i]);
    }
    uint64_t count = (uint64_t)mesh->corner_count - 2 * (uint64_t)mesh->face_count;
    MesoStatus status = allocate(&cutting, arena, count, error);
    for (uint32_t f = 0; f < mesh->face_count && !status; f++) {
        status = cut_face(&cutting, f, error);
        if (status)
            return meso_mesh_fail_at_face(file, f, error);
    }
    input->face_count = mesh->face_count;
    input->mesh.vertex_count = mesh->vertex_count;
    input->mesh.positions = mesh->positions;
    input->mesh.triangle_count = cutting.count;
    input->mesh.corners = cutting.corners;
    input->mesh.slots = cutting.slots ? cutting.slot_of : NULL;
    input->mesh.things = cutting.things ? cutting.thing_of : NULL;
    return status ? status : take_normals(&cutting, arena, error);
}

static MesoStatus read_mesh(MesoCheckInput *input, MesoTool *tool, const MesoInput *file)
{
    MesoPolygonMesh mesh;
    MesoStatus status = meso_polygon_mesh_read_loops(&mesh, &input->looped, &tool->arena, file, tool->threads,
                                                     &tool->error);
    return status ? status : cut_mesh(input, &tool->arena, &mesh, file, &tool->error);
}

/* ---- models ---- */

typedef struct Filling {
    const MesoSceneParts *parts;
    MesoVec3 *positions, *normals;
    uint32_t *corners, *slots, *things;
    uint32_t slot_channel, thing_channel;       /* MESO_NO_INDEX: none */
    uint32_t count;                             /* triangles */
    MesoMeshVertex *vertices;                   /* scratch of one part */
    MesoMeshFace *faces;
} Filling;

static void put_triangle(Filling *filling, uint32_t part, uint32_t a, uint32_t b, uint32_t c)
{
    const MesoScene *scene = filling->parts->scene;
    uint32_t *to = &filling->corners[3 * (size_t)filling->count], row = meso_scene_part(filling->parts, part).ids;
    to[0] = a;
    to[1] = b;
    to[2] = c;
    if (filling->slots)
        filling->slots[filling->count] = meso_scene_id(scene, row, filling->slot_channel);
    if (filling->things)
        filling->things[filling->count] = meso_scene_id(scene, row, filling->thing_channel);
    filling->count++;
}

static void fill_part(Filling *filling, uint32_t part)
{
    const MesoSceneParts *parts = filling->parts;
    uint64_t base = parts->vertex_begin[part], vertices = parts->vertex_begin[part + 1] - base;
    uint64_t faces = parts->face_begin[part + 1] - parts->face_begin[part];
    meso_scene_vertices(parts, part, part + 1, filling->vertices);
    meso_scene_faces(parts, part, part + 1, (uint32_t)base, filling->faces);
    for (uint64_t v = 0; v < vertices; v++) {
        filling->positions[base + v] = filling->vertices[v].position;
        filling->normals[base + v] = filling->vertices[v].normal;
    }
    for (uint64_t f = 0; f < faces; f++) {
        const uint32_t *v = filling->faces[f].v;
        uint32_t first = v[3] == MESO_NO_INDEX ? 0 : quad_begin(filling->positions, v);
        put_triangle(filling, part, v[first], v[first + 1], v[first + 2]);
        if (v[3] != MESO_NO_INDEX)
            put_triangle(filling, part, v[first], v[first + 2], v[(first + 3) % 4]);
    }
}

static uint32_t find_channel(const MesoScene *scene, const char *name)
{
    for (uint32_t c = 0; c < scene->channel_count; c++)
        if (strcmp(scene->channels[c].name, name) == 0)
            return c;
    return MESO_NO_INDEX;
}

static void find_channels(MesoCheckInput *input, Filling *filling, const MesoScene *scene)
{
    filling->slot_channel = find_channel(scene, "slot");
    filling->thing_channel = MESO_NO_INDEX;
    for (int i = 0; i < THING_COUNT && filling->thing_channel == MESO_NO_INDEX; i++) {
        filling->thing_channel = find_channel(scene, THINGS[i]);
        if (filling->thing_channel == MESO_NO_INDEX)
            continue;
        input->thing = THINGS[i];
        input->thing_names = scene->channels[filling->thing_channel].names;
        input->thing_name_count = scene->channels[filling->thing_channel].count;
    }
}

static MesoStatus make_room(Filling *filling, MesoArena *arena, MesoError *error)
{
    const MesoSceneParts *parts = filling->parts;
    uint64_t vertex_count = parts->vertex_begin[parts->part_count], vertices = 0, faces = 0;
    if (parts->triangle_count > MOST_TRIANGLES || vertex_count >= UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "%" PRIu64 " triangles; at most %d are checked at a time",
                         parts->triangle_count, MOST_TRIANGLES);
    for (uint32_t p = 0; p < parts->part_count; p++) {
        uint64_t v = parts->vertex_begin[p + 1] - parts->vertex_begin[p];
        uint64_t f = parts->face_begin[p + 1] - parts->face_begin[p];
        vertices = v > vertices ? v : vertices;
        faces = f > faces ? f : faces;
    }
    bool slots = filling->slot_channel != MESO_NO_INDEX, things = filling->thing_channel != MESO_NO_INDEX;
    filling->positions = MESO_NEW(arena, MesoVec3, vertex_count, error);
    filling->normals = MESO_NEW(arena, MesoVec3, vertex_count, error);
    filling->corners = MESO_NEW(arena, uint32_t, 3 * parts->triangle_count, error);
    filling->slots = slots ? MESO_NEW(arena, uint32_t, parts->triangle_count, error) : NULL;
    filling->things = things ? MESO_NEW(arena, uint32_t, parts->triangle_count, error) : NULL;
    filling->vertices = MESO_NEW(arena, MesoMeshVertex, vertices, error);
    filling->faces = MESO_NEW(arena, MesoMeshFace, faces, error);
    return filling->positions && filling->normals && filling->corners && (!slots || filling->slots) &&
           (!things || filling->things) && filling->vertices && filling->faces ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus fill_scene(MesoCheckInput *input, MesoArena *arena, const MesoScene *scene, MesoError *error)
{
    MesoSceneParts parts;
    Filling filling = {.parts = &parts};
    MesoStatus status = meso_scene_parts_init(&parts, arena, scene, error);
    find_channels(input, &filling, scene);
    if (!status)
        status = make_room(&filling, arena, error);
    for (uint32_t p = 0; !status && p < parts.part_count; p++)
        fill_part(&filling, p);
    input->face_count = status ? 0 : parts.face_begin[parts.part_count];
    input->mesh.vertex_count = input->mesh.normal_count = status ? 0 : (uint32_t)parts.vertex_begin[parts.part_count];
    input->mesh.positions = filling.positions;
    input->mesh.normals = filling.normals;
    input->mesh.triangle_count = filling.count;
    input->mesh.corners = filling.corners;
    input->mesh.slots = filling.slots;
    input->mesh.things = filling.things;
    return status;
}

/* Where the model says that its shell is; whether that is folded is not its word. */
static MesoStatus make_cages(MesoCheckInput *input, MesoArena *arena, const MesoModel *model, MesoError *error)
{
    MesoShell shell;
    uint32_t count = model->surface.face_count;
    MesoVec3 *cages = MESO_NEW(arena, MesoVec3, 8 * (size_t)count, error);
    uint32_t *across = MESO_NEW(arena, uint32_t, 4 * (size_t)count, error);
    MesoStatus status = cages && across ? meso_model_shell(&shell, arena, model, error) : MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < count && !status; f++) {
        MesoCage cage = meso_shell_cage(&shell, f);
        for (uint32_t k = 0; k < 8; k++)
            cages[8 * (size_t)f + k] = meso_cage_corner(&cage, k);
    }
    for (uint32_t h = 0; h < 4 * count && !status; h++)
        across[h] = model->graph.twin[h] == MESO_NO_INDEX ? MESO_NO_INDEX : model->graph.twin[h] / 4;
    input->mesh.cages = cages;
    input->mesh.across = across;
    input->mesh.cage_count = status ? 0 : count;
    input->edge = model->surface.mean_edge_length;
    return status;
}

static MesoStatus read_model(MesoCheckInput *input, MesoTool *tool, const MesoInput *file)
{
    MesoScene scene;
    MesoSceneReading reading = {.thread_count = tool->threads};
    MesoStatus status = meso_scene_read(&scene, &tool->arena, file, &reading, &tool->error);
    if (!status)
        status = fill_scene(input, &tool->arena, &scene, &tool->error);
    if (!status && reading.tiling)
        status = make_cages(input, &tool->arena, reading.tiling, &tool->error);
    return status;
}

/* ---- either ---- */

/* What begins in no known way is what its name says: a mesh, or a model that is broken. */
bool meso_check_is_mesh(const MesoInput *file)
{
    static const char *const extensions[] = {".obj", ".ply", ".off", ".glb", ".gltf", ".drc"};
    MesoFileKind kind = meso_file_kind(file);
    const char *dot = strrchr(file->path, '.');
    bool named = false;
    for (size_t i = 0; dot && i < sizeof extensions / sizeof *extensions; i++)
        named = named || strcasecmp(dot, extensions[i]) == 0;
    return kind == MESO_FILE_UNKNOWN ? named : !(kind & (MESO_FILE_MODEL | MESO_FILE_QUILT));
}

MesoStatus meso_check_read(MesoCheckInput *input, MesoTool *tool, const MesoInput *file)
{
    *input = (MesoCheckInput){.thing = "piece"};
    return meso_check_is_mesh(file) ? read_mesh(input, tool, file) : read_model(input, tool, file);
}

const char *meso_check_thing_name(const MesoCheckInput *input, uint32_t id, char room[24])
{
    if (input->thing_names && id < input->thing_name_count)
        return input->thing_names[id];
    snprintf(room, 24, "%u", id);
    return room;
}
