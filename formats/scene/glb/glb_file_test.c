/* GLB: plain, what is read back is the scene itself, bit by bit; with Draco, what its accessors promise is decoded. */
#include <jansson.h>

#include "formats/scene/mesh_file_fixture.h"

static const MesoMeshWriteOptions DRACO = {.speed = 7, .compression = MESO_GLB_DRACO};

static uint32_t word(const MesoInput *input, size_t offset)
{
    uint32_t value;
    CHECK(offset + 4 <= input->size);
    memcpy(&value, input->data + offset, 4);
    return value;
}

static uint32_t integer(const json_t *object, const char *key)
{
    CHECK(json_is_integer(json_object_get(object, key)));
    return (uint32_t)json_integer_value(json_object_get(object, key));
}

static MesoVec3 point(const json_t *array)
{
    CHECK(json_array_size(array) == 3);
    return (MesoVec3){(float)json_number_value(json_array_get(array, 0)),
                      (float)json_number_value(json_array_get(array, 1)),
                      (float)json_number_value(json_array_get(array, 2))};
}

/* Decodes one primitive and compares it with what its accessors promise; returns its triangles. */
static uint64_t check_primitive(const json_t *root, const json_t *primitive, const uint8_t *data, size_t size,
                                const char *numbers)
{
    const json_t *draco = json_object_get(json_object_get(primitive, "extensions"), "KHR_draco_mesh_compression");
    const json_t *view = json_array_get(json_object_get(root, "bufferViews"), integer(draco, "bufferView"));
    const json_t *accessors = json_object_get(root, "accessors");
    const json_t *attributes = json_object_get(primitive, "attributes");
    const json_t *position = json_array_get(accessors, integer(attributes, "POSITION"));
    const json_t *indices = json_array_get(accessors, integer(primitive, "indices"));
    const json_t *slot = json_array_get(accessors, integer(attributes, numbers));
    size_t offset = json_object_get(view, "byteOffset") ? integer(view, "byteOffset") : 0;
    size_t length = integer(view, "byteLength");
    CHECK(offset + length <= size && offset % 4 == 0);
    CHECK(json_object_size(json_object_get(draco, "attributes")) == json_object_size(attributes));
    CHECK(integer(slot, "componentType") == 5123 &&
          strcmp(json_string_value(json_object_get(slot, "type")), "VEC2") == 0);

    const char *path = path_of("piece.drc");
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(data + offset, 1, length, file) == length && fclose(file) == 0);
    Decoded d = decode(path);
    CHECK(d.vertex_count == integer(position, "count") && d.vertex_count == integer(slot, "count"));
    CHECK(3 * d.face_count == integer(indices, "count"));
    check_near(d.box.low, point(json_object_get(position, "min")), 0);
    check_near(d.box.high, point(json_object_get(position, "max")), 0);
    remove(path);
    return d.face_count;
}

/* ---- plain ---- */

/* One that is made again, part by part. */
typedef struct Rows {
    const MesoSceneParts *parts;
    const uint8_t *vertices;        /* rows of 40 bytes: no colours, two channels */
    const uint32_t *indices;
    uint32_t vertex_count, index_count;
} Rows;

static void check_part(const Rows *rows, Rows *at, const Whole *whole, uint32_t part)
{
    const MesoSceneParts *t = rows->parts;
    uint32_t base = at->vertex_count, ids = meso_scene_part(t, part).ids;
    for (uint64_t v = t->vertex_begin[part]; v < t->vertex_begin[part + 1]; v++) {
        const uint8_t *row = rows->vertices + (size_t)40 * at->vertex_count++;
        uint32_t channels[2];
        memcpy(channels, row + 32, sizeof channels);
        CHECK(memcmp(row, &whole->vertices[v], 32) == 0);
        CHECK(channels[0] == meso_scene_id(t->scene, ids, 0) && channels[1] == meso_scene_id(t->scene, ids, 1));
    }
    for (uint64_t f = t->face_begin[part]; f < t->face_begin[part + 1]; f++) {
        const uint32_t *v = whole->faces[f].v, corners[6] = {v[0], v[1], v[2], v[0], v[2], v[3]};
        for (uint32_t k = 0; k < (v[3] == MESO_NO_INDEX ? 3u : 6u); k++) {
            uint32_t expected = corners[k] - (uint32_t)t->vertex_begin[part] + base;
            CHECK(rows->indices[at->index_count++] == expected);
        }
    }
}

static const uint8_t *view_of(const json_t *root, const json_t *accessor, const uint8_t *data, size_t size)
{
    const json_t *view = json_array_get(json_object_get(root, "bufferViews"), integer(accessor, "bufferView"));
    CHECK((uint64_t)integer(view, "byteOffset") + integer(view, "byteLength") <= size);
    CHECK(integer(view, "byteOffset") % 4 == 0);
    return data + integer(view, "byteOffset");
}

