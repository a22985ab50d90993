/*
 * Files of many pieces: the same mesh and the same first error on one thread and on several, the mesh that was
 * written, and what OpenMesh reads. What files say of a mesh beside its shape, kind by kind.
 */
#include "formats/mesh/mesh_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/mesh/openmesh_adapter.h"
#include "libcore/base/check.h"
#include "libcore/base/random.h"

enum { SIDE = 170, ROW = SIDE + 1, VERTICES = ROW * ROW, FACES = SIDE * SIDE, TEXT = 1 << 23 };

static MesoArena arena;
static MesoError error;
static MesoPolygonMesh mesh;
static char text[TEXT];

static MesoStatus read_bytes(const char *path, const void *bytes, size_t size, uint32_t threads)
{
    MesoInput input;
    meso_input_wrap(&input, path, bytes, size);
    return meso_polygon_mesh_read(&mesh, &arena, &input, threads, &error);
}

static MesoStatus read_text(const char *path, const char *bytes)
{
    return read_bytes(path, bytes, strlen(bytes), 1);
}

/* ---- large files ---- */

static float coordinate(uint32_t v, uint32_t axis)
{
    return (float[]){0.01f * (float)(v % ROW), 0.01f * (float)(v / ROW), sinf(0.1f * (float)v)}[axis];
}

/* A quad, or a triangle in each tenth face; vertex k of face f. */
static uint32_t sides_of(uint32_t f)
{
    return f % 10 == 3 ? 3 : 4;
}

static uint32_t corner_of(uint32_t f, uint32_t k)
{
    uint32_t first = f / SIDE * ROW + f % SIDE;
    return (uint32_t[]){first, first + 1, first + 1 + ROW, first + ROW}[k];
}

/* Statements of all kinds, some of them joined, some indices from behind, a name each 500 faces. */
static size_t write_obj(char *out)
{
    char *at = out;
    for (uint32_t v = 0; v < VERTICES; v++)
        at += sprintf(at, v % 100 ? "v %.9g %.9g %.9g\n" : "v %.9g \\\n %.9g %.9g # joined\n", (double)coordinate(v, 0),
                      (double)coordinate(v, 1), (double)coordinate(v, 2));
    for (uint32_t f = 0; f < FACES; f++) {
        if (f % 500 == 0)
            at += sprintf(at, "g part%u of\t%u\n", f / 500 % 7, f / 500 % 3);
        at += sprintf(at, "f");
        for (uint32_t k = 0; k < sides_of(f); k++)
            at += sprintf(at, f % 9 ? " %d" : " %d/",
                          f % 8 ? (int)corner_of(f, k) + 1 : (int)corner_of(f, k) - VERTICES);
        *at++ = '\n';
    }
    return (size_t)(at - out);
}

static size_t write_ply(char *out)
{
    char *at = out + sprintf(out, "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty double z\n"
                             "property int number\nelement face %d\nproperty uchar part\nproperty list uchar int vertex_indices\n"
                             "end_header\n", VERTICES, FACES);
    for (uint32_t v = 0; v < VERTICES; v++)
        at += sprintf(at, "%.9g %.9g %.9g %u\n", (double)coordinate(v, 0), (double)coordinate(v, 1),
                      (double)coordinate(v, 2), v);
    for (uint32_t f = 0; f < FACES; f++) {
        at += sprintf(at, "%u  %u", f % 250, sides_of(f));
        for (uint32_t k = 0; k < sides_of(f); k++)
            at += sprintf(at, " %u", corner_of(f, k));
        *at++ = '\n';
    }
    return (size_t)(at - out);
}

static size_t write_off(char *out)
{
    char *at = out + sprintf(out, "OFF\n%d %d 0\n", VERTICES, FACES);
    for (uint32_t v = 0; v < VERTICES; v++)
        at += sprintf(at, "%.9g %.9g %.9g\n", (double)coordinate(v, 0), (double)coordinate(v, 1),
                      (double)coordinate(v, 2));
    for (uint32_t f = 0; f < FACES; f++) {
        at += sprintf(at, "%u", sides_of(f));
        for (uint32_t k = 0; k < sides_of(f); k++)
            at += sprintf(at, " %u", corner_of(f, k));
        *at++ = '\n';
    }
    return (size_t)(at - out);
}

