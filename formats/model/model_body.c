#include "formats/model/model_body.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_field.h"
#include "formats/json/json_text.h"
#include "formats/model/model_file.h"
#include "formats/scene/material_json.h"
#include "libcore/base/index.h"
#include "libcore/mesh/quad_mesh.h"
#include "libcore/scene/parts.h"

enum { MINOR = 1 };

/* How a body lies in the file. */
typedef struct StoredBody {
    uint32_t vertex_count, face_count, material, ids;
} StoredBody;

_Static_assert(sizeof(MesoMeshColor) == 3 && sizeof(MesoMeshFace) == 16, "layout of the chunks");

/* All bodies, one after the other. */
typedef struct Arrays {
    StoredBody *bodies;
    MesoVec3 *positions, *normals;
    MesoVec2 *uvs;
    MesoMeshColor *colors;
    MesoMeshFace *faces;
    uint64_t vertex_count, face_count;
} Arrays;

/* ---- writing ---- */

static bool has_uvs(const MesoScene *scene)
{
    for (uint32_t i = 0; i < scene->body_count; i++)
        if (scene->bodies[i].uvs)
            return true;
    return false;
}

static MesoStatus join_bodies(Arrays *all, const MesoSceneParts *parts, MesoArena *arena, MesoError *error)
{
    const MesoScene *scene = parts->scene;
    bool colored = meso_scene_is_colored(scene), mapped = has_uvs(scene);
    uint64_t count = parts->vertex_begin[parts->part_count];
    *all = (Arrays){.vertex_count = count, .face_count = parts->face_begin[parts->part_count]};
    MesoMeshVertex *vertices = MESO_NEW(arena, MesoMeshVertex, count, error);
    all->bodies = MESO_NEW(arena, StoredBody, parts->part_count, error);
    all->positions = MESO_NEW(arena, MesoVec3, count, error);
    all->normals = MESO_NEW(arena, MesoVec3, count, error);
    all->uvs = mapped ? MESO_NEW(arena, MesoVec2, count, error) : NULL;
    all->colors = colored ? MESO_NEW(arena, MesoMeshColor, count, error) : NULL;
    all->faces = MESO_NEW(arena, MesoMeshFace, all->face_count, error);
    if (!vertices || !all->bodies || !all->positions || !all->normals || !all->faces || (mapped && !all->uvs) ||
        (colored && !all->colors))
        return MESO_ERR_MEMORY;

    meso_scene_vertices(parts, 0, parts->part_count, vertices);
    if (colored)
        meso_scene_colors(parts, 0, parts->part_count, all->colors);
    for (uint64_t v = 0; v < count; v++) {
        all->positions[v] = vertices[v].position;
        all->normals[v] = vertices[v].normal;
        if (mapped)
            all->uvs[v] = vertices[v].uv;
    }
    for (uint32_t p = 0; p < parts->part_count; p++) {
        MesoPart part = meso_scene_part(parts, p);
        all->bodies[p] = (StoredBody){(uint32_t)(parts->vertex_begin[p + 1] - parts->vertex_begin[p]),
                                      (uint32_t)(parts->face_begin[p + 1] - parts->face_begin[p]), part.material,
                                      part.ids};
        meso_scene_faces(parts, p, p + 1, 0, all->faces + parts->face_begin[p]);
    }
    return MESO_OK;
}

/* 0, or -1 where memory is out, as Jansson has it. */
static int put_channel(json_t *channels, const MesoIdChannel *channel)
{
    json_t *object = json_object();
    int failed = json_object_set_new(object, "name", json_string(channel->name));
    failed |= json_object_set_new(object, "count", json_integer(channel->count));
    json_t *names = channel->names ? json_array() : NULL;
    for (uint32_t i = 0; names && i < channel->count; i++)
        failed |= json_array_append_new(names, meso_json_string(channel->names[i]));
    if (channel->names)
        failed |= json_object_set_new(object, "names", names);
    return failed | json_array_append_new(channels, object);
}

/* To be freed; NULL where memory is out. */
static char *describe(const MesoScene *scene)
{
    json_t *root = json_object(), *channels = json_array();
    int failed = 0;
    for (uint32_t c = 0; c < scene->channel_count; c++)
        failed |= put_channel(channels, &scene->channels[c]);
    failed |= json_object_set_new(root, "channels", channels);
    failed |= json_object_set_new(root, "materials", meso_materials_to_json(scene->material_count, scene->materials,
                                                                            scene->material_names));
    char *text = failed ? NULL : json_dumps(root, JSON_COMPACT);
    json_decref(root);
    return text;
}