static uint64_t check_plain(const SceneFixture *fixture, const Whole *whole, const json_t *root, uint32_t primitive,
                            const uint8_t *data, size_t size)
{
    const MesoSceneParts *t = &fixture->parts;
    const json_t *mesh = json_array_get(json_object_get(root, "meshes"), primitive), *accessors;
    const json_t *only = json_array_get(json_object_get(mesh, "primitives"), 0);
    accessors = json_object_get(root, "accessors");
    const json_t *position = json_array_get(accessors, integer(json_object_get(only, "attributes"), "POSITION"));
    const json_t *indices = json_array_get(accessors, integer(only, "indices"));
    Rows rows = {t, view_of(root, position, data, size),
                 (const uint32_t *)(const void *)view_of(root, indices, data, size), integer(position, "count"),
                 integer(indices, "count")}, at = {0};
    MesoVec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t part = 0; part < t->part_count; part++)
        if (meso_scene_part(t, part).material == primitive)
            check_part(&rows, &at, whole, part);
    CHECK(at.vertex_count == rows.vertex_count && at.index_count == rows.index_count);
    for (uint32_t v = 0; v < rows.vertex_count; v++) {
        MesoVec3 p;
        memcpy(&p, rows.vertices + (size_t)40 * v, sizeof p);
        low = (MesoVec3){fminf(low.x, p.x), fminf(low.y, p.y), fminf(low.z, p.z)};
        high = (MesoVec3){fmaxf(high.x, p.x), fmaxf(high.y, p.y), fmaxf(high.z, p.z)};
    }
    check_near(low, point(json_object_get(position, "min")), 0);
    check_near(high, point(json_object_get(position, "max")), 0);
    return rows.index_count / 3;
}

static json_t *json_of(const MesoInput *input)
{
    json_t *root = json_loadb((const char *)input->data + 20, word(input, 12), 0, NULL);
    CHECK(root);
    return root;
}

/* Large enough for several windows; the materials' parts lie between each other. */
static void test_plain(void)
{
    SceneFixture fixture;
    scene_fixture_init(&fixture, 24, 24, 0.02f);
    Whole whole = make_whole(&fixture);
    MesoInput input = write_mesh(meso_glb_write, &fixture.parts, 2, path_of("x.glb"));
    json_t *root = json_of(&input);
    const uint8_t *data = input.data + 20 + word(&input, 12) + 8;
    uint64_t triangles = 0;
    CHECK(input.size > (size_t)20 << 20 && word(&input, 8) == input.size);
    CHECK(!json_object_get(root, "extensionsRequired") && json_array_size(json_object_get(root, "meshes")) == 4);
    for (uint32_t m = 0; m < 4; m++)
        triangles += check_plain(&fixture, &whole, root, m, data, (size_t)(input.data + input.size - data));
    CHECK(triangles == fixture.parts.triangle_count);
    json_decref(root);
    check_threads(meso_glb_write, &fixture.parts, &input);
    meso_input_close(&input);
    scene_fixture_release(&fixture);
}

/* One root over all, turned and scaled where the scene is not as the format wants it. */
static void test_root(void)
{
    SceneFixture fixture;
    scene_fixture_init(&fixture, 2, 3, 0.1f);
    const MesoMeshWriteOptions ways[] = {{.speed = 7}, {.speed = 7, .z_up = true, .unit = 0.01f}, {.unit = 1}};
    for (int i = 0; i < 3; i++) {
        MesoInput input = write_mesh_as(meso_glb_write, &fixture.parts, &ways[i], 2, path_of("x.glb"));
        json_t *root = json_of(&input);
        const json_t *nodes = json_object_get(root, "nodes"), *top = json_array_get(nodes, 0);
        CHECK(json_array_size(json_object_get(json_array_get(json_object_get(root, "scenes"), 0), "nodes")) == 1);
        CHECK(json_array_size(json_object_get(top, "children")) == 4 && json_array_size(nodes) == 5);
        CHECK((json_object_get(top, "rotation") != NULL) == (i == 1));
        CHECK((json_object_get(top, "scale") != NULL) == (i == 1));
        CHECK(strcmp(json_string_value(json_object_get(json_array_get(nodes, 3), "name")), "weft_stud") == 0);
        json_decref(root);
        meso_input_close(&input);
    }
    scene_fixture_release(&fixture);
}

/* ---- Draco ---- */

