/* Listings of slots: round trips through both forms, every order and quote, every wrong line. */
#include "formats/tiling/result/slots_file.h"
#include "formats/tiling/result/slots_text.h"

#include <stdlib.h>

#include "formats/file/test_folder.h"
#include "formats/json/json_text.h"
#include "libcore/base/check.h"

static MesoArena arena;
static TestFolder folder;

static MesoStatus read_text(MesoSlotsFile *slots, const char *text, MesoError *error)
{
    MesoInput input;
    meso_input_wrap(&input, "file", text, strlen(text));
    return meso_slots_read(slots, &arena, &input, error);
}

static void expect(const char *text, const char *message)
{
    MesoSlotsFile slots;
    MesoError error = {0};
    CHECK(read_text(&slots, text, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
}

static void check_same(const MesoSlotsFile *a, const MesoSlotsFile *b)
{
    CHECK(a->assignment.slot_count == b->assignment.slot_count && !a->quarters == !b->quarters && !a->over == !b->over);
    for (uint32_t s = 0; s < a->assignment.slot_count; s++) {
        CHECK(strcmp(a->tile_names[a->assignment.tile[s]], b->tile_names[b->assignment.tile[s]]) == 0);
        CHECK(a->assignment.transform[s] == b->assignment.transform[s]);
        CHECK(!a->quarters || a->quarters[s] == b->quarters[s]);
        CHECK(!a->over || a->over[s] == b->over[s]);
    }
}

static void read_back(MesoSlotsFile *back, const MesoSlotsFile *slots, bool csv)
{
    const char *path = test_path(&folder, "listing");
    MesoOutput *output;
    MesoInput input;
    MesoError error;
    json_t *root = meso_slots_to_json(slots);
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK((csv ? meso_slots_write_csv(slots, output, &error) : meso_json_write(root, output, &error)) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    json_decref(root);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_slots_read(back, &arena, &input, &error) == MESO_OK);
    meso_input_close(&input);       /* nothing points into it */
}

static void test_round_trip(void)
{
    static const char *names[5] = {"plain", "a, b", "\"", " blanks ", "say \"\"x\""};
    static uint32_t tiles[8] = {0, 1, 2, 3, 4, 1, 0, 2};
    static MesoTransform transforms[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    static uint8_t quarters[8] = {0, 3, 1, 2, 0, 0, 0, 1}, over[8] = {0, 0, 0, 1, 1};
    MesoSlotsFile slots = {.assignment = {8, tiles, transforms}, .tile_count = 5, .tile_names = names,
                           .tiles_hash = {1, UINT64_MAX}, .surface_hash = {UINT64_MAX - 1, 2}, .provenance = "{}"}, back;
    for (int oriented = 0; oriented < 4; oriented++) {
        slots.quarters = oriented & 1 ? quarters : NULL;
        slots.over = oriented & 2 ? over : NULL;
        for (int csv = 0; csv < 2; csv++) {
            read_back(&back, &slots, csv);
            check_same(&slots, &back);
            CHECK(back.anonymous == csv && back.tile_count == 5 && strcmp(back.provenance, "{}") == 0);
            CHECK(csv || (memcmp(back.tiles_hash, slots.tiles_hash, 16) == 0 &&
                          memcmp(back.surface_hash, slots.surface_hash, 16) == 0));
        }
    }
    MesoSlotsFile again;        /* without hashes, as a listing without them was read */
    read_back(&back, &slots, true);
    read_back(&again, &back, false);
    check_same(&slots, &again);
    CHECK(again.anonymous);
}

/* Columns and slots in another order, carriage returns, a mark, empty lines, no end of the last line. */
static void test_forms(void)
{
    MesoSlotsFile slots, other;
    MesoError error;
    CHECK(read_text(&slots, "slot,tile,turn,flip\n0,a,0,0\n1,b,3,1\n", &error) == MESO_OK);
    CHECK(slots.assignment.slot_count == 2 && slots.assignment.transform[1] == 7 && !slots.quarters);
    CHECK(read_text(&other, "\xef\xbb\xbf" "flip,\"tile\",slot,turn\r\n\r\n1,\"b\",1,3\r\n\n0,a,0,0", &error) == MESO_OK);
    check_same(&slots, &other);
    CHECK(read_text(&slots, "tile,slot\na,0\n", &error) == MESO_OK && slots.assignment.transform[0] == 0);
    CHECK(read_text(&slots, "tile,corner,slot\na,2,0\n", &error) == MESO_OK && slots.quarters[0] == 2);
    CHECK(read_text(&slots, " {\"format\": \"meso-slots\", \"version\": 1, \"slots\": [{\"slot\": 1, \"tile\": \"a\"},"
                       "{\"tile\": \"b\", \"slot\": 0, \"flip\": true, \"turn\": 2}], \"provenance\": 3}", &error) == MESO_OK);
    CHECK(slots.assignment.transform[0] == 6 && strcmp(slots.tile_names[slots.assignment.tile[1]], "a") == 0);
}

static void test_wrong_csv(void)
{
    static const char kind[] = "file: neither an assignment nor a listing of slots, whose first line names its columns: "
                               "slot,tile and perhaps turn,flip,corner,over";
    expect("", kind);
    expect("\n\n", kind);
    expect("slot,turn\n0,0\n", kind);
    expect("slot,tile,tile\n0,a,a\n", kind);
    expect("slot,tile,colour\n0,a,a\n", kind);
    expect("slot,tile,turn,flip,corner,\n", kind);
    expect("slot,\"tile\n0,a\n", kind);
    expect("slot,tile\n", "file: lists 0 slots, which is no possible number");
    expect("slot,tile\n0\n", "file:2: 1 fields; the first line names 2");
    expect("slot,tile\n0,a,b\n", "file:2: more than 2 fields");
    expect("slot,tile\n\n0,a\n0,a\n", "file:4: slot 0 is listed twice");
    expect("slot,tile\n1,a\n", "file:2: slot 1 of 1: each slot from 0 must be listed once");
    expect("slot,tile\n-1,a\n", "file:2: slot '-1' is not a whole number from 0 to 1073741822");
    expect("slot,tile\n1073741823,a\n", "file:2: slot '1073741823' is not a whole number from 0 to 1073741822");
    expect("slot,tile\n18446744073709551616,a\n",
           "file:2: slot '18446744073709551616' is not a whole number from 0 to 1073741822");
    expect("slot,tile\n 0,a\n", "file:2: slot ' 0' is not a whole number from 0 to 1073741822");
    expect("slot,tile\n,a\n", "file:2: slot '' is not a whole number from 0 to 1073741822");
    expect("slot,tile\n0,\n", "file:2: tile '' is no name");
    expect("slot,tile\n0,a\tb\n", "file:2: tile 'a?b' is no name");
    expect("slot,tile,turn\n0,a,4\n", "file:2: turn '4' is not a whole number from 0 to 3");
    expect("slot,tile,flip\n0,a,true\n", "file:2: flip 'true' is not a whole number from 0 to 1");
    expect("slot,tile,corner\n0,a,9\n", "file:2: corner '9' is not a whole number from 0 to 3");
    expect("slot,tile\n0,a\"b\n", "file:2: field 2: a quote in the wrong place");
    expect("slot,tile\n0,\"a\n", "file:2: field 2: a quote in the wrong place");
    expect("slot,tile\n0,\"a\"b\n", "file:2: field 2: a quote in the wrong place");
    MesoSlotsFile slots;
    MesoInput input;
    MesoError error;
    meso_input_wrap(&input, "file", "slot,tile\n0,a\0\n", 15);
    CHECK(meso_slots_read(&slots, &arena, &input, &error) == MESO_ERR_INPUT && strcmp(error.message, kind) == 0);
}

#define LISTING(slots) "{\"format\": \"meso-slots\", \"version\": 1, " slots "}"

static void test_wrong_json(void)
{
    expect("{\"format\": \"meso-report\", \"version\": 1}",
           "file: is a 'meso-report' file; a 'meso-slots' file is needed here");
    expect("{\"format\": \"meso-slots\", \"version\": 2}", "file: version 2 is newer than this program reads (1)");
    expect(LISTING("\"slots\": []"), "file: slots: 0 items; from 1 to 1073741823 are possible");
    expect(LISTING("\"slot\": []"), "file: unknown key \"slot\"; there are \"format\", \"version\", \"provenance\", \"inputs\", \"slots\"");
    expect(LISTING("\"slots\": [{\"tile\": \"a\"}]"), "file: slots[0].slot: missing");
    expect(LISTING("\"slots\": [{\"slot\": 0}]"), "file: slots[0].tile: missing");
    expect(LISTING("\"slots\": [{\"slot\": 0, \"tile\": \"\"}]"), "file: slots[0].tile: is no name");
    expect(LISTING("\"slots\": [{\"slot\": 1, \"tile\": \"a\"}]"), "file: slots[0].slot: 1; it must be from 0 to 0");
    expect(LISTING("\"slots\": [{\"slot\": 0, \"tile\": \"a\"}, {\"slot\": 0, \"tile\": \"a\"}]"),
           "file: slots[1]: slot 0 is listed twice");
    expect(LISTING("\"slots\": [{\"slot\": 0, \"tile\": \"a\", \"turn\": 4}]"),
           "file: slots[0].turn: 4; it must be from 0 to 3");
    expect(LISTING("\"slots\": [{\"slot\": 0, \"tile\": \"a\", \"flip\": 1}]"),
           "file: slots[0].flip: true or false is needed here, not a number");
    expect(LISTING("\"inputs\": {\"tiles\": \"12\"}, \"slots\": [{\"slot\": 0, \"tile\": \"a\"}]"),
           "file: inputs.tiles: 32 hexadecimal digits are needed");
}

/* Every beginning of a listing is refused, or one of fewer slots; nothing is read beyond it. */
static void test_truncations(void)
{
    static const char text[] = "slot,tile,turn,flip,corner\n0,\"a \"\"b\"\"\",1,0,2\n1,c,0,1,0\n";
    for (size_t size = 0; size < sizeof text - 1; size++) {
        MesoSlotsFile slots;
        MesoInput input;
        MesoError error;
        char *copy = malloc(size + 1);
        memcpy(copy, text, size);
        meso_input_wrap(&input, "file", copy, size);
        if (meso_slots_read(&slots, &arena, &input, &error) == MESO_OK)
            CHECK(slots.assignment.slot_count == 1 || size == sizeof text - 2);
        free(copy);
    }
}

int main(void)
{
    folder = test_folder_make();
    meso_arena_init(&arena);
    test_round_trip();
    test_forms();
    test_wrong_csv();
    test_wrong_json();
    test_truncations();
    meso_arena_release(&arena);
    test_folder_remove(&folder);
    return 0;
}
