/* GLB through meshoptimizer: what its own decoder makes of the streams is the scene, within half a step. */
#include <jansson.h>
#include <meshoptimizer.h>

#include "formats/mesh/mesh_read.h"
#include "formats/scene/mesh_file_fixture.h"

static const MesoMeshWriteOptions MESHOPT = {.compression = MESO_GLB_MESHOPT};

enum { MOST_BYTES = 1 << 24 };

typedef struct File {
    MesoInput input;
    json_t *root;
    const uint8_t *data;        /* of the binary part */
} File;

static const json_t *get(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    CHECK(value);
    return value;
}

static uint32_t integer(const json_t *object, const char *key)
{
    CHECK(json_is_integer(get(object, key)));
    return (uint32_t)json_integer_value(get(object, key));
}

static File read_back(const MesoSceneParts *parts, const MesoMeshWriteOptions *options)
{
    File file = {.input = write_mesh_as(meso_glb_write, parts, options, 2, path_of("x.glb"))};
    uint32_t json_size;
    memcpy(&json_size, file.input.data + 12, sizeof json_size);
    file.root = json_loadb((const char *)file.input.data + 20, json_size, 0, NULL);
    CHECK(file.root);
    file.data = file.input.data + 20 + json_size + 8;
    const json_t *buffers = get(file.root, "buffers");
    CHECK(json_array_size(buffers) == 2 && json_array_size(get(file.root, "extensionsRequired")) == 2);
    CHECK(file.data + integer(json_array_get(buffers, 0), "byteLength") == file.input.data + file.input.size);
    CHECK(json_is_true(get(get(get(json_array_get(buffers, 1), "extensions"), "EXT_meshopt_compression"), "fallback")));
    return file;
}

static void close_file(File *file)
{
    json_decref(file->root);
    meso_input_close(&file->input);
}

/* What an accessor's view is decoded to; in a place that the next call takes again, one for each `which`. */
static const void *decode_accessor(const File *file, uint32_t number, uint32_t which, uint32_t *count)
{
    static uint8_t rooms[8][MOST_BYTES];
    const json_t *accessor = json_array_get(get(file->root, "accessors"), number);
    const json_t *view = json_array_get(get(file->root, "bufferViews"), integer(accessor, "bufferView"));
    const json_t *coding = get(get(view, "extensions"), "EXT_meshopt_compression");
    uint32_t stride = integer(coding, "byteStride"), size = integer(coding, "byteLength");
    const uint8_t *from = file->data + integer(coding, "byteOffset");
    *count = integer(coding, "count");
    CHECK(*count == integer(accessor, "count") && *count * stride == integer(view, "byteLength"));
    CHECK(*count * stride <= MOST_BYTES && integer(view, "buffer") == 1 && integer(view, "byteOffset") % 4 == 0);
    CHECK(from + size <= file->input.data + file->input.size && integer(coding, "byteOffset") % 4 == 0);
    bool indices = strcmp(json_string_value(get(coding, "mode")), "TRIANGLES") == 0;
    CHECK((indices ? meshopt_decodeIndexBuffer(rooms[which], *count, stride, from, size)
                   : meshopt_decodeVertexBuffer(rooms[which], *count, stride, from, size)) == 0);
    if (json_object_get(coding, "filter"))
        meshopt_decodeFilterOct(rooms[which], *count, stride);
    return rooms[which];
}

static const void *decode_attribute(const File *file, const json_t *primitive, const char *name, uint32_t which,
                                    uint32_t count)
{
    uint32_t own;
    const void *data = decode_accessor(file, integer(get(primitive, "attributes"), name), which, &own);
    CHECK(own == count);
    return data;
}

typedef struct Arrays {
    const uint16_t *positions;  /* four a vertex */
    const int16_t *normals;     /* four a vertex */
    const MesoVec2 *uvs;
    const uint32_t *slots, *tiles, *indices;
    uint32_t vertex_count, index_count;
} Arrays;

