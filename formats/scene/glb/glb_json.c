/* The JSON part of GLB files: accessors of plain rows, or of what a decoder will give. */
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_text.h"
#include "formats/scene/glb/glb_parts.h"

enum {
    TYPE_SIGNED_BYTE = 5120, TYPE_BYTE = 5121, TYPE_SIGNED_SHORT = 5122, TYPE_SHORT = 5123,
    TYPE_UINT = 5125, TYPE_FLOAT = 5126,
    ARRAY_BUFFER = 34962, ELEMENT_BUFFER = 34963
};

static const char DRACO[] = "KHR_draco_mesh_compression", MESHOPT[] = "EXT_meshopt_compression";
static const char QUANTIZED[] = "KHR_mesh_quantization", INSTANCED[] = "EXT_mesh_gpu_instancing";

typedef struct Document {
    const MesoSceneParts *parts;
    const MesoMeshWriteOptions *options;
    json_t *views, *accessors, *materials, *meshes, *nodes;     /* of `root` */
    json_t *root;
    bool colored;
    uint32_t material;  /* the last of `materials`, by its number in the scene; those of one lie together */
    int failed;         /* of Jansson: memory is out */
} Document;

static void set(Document *d, json_t *object, const char *key, json_t *value)
{
    d->failed |= json_object_set_new(object, key, value);
}

/* Appends, and returns the number of the item. */
static json_int_t add(Document *d, json_t *list, json_t *item)
{
    d->failed |= json_array_append_new(list, item);
    return (json_int_t)json_array_size(list) - 1;
}

static json_t *add_list(Document *d, const char *name)
{
    json_t *list = json_array();
    set(d, d->root, name, list);
    return list;
}

/* ---- accessors ---- */

static json_int_t add_view(Document *d, uint64_t offset, uint64_t size, uint32_t stride, int target)
{
    json_t *view = json_pack("{s:i, s:I, s:I}", "buffer", 0, "byteOffset", (json_int_t)offset, "byteLength",
                             (json_int_t)size);
    if (stride)
        set(d, view, "byteStride", json_integer(stride));
    if (target)
        set(d, view, "target", json_integer(target));
    return add(d, d->views, view);
}

/* One whose compressed values lie in no view has view -1. */
static json_int_t add_accessor(Document *d, json_int_t view, uint32_t offset, const char *type, int component,
                               uint64_t count)
{
    json_t *accessor = json_pack("{s:s, s:i, s:I}", "type", type, "componentType", component, "count",
                                 (json_int_t)count);
    if (view >= 0)
        set(d, accessor, "bufferView", json_integer(view));
    if (view >= 0 && offset)
        set(d, accessor, "byteOffset", json_integer(offset));
    return add(d, d->accessors, accessor);
}

/* -0 would depend on which vertex came first. */
static json_t *vector(MesoVec3 v)
{
    return json_pack("[f, f, f]", (double)v.x + 0.0, (double)v.y + 0.0, (double)v.z + 0.0);
}

static json_t *whole_vector(MesoVec3 v)
{
    return json_pack("[I, I, I]", (json_int_t)v.x, (json_int_t)v.y, (json_int_t)v.z);
}

/* "_TILE" for the channel "tile". */
static void attribute_name(const MesoIdChannel *channel, char name[MESO_CHANNEL_NAME + 1])
{
    size_t size = 0;
    name[size++] = '_';
    for (const char *c = channel->name; *c && size < MESO_CHANNEL_NAME; c++)
        name[size++] = *c >= 'a' && *c <= 'z' ? (char)(*c - 'a' + 'A') : *c;
    name[size] = 0;
}

/* What one attribute is called, where it lies in a row, and what Draco numbers it. */
static void add_attribute(Document *d, json_t *attributes, json_t *draco, const char *name, json_int_t accessor,
                          uint32_t draco_id)
{
    set(d, attributes, name, json_integer(accessor));
    if (draco)
        set(d, draco, name, json_integer(draco_id));
}

