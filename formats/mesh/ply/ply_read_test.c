/* PLY: three forms of one mesh, other properties around it, and broken headers and bodies. */
#include <math.h>

#include "formats/mesh/mesh_kinds.h"
#include "formats/mesh/surface_read_fixture.h"

static MesoStatus read_bytes(const void *bytes, size_t size)
{
    return read_file("t.ply", bytes, size);
}

static void check_message(const char *text, const char *message)
{
    check_refused("t.ply", text, message);
}

/* Two squares, 3 2 5 / 0 1 4, the right one upright. */
static const float points[6][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {2, 0, 2}, {2, 2, 2.25f}};
static const uint32_t faces[8] = {0, 1, 2, 3, 1, 4, 5, 2};

static void check_mesh(MesoStatus status)
{
    if (status)
        fprintf(stderr, "%s\n", error.message);
    CHECK(status == MESO_OK);
    CHECK(mesh.vertex_count == 6 && mesh.face_count == 2);
    CHECK(memcmp(mesh.positions, points, sizeof points) == 0);
    CHECK(memcmp(mesh.face_vertices, faces, sizeof faces) == 0);
}

#define HEADER "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n" \
               "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
#define VERTICES "0 0 0\n2 0 0\n2 2 0\n0 2 0\n2 0 2\n2 2 2.25\n"
#define BODY VERTICES "4 0 1 2 3\n4 1 4 5 2\n"

static void test_ascii(void)
{
    check_mesh(read_bytes(HEADER BODY, strlen(HEADER BODY)));
    check_mesh(read_bytes(HEADER BODY, strlen(HEADER BODY) - 1));
    const char *windows = "ply\r\nformat ascii 1.0\r\ncomment # made by hand\r\nobj_info x\r\nelement vertex 6\r\n"
        "property double x\r\nproperty double y\r\nproperty double z\r\nproperty uchar red\r\n"
        "element face 2\r\nproperty list uint8 uint32 vertex_index\r\nend_header\r\n"
        "0 0 0 1\r\n2 0 0 1\r\n2 2 0 1\r\n0 2 0 1\r\n2 0 2 1\r\n2 2 2.25 1\r\n4 0 1 2 3\r\n4 1 4 5 2\r\n\r\n";
    check_mesh(read_bytes(windows, strlen(windows)));
}