/* Each list may be as long as the others, or not: they lie elsewhere in the file. */
static size_t write_binary(char *out, bool big, bool all_quads)
{
    char *at = out + sprintf(out, "ply\nformat binary_%s_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                             "property float z\nproperty int number\nelement face %d\nproperty list uchar int vertex_indices\n"
                             "property uchar part\nend_header\n", big ? "big" : "little", VERTICES, FACES);
    for (uint32_t v = 0; v < VERTICES; v++)
        for (uint32_t i = 0; i < 4; i++, at += 4) {
            float number = i < 3 ? coordinate(v, i) : 0;
            uint32_t bits = v;
            if (i < 3)
                memcpy(&bits, &number, 4);
            bits = big ? __builtin_bswap32(bits) : bits;
            memcpy(at, &bits, 4);
        }
    for (uint32_t f = 0; f < FACES; f++) {
        uint32_t sides = all_quads ? 4 : sides_of(f);
        *at++ = (char)sides;
        for (uint32_t k = 0; k < sides; k++, at += 4) {
            uint32_t bits = big ? __builtin_bswap32(corner_of(f, k)) : corner_of(f, k);
            memcpy(at, &bits, 4);
        }
        *at++ = (char)(f % 250);
    }
    return (size_t)(at - out);
}

static void check_mesh(bool all_quads)
{
    CHECK(mesh.vertex_count == VERTICES && mesh.face_count == FACES && mesh.side_count == (all_quads ? 4 : 0));
    for (uint32_t v = 0; v < VERTICES; v++)
        CHECK(mesh.positions[v].x == coordinate(v, 0) && mesh.positions[v].y == coordinate(v, 1) &&
              mesh.positions[v].z == coordinate(v, 2));
    for (uint32_t f = 0; f < FACES; f++) {
        uint32_t begin = meso_polygon_begin(&mesh, f), sides = meso_polygon_sides(&mesh, f);
        CHECK(sides == (all_quads ? 4 : sides_of(f)));
        for (uint32_t k = 0; k < sides; k++)
            CHECK(mesh.corners[begin + k] == corner_of(f, k));
    }
}

static void check_numbers(void)
{
    const MesoAttribute *number = meso_polygon_attribute_on(&mesh, "number", MESO_ON_VERTICES);
    const MesoAttribute *part = meso_polygon_attribute_on(&mesh, "part", MESO_ON_FACES);
    CHECK(number && number->scalar == MESO_SCALAR_INT32 && part && part->scalar == MESO_SCALAR_UINT8);
    for (uint32_t v = 0; v < VERTICES; v += 7)
        CHECK(meso_attribute_number(number, v, 0) == v);
    for (uint32_t f = 0; f < FACES; f++)
        CHECK(meso_attribute_number(part, f, 0) == f % 250);
}

static void check_names(void)
{
    const MesoAttribute *group = meso_polygon_attribute(&mesh, "group");
    char name[100];
    CHECK(group && group->width == 0 && group->entry_count == 21);
    for (uint32_t f = 0; f < FACES; f++) {
        snprintf(name, sizeof name, "part%u of %u", f / 500 % 7, f / 500 % 3);
        CHECK(strcmp(group->names[group->entry_of[f]], name) == 0);
    }
}

typedef struct Theirs {
    uint32_t vertices, faces;
} Theirs;

static void compare_vertex(void *context, float x, float y, float z)
{
    Theirs *theirs = context;
    MesoVec3 p = mesh.positions[theirs->vertices++];
    CHECK(fabsf(x - p.x) <= 1e-6f * fabsf(p.x) && fabsf(y - p.y) <= 1e-6f * fabsf(p.y) &&
          fabsf(z - p.z) <= 1e-6f * fabsf(p.z));
}

