/* Assignment files: round trip, every kind of wrong chunk, every damaged byte. */
#include "formats/tiling/result/slots_file.h"

#include "formats/file/container_fixture.h"
#include "libcore/tiling/fixture/solve_fixture.h"

static MesoArena arena;
static TestFolder folder;

static const uint64_t tiles_hash[2] = {1, 2}, surface_hash[2] = {3, UINT64_MAX};
static uint32_t tiles[5] = {0, 2, 1, 2, 0};
static MesoTransform transforms[5] = {0, 7, 3, 1, 0};
static const uint8_t quarters[5] = {0, 3, 0, 2, 1}, over[5] = {0, 0, 1, 1, 0};

static MesoTileSet make_set(const char *a, const char *b, const char *c)
{
    static const int32_t labels[3][4] = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    MesoTileSet set = fixture_set(&arena, 1, 3, labels, true, true, false);
    set.tiles[0].name = a;
    set.tiles[1].name = b;
    set.tiles[2].name = c;
    return set;
}

static void write_oriented(const char *path, const uint8_t *turned, const uint8_t *turned_over)
{
    MesoTileSet set = make_set("zero", "one", "two");
    MesoAssignment assignment = {5, tiles, transforms};
    MesoProvenance provenance = {.tool = "meso-try", .command_line = "meso-try"};
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_slots_write(&assignment, &set, turned, turned_over, tiles_hash, surface_hash, &provenance,
                           output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
}

static void write_file(const char *path)
{
    write_oriented(path, quarters, over);
}

static void test_round_trip(void)
{
    const char *path = test_path(&folder, "a.slots");
    MesoInput input;
    MesoError error;
    MesoSlotsFile slots;
    write_file(path);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_slots_read(&slots, &arena, &input, &error) == MESO_OK);
    meso_input_close(&input);   /* nothing points into it */
    CHECK(slots.assignment.slot_count == 5);
    CHECK(memcmp(slots.assignment.tile, tiles, sizeof tiles) == 0);
    CHECK(memcmp(slots.assignment.transform, transforms, sizeof transforms) == 0);
    CHECK(memcmp(slots.quarters, quarters, sizeof quarters) == 0 && memcmp(slots.over, over, sizeof over) == 0);
    CHECK(memcmp(slots.tiles_hash, tiles_hash, 16) == 0);
    CHECK(memcmp(slots.surface_hash, surface_hash, 16) == 0);
    CHECK(slots.tile_count == 3 && strcmp(slots.tile_names[1], "one") == 0);
    CHECK(strncmp(slots.provenance, "{\"tool\":\"meso-try\"", 18) == 0);

    MesoTileSet lacking = make_set("two", "x", "zero");
    CHECK(meso_slots_bind(&slots, &lacking, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "slot 2: the tile set has no tile 'one'") == 0);
    CHECK(memcmp(slots.assignment.tile, tiles, sizeof tiles) == 0);

    MesoTileSet other = make_set("two", "one", "zero");
    const uint32_t bound[5] = {2, 0, 1, 0, 2};
    CHECK(meso_slots_bind(&slots, &other, &error) == MESO_OK);
    CHECK(memcmp(slots.assignment.tile, bound, sizeof bound) == 0);
}

/* Without an orientation, or with the file's own, a file is of the first version; with faces turned over, though it be
 * none, of the third. */
static void test_versions(void)
{
    const uint8_t none[5] = {0};
    const uint8_t *const given[5] = {NULL, none, quarters, NULL, quarters};
    const uint8_t *const sides[5] = {NULL, NULL, NULL, none, over};
    for (int i = 0; i < 5; i++) {
        MesoInput input;
        MesoError error;
        MesoContainer container;
        MesoSlotsFile slots;
        write_oriented(test_path(&folder, "v.slots"), given[i], sides[i]);
        CHECK(meso_input_open(&input, test_path(&folder, "v.slots"), &error) == MESO_OK);
        CHECK(meso_container_read(&container, &input, "slots", 3, &error) == MESO_OK);
        CHECK(container.major == (i < 2 ? 1 : i < 3 ? 2 : 3));
        CHECK(meso_slots_read(&slots, &arena, &input, &error) == MESO_OK);
        CHECK((slots.quarters != NULL) == (i == 2 || i == 4) && (slots.over != NULL) == (i > 2));
        meso_input_close(&input);
    }
}

