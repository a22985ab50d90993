/* Kinds of files by name and content, glTF, triangles for inner meshes. */
#include <math.h>

#include "formats/mesh/surface_read_fixture.h"

static MesoTriangleMesh triangles;

static MesoStatus read(const char *path, const char *text)
{
    return read_file(path, text, strlen(text));
}

static MesoStatus read_triangles(const char *path, const char *text)
{
    MesoInput input;
    meso_input_wrap(&input, path, text, strlen(text));
    return meso_triangle_mesh_read(&triangles, &arena, &input, 1, &error);
}

#define OBJ "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
#define OFF "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"
#define PLY "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" \
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n" \
            "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"

static void test_kinds(void)
{
    CHECK(read("a.b/c.OBJ", OBJ) == MESO_OK && read("-", OBJ) == MESO_OK && read("x.txt", " \n" OBJ) == MESO_OK);
    CHECK(read("a.Off", OFF) == MESO_OK && read("obj.d/a", OFF) == MESO_OK);
    CHECK(read(".ply", PLY) == MESO_OK && read("/dev/fd/63", PLY) == MESO_OK);
    CHECK(read("a.obj", PLY) == MESO_ERR_INPUT && read("a.ply", OBJ) == MESO_ERR_INPUT);
    check_refused("a.stl", "solid\nfacet\n", "a.stl: not a mesh; OBJ, PLY, OFF, glTF and Draco are read");
    check_refused("a.obj", "", "a.obj: empty file");
    check_refused("a", "", "a: empty file");
    check_refused("a", "\n\n", "a: not a mesh; OBJ, PLY, OFF, glTF and Draco are read");
}

/* `text` with a byte order mark, or with line ends as they once were; in a buffer of its own. */
static const char *marked(const char *text)
{
    static char bytes[1010];
    snprintf(bytes, sizeof bytes, "\xef\xbb\xbf%s", text);
    return bytes;
}

static char *returned(const char *text)
{
    static char bytes[1000];
    snprintf(bytes, sizeof bytes, "%s", text);
    for (char *c = bytes; *c; c++)
        *c = *c == '\n' ? '\r' : *c;
    return bytes;
}

static void check_square(const char *path, const char *text)
{
    const MesoVec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    if (read(path, text))
        fprintf(stderr, "%s: %s\n", path, error.message);
    CHECK(read(path, text) == MESO_OK);
    CHECK(mesh.vertex_count == 4 && mesh.face_count == 1 && memcmp(mesh.positions, corners, sizeof corners) == 0);
}

static void test_marks_and_returns(void)
{
    static const char *const names[][3] = {{"a.obj", "-", OBJ}, {"a.off", "-", OFF}, {"a.ply", "-", PLY}};
    for (int kind = 0; kind < 3; kind++)
        for (int name = 0; name < 2; name++) {
            check_square(names[kind][name], names[kind][2]);
            check_square(names[kind][name], marked(names[kind][2]));
            check_square(names[kind][name], returned(names[kind][2]));
            check_square(names[kind][name], marked(returned(names[kind][2])));
        }
    check_square("a.obj", "# one line\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n");
    check_refused("a.obj", "v 0 0 0\rv 1 x 0\r", "a.obj:2: coordinate 'x' is not a finite number");
}

/* Bytes behind the header that look like line ends, 0x0a0d0d0a among them, stay. */
static void test_binary_ply_returns(void)
{
    char bytes[1200], *at = bytes;
    const float floats[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const uint32_t face[4] = {0, 1, 2, 3}, mark = 0x0a0d0d0a;
    float odd;
    memcpy(&odd, &mark, sizeof odd);
    at += sprintf(at, "%s", returned("ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
                                     "property float y\nproperty float z\nelement face 1\n"
                                     "property list uchar int vertex_indices\nend_header\n"));
    memcpy(at, floats, sizeof floats);
    memcpy(at + 8, &odd, sizeof odd);
    at += sizeof floats;
    *at++ = 4;
    memcpy(at, face, sizeof face);
    at += sizeof face;
    CHECK(read_file("a.ply", bytes, (size_t)(at - bytes)) == MESO_OK);
    CHECK(mesh.face_count == 1 && mesh.positions[0].z == odd && mesh.positions[1].x == 1);
}

#define REFUSAL ": mesh has no faces"

/* Header, length, then a JSON chunk of 28 bytes. */
static const unsigned char glb[] =
    "glTF\2\0\0\0\60\0\0\0" "\34\0\0\0JSON" "{\"asset\":{\"version\":\"2.0\"}} ";

static void test_gltf(void)
{
    CHECK(read_file("a.glb", glb, sizeof glb - 1) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "a.glb" REFUSAL) == 0);
    for (size_t size = 1; size < sizeof glb - 1; size++) {
        CHECK(read_file("a.glb", glb, size) == MESO_ERR_INPUT);
        CHECK(strncmp(error.message, "a.glb: broken glTF: ", 20) == 0);
    }
    check_refused("a.gltf", "{\"asset\":{\"version\":\"2.0\"}}", "a.gltf" REFUSAL);
    CHECK(read("a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":4,\"uri\":\"/etc/passwd\"}]}") ==
          MESO_ERR_INPUT);
    CHECK(strstr(error.message, "broken glTF"));
    CHECK(read_triangles("a.glb", "{}") == MESO_ERR_INPUT);
}