static void compare_face(void *context, const uint32_t *vertices, uint32_t count)
{
    Theirs *theirs = context;
    uint32_t f = theirs->faces++;
    CHECK(count == meso_polygon_sides(&mesh, f));
    CHECK(memcmp(vertices, mesh.corners + meso_polygon_begin(&mesh, f), count * sizeof *vertices) == 0);
}

static void compare_openmesh(MesoOpenMeshKind kind, size_t size)
{
    Theirs theirs = {0};
    MesoOpenMeshSink sink = {&theirs, compare_vertex, compare_face};
    CHECK(meso_openmesh_read(kind, text, size, &sink, &error) == MESO_OK);
    CHECK(theirs.vertices == mesh.vertex_count && theirs.faces == mesh.face_count);
}

static void test_large_obj(void)
{
    size_t size = write_obj(text);
    for (uint32_t threads = 1; threads <= 3; threads++) {
        CHECK(read_bytes("a.obj", text, size, threads) == MESO_OK);
        check_mesh(false);
        check_names();
    }
}

static void test_large_text(void)
{
    for (uint32_t threads = 1; threads <= 3; threads++) {
        CHECK(read_bytes("a.ply", text, write_ply(text), threads) == MESO_OK);
        check_mesh(false);
        check_numbers();
        CHECK(read_bytes("a.off", text, write_off(text), threads) == MESO_OK);
        check_mesh(false);
    }
    compare_openmesh(MESO_OPENMESH_OFF, write_off(text));
}

static void test_large_binary(void)
{
    for (uint32_t form = 0; form < 4; form++)
        for (uint32_t threads = 1; threads <= 3; threads++) {
            size_t size = write_binary(text, form % 2, form / 2);
            CHECK(read_bytes("a.ply", text, size, threads) == MESO_OK);
            check_mesh(form / 2);
            check_numbers();
            compare_openmesh(MESO_OPENMESH_PLY, size);
        }
}

/* Something wrong here and there: on any number of threads the first is told, with its line. */
static void test_first_error(void)
{
    static size_t (*const writers[])(char *) = {write_obj, write_ply, write_off};
    static const char *const paths[] = {"a.obj", "a.ply", "a.off"};
    MesoRandom random;
    meso_random_init(&random, 2, 0);
    for (uint32_t round = 0; round < 30; round++) {
        char expected[200];
        size_t size = writers[round % 3](text), first = size;
        uint32_t line = 1;
        for (uint32_t i = 0; i < 6; i++) {
            size_t at = size / 10 + meso_random_below(&random, (uint32_t)(size - size / 10));
            while (text[at] < '1' || text[at] > '9')
                at--;
            text[at] = '?';
            first = at < first ? at : first;
        }
        for (size_t i = 0; i < first; i++)
            line += text[i] == '\n';
        snprintf(expected, sizeof expected, "%s:%u: ", paths[round % 3], line);
        char message[sizeof error.message];
        for (uint32_t threads = 1; threads <= 3; threads++) {
            CHECK(read_bytes(paths[round % 3], text, size, threads) == MESO_ERR_INPUT);
            if (threads > 1)
                CHECK(strcmp(message, error.message) == 0);
            memcpy(message, error.message, sizeof message);
        }
        bool joined = round % 3 == 0 && strncmp(message, expected, strlen(expected)) != 0;
        CHECK(joined || strncmp(message, expected, strlen(expected)) == 0);
    }
}

/* ---- what files say beside shapes ---- */