static MesoStatus write_chunks(const MesoScene *scene, const Arrays *all, uint32_t body_count, const char *provenance,
                               const char *description, MesoOutput *output, MesoError *error)
{
    const uint64_t vertices = all->vertex_count;
    MesoContainer file = {.kind = "model", .major = MESO_MODEL_MAJOR, .minor = MINOR};
    meso_container_add(&file, "prov", provenance, strlen(provenance));
    meso_container_add(&file, "body", all->bodies, body_count * sizeof *all->bodies);
    meso_container_add(&file, "bodydesc", description, strlen(description));
    meso_container_add(&file, "bodyids", scene->ids,
                       (uint64_t)scene->id_row_count * scene->channel_count * sizeof *scene->ids);
    meso_container_add(&file, "bodypos", all->positions, vertices * sizeof *all->positions);
    meso_container_add(&file, "bodynrm", all->normals, vertices * sizeof *all->normals);
    meso_container_add(&file, "bodyuv", all->uvs, all->uvs ? vertices * sizeof *all->uvs : 0);
    meso_container_add(&file, "bodycol", all->colors, all->colors ? vertices * sizeof *all->colors : 0);
    meso_container_add(&file, "bodyface", all->faces, all->face_count * sizeof *all->faces);
    return meso_container_write(&file, output, error);
}

MesoStatus meso_body_write(const MesoScene *scene, const MesoProvenance *provenance, MesoOutput *output,
                           MesoError *error)
{
    assert(scene->sweep_count == 0);
    MesoArena arena;
    MesoSceneParts parts;
    Arrays all;
    char *description = NULL;
    meso_arena_init(&arena);
    const char *text = meso_provenance_text(provenance, &arena, error);
    MesoStatus status = text ? meso_scene_parts_init(&parts, &arena, scene, error) : MESO_ERR_MEMORY;
    if (!status)
        status = join_bodies(&all, &parts, &arena, error);
    if (!status && !(description = describe(scene)))
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory for the materials");
    if (!status)
        status = write_chunks(scene, &all, parts.part_count, text, description, output, error);
    free(description);
    meso_arena_release(&arena);
    return status;
}

/* ---- reading ---- */

/* What the reader's steps share. */
typedef struct Reading {
    MesoScene *scene;
    const MesoContainer *file;
    MesoArena *arena;
    const char *path;
} Reading;

static void read_channel(MesoScene *scene, const MesoJsonField *field, MesoArena *arena)
{
    static const char *const keys[] = {"name", "count", "names", NULL};
    MesoIdChannel *channel = &scene->channels[scene->channel_count++];
    meso_json_object(field, keys);
    MesoJsonField name = meso_json_key(field, "name"), count = meso_json_key(field, "count");
    MesoJsonField names = meso_json_key(field, "names");
    channel->name = meso_json_text(&name);
    channel->count = (uint32_t)meso_json_whole(&count, 0, UINT32_MAX - 1, 0);
    size_t length = strspn(channel->name, "abcdefghijklmnopqrstuvwxyz0123456789_");
    if (meso_json_good(field) && (length == 0 || length >= MESO_CHANNEL_NAME || channel->name[length]))
        meso_json_wrong(&name, "not 1 to %d lower-case letters, digits and '_'", MESO_CHANNEL_NAME - 1);
    if (!names.value)
        return;
    uint32_t name_count = meso_json_count(&names, 0, UINT16_MAX);
    if (meso_json_good(field) && name_count != channel->count)
        meso_json_wrong(&names, "%u names for %u ids", name_count, channel->count);
    if (!meso_json_good(field))
        return;
    channel->names = MESO_NEW(arena, const char *, name_count, field->reader->error);
    if (!channel->names)
        field->reader->status = MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < name_count && meso_json_good(field); i++) {
        MesoJsonField item = meso_json_item(&names, i);
        channel->names[i] = meso_json_text(&item);
    }
}

