/* Quilt files: round trip to the bit, every kind of wrong chunk, every damaged byte. */
#include "formats/quilt/quilt_file.h"

#include "formats/file/container_fixture.h"
#include "formats/file/container_memory.h"
#include "formats/quilt/quilt_file_fixture.h"

static MesoArena arena;
static TestFolder folder;

static void write_file(const MesoQuiltFile *file, const char *path)
{
    MesoProvenance provenance = quilt_file_fixture_provenance();
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_quilt_write(file, &provenance, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
}

static void test_round_trip(void)
{
    MesoQuiltFile file = quilt_file_fixture(&arena), back;
    const char *path = test_path(&folder, "a.quilt"), *provenance;
    MesoInput input;
    MesoError error;
    write_file(&file, path);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_quilt_recognise(&input));
    CHECK(meso_quilt_read(&back, &provenance, &arena, &input, &error) == MESO_OK);
    meso_input_close(&input);

    CHECK(back.quilt.element_count == 2 && back.quilt.vertex_count == 16 && back.quilt.triangle_count == 24);
    CHECK(memcmp(back.quilt.vertices, file.quilt.vertices, 16 * sizeof *back.quilt.vertices) == 0);
    CHECK(memcmp(back.quilt.corners, file.quilt.corners, 72 * sizeof *back.quilt.corners) == 0);
    CHECK(back.quilt.vertex_begin[1] == 8 && back.quilt.triangle_begin[2] == 24 && back.quilt.patches[23] == 1);
    CHECK(back.swatch.element_count == 1 && back.swatch.material_count == 2 && !back.swatch.uvs == !file.swatch.uvs);
    CHECK(memcmp(back.swatch.corner_uvs, file.swatch.corner_uvs, 36 * sizeof(MesoVec2)) == 0);
    CHECK_TEXT(back.swatch.material_names[1], "gold");
    CHECK(memcmp(back.base.positions, file.base.positions, file.base.vertex_count * sizeof(MesoVec3)) == 0);
    CHECK(back.embedding == MESO_QUILT_CHARTS);
    CHECK(memcmp(back.base_uvs, file.base_uvs, 3 * file.base.triangle_count * sizeof *back.base_uvs) == 0);
    CHECK(strstr(provenance, "\"command\":\"meso-try\",\"seed\":5"));

    /* A quilt of the quilt has the same bytes. */
    const char *again = test_path(&folder, "b.quilt");
    write_file(&back, again);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(test_file_is(again, input.data, input.size));
    meso_input_close(&input);
    meso_triangulation_release(&file.base);
}

static MesoStatus read_quietly(const MesoInput *input, MesoError *error)
{
    MesoQuiltFile file;
    MesoArenaMark mark = meso_arena_mark(&arena);
    MesoStatus status = meso_quilt_read(&file, NULL, &arena, input, error);
    meso_arena_rewind(&arena, mark);
    return status;
}

static const ContainerFixture fixture = {&folder, "a.quilt", "quilt", 1, read_quietly};

static void expect(const char *chunk, const void *data, uint64_t size, const char *message)
{
    container_fixture_expect(&fixture, chunk, data, size, message);
}

static void test_missing_chunks(void)
{
    static const char *const names[] = {
        "prov", "head", "surface", "vertex", "origin", "corner", "triorig", "patch", "vbegin", "tbegin", "elemorig",
        "basepos", "basecorn", "baseorig", "swpos", "swcorn", "swtwin", "swmat", "swuv", "swcuv", "looks"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char message[64];
        snprintf(message, sizeof message, "file: chunk '%s' is missing", names[i]);
        expect(names[i], NULL, UINT64_MAX, message);
    }
}

/* A surface may have no texture coordinates; version 1.0 has no chunk for them. */
static void test_without_texture(void)
{
    MesoContainer container;
    MesoQuiltFile file;
    MesoInput whole, input;
    MesoError error;
    size_t size;
    CHECK(meso_input_open(&whole, test_path(&folder, "a.quilt"), &error) == MESO_OK);
    CHECK(meso_container_read(&container, &whole, "quilt", 1, &error) == MESO_OK);
    for (uint32_t pass = 0; pass < 3; pass++) {
        if (pass > 0)           /* empty, then under another name */
            container_fixture_change(&container, "baseuv", NULL, pass == 1 ? 0 : UINT64_MAX);
        uint8_t *bytes = container_to_memory(&container, &size);
        meso_input_wrap(&input, "file", bytes, size);
        CHECK(meso_quilt_read(&file, NULL, &arena, &input, &error) == MESO_OK);
        CHECK(!file.base_uvs == (pass > 0));
        free(bytes);
    }
    meso_input_close(&whole);
    expect("baseuv", "1234", 4, "file: chunk 'baseuv' has 4 bytes, not 12 times 8");
}

