/* glTF as text with its buffers in data URIs: nodes, strips, colours, ids, and what is broken. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "formats/mesh/mesh_kinds.h"
#include "libcore/base/check.h"

/*
 * A square of two triangles, 0 1 2 and 0 2 3, in four vertices; `_GROUP` is 7 at all of them.
 * Bytes: positions 48, indices 12 (16 bits), groups 4.
 */
static const char buffer[] =
    "data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAA" "AAABAAIAAAACAAMA" "BwcHBw==";

static char text[4000];
static MesoPolygonMesh mesh;
static MesoError error;
static MesoArena arena;

static MesoStatus read_gltf(const char *nodes, const char *primitive, const char *more)
{
    MesoInput input;
    int size = snprintf(text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},%s\"scenes\":[{\"nodes\":[0]}],\"nodes\":[%s],"
        "\"meshes\":[{\"name\":\"sheet\",\"primitives\":[%s]}],"
        "\"materials\":[{\"name\":\"red\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0,0,1]}}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
        "{\"bufferView\":2,\"componentType\":5121,\"count\":4,\"type\":\"SCALAR\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":4,\"type\":\"SCALAR\"},"
        "{\"bufferView\":0,\"componentType\":5126,\"count\":5,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":4294967295,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12},"
        "{\"buffer\":0,\"byteOffset\":60,\"byteLength\":4}],"
        "\"buffers\":[{\"byteLength\":64,\"uri\":\"%s\"}]}", more, nodes, primitive, buffer);
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

/* A material's colour becomes one of vertices; a whole number that faces agree on is theirs. */
static void test_attributes(void)
{
    CHECK(read_gltf("{\"mesh\":0}", SQUARE, "") == MESO_OK);
    const MesoAttribute *color = meso_polygon_attribute(&mesh, "color"), *group = meso_polygon_attribute(&mesh, "group");
    CHECK(color && color->width == 4 && meso_attribute_number(color, 0, 0) == 0.5 && meso_attribute_number(color, 3, 1) == 0);
    CHECK(group && group->domain == MESO_ON_FACES && group->scalar == MESO_SCALAR_UINT32);
    CHECK(meso_attribute_number(group, group->entry_of[1], 0) == 7);
    const MesoAttribute *material = meso_polygon_attribute(&mesh, "material");
    CHECK(material && strcmp(material->names[material->entry_of[0]], "red") == 0);
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
    expect("{\"attributes\":{\"POSITION\":9},\"indices\":1}", "", "accessor 9 is not there");
    expect("{\"attributes\":{\"POSITION\":0},\"indices\":5}", "", "accessor 5 is absurdly large for its file");
    expect("{\"attributes\":{\"POSITION\":2},\"indices\":1}", "", "positions are not of three numbers");
    expect("{\"attributes\":{\"POSITION\":0,\"NORMAL\":4},\"indices\":1}", "", "accessor 4 has 5 elements, not 4");
    expect(SQUARE, "\"extensionsRequired\":[\"EXT_meshopt_compression\"],", "requires the extension EXT_meshopt_compression");
    expect("{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":3}", "", "material 3 is not there");
}

int main(void)
{
    meso_arena_init(&arena);
    test_nodes();
    test_attributes();
    test_modes();
    test_broken();
    meso_arena_release(&arena);
    return 0;
}
