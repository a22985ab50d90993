/* The container: what comes back, and that every changed byte is noticed. */
#include "formats/file/container.h"

#include <xxhash.h>

#include "formats/file/test_folder.h"

static const char first[] = "first chunk", third[100] = {1, 2, 3};

static MesoContainer example(void)
{
    MesoContainer container = {.kind = "slots", .major = 1, .minor = 3};
    meso_container_add(&container, "first", first, sizeof first);
    meso_container_add(&container, "empty", NULL, 0);
    meso_container_add(&container, "eightlet", third, sizeof third);
    return container;
}

/* Writes `container` and gives its bytes in fresh memory, with room for 64 more. */
static uint8_t *bytes_of(const TestFolder *folder, const MesoContainer *container, size_t *size)
{
    MesoOutput *output;
    MesoInput input;
    MesoError error;
    const char *path = test_path(folder, "container");
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_container_write(container, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    uint8_t *bytes = calloc(1, input.size + 64);
    CHECK(bytes != NULL);
    memcpy(bytes, input.data, input.size);
    *size = input.size;
    meso_input_close(&input);
    return bytes;
}

static MesoStatus read_bytes(MesoContainer *container, const void *bytes, size_t size, MesoError *error)
{
    MesoInput input;
    meso_input_wrap(&input, "file", bytes, size);
    return meso_container_read(container, &input, "slots", 1, error);
}

static void expect_error(const void *bytes, size_t size, const char *message)
{
    MesoContainer container;
    MesoError error;
    CHECK(read_bytes(&container, bytes, size, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
}

static void test_round_trip(const TestFolder *folder)
{
    MesoContainer written = example(), back;
    MesoError error;
    size_t size;
    uint64_t length;
    uint8_t *bytes = bytes_of(folder, &written, &size);
    /* header 64, table 3 * 32 -> 192: first 12 -> 256: empty -> 256: third 100 */
    CHECK(size == 256 + 100 && memcmp(bytes, "MESOFILEslots\0\0\0\4\3\2\1\1\0\3\0\3\0\0\0", 28) == 0);
    CHECK(memcmp(bytes + 192, first, sizeof first) == 0 && memcmp(bytes + 256, third, 100) == 0);

    CHECK(read_bytes(&back, bytes, size, &error) == MESO_OK);
    CHECK(strcmp(back.kind, "slots") == 0 && back.major == 1 && back.minor == 3);
    CHECK(back.chunk_count == 3 && meso_container_find(&back, "first", &length) == bytes + 192);
    CHECK(length == sizeof first && meso_container_find(&back, "empty", &length) && length == 0);
    CHECK(meso_container_find(&back, "eightlet", &length) == bytes + 256 && length == 100);
    CHECK(!meso_container_find(&back, "eight", &length) && length == 0);

    CHECK(meso_container_require(&back, "file", "eightlet", 25, 4, &error) == bytes + 256);
    CHECK(meso_container_require(&back, "file", "empty", 0, 4, &error) != NULL);
    CHECK(!meso_container_require(&back, "file", "eightlet", 26, 4, &error));
    CHECK(strcmp(error.message, "file: chunk 'eightlet' has 100 bytes, not 26 times 4") == 0);
    CHECK(!meso_container_require(&back, "file", "eightlet", UINT64_MAX / 2, 4, &error));
    CHECK(!meso_container_require(&back, "file", "none", 0, 0, &error));
    CHECK(error.status == MESO_ERR_INPUT);
    free(bytes);

    MesoContainer nothing = {.kind = "slots", .major = 1};
    bytes = bytes_of(folder, &nothing, &size);
    CHECK(size == 64 && read_bytes(&back, bytes, size, &error) == MESO_OK && back.chunk_count == 0);
    free(bytes);
}

static void test_every_byte(const TestFolder *folder)
{
    MesoContainer container = example();
    MesoError error;
    size_t size;
    uint8_t *bytes = bytes_of(folder, &container, &size);
    for (size_t i = 0; i < size; i++)
        for (int bit = 0; bit < 8; bit++) {
            bytes[i] ^= (uint8_t)(1 << bit);
            CHECK(read_bytes(&container, bytes, size, &error) == MESO_ERR_INPUT);
            bytes[i] ^= (uint8_t)(1 << bit);
        }
    for (size_t cut = 0; cut < size; cut++) {
        CHECK(read_bytes(&container, bytes, cut, &error) == MESO_ERR_INPUT);
        CHECK(strstr(error.message, "truncated"));
    }
    for (size_t more = 1; more <= 64; more++)
        CHECK(read_bytes(&container, bytes, size + more, &error) == MESO_ERR_INPUT);
    CHECK(read_bytes(&container, bytes, size, &error) == MESO_OK);
    free(bytes);
}

static void test_messages(const TestFolder *folder)
{
    MesoContainer container = example();
    size_t size;
    uint8_t *bytes = bytes_of(folder, &container, &size);
    expect_error(bytes, 40, "file: truncated: ends within its header");
    expect_error(bytes, 100, "file: truncated: ends within its chunk table");
    expect_error(bytes, 200, "file: truncated: 200 of 356 bytes, ends at chunk 'first'");
    expect_error(bytes, 300, "file: truncated: 300 of 356 bytes, ends at chunk 'eightlet'");
    expect_error(bytes, size + 2, "file: corrupt: 2 bytes follow its end");
    bytes[355] ^= 1;
    expect_error(bytes, size, "file: corrupt: the checksum of chunk 'eightlet' is wrong");
    bytes[355] ^= 1;
    bytes[250] = 1;
    expect_error(bytes, size, "file: corrupt: the bytes before chunk 'empty' are not zero");
    bytes[250] = 0;
    bytes[70] ^= 1;
    expect_error(bytes, size, "file: corrupt: the checksum of the chunk table is wrong");
    bytes[70] ^= 1;
    bytes[20] = 7;
    expect_error(bytes, size, "file: corrupt: the checksum of the header is wrong");
    memcpy(bytes + 16, "\1\2\3\4", 4);
    expect_error(bytes, size, "file: was written with the other byte order");
    bytes[0] = 'm';
    expect_error(bytes, size, "file: is not a slots or model file of meso");
    free(bytes);

    container.major = 2;
    container.minor = 0;
    bytes = bytes_of(folder, &container, &size);
    expect_error(bytes, size, "file: file version 2.0 is newer than this program reads (1.x)");
    free(bytes);
    container.major = 0;
    bytes = bytes_of(folder, &container, &size);
    expect_error(bytes, size, "file: corrupt: the header holds impossible values");
    free(bytes);
    container = (MesoContainer){.kind = "model", .major = 1};
    bytes = bytes_of(folder, &container, &size);
    expect_error(bytes, size, "file: is a 'model' file; a 'slots' file is needed here");
    free(bytes);
}

/* Files that are made wrong on purpose: their checksums are right. */
static void test_wrong_on_purpose(const TestFolder *folder)
{
    size_t size;
    MesoContainer container = example();
    meso_container_add(&container, "first", first, 1);
    uint8_t *bytes = bytes_of(folder, &container, &size);
    expect_error(bytes, size, "file: corrupt: chunk 'first' appears twice");
    free(bytes);
    container = example();
    container.chunks[1].name[0] = 0;
    bytes = bytes_of(folder, &container, &size);
    expect_error(bytes, size, "file: corrupt: a chunk has no proper name");
    free(bytes);
    container = example();
    memcpy(container.chunks[1].name, "a\0b", 4);
    bytes = bytes_of(folder, &container, &size);
    expect_error(bytes, size, "file: corrupt: a chunk has no proper name");
    free(bytes);
}

/* Puts `size` bytes of `value` at `offset` into the example, makes its checksums right, and reads it. */
static void expect_after_patch(const TestFolder *folder, size_t offset, uint64_t value, size_t size,
                               const char *message)
{
    MesoContainer container = example();
    size_t whole;
    uint8_t *bytes = bytes_of(folder, &container, &whole);
    memcpy(bytes + offset, &value, size);
    uint64_t hash = XXH3_64bits(bytes + 64, 96);
    memcpy(bytes + 40, &hash, 8);
    hash = XXH3_64bits(bytes, 56);
    memcpy(bytes + 56, &hash, 8);
    expect_error(bytes, whole, message);
    free(bytes);
}

static void test_patched(const TestFolder *folder)
{
    static const char *const header = "file: corrupt: the header holds impossible values";
    static const char *const place = "file: corrupt: chunk 'empty' lies out of place";
    const size_t entry = 64 + 32;   /* of the second chunk: name, offset, size, checksum */
    expect_after_patch(folder, 16, 5, 4, header);
    expect_after_patch(folder, 24, 65, 4, header);
    expect_after_patch(folder, 24, UINT32_MAX, 4, header);
    expect_after_patch(folder, 28, 1, 4, header);
    expect_after_patch(folder, 48, 1, 8, header);
    expect_after_patch(folder, 8, 0, 8, header);
    expect_after_patch(folder, 32, 357, 8, "file: corrupt: the file size of the header is wrong");
    expect_after_patch(folder, 32, 100, 8, "file: corrupt: the file size of the header is wrong");
    expect_after_patch(folder, entry + 8, 192, 8, place);
    expect_after_patch(folder, entry + 8, 320, 8, place);
    expect_after_patch(folder, entry + 8, 257, 8, place);
    expect_after_patch(folder, entry + 16, UINT64_MAX, 8, place);
    expect_after_patch(folder, entry + 16, UINT64_MAX - 255, 8, place);
    expect_after_patch(folder, entry + 16, 1, 8, "file: corrupt: chunk 'eightlet' lies out of place");
    expect_after_patch(folder, entry, 0, 8, "file: corrupt: a chunk has no proper name");
}

static void test_recognise(void)
{
    MesoInput input;
    meso_input_wrap(&input, "file", "MESOFILE", 8);
    CHECK(meso_container_recognise(&input));
    meso_input_wrap(&input, "file", "MESOFIL", 7);
    CHECK(!meso_container_recognise(&input));
}

int main(void)
{
    TestFolder folder = test_folder_make();
    test_round_trip(&folder);
    test_every_byte(&folder);
    test_messages(&folder);
    test_wrong_on_purpose(&folder);
    test_patched(&folder);
    test_recognise();
    test_folder_remove(&folder);
    return 0;
}