/* Brackets that would exhaust the stack of a reader that recurses; in a string they are none. */
static void test_deep_gltf(void)
{
    enum { DEPTH = 1000000 };
    static char text[2 * DEPTH + 100];
    char *at = text + sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"extras\":");
    memset(at, '[', DEPTH);
    memset(at + DEPTH, ']', DEPTH);
    strcpy(at + 2 * DEPTH, "}");
    check_refused("a.gltf", text, "a.gltf: broken glTF: nested more than 200 deep");
    check_refused("a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"extras\":\"\\\"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["
                  "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["
                  "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["
                  "\"}", "a.gltf" REFUSAL);
}

/* A pentagon and a triangle over one edge; the edge's vertices have two normals each. */
static void test_split(void)
{
    CHECK(read_triangles("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 9 9 9\nv .5 2 0\nv 0 1 0\nv .5 -1 1\n"
                         "vn 0 0 4\nvn 0 1 0\nf 1//1 2//1 3//1 5//1 6//1\nf 2//2 1//2 7//2\n") == MESO_OK);
    CHECK(triangles.vertex_count == 8 && triangles.triangle_count == 4);
    const float expected[8][2] = {{0, 0}, {0, 0}, {1, 0}, {1, 0}, {1, 1}, {.5f, 2}, {0, 1}, {.5f, -1}};
    for (int v = 0; v < 8; v++)
        CHECK(triangles.positions[v].x == expected[v][0] && triangles.positions[v].y == expected[v][1]);
    const uint32_t fans[12] = {0, 2, 4, 0, 4, 5, 0, 5, 6, 3, 1, 7};
    CHECK(memcmp(triangles.triangles, fans, sizeof fans) == 0);
    for (int v = 0; v < 8; v++) {
        bool second = v == 1 || v == 3 || v == 7;
        CHECK(triangles.normals[v].z == (second ? 0 : 1) && triangles.normals[v].y == (second ? 1 : 0));
    }
}

/* A right angle of a square and a triangle of half its area; no normals, or one of length 0. */
static void test_vertex_normals(void)
{
    const char *texts[2] = {
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf 2 1 5\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvn 0 0 0\nf 1//1 2//1 3//1 4//1\nf 2 1 5//1\n",
    };
    for (int i = 0; i < 2; i++) {
        CHECK(read_triangles("a.obj", texts[i]) == MESO_OK);
        CHECK(triangles.vertex_count == 5 && triangles.triangle_count == 3);
        float length = sqrtf(1.25f);
        for (int v = 0; v < 5; v++) {
            MesoVec3 n = triangles.normals[v];
            MesoVec3 wanted = v < 2 ? (MesoVec3){0, 0.5f / length, 1 / length} : v < 4 ? (MesoVec3){0, 0, 1} : (MesoVec3){0, 1, 0};
            CHECK(meso_vec3_length(meso_vec3_sub(n, wanted)) < 1e-6f);
        }
    }
}

static void test_triangle_refusals(void)
{
    CHECK(read_triangles("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n") == MESO_ERR_INPUT);
    CHECK(read_triangles("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 2\n") == MESO_ERR_INPUT);
    CHECK(read_triangles("a.obj", "v 0 0 0\nv 1e20 0 0\nv 1 1 0\nf 1 2 3\n") == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "a.obj: vertex 2 lies beyond the largest coordinate, 1e+18") == 0);
    CHECK(read_triangles("a.obj", OBJ) == MESO_OK && triangles.triangle_count == 2);
}

/* Of every truncation, whatever it gives: nothing worse than an error. */
static void test_truncation(void)
{
    const char *texts[3] = {OBJ "vn 0 0 1\nf -4/1/-1 4//1 3/2/1 2\n", OFF, PLY};
    for (int i = 0; i < 3; i++)
        for (size_t size = 0; size <= strlen(texts[i]); size++) {
            char *copy = meso_arena_copy_text(&arena, texts[i], &error);
            MesoStatus status = read_file("a", copy, size);
            CHECK(status == MESO_OK || status == MESO_ERR_INPUT);
        }
}

int main(void)
{
    meso_arena_init(&arena);
    test_kinds();
    test_marks_and_returns();
    test_binary_ply_returns();
    test_gltf();
    test_deep_gltf();
    test_split();
    test_vertex_normals();
    test_triangle_refusals();
    test_truncation();
    meso_arena_release(&arena);
    return 0;
}