static json_t *add_attributes(Document *d, const MesoGlbPrimitive *primitive, json_int_t view, json_t *draco)
{
    static const MesoDracoResult none = {0};
    const MesoScene *scene = d->parts->scene;
    const MesoDracoResult *ids = primitive->draco ? primitive->draco : &none;
    uint64_t count = primitive->vertex_count;
    json_t *attributes = json_object();
    json_int_t position = add_accessor(d, view, 0, "VEC3", TYPE_FLOAT, count);
    set(d, json_array_get(d->accessors, (size_t)position), "min", vector(primitive->low));
    set(d, json_array_get(d->accessors, (size_t)position), "max", vector(primitive->high));
    add_attribute(d, attributes, draco, "POSITION", position, ids->position_id);
    add_attribute(d, attributes, draco, "NORMAL", add_accessor(d, view, 12, "VEC3", TYPE_FLOAT, count),
                  ids->normal_id);
    add_attribute(d, attributes, draco, "TEXCOORD_0", add_accessor(d, view, 24, "VEC2", TYPE_FLOAT, count),
                  ids->uv_id);
    uint32_t offset = sizeof(MesoMeshVertex);
    if (d->colored) {
        json_int_t color = add_accessor(d, view, offset, "VEC3", TYPE_BYTE, count);
        set(d, json_array_get(d->accessors, (size_t)color), "normalized", json_true());
        add_attribute(d, attributes, draco, "COLOR_0", color, ids->color_id);
        offset += 4;
    }
    for (uint32_t c = 0; c < scene->channel_count; c++, offset += 4) {
        if (primitive->instances)       /* each instance has its own */
            continue;
        char name[MESO_CHANNEL_NAME + 1];
        attribute_name(&scene->channels[c], name);
        const char *type = scene->channels[c].names ? "SCALAR" : "VEC2";    /* the format has no whole 32 bits */
        add_attribute(d, attributes, draco, name, add_accessor(d, view, offset, type, TYPE_SHORT, count),
                      ids->channel_id[c]);
    }
    if (d->options->lengths && !draco) {
        set(d, attributes, "TEXCOORD_1", json_integer(add_accessor(d, view, offset, "VEC2", TYPE_FLOAT, count)));
        offset += 8;
    }
    if (d->options->tangents && !draco)
        set(d, attributes, "TANGENT", json_integer(add_accessor(d, view, offset, "VEC4", TYPE_FLOAT, count)));
    return attributes;
}

/* ---- meshes ---- */

static json_t *make_plain(Document *d, const MesoGlbPrimitive *p)
{
    uint32_t stride = meso_glb_stride(d->parts->scene, d->options);
    json_int_t vertices = add_view(d, p->vertices_at, stride * p->vertex_count, stride, ARRAY_BUFFER);
    json_int_t indices = add_view(d, p->indices_at, 12 * p->triangle_count, 0, ELEMENT_BUFFER);
    json_t *attributes = add_attributes(d, p, vertices, NULL);
    return json_pack("{s:o, s:I}", "attributes", attributes, "indices",
                     add_accessor(d, indices, 0, "SCALAR", TYPE_UINT, 3 * p->triangle_count));
}

static json_t *make_compressed(Document *d, const MesoGlbPrimitive *p)
{
    json_t *ids = json_object();
    json_int_t view = add_view(d, p->vertices_at, p->draco->size, 0, 0);
    json_t *attributes = add_attributes(d, p, -1, ids);
    return json_pack("{s:o, s:I, s:{s:{s:I, s:o}}}", "attributes", attributes, "indices",
                     add_accessor(d, -1, 0, "SCALAR", TYPE_UINT, 3 * p->triangle_count), "extensions", DRACO,
                     "bufferView", view, "attributes", ids);
}

/* ---- instances ---- */