static const char normals_header[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
    "property list uchar int vertex_indices\nproperty int material\nelement edge 1\nproperty int vertex1\n"
    "property int vertex2\nend_header\n"
    "0 0 0 0 0 2\n1 0 0 0 -1 0\n1 1 0 1 0 0\n0 1 0 0 0 0\n4 0 1 2 3 7\n0 1\n";

static void test_normals(void)
{
    CHECK(read_bytes(normals_header, strlen(normals_header)) == MESO_OK);
    CHECK(mesh.normals[mesh.face_normals[0]].z == 1 && mesh.normals[mesh.face_normals[1]].y == -1);
    CHECK(mesh.normals[mesh.face_normals[2]].x == 1 && mesh.normals[mesh.face_normals[3]].z == 1);
}

static void put(unsigned char **at, const void *value, size_t size, bool big)
{
    const unsigned char *bytes = value;
    for (size_t i = 0; i < size; i++)
        *(*at)++ = bytes[big ? size - 1 - i : i];
}

/* Vertices with a scalar and a list that are passed over, on a machine of little endian. */
static size_t make_binary(unsigned char *out, bool big)
{
    int length = sprintf((char *)out,
        "ply\nformat binary_%s_endian 1.0\nelement vertex 6\nproperty uchar a\nproperty float x\n"
        "property float y\nproperty float z\nelement other 2\nproperty double b\n"
        "element face 2\nproperty list uchar uint vertex_indices\nproperty short c\nend_header\n",
        big ? "big" : "little");
    unsigned char *at = out + length;
    double other = 0.5;
    for (int v = 0; v < 6; v++) {
        put(&at, "a", 1, big);
        for (int i = 0; i < 3; i++)
            put(&at, &points[v][i], 4, big);
    }
    put(&at, &other, 8, big);
    put(&at, &other, 8, big);
    for (int f = 0; f < 2; f++) {
        put(&at, "\4", 1, big);
        for (int i = 0; i < 4; i++)
            put(&at, &faces[4 * f + i], 4, big);
        put(&at, "cc", 2, big);
    }
    return (size_t)(at - out);
}

static void test_binary(void)
{
    unsigned char bytes[1000];
    for (int big = 0; big < 2; big++) {
        size_t size = make_binary(bytes, big);
        check_mesh(read_bytes(bytes, size));
        for (size_t end = 0; end < size; end++) {
            CHECK(read_bytes(bytes, end) == MESO_ERR_INPUT);
        }
        CHECK(strcmp(error.message, "t.ply: file ends in face 2 of 2") == 0);
        bytes[size] = 'x';
        CHECK(read_bytes(bytes, size + 1) == MESO_ERR_INPUT);
        CHECK(strcmp(error.message, "t.ply: 1 bytes more than the header counts") == 0);
        size_t last = size - 2 - 4 * 4 - 1;     /* the count of the last face */
        bytes[last] = 3;
        CHECK(read_bytes(bytes, size) == MESO_ERR_INPUT);
        bytes[last] = 4;
        bytes[size - 3 - (big ? 0 : 3)] = 6;    /* its last index */
        CHECK(read_bytes(bytes, size) == MESO_ERR_INPUT);
        CHECK(strcmp(error.message, "t.ply: face 2 uses vertex 7 of 6") == 0);
    }
}

/* Layouts that OpenMesh does not know: faces first, a list in the vertices, unusual counts, integers. */
static void test_foreign(void)
{
    const char *faces_first = "ply\nformat ascii 1.0\nelement face 2\nproperty list ushort int vertex_indices\n"
        "element vertex 6\nproperty float x\nproperty list uchar int q\nproperty float y\nproperty float z\n"
        "end_header\n4 0 1 2 3\n4 1 4 5 2\n0 0 0 0\n2 1 7 0 0\n2 0 2 0\n0 0 2 0\n2 2 7 8 0 2\n2 0 2 2.25\n";
    check_mesh(read_bytes(faces_first, strlen(faces_first)));
    static const char integers[] = "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty char x\n"
        "property char y\nproperty uchar z\nelement face 1\nproperty list uchar char vertex_index\nend_header\n"
        "\0\0\0" "\1\0\0" "\1\377\0" "\0\377\377" "\4\0\1\2\3";
    CHECK(read_bytes(integers, sizeof integers - 1) == MESO_OK);
    CHECK(mesh.positions[3].y == -1 && mesh.positions[3].z == 255 && mesh.face_vertices[3] == 3);
}

static void test_not_finite(void)
{
    unsigned char bytes[1000];
    size_t size = make_binary(bytes, false);
    unsigned char *vertices = bytes + size - 2 * (1 + 16 + 2) - 2 * 8 - 6 * (1 + 12);
    const float infinity = INFINITY;
    memcpy(vertices + 13 + 1 + 4, &infinity, 4);
    CHECK(read_bytes(bytes, size) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "t.ply: vertex 2 is not finite") == 0);
}

#define VERTEX "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
#define FACE "element face 2\nproperty list uchar int vertex_indices\n"
#define ASCII "ply\nformat ascii 1.0\n"

static void test_header(void)
{
    check_message("plx\n", "t.ply:1: not a PLY file: the first line is not 'ply'");
    check_message("ply\nformat ascii 2.0\n", "t.ply:2: format 'ascii 2.0' is not ascii, binary_little_endian or "
                  "binary_big_endian 1.0");
    check_message(ASCII "format ascii 1.0\n", "t.ply:3: format comes twice");
    check_message(ASCII VERTEX FACE, "t.ply:9: file ends in the header");
    check_message("ply\n" VERTEX FACE "end_header\n", "t.ply: header has no format line");
    check_message(ASCII "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n",
                  "t.ply: mesh has no faces");
    check_message(ASCII FACE "end_header\n", "t.ply: mesh has no element 'vertex'");
    check_message(ASCII VERTEX VERTEX, "t.ply:7: element 'vertex' comes twice");
    check_message(ASCII "element vertex -1\n", "t.ply:3: count '-1' of the element is not a number of items");
    check_message(ASCII "element vertex 4294967295\n", "t.ply:3: count 4294967295 of the element is too large");
    check_message(ASCII "element vertex 99999999999999999999\n",
                  "t.ply:3: count 99999999999999999999 of the element is too large");
    check_message(ASCII "element a 4000000000\n" VERTEX FACE "end_header\n", "t.ply: element 'a' has no properties");
    check_message(ASCII "property float x\n", "t.ply:3: property before the first element");
    check_message(ASCII VERTEX "property float x\n", "t.ply:7: property 'x' comes twice");
    check_message(ASCII VERTEX "property list uchar float nx\n", "t.ply:7: property 'nx' must not be a list");
    check_message(ASCII VERTEX "property half q\n", "t.ply:7: unknown type 'half' of a property");
    check_message(ASCII VERTEX "property float\n", "t.ply:7: property without a name");
    check_message(ASCII "element face 1\nproperty list float int vertex_indices\n",
                  "t.ply:4: count of a list is not an integer");
    check_message(ASCII "element face 1\nproperty list uchar float vertex_indices\n",
                  "t.ply:4: vertex indices are not integers");
    check_message(ASCII "element face 1\nproperty int vertex_indices\n",
                  "t.ply:4: property 'vertex_indices' must be a list");
    check_message(ASCII "element vertex 1\nproperty float x\n" FACE "end_header\n",
                  "t.ply: vertices lack a property x, y or z");
    check_message(ASCII VERTEX "element face 1\nproperty int a\nend_header\n",
                  "t.ply: faces lack the list vertex_indices");
    check_message(ASCII "elements\n", "t.ply:3: unknown statement 'elements' in the header");
}