static MesoStatus read_fields(const Reading *in, MesoJsonReader *reader, const json_t *root)
{
    static const char *const keys[] = {"channels", "materials", NULL};
    MesoScene *scene = in->scene;
    MesoJsonField top = meso_json_root(reader, root);
    meso_json_object(&top, keys);
    MesoJsonField channels = meso_json_key(&top, "channels"), materials = meso_json_key(&top, "materials");
    uint32_t channel_count = meso_json_count(&channels, 0, MESO_ID_CHANNELS);
    for (uint32_t c = 0; c < channel_count && meso_json_good(&top); c++) {
        MesoJsonField item = meso_json_item(&channels, c);
        read_channel(scene, &item, in->arena);
    }
    meso_materials_of_json(&materials, &scene->material_count, &scene->materials, &scene->material_names);
    return reader->status;
}

static MesoStatus read_description(const Reading *in, MesoError *error)
{
    MesoInput text;
    json_t *root = NULL;
    uint64_t size;
    if (!meso_container_require(in->file, in->path, "bodydesc", 0, 0, error))
        return MESO_ERR_INPUT;
    const void *data = meso_container_find(in->file, "bodydesc", &size);
    meso_input_wrap(&text, "chunk 'bodydesc'", data, size);
    MesoStatus status = meso_json_parse(&root, &text, error);
    if (!status) {
        MesoJsonReader reader = {.path = text.path, .arena = in->arena, .error = error};
        status = read_fields(in, &reader, root);
    }
    json_decref(root);
    if (status)
        meso_fail_prefix(error, in->path);
    return status;
}

static MesoStatus read_ids(const Reading *in, MesoError *error)
{
    MesoScene *scene = in->scene;
    uint64_t size, row_bytes = sizeof *scene->ids * scene->channel_count;
    meso_container_find(in->file, "bodyids", &size);
    uint64_t rows = row_bytes ? size / row_bytes : 0;
    if (rows >= UINT32_MAX)
        return meso_fail(error, MESO_ERR_INPUT, "%s: chunk 'bodyids' has over 2^32 rows", in->path);
    const uint32_t *ids = meso_container_require(in->file, in->path, "bodyids", rows * scene->channel_count,
                                                 sizeof *ids, error);
    scene->ids = ids ? MESO_NEW(in->arena, uint32_t, rows * scene->channel_count, error) : NULL;
    if (!scene->ids)
        return ids ? MESO_ERR_MEMORY : MESO_ERR_INPUT;
    scene->id_row_count = (uint32_t)rows;
    for (uint64_t i = 0; i < rows * scene->channel_count; i++) {
        const MesoIdChannel *channel = &scene->channels[i % scene->channel_count];
        if (ids[i] >= channel->count)
            return meso_fail(error, MESO_ERR_INPUT, "%s: no %s %u; there are %u", in->path, channel->name, ids[i],
                             channel->count);
        scene->ids[i] = ids[i];
    }
    return MESO_OK;
}

/* A chunk of `count` elements of `size` bytes that may be empty instead: then NULL without an error. */
static MesoStatus find_optional(const Reading *in, const char *name, uint64_t count, uint64_t size, const void **data,
                                MesoError *error)
{
    uint64_t bytes = 0;
    bool empty = meso_container_find(in->file, name, &bytes) && bytes == 0;
    *data = empty ? NULL : meso_container_require(in->file, in->path, name, count, size, error);
    return empty || *data ? MESO_OK : MESO_ERR_INPUT;
}

/* The chunks, checked against the sums over `stored`. */
static MesoStatus find_arrays(const Reading *in, const StoredBody *stored, uint32_t count, MesoBody *all,
                              MesoError *error)
{
    uint64_t vertices = 0, faces = 0;
    const void *uvs, *colors;
    for (uint32_t i = 0; i < count; i++) {
        vertices += stored[i].vertex_count;
        faces += stored[i].face_count;
    }
    all->positions = meso_container_require(in->file, in->path, "bodypos", vertices, sizeof(MesoVec3), error);
    all->normals = !all->positions ? NULL
        : meso_container_require(in->file, in->path, "bodynrm", vertices, sizeof(MesoVec3), error);
    all->corners = !all->normals ? NULL
        : meso_container_require(in->file, in->path, "bodyface", faces, sizeof(MesoMeshFace), error);
    if (!all->corners)
        return MESO_ERR_INPUT;
    MesoStatus status = find_optional(in, "bodyuv", vertices, sizeof(MesoVec2), &uvs, error);
    if (!status)
        status = find_optional(in, "bodycol", vertices, sizeof(MesoMeshColor), &colors, error);
    if (status)
        return status;
    all->uvs = uvs;
    all->colors = colors;
    return MESO_OK;
}