/* Where a node's mesh is placed, in views of their own. */
static void place_instances(Document *d, json_t *node, const MesoGlbPrimitive *p)
{
    static const struct { const char *name, *type; uint32_t width; } poses[] = {
        {"TRANSLATION", "VEC3", 3}, {"ROTATION", "VEC4", 4}, {"SCALE", "VEC3", 3}};
    const MesoScene *scene = d->parts->scene;
    uint64_t at = p->instances_at, count = p->instances->count;
    json_t *attributes = json_object();
    for (uint32_t i = 0; i < 3 + scene->channel_count; i++) {
        char name[MESO_CHANNEL_NAME + 1];
        uint32_t width = i < 3 ? poses[i].width : 1;
        json_int_t view = add_view(d, at, 4 * width * count, 0, 0);
        if (i >= 3)
            attribute_name(&scene->channels[i - 3], name);
        set(d, attributes, i < 3 ? poses[i].name : name,
            json_integer(add_accessor(d, view, 0, i < 3 ? poses[i].type : "SCALAR", i < 3 ? TYPE_FLOAT : TYPE_UINT,
                                      count)));
        at += 4 * width * count;
    }
    set(d, node, "extensions", json_pack("{s:{s:o}}", INSTANCED, "attributes", attributes));
}

/* ---- of meshoptimizer ---- */

/* A view of the buffer that nobody has to fill, and how it is decoded into it. */
static json_int_t add_stream(Document *d, const MesoGlbStream *stream, uint64_t count, const char *filter, int target)
{
    bool indices = target == ELEMENT_BUFFER;
    json_t *coding = json_pack("{s:i, s:I, s:I, s:I, s:I, s:s}", "buffer", 0, "byteOffset", (json_int_t)stream->at,
                               "byteLength", (json_int_t)stream->size, "byteStride", (json_int_t)stream->stride,
                               "count", (json_int_t)count, "mode", indices ? "TRIANGLES" : "ATTRIBUTES");
    if (filter)
        set(d, coding, "filter", json_string(filter));
    json_int_t view = add_view(d, stream->plain_at, count * stream->stride, indices ? 0 : stream->stride, target);
    json_t *object = json_array_get(d->views, (size_t)view);
    set(d, object, "buffer", json_integer(1));
    set(d, object, "extensions", json_pack("{s:o}", MESHOPT, coding));
    return view;
}

static json_t *add_streamed(Document *d, json_t *attributes, const char *name, const MesoGlbPrimitive *p,
                            uint32_t number, const char *filter, const char *type, int component)
{
    json_int_t view = add_stream(d, &p->meshopt->of[number], p->vertex_count, filter, ARRAY_BUFFER);
    json_int_t accessor = add_accessor(d, view, 0, type, component, p->vertex_count);
    set(d, attributes, name, json_integer(accessor));
    return json_array_get(d->accessors, (size_t)accessor);
}

static json_t *make_meshopt(Document *d, const MesoGlbPrimitive *p)
{
    const MesoScene *scene = d->parts->scene;
    json_t *attributes = json_object();
    json_t *position = add_streamed(d, attributes, "POSITION", p, MESO_GLB_POSITION, NULL, "VEC3", TYPE_SHORT);
    set(d, position, "min", whole_vector(p->low));
    set(d, position, "max", whole_vector(p->high));
    bool wide = p->meshopt->of[MESO_GLB_NORMAL].stride == 8;
    json_t *normal = add_streamed(d, attributes, "NORMAL", p, MESO_GLB_NORMAL, "OCTAHEDRAL", "VEC3",
                                  wide ? TYPE_SIGNED_SHORT : TYPE_SIGNED_BYTE);
    set(d, normal, "normalized", json_true());
    add_streamed(d, attributes, "TEXCOORD_0", p, MESO_GLB_UV, NULL, "VEC2", TYPE_FLOAT);
    if (d->colored)
        set(d, add_streamed(d, attributes, "COLOR_0", p, MESO_GLB_COLOR, NULL, "VEC3", TYPE_BYTE), "normalized",
            json_true());
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        char name[MESO_CHANNEL_NAME + 1];
        attribute_name(&scene->channels[c], name);
        add_streamed(d, attributes, name, p, MESO_GLB_IDS + c, NULL, scene->channels[c].names ? "SCALAR" : "VEC2",
                     TYPE_SHORT);
    }
    json_int_t indices = add_stream(d, &p->meshopt->of[MESO_GLB_INDICES], 3 * p->triangle_count, NULL, ELEMENT_BUFFER);
    return json_pack("{s:o, s:I}", "attributes", attributes, "indices",
                     add_accessor(d, indices, 0, "SCALAR", TYPE_UINT, 3 * p->triangle_count));
}