static void test_obj_attributes(void)
{
    CHECK(read_text("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 .5 .5 .5\nvt 0 0\nvt 1 0\nvt 1 1 0.5\n"
                    "vn 0 0 2\nusemtl moss\nf 1/1/1 2/2/1 3/3/-1\ng\no  top   side \nf 1/1 3//1 4\n") == MESO_OK);
    const MesoAttribute *normal = meso_polygon_normals(&mesh), *uv = meso_polygon_attribute(&mesh, "uv");
    const MesoAttribute *color = meso_polygon_attribute(&mesh, "color");
    const MesoAttribute *material = meso_polygon_attribute(&mesh, "material");
    const MesoAttribute *object = meso_polygon_attribute(&mesh, "object");
    const MesoAttribute *group = meso_polygon_attribute(&mesh, "group");
    CHECK(normal->domain == MESO_ON_CORNERS && normal->entry_count == 1 && normal->entry_of[4] == 0 &&
          normal->entry_of[5] == MESO_NO_INDEX && meso_attribute_vec3(normal, 0).z == 2);
    CHECK(uv->width == 2 && uv->entry_count == 3 && uv->entry_of[2] == 2 && uv->entry_of[4] == MESO_NO_INDEX);
    CHECK(color->domain == MESO_ON_VERTICES && meso_attribute_number(color, 3, 1) == 0.5 &&
          strcmp(color->components[2], "blue") == 0);
    CHECK(strcmp(material->names[material->entry_of[1]], "moss") == 0);
    CHECK(object->entry_of[0] == MESO_NO_INDEX && strcmp(object->names[object->entry_of[1]], "top side") == 0);
    CHECK(group->entry_of[0] == MESO_NO_INDEX && strcmp(group->names[group->entry_of[1]], "") == 0);
    CHECK(mesh.side_count == 3 && !mesh.face_begin);

    /* one vertex without a colour, a texture coordinate that is none: these are left out */
    CHECK(read_text("a.obj", "v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0 1 1 1\nvt x\nf 1/1 2/1 3/1\n") == MESO_OK);
    CHECK(!meso_polygon_attribute(&mesh, "color") && !meso_polygon_attribute(&mesh, "uv"));
    CHECK(read_text("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1//1 2//1 3//1\n") == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "a.obj:4: face 1 uses normal 1 of 0") == 0);
    CHECK(read_text("a.obj", "vt 1 2 3\nvt 4 5\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1 2/2 3/1\n") == MESO_OK);
    CHECK(meso_polygon_attribute(&mesh, "uv")->width == 3);
}

#define PLY_HEAD "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
#define PLY_FACE "element face 1\nproperty list uchar int vertex_indices\n"

static void test_ply_attributes(void)
{
    CHECK(read_text("a.ply", PLY_HEAD "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty double u\n"
                    "property double v\nproperty short wind_x\nproperty short wind_y\nproperty short wind_z\nproperty int8 age\n"
                    PLY_FACE "property list uchar float texcoord\nproperty ushort fieldx\nproperty ushort fieldy\n"
                    "property ushort fieldz\nend_header\n0 0 0 255 0 51 .1 .2 1 2 -3 -128\n1 0 0 0 0 0 1 0 0 0 0 1\n"
                    "1 1 0 0 0 0 1 1 0 0 0 1\n3 0 1 2 6 0 0 1 0 1 1 9 8 7\n") == MESO_OK);
    const MesoAttribute *color = meso_polygon_attribute(&mesh, "color"), *wind = meso_polygon_attribute(&mesh, "wind");
    const MesoAttribute *uv = meso_polygon_attribute_on(&mesh, "uv", MESO_ON_VERTICES), *field = meso_polygon_attribute(&mesh, "field");
    const MesoAttribute *corner = meso_polygon_attribute_on(&mesh, "uv", MESO_ON_CORNERS), *age = meso_polygon_attribute(&mesh, "age");
    CHECK(color->width == 3 && color->normalized && color->scalar == MESO_SCALAR_UINT8 &&
          meso_attribute_number(color, 0, 2) == 51 * (1.0 / 255));
    CHECK(uv->scalar == MESO_SCALAR_DOUBLE && meso_attribute_number(uv, 0, 0) == 0.1 &&
          strcmp(uv->components[1], "v") == 0);
    CHECK(wind->scalar == MESO_SCALAR_INT16 && meso_attribute_number(wind, 0, 2) == -3 &&
          strcmp(wind->components[0], "wind_x") == 0);
    CHECK(field->domain == MESO_ON_FACES && field->width == 3 && meso_attribute_number(field, 0, 1) == 8);
    CHECK(corner->entry_count == 3 && meso_attribute_vec2(corner, 2).y == 1 && corner->scalar == MESO_SCALAR_FLOAT);
    CHECK(age->scalar == MESO_SCALAR_INT8 && meso_attribute_number(age, 0, 0) == -128);

    CHECK(read_text("a.ply", PLY_HEAD "property char nx\nproperty float ny\nproperty double nz\nproperty float red\n" PLY_FACE
                    "property list uchar float texcoord\nend_header\n0 0 0 1 .5 .25 2\n1 0 0 0 0 1 2\n1 1 0 0 0 1 2\n3 0 1 2 4 0 0 1 0\n") ==
          MESO_OK);
    CHECK(meso_polygon_normals(&mesh)->scalar == MESO_SCALAR_FLOAT &&
          meso_attribute_vec3(meso_polygon_normals(&mesh), 0).z == 0.25f);
    CHECK(!meso_polygon_attribute(&mesh, "uv") && meso_polygon_attribute(&mesh, "red")->width == 1);
    CHECK(read_text("a.ply", PLY_HEAD "property uchar a\n" PLY_FACE "end_header\n0 0 0 256\n1 0 0 0\n1 1 0 0\n3 0 1 2\n") == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "a.ply:11: value '256' is beyond its type") == 0);
}