/* False for what is not a number, too. */
static bool is_near(MesoVec3 p)
{
    return fmaxf(fabsf(p.x), fmaxf(fabsf(p.y), fabsf(p.z))) <= MESO_COORDINATE_LIMIT && meso_vec3_finite(p);
}

static MesoStatus check_body(const Reading *in, uint32_t number, const StoredBody *stored, const MesoBody *body,
                             MesoError *error)
{
    const MesoScene *scene = in->scene;
    uint32_t least_rows = scene->channel_count ? scene->id_row_count : UINT32_MAX;
    if (stored->material >= scene->material_count || stored->ids >= least_rows)
        return meso_fail(error, MESO_ERR_INPUT, "%s: body %u: no material %u or row of ids %u", in->path, number,
                         stored->material, stored->ids);
    for (uint32_t v = 0; v < body->vertex_count; v++)
        if (!is_near(body->positions[v]) || !is_near(body->normals[v]) ||
            (body->uvs && !(isfinite(body->uvs[v].x) && isfinite(body->uvs[v].y))))
            return meso_fail(error, MESO_ERR_INPUT, "%s: body %u: vertex %u is not finite, or too far away", in->path,
                             number, v);
    for (uint64_t c = 0; c < 4 * (uint64_t)body->face_count; c++)
        if (body->corners[c] >= body->vertex_count && (c % 4 < 3 || body->corners[c] != MESO_NO_INDEX))
            return meso_fail(error, MESO_ERR_INPUT, "%s: body %u: no vertex %u; it has %u", in->path, number,
                             body->corners[c], body->vertex_count);
    return MESO_OK;
}

static MesoStatus read_bodies(const Reading *in, MesoError *error)
{
    MesoScene *scene = in->scene;
    MesoBody next = {.face_width = 4};
    uint64_t size;
    meso_container_find(in->file, "body", &size);
    uint32_t count = (uint32_t)(size / sizeof(StoredBody) < UINT32_MAX ? size / sizeof(StoredBody) : UINT32_MAX);
    const StoredBody *stored = meso_container_require(in->file, in->path, "body", count, sizeof *stored, error);
    MesoStatus status = stored ? find_arrays(in, stored, count, &next, error) : MESO_ERR_INPUT;
    if (status)
        return status;
    scene->body_count = scene->placed_count = count;
    scene->bodies = MESO_NEW(in->arena, MesoBody, count, error);
    scene->placed = MESO_NEW(in->arena, MesoPlacedBody, count, error);
    if (!scene->bodies || !scene->placed)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count && !status; i++) {
        next.vertex_count = stored[i].vertex_count;
        next.face_count = stored[i].face_count;
        status = check_body(in, i, &stored[i], &next, error);
        scene->bodies[i] = next;
        scene->placed[i] = (MesoPlacedBody){.body = i, .material = stored[i].material, .ids = stored[i].ids};
        next.positions += next.vertex_count;
        next.normals += next.vertex_count;
        next.uvs = next.uvs ? next.uvs + next.vertex_count : NULL;
        next.colors = next.colors ? next.colors + next.vertex_count : NULL;
        next.corners += 4 * (size_t)next.face_count;
    }
    return status;
}

bool meso_model_has_body(const MesoInput *input)
{
    MesoContainer file;
    uint64_t size;
    return meso_container_read(&file, input, "model", MESO_MODEL_MAJOR, NULL) == MESO_OK &&
           meso_container_find(&file, "body", &size) && !meso_container_find(&file, "tiles", &size);
}

MesoStatus meso_body_read(MesoScene *scene, MesoArena *arena, const MesoContainer *container, const char *path,
                          MesoError *error)
{
    Reading in = {scene, container, arena, path};
    *scene = (MesoScene){0};
    MesoStatus status = read_description(&in, error);
    if (!status)
        status = read_ids(&in, error);
    if (!status)
        status = read_bodies(&in, error);
    if (!status)
        meso_scene_measure(scene);
    return status;
}
