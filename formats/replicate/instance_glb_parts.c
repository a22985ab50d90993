#include "formats/replicate/instance_glb_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_text.h"

enum { ARRAY_BUFFER = 34962, ELEMENT_BUFFER = 34963 };

uint32_t meso_glb_accessor(MesoGlbParts *glb, const char *type, int component, uint32_t count, uint32_t width,
                           int target)
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

void meso_glb_bounds(MesoGlbParts *glb, uint32_t accessor, const MesoVec3 *positions, uint32_t count)
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

json_t *meso_glb_mesh(MesoGlbParts *glb, const MesoInstanceShape *shape, const MesoVec3 *positions,
                      const MesoVec3 *normals)
{
    json_int_t number = (json_int_t)json_array_size(glb->meshes);
    uint32_t position = meso_glb_accessor(glb, "VEC3", MESO_GLB_FLOAT, shape->vertex_count, 3, ARRAY_BUFFER);
    meso_glb_bounds(glb, position, positions, shape->vertex_count);
    json_t *attributes = json_pack("{s:I}", "POSITION", (json_int_t)position);
    if (normals) {
        uint32_t normal = meso_glb_accessor(glb, "VEC3", MESO_GLB_FLOAT, shape->vertex_count, 3, ARRAY_BUFFER);
        glb->failed |= json_object_set_new(attributes, "NORMAL", json_integer((json_int_t)normal));
    }
    uint32_t indices = meso_glb_accessor(glb, "SCALAR", MESO_GLB_UINT, 3 * shape->triangle_count, 1, ELEMENT_BUFFER);
    json_t *primitive = json_pack("{s:o, s:I, s:I}", "attributes", attributes, "indices", (json_int_t)indices,
                                  "material", number);
    json_t *node = json_pack("{s:o, s:I}", "name", meso_json_string(shape->name), "mesh", number);
    glb->failed |= json_array_append_new(glb->materials, material_of(shape));
    glb->failed |= json_array_append_new(glb->meshes, json_pack("{s:o, s:[o]}", "name", meso_json_string(shape->name),
                                                                "primitives", primitive));
    glb->failed |= json_array_append_new(glb->nodes, node);
    return node;
}

static void add_asset(MesoGlbParts *glb, const MesoProvenance *provenance, MesoArena *arena, MesoError *error)
{
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
}

/* All nodes, below one that turns and enlarges them where the format's axes and unit are others. */
static void add_scene(MesoGlbParts *glb, const MesoInstanceScene *scene)
{
    const double unit = (double)meso_instance_unit(scene), half = 0.70710678118654752;
    json_t *nodes = json_array();
    json_int_t count = (json_int_t)json_array_size(glb->nodes);
    for (json_int_t i = 0; i < count; i++)
        glb->failed |= json_array_append_new(nodes, json_integer(i));
    if (count > 0 && (scene->z_up || unit < 1 || unit > 1)) {
        json_t *above = json_pack("{s:s, s:o}", "name", "meso", "children", nodes);
        if (scene->z_up)
            glb->failed |= json_object_set_new(above, "rotation", json_pack("[f, f, f, f]", -half, 0.0, 0.0, half));
        if (unit < 1 || unit > 1)
            glb->failed |= json_object_set_new(above, "scale", json_pack("[f, f, f]", unit, unit, unit));
        glb->failed |= json_array_append_new(glb->nodes, above);
        nodes = json_pack("[I]", count);
    }
    glb->failed |= json_object_set_new(glb->root, "scene", json_integer(0));
    glb->failed |= json_object_set_new(glb->root, "scenes", json_pack("[{s:o}]", "nodes", nodes));
}

static json_t *add_list(MesoGlbParts *glb, const char *name)
{
    json_t *list = json_array();
    glb->failed |= json_object_set_new(glb->root, name, list);
    return list;
}

void meso_glb_begin(MesoGlbParts *glb)
{
    *glb = (MesoGlbParts){.root = json_object()};
    glb->nodes = add_list(glb, "nodes");
    glb->meshes = add_list(glb, "meshes");
    glb->materials = add_list(glb, "materials");
    glb->accessors = add_list(glb, "accessors");
    glb->views = add_list(glb, "bufferViews");
}

void meso_glb_release(MesoGlbParts *glb)
{
    json_decref(glb->root);
}

/* ---- the file ---- */

MesoStatus meso_glb_write_mesh(const MesoInstanceShape *shape, const MesoVec3 *positions, const MesoVec3 *normals,
                             MesoOutput *output, MesoError *error)
{
    MesoStatus status = meso_output_write(output, positions, shape->vertex_count * sizeof *positions, error);
    if (!status && normals)
        status = meso_output_write(output, normals, shape->vertex_count * sizeof *normals, error);
    return status ? status : meso_output_write(output, shape->corners, 12 * (size_t)shape->triangle_count, error);
}

static MesoStatus write_head(const MesoGlbParts *glb, const char *text, MesoOutput *output, MesoError *error)
{
    size_t length = strlen(text), padding = (4 - length % 4) % 4;
    uint64_t total = 28 + length + padding + glb->size;
    if (total > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "a GLB file holds 4 GiB; this takes %.1f",
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
    return status;
}

MesoStatus meso_glb_finish(MesoGlbParts *glb, const MesoInstanceScene *scene, MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    MesoStatus status = MESO_ERR_MEMORY;
    meso_arena_init(&arena);
    add_asset(glb, scene->provenance, &arena, error);
    add_scene(glb, scene);
    glb->failed |= json_object_set_new(glb->root, "buffers",
                                       json_pack("[{s:I}]", "byteLength", (json_int_t)glb->size));
    char *text = glb->failed ? NULL : json_dumps(glb->root, JSON_COMPACT | JSON_REAL_PRECISION(9));
    if (!text)
        meso_fail(error, status, "out of memory");
    else if (json_array_size(glb->nodes) == 0)
        status = meso_fail(error, MESO_ERR_INPUT, "no geometry to write");
    else
        status = write_head(glb, text, output, error);
    free(text);
    meso_arena_release(&arena);
    return status;
}
