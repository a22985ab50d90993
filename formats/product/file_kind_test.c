/* Kinds of files by their content, and every truncation of them. */
#include <stdlib.h>
#include <string.h>

#include "formats/product/file_kind.h"
#include "libcore/base/check.h"

static MesoFileKind kind_of(const char *bytes, size_t size)
{
    MesoInput input;
    char *exact = malloc(size ? size : 1);  /* so that a read beyond the end is noticed */
    CHECK(exact);
    memcpy(exact, bytes, size);
    meso_input_wrap(&input, "file", exact, size);
    MesoFileKind kind = meso_file_kind(&input);
    free(exact);
    return kind;
}

/* And so with a byte order mark before it, where it is text; cut anywhere it is no other kind but one of JSON. */
static void expect(const char *text, MesoFileKind kind)
{
    char marked[300];
    snprintf(marked, sizeof marked, "\xef\xbb\xbf%s", text);
    CHECK(kind_of(text, strlen(text)) == kind);
    CHECK(kind_of(marked, strlen(marked)) == kind);
    for (size_t cut = 0; cut < strlen(text); cut++) {
        MesoFileKind found = kind_of(text, cut);
        CHECK(found == kind || found == MESO_FILE_UNKNOWN || (found & MESO_FILES_OF_JSON && kind & MESO_FILES_OF_JSON));
    }
}

static void test_json(void)
{
    expect("{\"format\": \"meso-tiles\", \"version\": 1}", MESO_FILE_TILES);
    expect(" \n{ \"version\" : 1 , \"format\" :\n\"meso-constraints\"}", MESO_FILE_CONSTRAINTS);
    expect("{\"format\": \"meso-pattern\", \"version\": 1}", MESO_FILE_PATTERN);
    expect("{\"format\": \"meso-macros\", \"version\": 1}", MESO_FILE_MACROS);
    expect("{\"format\": \"meso-regions\", \"version\": 1}", MESO_FILE_REGIONS);
    expect("{\"a\": {\"format\": \"meso-tiles\"}, \"b\": \"\\\"}{\\\\\", \"format\": \"meso-report\"}",
           MESO_FILE_REPORT);
    expect("{\"edgeTypes\": [{\"tileTypes\": 1}], \"tileTypes\": []}", MESO_FILE_PROTOTYPE);
    expect("{\"seed\": 1, \"verdict\": \"solved\"}\n{\"seed\": 2, \"verdict\": \"solved\"}\n", MESO_FILE_SEED_LINES);
    expect("{\"format\": \"meso-slots\", \"slots\": []}", MESO_FILE_LISTING);
    expect("{\"asset\": {\"version\": \"2.0\"}}", MESO_FILE_GLTF);
    expect("{\"format\": \"other\"}", MESO_FILE_JSON);
    expect("{\"x\": \"format\", \"y\": \"meso-tiles\"}", MESO_FILE_JSON);
    expect("[{\"format\": \"meso-tiles\"}]", MESO_FILE_JSON);
    expect("{\"edgeTypes\": [{\"tileTypes\": 1}]}", MESO_FILE_JSON);
    expect("{}}, \"format\": \"meso-tiles\"}", MESO_FILE_JSON);
    expect("{\"format", MESO_FILE_JSON);
}

static void test_text(void)
{
    expect("v 0 0 0\n", MESO_FILE_OBJ);
    expect("# ivy\n\nmeso-grow 1\nunit m\n", MESO_FILE_GRAMMAR);
    expect("# a comment\r\r\n# another\n\no Sphere\n", MESO_FILE_OBJ);
    expect("OFF\n4 1 0\n", MESO_FILE_OFF);
    expect("# made by hand\nCOFF\n", MESO_FILE_OFF);
    expect("ply\rformat", MESO_FILE_PLY);
    expect("slot,tile,turn,flip\n0,a,0,0\n", MESO_FILE_CSV);
    expect("# a comment alone", MESO_FILE_UNKNOWN);
    expect("version 1\n", MESO_FILE_UNKNOWN);
    expect("", MESO_FILE_UNKNOWN);
}

static void test_bytes(void)
{
    CHECK(kind_of("\x76\x2f\x31\x01", 4) == MESO_FILE_EXR);
    CHECK(kind_of("#?RADIANCE\n", 11) == MESO_FILE_HDR && kind_of("#?RGBE\nFORMAT=", 14) == MESO_FILE_HDR);
    CHECK(kind_of("\x89PNG\r\n\x1a\n", 8) == MESO_FILE_PNG);
    CHECK(kind_of("glTF\2\0\0\0", 8) == MESO_FILE_GLB);
    CHECK(kind_of("DRACO\2\2", 7) == MESO_FILE_DRC);
    CHECK(kind_of("\0\0\0\0", 4) == MESO_FILE_UNKNOWN);
    for (unsigned bit = 0; bit < 18; bit++)
        CHECK(strncmp(meso_file_kind_phrase((MesoFileKind)(1u << bit)), "of no", 5) != 0);
}

int main(void)
{
    test_json();
    test_text();
    test_bytes();
    return 0;
}