/* Lists of as many numbers for each corner are corners'; others are passed over. */
static void test_ply_lists(void)
{
    CHECK(read_text("a.ply", PLY_HEAD "element face 2\nproperty list uchar uchar before\nproperty list uchar int vertex_indices\n"
                    "property list uchar short pair\nproperty list int float other\nproperty uchar age\n"
                    "property list uchar uchar color\nproperty list uchar float empty\nend_header\n0 0 0\n1 0 0\n1 1 0\n"
                    "3 7 8 9 3 0 1 2 6 1 2 3 4 5 -6 3 1 1 1 33 9 255 0 0 0 255 0 0 0 255 0\n"
                    "3 4 5 6 3 0 2 1 6 7 8 9 10 11 12 1 1 44 9 0 0 0 0 0 0 0 0 51 0\n") == MESO_OK);
    const MesoAttribute *before = meso_polygon_attribute(&mesh, "before");
    const MesoAttribute *pair = meso_polygon_attribute(&mesh, "pair");
    const MesoAttribute *color = meso_polygon_attribute(&mesh, "color"), *age = meso_polygon_attribute(&mesh, "age");
    CHECK(before && before->domain == MESO_ON_CORNERS && before->width == 1 && !before->normalized &&
          mesh.attribute_count == 4);
    CHECK(meso_attribute_number(before, 0, 0) == 7 && meso_attribute_number(before, 5, 0) == 6);
    CHECK(pair->width == 2 && meso_attribute_number(pair, 2, 1) == -6 && meso_attribute_number(pair, 3, 0) == 7);
    CHECK(color->width == 3 && color->normalized && meso_attribute_number(color, 5, 2) == 51 * (1.0 / 255));
    CHECK(age->domain == MESO_ON_FACES && meso_attribute_number(age, 1, 0) == 44);
}

#define BINARY_HEAD "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty char x\nproperty char y\n" \
    "property char z\nelement face 2\nproperty list uchar uchar vertex_indices\nproperty list uchar short pair\n" \
    "property list uchar uchar other\nend_header\n\0\0\0\1\0\0\1\1\0\0\1\0"

