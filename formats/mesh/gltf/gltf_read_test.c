/* glTF as text with its buffers in data URIs: nodes, strips, colours, ids, and what is broken. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "formats/mesh/mesh_kinds.h"
#include "libcore/base/check.h"

/*
 * A square of two triangles, 0 1 2 and 0 2 3, in four vertices; `_GROUP` is 7 at all of them. Normals look along +X and +Z. The
 * sparse accessor moves vertex 2 to (5, 6, 7).
 */
static const struct {
    float positions[4][3];
    uint16_t indices[6];
    uint8_t groups[4];
    float normals[4][3], uvs[4][2];
    uint8_t colors[4][4];
    uint8_t changed[4];
    float changes[3];
} data = {
    .positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, .indices = {0, 1, 2, 0, 2, 3}, .groups = {7, 7, 7, 7},
    .normals = {{1, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 0}}, .uvs = {{0, 0}, {1, 0}, {1, 0.5f}, {0, 0.5f}},
    .colors = {{255, 0, 51, 255}, {0, 255, 0, 0}}, .changed = {2}, .changes = {5, 6, 7},
};
_Static_assert(sizeof data == 176, "the bufferViews below say where what lies");

static char buffer[300];        /* as a data URI */

static void make_buffer(void)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *at = (const unsigned char *)&data;
    char *out = buffer + sprintf(buffer, "data:application/octet-stream;base64,");
    for (size_t i = 0; i < sizeof data; i += 3) {
        uint32_t three = (uint32_t)at[i] << 16 | (i + 1 < sizeof data ? (uint32_t)at[i + 1] << 8 : 0) |
                         (i + 2 < sizeof data ? at[i + 2] : 0);
        for (int k = 3; k >= 0; k--)
            *out++ = i + 3 - (size_t)k <= sizeof data ? digits[three >> 6 * k & 63] : '=';
    }
    *out = 0;
}

static char text[4000];
static MesoPolygonMesh mesh;
static MesoError error;
static MesoArena arena;

static MesoStatus read_gltf(const char *nodes, const char *primitive, const char *more)
{
    MesoInput input;
    int size = snprintf(text, sizeof text,
        "{%s%s\"scenes\":[{\"nodes\":[0]}],\"nodes\":[%s],"
        "\"meshes\":[{\"name\":\"sheet\",\"primitives\":[%s]}],"
        "\"materials\":[{\"name\":\"red\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0,0,1],\"roughnessFactor\":0.25}},"
        "{\"name\":\"red\",\"pbrMetallicRoughness\":{\"metallicFactor\":0}},{}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
        "{\"bufferView\":2,\"componentType\":5121,\"count\":4,\"type\":\"SCALAR\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":4,\"type\":\"SCALAR\"},"
        "{\"bufferView\":0,\"componentType\":5126,\"count\":5,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":4294967295,\"type\":\"SCALAR\"},"
        "{\"bufferView\":3,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":4,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":5,\"componentType\":5121,\"normalized\":true,\"count\":4,\"type\":\"VEC4\"},"
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":1,"
        "\"indices\":{\"bufferView\":6,\"componentType\":5121},\"values\":{\"bufferView\":7}}},"
        "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":1,"
        "\"indices\":{\"bufferView\":6,\"componentType\":5121},\"values\":{\"bufferView\":7}}}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12},"
        "{\"buffer\":0,\"byteOffset\":60,\"byteLength\":4},{\"buffer\":0,\"byteOffset\":64,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":112,\"byteLength\":32},{\"buffer\":0,\"byteOffset\":144,\"byteLength\":16},"
        "{\"buffer\":0,\"byteOffset\":160,\"byteLength\":4},{\"buffer\":0,\"byteOffset\":164,\"byteLength\":12}],"
        "\"buffers\":[{\"byteLength\":176,\"uri\":\"%s\"}]}", strstr(more, "\"asset\"") ? "" : "\"asset\":{\"version\":\"2.0\"},", more, nodes, primitive, buffer);
    CHECK(size > 0 && (size_t)size < sizeof text);
    meso_input_wrap(&input, "a.gltf", text, (size_t)size);
    error = (MesoError){0};
    return meso_gltf_read(&mesh, &arena, &input, 1, &error);
}

#define SQUARE "{\"attributes\":{\"POSITION\":0,\"_GROUP\":2},\"indices\":1,\"material\":0}"