static void test_body(void)
{
    check_message(HEADER "0 0\n", "t.ply:10: vertex 1 has too few values");
    check_message(HEADER "0 0 0 0\n", "t.ply:10: vertex 1 has too many values");
    check_message(HEADER "0 0 nan\n", "t.ply:10: value 'nan' is not a finite number");
    check_message(HEADER "0 0 0\n", "t.ply:11: file ends before vertex 2 of 6");
    check_message(HEADER VERTICES "4 0 1 2 3\n", "t.ply:17: file ends before face 2 of 2");
    check_message(HEADER VERTICES "4 0 1 2 3\n3 0 1 2\n",
                  "t.ply:17: face 2 has 3 sides; every face of a macrosurface must be a quad: meso-mesh quads makes them");
    check_message(HEADER VERTICES "4 0 1 2 -3\n", "t.ply:16: face 1 has a negative vertex index");
    check_message(HEADER VERTICES "4 0 1 2 1.5\n", "t.ply:16: value '1.5' is not an integer");
    check_message(HEADER VERTICES "4 0 1 2 6\n4 1 4 5 2\n", "t.ply:16: face 1 uses vertex 7 of 6");
    check_message(HEADER VERTICES "4 0 1 2 5000000000\n", "t.ply:16: face 1 has a vertex index that is too large");
    check_message(HEADER VERTICES "-4 0 1 2 3\n", "t.ply:16: face 1 has a list of negative length");
    check_message(HEADER BODY "0 0 0\n", "t.ply:18: more lines than the header counts");
    check_message(ASCII "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face 4000000000\nproperty list uchar int vertex_indices\nend_header\n",
                  "t.ply:10: file ends before vertex 1 of 4000000000");
}

/* All of "kind" have names, one of them none; not all of "part"; "x y" is no property. */
static const char *named =
    "ply\r\nformat ascii 1.0\r\ncomment kind 0 left side\r\ncomment part 0 p\r\ncomment kind 2 later\r\ncomment kind 1 \r\n"
    "comment x y z\r\ncomment kind\r\ncomment kind 99999999999 z\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\n"
    "property float z\r\nelement face 3\r\nproperty list uchar int vertex_indices\r\nproperty int kind\r\nproperty int part\r\n"
    "end_header\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n3 0 1 2 1 0\r\n3 0 2 3 0 1\r\n3 2 1 0 -1 0\r\n";

static void test_names(void)
{
    MesoPolygonMesh polygons;
    MesoInput input;
    meso_input_wrap(&input, "t.ply", named, strlen(named));
    CHECK(meso_ply_read(&polygons, &arena, &input, 1, &error) == MESO_OK);
    const MesoAttribute *kind = meso_polygon_attribute(&polygons, "kind");
    const MesoAttribute *part = meso_polygon_attribute(&polygons, "part");
    CHECK(kind && kind->width == 0 && kind->entry_count == 2 && strcmp(kind->names[0], "left side") == 0);
    CHECK(strcmp(kind->names[kind->entry_of[0]], "") == 0 && kind->entry_of[1] == 0 &&
          kind->entry_of[2] == MESO_NO_INDEX);
    CHECK(part && part->width == 1 && meso_attribute_number(part, 1, 0) == 1);
}

int main(void)
{
    meso_arena_init(&arena);
    test_ascii();
    test_normals();
    test_binary();
    test_foreign();
    test_not_finite();
    test_header();
    test_body();
    test_names();
    meso_arena_release(&arena);
    return 0;
}
