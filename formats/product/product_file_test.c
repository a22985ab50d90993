/* Headers of products: what is recognised, what is found, and every truncation. */
#include "formats/product/product_file.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/check.h"

#define PROVENANCE "{\"tool\":\"meso-map\",\"seed\":5}"

/* String literals with zero bytes in them, and their length. */
#define BYTES(text) (text), sizeof(text) - 1

static json_t *describe(const char *bytes, size_t size, MesoProductKind kind, MesoStatus expected)
{
    MesoInput input;
    MesoError error;
    json_t *facts = json_object();
    char *copy = malloc(size + 1);     /* exact, so that a read beyond the end is noticed */
    CHECK(facts && copy);
    char *exact = realloc(copy, size ? size : 1);
    memcpy(exact, bytes, size);
    meso_input_wrap(&input, "file", exact, size);
    if (size > 8)
        CHECK(meso_product_recognise(&input) == kind);
    CHECK(meso_product_describe(facts, kind, &input, &error) == expected);
    free(exact);
    return facts;
}

/* Compares the facts with `expected`; the first `needed` bytes are the least that is read. */
static void expect(const char *bytes, size_t size, MesoProductKind kind, size_t needed,
                   const char *expected)
{
    json_t *facts = describe(bytes, size, kind, MESO_OK);
    json_t *wanted = json_loads(expected, 0, NULL);
    char *text = json_dumps(facts, JSON_COMPACT);
    CHECK(wanted);
    if (!json_equal(facts, wanted))
        fprintf(stderr, "%s\n", text);
    CHECK(json_equal(facts, wanted));
    free(text);
    json_decref(facts);
    json_decref(wanted);
    for (size_t cut = 0; cut < needed; cut++)
        json_decref(describe(bytes, cut, kind, MESO_ERR_INPUT));
}

static void test_exr(void)
{
    static const char file[] =
        "\x76\x2f\x31\x01\2\0\0\0"
        "channels\0chlist\0\x25\0\0\0" "A\0" "\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0"
        "R\0" "\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0" "\0"
        "dataWindow\0box2i\0\x10\0\0\0" "\2\0\0\0\3\0\0\0\x0b\0\0\0\x0c\0\0\0"
        "meso:provenance\0string\0\x1c\0\0\0" PROVENANCE
        "\0";
    expect(BYTES(file), MESO_PRODUCT_EXR, sizeof file - 1,
           "{\"width\": 10, \"height\": 10, \"provenance\": " PROVENANCE ", \"channels\": [\"A\", \"R\"]}");
}

static void test_png(void)
{
    static const char file[] =
        "\x89PNG\r\n\x1a\n"
        "\0\0\0\x0d" "IHDR" "\0\0\1\2\0\0\0\3\x08\6\0\0\0" "crc0"
        "\0\0\0\x30" "iTXt" "meso:provenance\0\0\0\0\0" PROVENANCE "crc1"
        "\0\0\0\0" "IEND" "crc2";
    expect(BYTES(file), MESO_PRODUCT_PNG, sizeof file - 1,
           "{\"width\": 258, \"height\": 3, \"provenance\": " PROVENANCE "}");
}

static void test_glb(void)
{
    static const char json[] =
        "{\"asset\": {\"generator\": \"g\", \"extras\": {\"provenance\":"
        " \"{\\\"tool\\\":\\\"meso-map\\\",\\\"seed\\\":5}\"}},"
        " \"accessors\": [{\"count\": 7}, {\"count\": 12}], \"materials\": [{}],"
        " \"meshes\": [{\"primitives\": [{\"indices\": 1}, {\"indices\": 9}, {}]}]}";
    char file[512] = "glTF\2\0\0\0\0\0\0\0\0\0\0\0JSON";
    file[12] = (char)(sizeof json - 1);
    file[13] = (char)((sizeof json - 1) >> 8);
    memcpy(file + 20, json, sizeof json - 1);
    expect(file, 20 + sizeof json - 1, MESO_PRODUCT_GLB, 20 + sizeof json - 1,
           "{\"generator\": \"g\", \"primitives\": 3, \"materials\": 1, \"triangles\": 4,"
           " \"provenance\": " PROVENANCE "}");
}

static void test_drc(void)
{
    static const char file[] = "DRACO\2\2\1\1\0\x80" "\1\0\0\1" "\012provenance\x1c" PROVENANCE "rest";
    expect(BYTES(file), MESO_PRODUCT_DRC, 11,
           "{\"encoding\": \"edgebreaker\", \"provenance\": " PROVENANCE "}");
    static const char plain[] = "DRACO\2\2\1\0\0\0" "data";
    expect(BYTES(plain), MESO_PRODUCT_DRC, 11, "{\"encoding\": \"sequential\"}");
    json_decref(describe("DRACO\2\2\0\0\0\0", 11, MESO_PRODUCT_DRC, MESO_ERR_INPUT));
    /* The length of the text is beyond the end. */
    json_decref(describe("DRACO\2\2\1\1\0\x80\012provenance\xff\x7f{}", 26, MESO_PRODUCT_DRC, MESO_ERR_INPUT));
}

static void test_text(void)
{
    static const char ply[] =
        "ply\r\nformat ascii 1.0\r\ncomment provenance " PROVENANCE "\r\nelement vertex 12\r\n"
        "property float x\nelement face 3\nelement odd -1\nend_header\n1 2 3\n";
    expect(BYTES(ply), MESO_PRODUCT_PLY, (size_t)(strstr(ply, "end_header") - ply) + 10,
           "{\"elements\": {\"vertex\": 12, \"face\": 3}, \"provenance\": " PROVENANCE "}");
    static const char obj[] = "# provenance " PROVENANCE "\nv 1 2 3\nvn 1 2 3\nv 1 2 3\nf 1 2 3\n";
    expect(BYTES(obj), MESO_PRODUCT_OBJ, 0,
           "{\"vertices\": 2, \"faces\": 1, \"provenance\": " PROVENANCE "}");
    /* A long one stands on several lines, in pieces. */
    static const char pieces[] = "ply\nformat ascii 1.0\ncomment provenance {\"tool\":\"meso-map\",\n"
        "comment provenance+ \"seed\"\ncomment provenance+ :5}\r\nelement vertex 12\nend_header\n";
    expect(BYTES(pieces), MESO_PRODUCT_PLY, sizeof pieces - 2,
           "{\"elements\": {\"vertex\": 12}, \"provenance\": " PROVENANCE "}");
    static const char obj_pieces[] = "# provenance {\"tool\":\"meso-map\"\n# provenance+ ,\"seed\":5}\nv 1 2 3\n";
    expect(BYTES(obj_pieces), MESO_PRODUCT_OBJ, 0, "{\"vertices\": 1, \"faces\": 0, \"provenance\": " PROVENANCE "}");
    /* A comment that is not ours. */
    static const char other[] = "# provenance unknown\nv 1 2 3\n";
    expect(BYTES(other), MESO_PRODUCT_OBJ, 0, "{\"vertices\": 1, \"faces\": 0}");
}

static void test_nothing(void)
{
    MesoInput input;
    meso_input_wrap(&input, "file", "glT", 3);
    CHECK(meso_product_recognise(&input) == MESO_PRODUCT_NONE);
    meso_input_wrap(&input, "file", "", 0);
    CHECK(meso_product_recognise(&input) == MESO_PRODUCT_NONE);
    CHECK(strcmp(meso_product_name(MESO_PRODUCT_GLB), "glb") == 0);
}

int main(void)
{
    test_exr();
    test_png();
    test_glb();
    test_drc();
    test_text();
    test_nothing();
    return 0;
}