/* Moved by the parent, mirrored by the child: wound the other way round, so that it looks to where it looked. */
static void test_nodes(void)
{
    CHECK(read_gltf("{\"mesh\":0}", SQUARE, "") == MESO_OK);
    CHECK(mesh.vertex_count == 4 && mesh.face_count == 2 && mesh.side_count == 3);
    CHECK(mesh.corners[1] == 1 && mesh.corners[2] == 2 && mesh.corners[5] == 3);

    CHECK(read_gltf("{\"translation\":[10,0,0],\"children\":[1]},{\"name\":\"leaf\",\"mesh\":0,\"scale\":[-1,1,2]}", SQUARE,
                    "") == MESO_OK);
    CHECK(mesh.positions[1].x == 9 && mesh.positions[2].y == 1);
    CHECK(mesh.corners[0] == 0 && mesh.corners[1] == 2 && mesh.corners[2] == 1);
    const MesoAttribute *object = meso_polygon_attribute(&mesh, "object");
    CHECK(object && object->domain == MESO_ON_FACES && strcmp(object->names[object->entry_of[1]], "leaf") == 0);

    CHECK(read_gltf("{\"children\":[1]},{\"children\":[0],\"mesh\":0}", SQUARE, "") == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "a.gltf: broken glTF: node 0 is reached twice") == 0);
}

static double number(const char *name, uint32_t element, uint32_t component)
{
    const MesoAttribute *attribute = meso_polygon_attribute(&mesh, name);
    CHECK(attribute);
    uint32_t entry = meso_attribute_entry(attribute, element);
    CHECK(entry != MESO_NO_INDEX);
    return meso_attribute_number(attribute, entry, component);
}

/* Normals turn as the surface does, also where it is mirrored and stretched; one without length is none. */
static void test_attributes(void)
{
    const char *all = "{\"attributes\":{\"POSITION\":0,\"NORMAL\":6,\"TEXCOORD_0\":7,\"TEXCOORD_1\":7,\"COLOR_0\":8,\"_GROUP\":2,"
                      "\"_HEAT\":7},\"indices\":1}";
    CHECK(read_gltf("{\"mesh\":0,\"scale\":[-2,1,1]}", all, "") == MESO_OK);
    CHECK(number("normal", 0, 0) == -1 && number("normal", 1, 2) == 1 && number("normal", 3, 2) == 0);
    CHECK(read_gltf("{\"mesh\":0,\"rotation\":[0,0,0.7071067811865476,0.7071067811865476]}", all, "") == MESO_OK);
    CHECK(fabs(number("normal", 0, 1) - 1) < 1e-6 && number("normal", 1, 2) == 1 && fabs(mesh.positions[1].y - 1) < 1e-6f);
    CHECK(number("uv", 2, 1) == 0.5 && number("uv1", 1, 0) == 1 && number("heat", 2, 0) == 1);
    CHECK(number("color", 0, 0) == 1 && fabs(number("color", 0, 2) - 0.2) < 1e-6 && number("color", 1, 3) == 0);
    const MesoAttribute *group = meso_polygon_attribute(&mesh, "group");
    CHECK(group && group->domain == MESO_ON_FACES && group->scalar == MESO_SCALAR_UINT32 && number("group", 1, 0) == 7);
    CHECK(meso_polygon_attribute(&mesh, "material")->entry_of[0] == MESO_NO_INDEX);
}

/* One entry a material, whatever its name; colours of vertices stay apart from those of materials. */
static void test_materials(void)
{
    CHECK(read_gltf("{\"mesh\":0}", SQUARE ",{\"attributes\":{\"POSITION\":0},\"material\":1},"
                    "{\"attributes\":{\"POSITION\":0},\"material\":2},{\"attributes\":{\"POSITION\":0}}", "") == MESO_OK);
    const MesoAttribute *material = meso_polygon_attribute(&mesh, "material");
    CHECK(mesh.face_count == 5 && mesh.vertex_count == 16 && !meso_polygon_attribute(&mesh, "color"));
    CHECK(material && material->entry_count == 3 && material->entry_of[4] == MESO_NO_INDEX);
    CHECK(strcmp(material->names[material->entry_of[1]], "red") == 0 && material->entry_of[2] == 1);
    CHECK(strcmp(material->names[1], "red") == 0 && strcmp(material->names[2], "material 2") == 0);
    CHECK(number("albedo", 1, 0) == 0.5 && number("albedo", 1, 1) == 0 && number("albedo", 2, 1) == 1);
    CHECK(number("roughness", 0, 0) == 0.25 && number("roughness", 2, 0) == 1);
    CHECK(number("metallic", 0, 0) == 1 && number("metallic", 2, 0) == 0);
}

