/* The binary part is written straight from the arrays, in the order in which the JSON part has named its pieces. */
#include "formats/replicate/instance_glb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_text.h"

enum { TYPE_FLOAT = 5126, TYPE_UINT = 5125, ARRAY_BUFFER = 34962, ELEMENT_BUFFER = 34963, CHUNK = 4096 };

typedef struct Glb {
    const MesoInstanceScene *scene;
    const MesoInstanceFrame *frame;
    json_t *views, *accessors, *meshes, *nodes, *materials;     /* owned by `root` */
    json_t *root;
    uint64_t size;          /* of the binary part so far */
    uint32_t count;         /* of accessors */
    int failed;             /* of Jansson: memory is out */
} Glb;

/* ---- the JSON part ---- */

/* All pieces are made of words of 32 bits, and so all are aligned. Returns the accessor's number. */
static uint32_t add_accessor(Glb *glb, const char *type, int component, uint32_t count, uint32_t width, int target)
{
    uint64_t bytes = 4 * (uint64_t)width * count;
    json_t *view = json_pack("{s:i, s:I, s:I}", "buffer", 0, "byteOffset", (json_int_t)glb->size, "byteLength",
                             (json_int_t)bytes);
    if (target)
        glb->failed |= json_object_set_new(view, "target", json_integer(target));
    glb->failed |= json_array_append_new(glb->views, view);
    glb->failed |= json_array_append_new(glb->accessors,
                                         json_pack("{s:I, s:i, s:I, s:s}", "bufferView", (json_int_t)glb->count,
                                                   "componentType", component, "count", (json_int_t)count, "type",
                                                   type));
    glb->size += bytes;
    return glb->count++;
}

/* Which the format wants of positions. */
static void set_bounds(Glb *glb, uint32_t accessor, const MesoVec3 *positions, uint32_t count)
{
    MesoVec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t v = 0; v < count; v++) {
        low = (MesoVec3){fminf(low.x, positions[v].x), fminf(low.y, positions[v].y), fminf(low.z, positions[v].z)};
        high = (MesoVec3){fmaxf(high.x, positions[v].x), fmaxf(high.y, positions[v].y), fmaxf(high.z, positions[v].z)};
    }
    json_t *object = json_array_get(glb->accessors, accessor);
    glb->failed |= json_object_set_new(object, "min", json_pack("[f, f, f]", (double)low.x, (double)low.y,
                                                                (double)low.z));
    glb->failed |= json_object_set_new(object, "max", json_pack("[f, f, f]", (double)high.x, (double)high.y,
                                                                (double)high.z));
}

static json_t *material_of(const MesoInstanceShape *shape)
{
    const MesoMaterial *m = shape->material;
    return json_pack("{s:o, s:b, s:{s:[f, f, f, f], s:f, s:f}}", "name", meso_json_string(shape->name), "doubleSided",
                     1, "pbrMetallicRoughness", "baseColorFactor", (double)m->albedo[0], (double)m->albedo[1],
                     (double)m->albedo[2], 1.0, "roughnessFactor", (double)m->roughness, "metallicFactor",
                     (double)m->metallic);
}

/* Returns the node, of which the caller may say more. */
static json_t *add_mesh(Glb *glb, const MesoInstanceShape *shape, const MesoVec3 *positions, const MesoVec3 *normals)
{
    json_int_t number = (json_int_t)json_array_size(glb->meshes);
    uint32_t position = add_accessor(glb, "VEC3", TYPE_FLOAT, shape->vertex_count, 3, ARRAY_BUFFER);
    set_bounds(glb, position, positions, shape->vertex_count);
    json_t *attributes = json_pack("{s:I}", "POSITION", (json_int_t)position);
    if (normals) {
        uint32_t normal = add_accessor(glb, "VEC3", TYPE_FLOAT, shape->vertex_count, 3, ARRAY_BUFFER);
        glb->failed |= json_object_set_new(attributes, "NORMAL", json_integer((json_int_t)normal));
    }
    uint32_t indices = add_accessor(glb, "SCALAR", TYPE_UINT, 3 * shape->triangle_count, 1, ELEMENT_BUFFER);
    json_t *primitive = json_pack("{s:o, s:I, s:I}", "attributes", attributes, "indices", (json_int_t)indices,
                                  "material", number);
    json_t *node = json_pack("{s:o, s:I}", "name", meso_json_string(shape->name), "mesh", number);
    glb->failed |= json_array_append_new(glb->materials, material_of(shape));
    glb->failed |= json_array_append_new(glb->meshes, json_pack("{s:o, s:[o]}", "name", meso_json_string(shape->name),
                                                                "primitives", primitive));
    glb->failed |= json_array_append_new(glb->nodes, node);
    return node;
}