static void check_glb(const SceneFixture *fixture, const MesoInput *input, size_t least_primitives)
{
    uint32_t json_size = word(input, 12), data_at = 20 + json_size + 8;
    CHECK(word(input, 0) == 0x46546c67 && word(input, 4) == 2 && word(input, 8) == input->size);
    CHECK(word(input, 16) == 0x4e4f534a && word(input, data_at - 4) == 0x004e4942);
    CHECK(data_at + word(input, data_at - 8) == input->size);
    json_t *root = json_loadb((const char *)input->data + 20, json_size, 0, NULL);
    CHECK(root);
    const json_t *meshes = json_object_get(root, "meshes");
    const json_t *extras = json_object_get(json_object_get(root, "asset"), "extras");
    CHECK(json_array_size(meshes) == 4);
    CHECK(strcmp(json_string_value(json_object_get(json_array_get(meshes, 2), "name")), "weft_stud") == 0);
    const json_t *materials = json_object_get(root, "materials");
    CHECK(strcmp(json_string_value(json_object_get(json_array_get(materials, 2), "name")), "weft/stud") == 0);
    CHECK(strcmp(json_string_value(json_array_get(json_object_get(extras, "tiles"), 0)), "plain \"weave\"") == 0);
    CHECK(strstr(json_string_value(json_object_get(extras, "provenance")), "\"seed\":7"));

    uint64_t triangles = 0, primitive_count = 0;
    for (size_t m = 0; m < json_array_size(meshes); m++) {
        const json_t *primitives = json_object_get(json_array_get(meshes, m), "primitives");
        primitive_count += json_array_size(primitives);
        for (size_t p = 0; p < json_array_size(primitives); p++)
            triangles += check_primitive(root, json_array_get(primitives, p), input->data + data_at,
                                         input->size - data_at, "_SLOT");
    }
    CHECK(primitive_count >= least_primitives);
    CHECK(triangles == fixture->parts.triangle_count);
    json_decref(root);
}

static void test_draco(void)
{
    SceneFixture fixture;
    scene_fixture_init(&fixture, 24, 28, 0.02f);
    MesoInput input = write_mesh_as(meso_glb_write, &fixture.parts, &DRACO, 2, path_of("x.glb"));
    check_glb(&fixture, &input, 5);   /* four materials, one of which needs two pieces */
    check_threads_as(meso_glb_write, &fixture.parts, &DRACO, &input);
    meso_input_close(&input);
    scene_fixture_release(&fixture);
}

static void test_colored(const MesoSceneParts *parts, bool draco)
{
    MesoInput input = write_mesh_as(meso_glb_write, parts, draco ? &DRACO : NULL, 2, path_of("x.glb"));
    json_t *root = json_loadb((const char *)input.data + 20, word(&input, 12), 0, NULL);
    const json_t *extras = json_object_get(json_object_get(json_object_get(root, "asset"), "extras"), "regions");
    const json_t *mesh = json_array_get(json_object_get(root, "meshes"), 0);
    const json_t *attributes = json_object_get(json_array_get(json_object_get(mesh, "primitives"), 0), "attributes");
    const json_t *accessors = json_object_get(root, "accessors");
    const json_t *color = json_array_get(accessors, integer(attributes, "COLOR_0"));
    const json_t *element = json_array_get(accessors, integer(attributes, "_ELEMENT"));
    CHECK(strcmp(json_string_value(json_array_get(extras, 1)), "stem one") == 0);
    CHECK(integer(color, "componentType") == 5121 && json_is_true(json_object_get(color, "normalized")));
    CHECK(strcmp(json_string_value(json_object_get(element, "type")), "VEC2") == 0);
    CHECK(json_object_get(attributes, "_REGION") && json_object_get(attributes, "_STATE"));
    CHECK(!draco || check_primitive(root, json_array_get(json_object_get(mesh, "primitives"), 0),
                          input.data + 20 + word(&input, 12) + 8, word(&input, 20 + word(&input, 12)),
                          "_ELEMENT") == 1);
    json_decref(root);
    meso_input_close(&input);
}

/* ---- refusals ---- */

static void test_refusals(void)
{
    SceneFixture fixture;
    MesoError error;
    MesoOutput *output;
    scene_fixture_init(&fixture, 2, 4, 0.1f);
    fixture.scene.channels[0].count = (1u << 30) + 1;
    CHECK(meso_output_open(&output, path_of("refused"), &error) == MESO_OK);
    CHECK(meso_glb_write(&fixture.parts, &DRACO, output, &error) == MESO_ERR_LIMIT);
    meso_output_discard(output);
    scene_fixture_release(&fixture);
}

int main(void)
{
    ColoredFixture c;
    MesoArena arena;
    MesoSceneParts parts;
    CHECK(mkdtemp(folder));
    test_plain();
    test_root();
    test_draco();
    meso_arena_init(&arena);
    colored_fixture_init(&c);
    CHECK(meso_scene_parts_init(&parts, &arena, &c.scene, NULL) == MESO_OK);
    test_colored(&parts, false);
    test_colored(&parts, true);
    meso_arena_release(&arena);
    test_refusals();
    static const char *const products[] = {"x.glb", "again"};
    remove_products(products, 2);
    return 0;
}