/* From whole steps to the scene. */
static void place_node(Document *d, json_t *node, const MesoGlbMeshopt *meshopt)
{
    double step = (double)meshopt->step;
    set(d, node, "translation", vector(meshopt->origin));
    set(d, node, "scale", json_pack("[f, f, f]", step, step, step));
}

/* ---- materials and nodes ---- */

/* Sweeps that end at a border are open tubes: their insides can be seen. */
static json_t *material_of(const MesoMaterial *m, const char *name)
{
    return json_pack("{s:o, s:b, s:{s:[f, f, f, f], s:f, s:f}}", "name", meso_json_string(name), "doubleSided", 1,
                     "pbrMetallicRoughness", "baseColorFactor", (double)m->albedo[0], (double)m->albedo[1],
                     (double)m->albedo[2], 1.0, "roughnessFactor", (double)m->roughness, "metallicFactor",
                     (double)m->metallic);
}

/* Slashes in names of nodes are paths to some programs. */
static json_t *node_name(const char *name)
{
    char plain[MESO_MESH_NAME];
    size_t size = 0;
    for (; name[size] && size + 1 < sizeof plain; size++)
        plain[size] = name[size] == '/' ? '_' : name[size];
    plain[size] = 0;
    return meso_json_string(plain);
}

/* The primitives of one material, from `first` on; returns how many. */
static uint32_t add_mesh(Document *d, const MesoGlbPrimitive *first, uint32_t count)
{
    const MesoScene *scene = d->parts->scene;
    char name[MESO_MESH_NAME];
    json_t *primitives = json_array();
    uint32_t used = 0;
    meso_mesh_material_name(scene, first->material, name);
    json_int_t material = (json_int_t)json_array_size(d->materials) - 1;
    if (first->material != d->material)
        material = add(d, d->materials, material_of(&scene->materials[first->material], name));
    d->material = first->material;
    for (; used < count && first[used].material == first->material && first[used].instances == first->instances;
         used++) {
        json_t *primitive = (first[used].draco ? make_compressed : first[used].meshopt ? make_meshopt : make_plain)(
            d, &first[used]);
        set(d, primitive, "material", json_integer(material));
        add(d, primitives, primitive);
    }
    json_int_t mesh = add(d, d->meshes, json_pack("{s:o, s:o}", "name", node_name(name), "primitives", primitives));
    json_t *node = json_pack("{s:o, s:I}", "name", node_name(name), "mesh", mesh);
    if (first->instances)
        place_instances(d, node, first);
    if (first->meshopt)
        place_node(d, node, first->meshopt);
    add(d, d->nodes, node);
    return used;
}

/* The format's up is y, its unit the metre. */
static void add_root(Document *d)
{
    const double unit = d->options->unit > 0 ? (double)d->options->unit : 1, half = 0.70710678118654752;
    json_t *children = json_array();
    for (size_t i = 1; i < json_array_size(d->nodes); i++)
        add(d, children, json_integer((json_int_t)i));
    json_t *root = json_array_get(d->nodes, 0);
    set(d, root, "name", json_string("meso"));
    if (d->options->z_up)
        set(d, root, "rotation", json_pack("[f, f, f, f]", -half, 0.0, 0.0, half));
    if (unit > 1 || unit < 1)
        set(d, root, "scale", json_pack("[f, f, f]", unit, unit, unit));
    set(d, root, "children", children);
}

/* ---- the document ---- */

static json_t *names_of(Document *d, const MesoIdChannel *channel)
{
    json_t *names = json_array();
    for (uint32_t i = 0; i < channel->count; i++)
        add(d, names, meso_json_string(channel->names[i]));
    return names;
}

static json_t *lengths_of(Document *d)
{
    json_t *lengths = json_array();
    for (uint32_t i = 0; i < d->options->strand_count; i++)
        add(d, lengths, meso_json_shortest(d->options->strand_lengths[i]));
    return lengths;
}

