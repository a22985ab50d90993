/* Reader of containers: raw bytes, and a container made of the fuzzer's chunks, which must come back. */
#include "formats/file/container_memory.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void read_raw(const uint8_t *data, size_t size)
{
    MesoInput input;
    MesoContainer container;
    MesoError error;
    uint64_t *aligned = malloc(size + 8);
    if (!aligned)
        abort();
    memcpy(aligned, data, size);
    meso_input_wrap(&input, "fuzz", aligned, size);
    meso_container_recognise(&input);
    meso_container_read(&container, &input, size % 2 ? "slots" : "model", 1, &error);
    free(aligned);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    read_raw(data, size);
    MesoContainer container = {.kind = "slots", .major = 1}, back;
    meso_container_add(&container, "a", NULL, 0);
    meso_container_add(&container, "b", NULL, 0);
    meso_container_add(&container, "longname", NULL, 0);
    container_replace_chunks(&container, data, size);

    MesoInput input;
    MesoError error;
    size_t length;
    uint8_t *bytes = container_to_memory(&container, &length);
    meso_input_wrap(&input, "fuzz", bytes, length);
    if (meso_container_read(&back, &input, "slots", 1, &error) != MESO_OK || back.chunk_count != 3)
        abort();
    for (uint32_t i = 0; i < 3; i++)
        if (back.chunks[i].size != container.chunks[i].size ||
            (back.chunks[i].size &&
             memcmp(back.chunks[i].data, container.chunks[i].data, back.chunks[i].size) != 0))
            abort();

    /* One wrong bit anywhere is noticed. */
    if (size >= 4) {
        bytes[(data[1] | (size_t)data[2] << 8) % length] ^= (uint8_t)(1 << data[3] % 8);
        if (meso_container_read(&back, &input, "slots", 1, &error) == MESO_OK)
            abort();
    }
    free(bytes);
    return 0;
}
