/* What the tests of files that are containers share: one chunk that is wrong, and every byte that is. */
#ifndef MESO_CONTAINER_FIXTURE_H
#define MESO_CONTAINER_FIXTURE_H

#include "formats/file/container.h"
#include "formats/file/test_folder.h"

typedef struct ContainerFixture {
    const TestFolder *folder;
    const char *name;           /* of the proper file in it */
    const char *kind;
    uint16_t major;
    MesoStatus (*read)(const MesoInput *input, MesoError *error);
} ContainerFixture;

static inline void container_fixture_change(MesoContainer *container, const char *chunk, const void *data,
                                            uint64_t size)
{
    bool found = false;
    for (uint32_t i = 0; i < container->chunk_count; i++)
        if (strcmp(container->chunks[i].name, chunk) == 0) {
            found = true;
            if (size == UINT64_MAX)
                container->chunks[i] = (MesoChunk){.name = "other"};
            container->chunks[i].data = data;
            container->chunks[i].size = size == UINT64_MAX ? 0 : size;
        }
    if (!found)
        meso_container_add(container, chunk, data, size);
}

/* Writes the file with one chunk replaced (renamed where `size` is UINT64_MAX) or added, and reads it as 'file'. */
static inline void container_fixture_expect(const ContainerFixture *fixture, const char *chunk, const void *data,
                                            uint64_t size, const char *message)
{
    const char *changed = test_path(fixture->folder, "changed");
    MesoContainer container;
    MesoInput input;
    MesoOutput *output;
    MesoError error;
    CHECK(meso_input_open(&input, test_path(fixture->folder, fixture->name), &error) == MESO_OK);
    CHECK(meso_container_read(&container, &input, fixture->kind, fixture->major, &error) == MESO_OK);
    container_fixture_change(&container, chunk, data, size);
    CHECK(meso_output_open(&output, changed, &error) == MESO_OK);
    CHECK(meso_container_write(&container, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    meso_input_close(&input);
    CHECK(meso_input_open(&input, changed, &error) == MESO_OK);
    input.path = "file";
    CHECK(fixture->read(&input, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
    meso_input_close(&input);
}

/* The file is refused cut off at any byte, and with a bit of any byte flipped. */
static inline void container_fixture_damage(const ContainerFixture *fixture)
{
    MesoInput whole, input;
    MesoError error;
    CHECK(meso_input_open(&whole, test_path(fixture->folder, fixture->name), &error) == MESO_OK);
    uint8_t *bytes = malloc(whole.size);
    CHECK(bytes != NULL);
    memcpy(bytes, whole.data, whole.size);
    for (size_t i = 0; i < whole.size; i++) {
        meso_input_wrap(&input, "file", bytes, i);
        CHECK(fixture->read(&input, &error) == MESO_ERR_INPUT);
        bytes[i] ^= (uint8_t)(1 << i % 8);
        meso_input_wrap(&input, "file", bytes, whole.size);
        CHECK(fixture->read(&input, &error) == MESO_ERR_INPUT);
        bytes[i] ^= (uint8_t)(1 << i % 8);
    }
    free(bytes);
    meso_input_close(&whole);
}

#endif