/* Names of numbers, where there is one for each. */
static void test_names(void)
{
    const char *names = "\"asset\":{\"version\":\"2.0\",\"extras\":{\"groups\":[\"0\",\"1\",\"2\",\"3\",\"4\",\"5\",\"6\",\"seven\"]}},";
    CHECK(read_gltf("{\"mesh\":0}", SQUARE, names) == MESO_OK);
    const MesoAttribute *group = meso_polygon_attribute(&mesh, "group");
    CHECK(group && group->width == 0 && group->entry_count == 8 && strcmp(group->names[group->entry_of[1]], "seven") == 0);

    CHECK(read_gltf("{\"mesh\":0}", SQUARE, "\"asset\":{\"version\":\"2.0\",\"extras\":{\"groups\":[\"zero\"]}},") == MESO_OK);
    CHECK(number("group", 1, 0) == 7);
    CHECK(read_gltf("{\"mesh\":0}", SQUARE, "\"asset\":{\"version\":\"2.0\",\"extras\":{\"groups\":[8],\"s\":[\"\"],\"\":[\"\"]}},") ==
          MESO_OK);
    CHECK(number("group", 1, 0) == 7);
}

/* With a bufferView below the changes, and with zeros. */
static void test_sparse(void)
{
    CHECK(read_gltf("{\"mesh\":0}", "{\"attributes\":{\"POSITION\":9},\"indices\":1}", "") == MESO_OK);
    CHECK(mesh.positions[1].x == 1 && mesh.positions[2].x == 5 && mesh.positions[2].z == 7 && mesh.positions[3].y == 1);
    CHECK(read_gltf("{\"mesh\":0}", "{\"attributes\":{\"POSITION\":10},\"indices\":1}", "") == MESO_OK);
    CHECK(mesh.positions[1].x == 0 && mesh.positions[2].y == 6);
}

/* 0 1 2, then 0 2 3 as a fan; 0 1 2, then 2 1 3 as a strip. Points are passed over. */
static void test_modes(void)
{
    static const uint32_t fan[6] = {0, 1, 2, 0, 2, 3}, strip[6] = {0, 1, 2, 1, 3, 2};
    CHECK(read_gltf("{\"mesh\":0}", "{\"attributes\":{\"POSITION\":0},\"mode\":6}", "") == MESO_OK);
    CHECK(mesh.face_count == 2 && memcmp(mesh.corners, fan, sizeof fan) == 0);
    CHECK(read_gltf("{\"mesh\":0}", "{\"attributes\":{\"POSITION\":0},\"mode\":5}", "") == MESO_OK);
    CHECK(mesh.face_count == 2 && memcmp(mesh.corners, strip, sizeof strip) == 0);
    CHECK(read_gltf("{\"mesh\":0}", "{\"attributes\":{\"POSITION\":0},\"mode\":0}", "") == MESO_OK && mesh.face_count == 0);
}

static void expect(const char *primitive, const char *more, const char *message)
{
    MesoStatus status = read_gltf("{\"mesh\":0}", primitive, more);
    if (status == MESO_OK || !strstr(error.message, message))
        fprintf(stderr, "got '%s'\n", error.message);
    CHECK(status == MESO_ERR_INPUT && strstr(error.message, message));
}

static void test_broken(void)
{
    expect("{\"attributes\":{\"POSITION\":4},\"indices\":1}", "", "accessor 4 ends behind its bufferView");
    expect("{\"attributes\":{\"POSITION\":99},\"indices\":1}", "", "accessor 99 is not there");
    expect("{\"attributes\":{\"POSITION\":0},\"indices\":5}", "", "accessor 5 is absurdly large for its file");
    expect("{\"attributes\":{\"POSITION\":2},\"indices\":1}", "", "positions are not of three numbers");
    expect("{\"attributes\":{\"POSITION\":0,\"NORMAL\":4},\"indices\":1}", "", "accessor 4 has 5 elements, not 4");
    expect(SQUARE, "\"extensionsRequired\":[\"EXT_meshopt_compression\"],", "requires the extension EXT_meshopt_compression");
    expect("{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":3}", "", "material 3 is not there");
}

/* A header alone, whose faces Draco would take 7 GB for. */
static void test_draco_claims(void)
{
    static const unsigned char bytes[] = "DRACO\1\114\1\1\1\52\1s \377\377\377\377\377\15\15\15\15\15\15\15\15\15\15\15";
    MesoInput input;
    meso_input_wrap(&input, "a.drc", bytes, sizeof bytes);
    CHECK(meso_draco_read(&mesh, &arena, &input, 1, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "a.drc: broken .drc: a mesh that Draco compressed is absurdly large for its file") == 0);
    meso_input_wrap(&input, "a.drc", bytes, 14);
    CHECK(meso_draco_read(&mesh, &arena, &input, 1, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "a.drc: broken .drc: Draco: the bitstream ends where it counts faces") == 0);
}

int main(void)
{
    meso_arena_init(&arena);
    make_buffer();
    test_nodes();
    test_attributes();
    test_materials();
    test_names();
    test_sparse();
    test_modes();
    test_broken();
    test_draco_claims();
    meso_arena_release(&arena);
    return 0;
}