/* One number of a chunk of the good file, replaced. */
static void expect_number(const char *chunk, size_t at, uint32_t value, const char *message)
{
    MesoContainer container;
    MesoInput input;
    MesoError error;
    uint64_t size;
    CHECK(meso_input_open(&input, test_path(&folder, "a.quilt"), &error) == MESO_OK);
    CHECK(meso_container_read(&container, &input, "quilt", 1, &error) == MESO_OK);
    const void *data = meso_container_find(&container, chunk, &size);
    uint32_t *copy = malloc(size);
    CHECK(data && copy && 4 * (at + 1) <= size);
    memcpy(copy, data, size);
    copy[at] = value;
    expect(chunk, copy, size, message);
    free(copy);
    meso_input_close(&input);
}

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static void test_wrong_numbers(void)
{
    const uint32_t nan = bits_of(NAN), far = bits_of(2e18f);
    expect_number("head", 1, UINT32_MAX, "file: chunk 'head': over 1431655764 triangles");
    expect_number("head", 0, 15, "file: chunk 'vertex' has 256 bytes, not 15 times 16");
    expect_number("vertex", 4, 4, "file: vertex 1 lies over triangle 4; the base has 4");
    expect_number("vertex", 5, nan, "file: vertex 1 is not finite, or too far away");
    expect_number("vertex", 6, bits_of(1e7f), "file: vertex 1 is not finite, or too far away");
    expect_number("vertex", 7, far, "file: vertex 1 is not finite, or too far away");
    expect_number("origin", 2, 8, "file: chunk 'origin': number 2 is 8, of 8");
    expect_number("corner", 0, 8, "file: element 0 has a corner at vertex 8, not its own");
    expect_number("corner", 71, 7, "file: element 1 has a corner at vertex 7, not its own");
    expect_number("triorig", 0, 12, "file: chunk 'triorig': number 0 is 12, of 12");
    expect_number("patch", 23, UINT32_MAX, "file: chunk 'patch': number 23 is 4294967295, of 4294967294");
    expect_number("vbegin", 0, 1, "file: chunk 'vbegin' is no list of ranges up to 16");
    expect_number("vbegin", 1, 17, "file: chunk 'vbegin' is no list of ranges up to 16");
    expect_number("tbegin", 2, 23, "file: chunk 'tbegin' is no list of ranges up to 24");
    expect_number("elemorig", 1, 1, "file: chunk 'elemorig': number 1 is 1, of 1");
    expect_number("basepos", 3, nan, "file: chunk 'basepos': vertex 1 is not finite, or too far away");
    expect_number("basecorn", 0, 6, "file: chunk 'basecorn': number 0 is 6, of 6");
    expect_number("baseorig", 0, 6, "file: chunk 'baseorig': number 0 is 6, of 6");
    expect_number("baseuv", 3, nan, "file: chunk 'baseuv': number 1 is not finite");
    expect_number("surface", 3, 3, "file: chunk 'surface': it lies over it in way 3, which is not known");
    expect_number("swpos", 0, far, "file: chunk 'swpos': vertex 0 is not finite, or too far away");
    expect_number("swcorn", 0, 8, "file: chunk 'swcorn': number 0 is 8, of 8");
    expect_number("swtwin", 0, 36, "file: chunk 'swtwin': number 0 is 36, of 36");
    expect_number("swtwin", 0, 0, "file: chunk 'swtwin': half-edge 24 is not across its own");
    expect_number("swmat", 0, 2, "file: chunk 'swmat': number 0 is 2, of 2");
    expect_number("swcuv", 1, nan, "file: chunk 'swcuv': number 0 is not finite");
    expect("looks", "{\"materials\": 1}", 16, "file: chunk 'looks': materials: an array is needed here, not a number");
    expect("looks", "{}", 2, "file: chunk 'swmat': number 0 is 0, of 0");
    expect("prov", "[]", 2, "file: chunk 'prov': is not an object");
}

/* Numbers of sides count, not only corners: two quads are no triangle and a pentagon. */
static void test_mark(void)
{
    uint32_t corners[8] = {0, 1, 2, 3, 4, 5, 6, 7}, sides[3] = {0, 3, 8}, quads[3] = {0, 4, 8};
    MesoPolygonMesh a = {.vertex_count = 8, .face_count = 2, .corner_count = 8, .face_begin = sides}, b;
    a.corners = corners;
    b = a;
    b.face_begin = quads;
    MesoSurfaceMark x = meso_surface_mark(&a), y = meso_surface_mark(&b);
    CHECK(x.hash[0] != y.hash[0] || x.hash[1] != y.hash[1]);
}

int main(void)
{
    meso_arena_init(&arena);
    folder = test_folder_make();
    test_round_trip();
    test_missing_chunks();
    test_without_texture();
    test_wrong_numbers();
    container_fixture_damage(&fixture);
    test_mark();
    test_folder_remove(&folder);
    meso_arena_release(&arena);
    return 0;
}