static uint32_t count_instances(const Glb *glb, uint32_t shape)
{
    uint32_t count = 0;
    for (uint32_t d = 0; d < glb->frame->count; d++)
        count += glb->frame->details[d].kind == shape && meso_instance_shown(glb->scene, glb->frame, d);
    return count;
}

static void add_instances(Glb *glb, json_t *node, uint32_t count)
{
    static const struct { const char *name, *type; int component; uint32_t width; } attributes[] = {
        {"TRANSLATION", "VEC3", TYPE_FLOAT, 3}, {"ROTATION", "VEC4", TYPE_FLOAT, 4}, {"SCALE", "VEC3", TYPE_FLOAT, 3},
        {"_ID", "SCALAR", TYPE_UINT, 1}, {"_BIRTH", "SCALAR", TYPE_FLOAT, 1}};
    json_t *object = json_object();
    for (uint32_t i = 0; i < 5; i++) {
        uint32_t accessor = add_accessor(glb, attributes[i].type, attributes[i].component, count, attributes[i].width,
                                         0);
        glb->failed |= json_object_set_new(object, attributes[i].name, json_integer((json_int_t)accessor));
    }
    glb->failed |= json_object_set_new(node, "extensions",
                                       json_pack("{s:{s:o}}", "EXT_mesh_gpu_instancing", "attributes", object));
}

static void add_asset(Glb *glb, bool instanced, MesoArena *arena, MesoError *error)
{
    const MesoProvenance *provenance = glb->scene->provenance;
    const char *generator = meso_arena_print(arena, error, "%s %s", provenance ? provenance->tool : "meso",
                                             MESO_VERSION);
    json_t *asset = json_pack("{s:s, s:o}", "version", "2.0", "generator",
                              meso_json_string(generator ? generator : ""));
    const char *text = provenance ? meso_provenance_text(provenance, arena, error) : "";
    if (!text || !generator)
        glb->failed = -1;
    else if (*text)
        glb->failed |= json_object_set_new(asset, "extras", json_pack("{s:o}", "provenance", meso_json_string(text)));
    glb->failed |= json_object_set_new(glb->root, "asset", asset);
    json_t *nodes = json_array();
    for (size_t i = 0; i < json_array_size(glb->nodes); i++)
        glb->failed |= json_array_append_new(nodes, json_integer((json_int_t)i));
    glb->failed |= json_object_set_new(glb->root, "scene", json_integer(0));
    glb->failed |= json_object_set_new(glb->root, "scenes", json_pack("[{s:o}]", "nodes", nodes));
    for (int i = 0; i < 2 && instanced; i++)
        glb->failed |= json_object_set_new(glb->root, i ? "extensionsRequired" : "extensionsUsed",
                                           json_pack("[s]", "EXT_mesh_gpu_instancing"));
}

static json_t *add_list(Glb *glb, const char *name)
{
    json_t *list = json_array();
    glb->failed |= json_object_set_new(glb->root, name, list);
    return list;
}

static void describe(Glb *glb, MesoArena *arena, MesoError *error)
{
    const MesoInstanceScene *scene = glb->scene;
    bool instanced = false;
    glb->root = json_object();
    glb->nodes = add_list(glb, "nodes");
    glb->meshes = add_list(glb, "meshes");
    glb->materials = add_list(glb, "materials");
    glb->accessors = add_list(glb, "accessors");
    glb->views = add_list(glb, "bufferViews");
    if (scene->surface)
        add_mesh(glb, scene->surface, glb->frame->positions, glb->frame->normals);
    for (uint32_t s = 0; s < scene->shape_count; s++) {
        uint32_t count = count_instances(glb, s);
        if (count == 0)
            continue;
        add_instances(glb, add_mesh(glb, &scene->shapes[s], scene->shapes[s].positions, scene->shapes[s].normals),
                      count);
        instanced = true;
    }
    add_asset(glb, instanced, arena, error);
    glb->failed |= json_object_set_new(glb->root, "buffers",
                                       json_pack("[{s:I}]", "byteLength", (json_int_t)glb->size));
}