static Arrays decode_primitive(const File *file, const json_t *primitive)
{
    const json_t *accessors = get(file->root, "accessors");
    Arrays a = {.vertex_count = integer(json_array_get(accessors, integer(get(primitive, "attributes"), "POSITION")),
                                        "count")};
    a.positions = decode_attribute(file, primitive, "POSITION", 0, a.vertex_count);
    a.normals = decode_attribute(file, primitive, "NORMAL", 1, a.vertex_count);
    a.uvs = decode_attribute(file, primitive, "TEXCOORD_0", 2, a.vertex_count);
    a.slots = decode_attribute(file, primitive, "_SLOT", 3, a.vertex_count);
    a.tiles = decode_attribute(file, primitive, "_TILE", 4, a.vertex_count);
    a.indices = decode_accessor(file, integer(primitive, "indices"), 5, &a.index_count);
    return a;
}

static double component(const json_t *node, const char *key, size_t k)
{
    return json_number_value(json_array_get(get(node, key), k));
}

static void check_vertex(const Arrays *a, uint32_t v, const json_t *node, const MesoMeshVertex *vertex)
{
    double step = component(node, "scale", 0);
    const float at[3] = {vertex->position.x, vertex->position.y, vertex->position.z};
    for (size_t k = 0; k < 3; k++) {
        double p = component(node, "translation", k) + step * a->positions[4 * v + k];
        CHECK(fabs(p - (double)at[k]) <= 0.51 * step);
    }
    const int16_t *n = a->normals + 4 * (size_t)v;
    MesoVec3 normal = meso_vec3_scale((MesoVec3){n[0], n[1], n[2]}, 1 / 32767.0f);
    CHECK(meso_vec3_length(meso_vec3_sub(normal, vertex->normal)) < 0.006f);
    CHECK(memcmp(&a->uvs[v], &vertex->uv, sizeof vertex->uv) == 0);
}

/* A triangle may begin at any of its corners. */
static bool is_same_triangle(const uint32_t *a, const uint32_t *b)
{
    for (uint32_t k = 0; k < 3; k++)
        if (a[0] == b[k] && a[1] == b[(k + 1) % 3] && a[2] == b[(k + 2) % 3])
            return true;
    return false;
}

/* The parts of a material from `part` on that one primitive has; returns where the next begins. */
static uint32_t check_primitive(const SceneFixture *fixture, const Whole *whole, const Arrays *a, const json_t *node,
                                uint32_t material, uint32_t part)
{
    const MesoSceneParts *t = &fixture->parts;
    uint32_t vertex = 0, index = 0;
    for (; part < t->part_count && vertex < a->vertex_count; part++) {
        MesoPart own = meso_scene_part(t, part);
        uint32_t base = vertex;
        if (own.material != material)
            continue;
        for (uint64_t v = t->vertex_begin[part]; v < t->vertex_begin[part + 1]; v++, vertex++) {
            check_vertex(a, vertex, node, &whole->vertices[v]);
            CHECK(a->slots[vertex] == meso_scene_id(t->scene, own.ids, 0));
            CHECK(a->tiles[vertex] == meso_scene_id(t->scene, own.ids, 1));
        }
        for (uint64_t f = t->face_begin[part]; f < t->face_begin[part + 1]; f++) {
            const uint32_t *v = whole->faces[f].v, first = (uint32_t)t->vertex_begin[part];
            for (uint32_t k = 2; k < 4 && v[k] != MESO_NO_INDEX; k++, index += 3) {
                const uint32_t expected[3] = {v[0] - first + base, v[k - 1] - first + base, v[k] - first + base};
                CHECK(is_same_triangle(a->indices + index, expected));
            }
        }
    }
    CHECK(vertex == a->vertex_count && index == a->index_count);
    return part;
}