/* The same in binary, with faces of one size, and of two. */
static void test_binary_lists(void)
{
    static const char same[] = BINARY_HEAD "\3\0\1\2" "\6\1\0\2\0\3\0\4\0\5\0\6\0" "\0"
                               "\3\0\2\3" "\6\7\0\10\0\11\0\12\0\13\0\14\0" "\0";
    static const char mixed[] = BINARY_HEAD "\3\0\1\2" "\3\1\0\2\0\3\0" "\0" "\4\0\1\2\3" "\4\4\0\5\0\6\0\7\0" "\1\1";
    CHECK(read_bytes("a.ply", same, sizeof same - 1, 1) == MESO_OK && mesh.side_count == 3 &&
          mesh.attribute_count == 1);
    const MesoAttribute *pair = mesh.attributes;
    CHECK(pair->width == 2 && meso_attribute_number(pair, 2, 1) == 6 && meso_attribute_number(pair, 5, 0) == 11);
    CHECK(read_bytes("a.ply", mixed, sizeof mixed - 1, 1) == MESO_OK && mesh.side_count == 0 &&
          mesh.attribute_count == 1);
    pair = mesh.attributes;
    CHECK(pair->domain == MESO_ON_CORNERS && pair->width == 1 && pair->entry_count == 7);
    CHECK(meso_attribute_number(pair, 2, 0) == 3 && meso_attribute_number(pair, 6, 0) == 7);
}

/* Numbers of items that the header cannot mean, negative lists, indices and normals that cannot be. */
static void test_binary_refusals(void)
{
    static const char head[] = "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty char x\nproperty char y\nproperty char z\n"
                               "property float nx\nproperty float ny\nproperty float nz\n"
                               "element face %s\nproperty list %s %s vertex_index\nend_header\n";
    static const char vertices[] = "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0" "\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0" "\1\1\0\0\0\0\0\0\0\0\0\0\0\0\0";
    const struct {
        const char *count, *list, *index, *faces;
        size_t size;
        const char *message;
    } rows[] = {
        {"1", "char", "char", "\3\0\1\2", 4, NULL},
        {"1", "char", "char", "\3\0\1\377", 4, "a.ply: face 1 has a negative vertex index"},
        {"2", "char", "char", "\3\0\1\2\377", 5, "a.ply: face 2 has a list of negative length"},
        {"1", "char", "uint", "\3\0\0\0\0\377\377\377\377\0\0\0\0", 13,
         "a.ply: face 1 has a vertex index that is too large"},
        {"4000000000", "uchar", "uchar", "\3\0\1\2\3\0", 6, "a.ply: file ends in face 2 of 4000000000"},
        {"1", "uint", "uchar", "\377\377\377\377\0", 5, "a.ply: file ends in face 1 of 1"},
        {"1", "uchar", "uchar", "\2\0\1", 3, "a.ply: face 1 has 2 sides; a face has at least 3"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *at = text + sprintf(text, head, rows[i].count, rows[i].list, rows[i].index);
        memcpy(at, vertices, sizeof vertices - 1);
        memcpy(at + sizeof vertices - 1, rows[i].faces, rows[i].size);
        MesoStatus status = read_bytes("a.ply", text, (size_t)(at - text) + sizeof vertices - 1 + rows[i].size, 2);
        if (rows[i].message && strcmp(rows[i].message, error.message) != 0)
            fprintf(stderr, "got '%s'\n", error.message);
        CHECK(status == (rows[i].message ? MESO_ERR_INPUT : MESO_OK) &&
              (!status || strcmp(error.message, rows[i].message) == 0));
        at[15 + 3] = 0x7f;
        at[15 + 4] = (char)0x80;
        CHECK(read_bytes("a.ply", text, (size_t)(at - text) + sizeof vertices - 1 + rows[i].size, 2) == MESO_ERR_INPUT);
        CHECK(strcmp(error.message, "a.ply: vertex 2 has a normal that is not finite") == 0);
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_obj_attributes();
    test_ply_attributes();
    test_ply_lists();
    test_binary_lists();
    test_binary_refusals();
    test_large_obj();
    test_large_text();
    test_large_binary();
    test_first_error();
    meso_arena_release(&arena);
    return 0;
}