/* A tile that no slot uses may be missing. */
static void test_unused_name(void)
{
    MesoTileSet set = make_set("zero", "one", "two"), other = make_set("two", "x", "zero");
    MesoAssignment assignment = {2, tiles, transforms};
    MesoProvenance provenance = {.tool = "meso-try", .command_line = "meso-try"};
    const char *path = test_path(&folder, "b.slots");
    MesoOutput *output;
    MesoInput input;
    MesoError error;
    MesoSlotsFile slots;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_slots_write(&assignment, &set, NULL, NULL, tiles_hash, surface_hash, &provenance,
                           output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_slots_read(&slots, &arena, &input, &error) == MESO_OK);
    CHECK(meso_slots_bind(&slots, &other, &error) == MESO_OK);
    CHECK(slots.assignment.tile[0] == 2 && slots.assignment.tile[1] == 0);
    meso_input_close(&input);
}

static MesoStatus read_quietly(const MesoInput *input, MesoError *error)
{
    MesoSlotsFile slots;
    MesoArenaMark mark = meso_arena_mark(&arena);
    MesoStatus status = meso_slots_read(&slots, &arena, input, error);
    meso_arena_rewind(&arena, mark);
    return status;
}

static const ContainerFixture fixture = {&folder, "a.slots", "slots", 3, read_quietly};

static void expect(const char *chunk, const void *data, uint64_t size, const char *message)
{
    container_fixture_expect(&fixture, chunk, data, size, message);
}

static void test_wrong_chunks(void)
{
    const uint32_t far[5] = {0, 1, 2, 3, 0};
    const uint8_t turned[5] = {0, 1, 8, 0, 0};
    expect("prov", NULL, UINT64_MAX, "file: chunk 'prov' is missing");
    expect("inputs", NULL, UINT64_MAX, "file: chunk 'inputs' is missing");
    expect("names", NULL, UINT64_MAX, "file: chunk 'names' is missing");
    expect("tile", NULL, UINT64_MAX, "file: chunk 'tile' is missing");
    expect("xform", NULL, UINT64_MAX, "file: chunk 'xform' is missing");
    expect("prov", "[]", 2, "file: chunk 'prov': is not an object");
    expect("inputs", tiles_hash, 16, "file: chunk 'inputs' has 16 bytes, not 4 times 8");
    expect("names", "", 0, "file: chunk 'names' does not end with a name");
    expect("names", "a\0b\0c", 5, "file: chunk 'names' does not end with a name");
    expect("names", "a\0\0c", 5, "file: tile 1 has an empty name");
    expect("names", "a\0b\0a", 6, "file: names the tile 'a' twice");
    expect("names", "a\0b", 4, "file: slot 1 has tile 2 of 2");
    expect("tile", tiles, 16, "file: chunk 'tile' has 16 bytes, not 5 times 4");
    expect("tile", far, 20, "file: slot 3 has tile 3 of 3");
    expect("xform", turned, 4, "file: chunk 'tile' has 20 bytes, not 4 times 4");
    expect("xform", turned, 5, "file: slot 2 has transform 8 of 8");
    expect("orient", quarters, 4, "file: chunk 'orient' has 4 bytes, not 5 times 1");
    expect("orient", turned, 5, "file: slot 2 has orientation 8 of 4");
    expect("over", over, 4, "file: chunk 'over' has 4 bytes, not 5 times 1");
    expect("over", turned, 5, "file: slot 2 has orientation 8 of 2 sides");
    expect("xform", turned, 0, "file: chunk 'xform' has no possible number of slots");
}

int main(void)
{
    folder = test_folder_make();
    meso_arena_init(&arena);
    test_round_trip();
    test_versions();
    test_unused_name();
    test_wrong_chunks();
    container_fixture_damage(&fixture);
    meso_arena_release(&arena);
    test_folder_remove(&folder);
    return 0;
}