/* Our own reader sees the scene, and refuses what is broken. */
static void test_read(const SceneFixture *fixture, const File *file)
{
    MesoArena arena;
    MesoPolygonMesh mesh;
    MesoError error;
    MesoBox box = meso_box_empty(), whole;
    const MesoSceneParts *parts = &fixture->parts;
    meso_arena_init(&arena);
    CHECK(meso_polygon_mesh_read(&mesh, &arena, &file->input, 1, &error) == MESO_OK);
    CHECK(mesh.face_count == parts->triangle_count && mesh.vertex_count == parts->vertex_begin[parts->part_count]);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        meso_box_add(&box, mesh.positions[v]);
    CHECK(meso_scene_parts_box(parts, 1, &whole, &error) == MESO_OK);
    check_near(box.low, whole.low, 1e-3f);
    check_near(box.high, whole.high, 1e-3f);

    MesoInput cut = file->input;
    uint8_t *bytes = meso_arena_alloc(&arena, cut.size, 1, NULL);
    CHECK(bytes);
    memcpy(bytes, cut.data, cut.size);
    bytes[file->data - file->input.data] ^= 0xff;   /* the first stream's own sign */
    cut.data = bytes;
    CHECK(meso_polygon_mesh_read(&mesh, &arena, &cut, 1, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "bufferView") && strstr(error.message, "meshopt"));
    meso_arena_release(&arena);
}

static void test_decoded(void)
{
    SceneFixture fixture;
    scene_fixture_init(&fixture, 24, 28, 0.02f);
    Whole whole = make_whole(&fixture);
    File file = read_back(&fixture.parts, &MESHOPT);
    const json_t *meshes = get(file.root, "meshes");
    uint64_t indices = 0;
    size_t primitive_count = 0;
    for (uint32_t m = 0; m < json_array_size(meshes); m++) {
        const json_t *primitives = get(json_array_get(meshes, m), "primitives");
        const json_t *node = json_array_get(get(file.root, "nodes"), m + 1);
        uint32_t part = 0;
        for (size_t p = 0; p < json_array_size(primitives); p++, primitive_count++) {
            Arrays a = decode_primitive(&file, json_array_get(primitives, p));
            part = check_primitive(&fixture, &whole, &a, node, m, part);
            indices += a.index_count;
        }
    }
    CHECK(indices == 3 * fixture.parts.triangle_count && primitive_count > json_array_size(meshes));
    CHECK(file.input.size < 10 * fixture.parts.triangle_count);
    check_threads_as(meso_glb_write, &fixture.parts, &MESHOPT, &file.input);
    test_read(&fixture, &file);
    close_file(&file);
    scene_fixture_release(&fixture);
}

static void test_colored(const MesoSceneParts *parts)
{
    const MesoMeshWriteOptions narrow = {.compression = MESO_GLB_MESHOPT, .normal_bits = 8};
    File file = read_back(parts, &narrow);
    const json_t *primitive = json_array_get(get(json_array_get(get(file.root, "meshes"), 0), "primitives"), 0);
    const json_t *accessors = get(file.root, "accessors");
    const json_t *normal = json_array_get(accessors, integer(get(primitive, "attributes"), "NORMAL"));
    const json_t *color = json_array_get(accessors, integer(get(primitive, "attributes"), "COLOR_0"));
    uint32_t count = integer(color, "count");
    MesoMeshColor colors[64];
    CHECK(integer(normal, "componentType") == 5120 && json_is_true(get(normal, "normalized")) && count <= 64);
    const uint8_t *decoded = decode_attribute(&file, primitive, "COLOR_0", 0, count);
    meso_scene_colors(parts, 0, 1, colors);
    for (uint64_t v = 0; v < parts->vertex_begin[1]; v++)
        CHECK(memcmp(decoded + 4 * v, &colors[v], sizeof *colors) == 0);
    close_file(&file);
}

int main(void)
{
    ColoredFixture c;
    MesoArena arena;
    MesoSceneParts parts;
    CHECK(mkdtemp(folder));
    test_decoded();
    meso_arena_init(&arena);
    colored_fixture_init(&c);
    CHECK(meso_scene_parts_init(&parts, &arena, &c.scene, NULL) == MESO_OK);
    test_colored(&parts);
    meso_arena_release(&arena);
    static const char *const products[] = {"x.glb", "again"};
    remove_products(products, 2);
    return 0;
}