static MesoStatus add_asset(Document *d, MesoArena *arena, MesoError *error)
{
    const MesoScene *scene = d->parts->scene;
    const MesoProvenance *provenance = d->options->provenance;
    const char *generator = meso_arena_print(arena, error, "%s %s", provenance ? provenance->tool : "meso",
                                             MESO_VERSION);
    const char *text = meso_mesh_provenance(d->options, arena, error);
    json_t *extras = json_object();
    set(d, d->root, "asset", json_pack("{s:s, s:o, s:o}", "version", "2.0", "generator",
                                       meso_json_string(generator ? generator : ""), "extras", extras));
    if (!generator || !text)
        return MESO_ERR_MEMORY;
    if (*text)
        set(d, extras, "provenance", meso_json_string(text));
    if (d->options->strand_count)
        set(d, extras, "strand_lengths", lengths_of(d));
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        const char *key = meso_mesh_names_key(&scene->channels[c], arena, error);
        if (!key)
            return MESO_ERR_MEMORY;
        if (scene->channels[c].names)
            set(d, extras, key, names_of(d, &scene->channels[c]));
    }
    return MESO_OK;
}

static MesoStatus describe(Document *d, const MesoGlbPrimitive *primitives, uint32_t count, uint64_t size,
                           MesoArena *arena, MesoError *error)
{
    MesoStatus status = add_asset(d, arena, error);
    if (status)
        return status;
    for (int i = 0; i < 2 && (primitives[0].draco || primitives[0].meshopt); i++)
        set(d, d->root, i ? "extensionsRequired" : "extensionsUsed",
            primitives[0].draco ? json_pack("[s]", DRACO) : json_pack("[s, s]", MESHOPT, QUANTIZED));
    bool instanced = false;
    for (uint32_t i = 0; i < count; i++)
        instanced = instanced || primitives[i].instances;
    for (int i = 0; i < 2 && instanced; i++)
        set(d, d->root, i ? "extensionsRequired" : "extensionsUsed", json_pack("[s]", INSTANCED));
    set(d, d->root, "scene", json_integer(0));
    set(d, d->root, "scenes", json_pack("[{s:[i]}]", "nodes", 0));
    d->nodes = add_list(d, "nodes");
    d->materials = add_list(d, "materials");
    d->meshes = add_list(d, "meshes");
    d->accessors = add_list(d, "accessors");
    d->views = add_list(d, "bufferViews");
    json_t *buffers = json_pack("[{s:I}]", "byteLength", (json_int_t)size);
    if (primitives[0].meshopt)      /* where the views are, which only decoders fill */
        add(d, buffers, json_pack("{s:I, s:{s:{s:b}}}", "byteLength",
                                  (json_int_t)primitives[count - 1].meshopt->plain_end, "extensions", MESHOPT,
                                  "fallback", 1));
    set(d, d->root, "buffers", buffers);
    add(d, d->nodes, json_object());
    for (uint32_t i = 0; i < count;)
        i += add_mesh(d, &primitives[i], count - i);
    add_root(d);
    return MESO_OK;
}

/* The text with spaces behind it. */
static const char *pad(const char *text, MesoArena *arena, MesoError *error)
{
    static const char spaces[] = "   ";
    return meso_arena_print(arena, error, "%s%.*s", text, (int)((4 - strlen(text) % 4) % 4), spaces);
}

const char *meso_glb_json(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          const MesoGlbPrimitive *primitives, uint32_t count, uint64_t size, MesoArena *arena,
                          MesoError *error)
{
    Document d = {.parts = parts, .options = options, .root = json_object(), .material = MESO_NO_INDEX,
                  .colored = meso_scene_is_colored(parts->scene)};
    MesoStatus status = describe(&d, primitives, count, size, arena, error);
    char *text = status || d.failed ? NULL : json_dumps(d.root, JSON_COMPACT | JSON_REAL_PRECISION(9));
    const char *padded = text ? pad(text, arena, error) : NULL;
    if (!text && !status)
        meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    free(text);
    json_decref(d.root);
    return padded;
}