/* ---- the binary part ---- */

static MesoStatus write_mesh(const MesoInstanceShape *shape, const MesoVec3 *positions, const MesoVec3 *normals,
                             MesoOutput *output, MesoError *error)
{
    MesoStatus status = meso_output_write(output, positions, shape->vertex_count * sizeof *positions, error);
    if (!status && normals)
        status = meso_output_write(output, normals, shape->vertex_count * sizeof *normals, error);
    return status ? status : meso_output_write(output, shape->corners, 12 * (size_t)shape->triangle_count, error);
}

/* The words of an attribute of one detail; how many they are. */
static uint32_t words_of(const Glb *glb, uint32_t detail, int attribute, void *words)
{
    MesoInstance instance = meso_instance_of(&glb->frame->placed[detail]);
    const float birth = (float)meso_instance_birth(&glb->frame->details[detail]);
    const void *from[] = {&instance.position, instance.rotation, &instance.scale, &detail, &birth};
    static const uint32_t widths[] = {3, 4, 3, 1, 1};
    memcpy(words, from[attribute], 4 * (size_t)widths[attribute]);
    return widths[attribute];
}

static MesoStatus write_instances(const Glb *glb, uint32_t shape, int attribute, MesoOutput *output, MesoError *error)
{
    uint32_t words[CHUNK], used = 0;
    MesoStatus status = MESO_OK;
    for (uint32_t d = 0; d < glb->frame->count && !status; d++) {
        if (glb->frame->details[d].kind != shape || !meso_instance_shown(glb->scene, glb->frame, d))
            continue;
        used += words_of(glb, d, attribute, words + used);
        if (used + 4 > CHUNK) {
            status = meso_output_write(output, words, 4 * (size_t)used, error);
            used = 0;
        }
    }
    return status ? status : meso_output_write(output, words, 4 * (size_t)used, error);
}

static MesoStatus write_pieces(const Glb *glb, MesoOutput *output, MesoError *error)
{
    const MesoInstanceScene *scene = glb->scene;
    MesoStatus status = MESO_OK;
    if (scene->surface)
        status = write_mesh(scene->surface, glb->frame->positions, glb->frame->normals, output, error);
    for (uint32_t s = 0; s < scene->shape_count && !status; s++) {
        const MesoInstanceShape *shape = &scene->shapes[s];
        if (count_instances(glb, s) == 0)
            continue;
        status = write_mesh(shape, shape->positions, shape->normals, output, error);
        for (int attribute = 0; attribute < 5 && !status; attribute++)
            status = write_instances(glb, s, attribute, output, error);
    }
    return status;
}

/* ---- the file ---- */

static MesoStatus write_file(const Glb *glb, const char *text, MesoOutput *output, MesoError *error)
{
    size_t length = strlen(text), padding = (4 - length % 4) % 4;
    uint64_t total = 28 + length + padding + glb->size;
    if (total > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "a GLB file holds 4 GiB; this frame takes %.1f",
                         (double)total / 1073741824.0);
    const uint32_t head[] = {0x46546c67, 2, (uint32_t)total, (uint32_t)(length + padding), 0x4e4f534a};
    const uint32_t binary[] = {(uint32_t)glb->size, 0x004e4942};
    MesoStatus status = meso_output_write(output, head, sizeof head, error);
    if (!status)
        status = meso_output_write(output, text, length, error);
    if (!status)
        status = meso_output_write(output, "   ", padding, error);
    if (!status)
        status = meso_output_write(output, binary, sizeof binary, error);
    return status ? status : write_pieces(glb, output, error);
}

MesoStatus meso_instance_glb_write(const MesoInstanceScene *scene, const MesoInstanceFrame *frame, MesoOutput *output,
                                   MesoError *error)
{
    Glb glb = {.scene = scene, .frame = frame};
    MesoArena arena;
    MesoStatus status;
    meso_arena_init(&arena);
    describe(&glb, &arena, error);
    char *text = glb.failed ? NULL : json_dumps(glb.root, JSON_COMPACT | JSON_REAL_PRECISION(9));
    if (!text)
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    else if (json_array_size(glb.nodes) == 0)
        status = meso_fail(error, MESO_ERR_INPUT, "no geometry to write");
    else
        status = write_file(&glb, text, output, error);
    free(text);
    json_decref(glb.root);
    meso_arena_release(&arena);
    return status;
}
