/* Packed chunks: there and back for all kinds of numbers, and every truncation and many a changed byte. */
#include "formats/file/packed_chunk.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"

enum { COUNT = 4 * 250 };

static void test_there_and_back(MesoArena *arena, MesoPacking packing, uint32_t spread)
{
    uint8_t *data = malloc(COUNT * packing.number_bytes);
    MesoContainer container = {.kind = "model"};
    MesoRandom random;
    MesoError error;
    CHECK(data);
    meso_random_init(&random, spread, packing.row);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t number = i / packing.row + meso_random_below(&random, spread) - spread / 2;
        memcpy(data + i * packing.number_bytes, &number, packing.number_bytes);
    }
    uint64_t size = (uint64_t)COUNT * packing.number_bytes;
    CHECK(meso_packed_add(&container, arena, "zthing", data, size, packing, &error) == MESO_OK);
    CHECK(!packing.differences || spread > 100 || container.chunks[0].size < size / 2);
    MesoContainer back = container;
    CHECK(meso_packed_open(&back, arena, "file", "zother", "other", &error) == MESO_OK);
    CHECK(back.chunks[0].size == container.chunks[0].size);
    CHECK(meso_packed_open(&back, arena, "file", "zthing", "thing", &error) == MESO_OK);
    CHECK(strcmp(back.chunks[0].name, "thing") == 0 && back.chunks[0].size == size);
    CHECK(memcmp(back.chunks[0].data, data, size) == 0);
    free(data);
}

/* What is cut off is refused, and what is changed is refused or of the size that it says. */
static void test_broken(MesoArena *arena)
{
    uint16_t data[96];
    MesoContainer container = {.kind = "model"};
    MesoError error;
    for (uint32_t i = 0; i < 96; i++)
        data[i] = (uint16_t)(i * i);
    const MesoPacking packing = {2, 4, true};
    CHECK(meso_packed_add(&container, arena, "zthing", data, sizeof data, packing, &error) == MESO_OK);
    uint64_t size = container.chunks[0].size;
    uint8_t *copy = malloc(size);
    CHECK(copy);
    for (uint64_t cut = 0; cut < size; cut++) {
        MesoContainer broken = container;
        broken.chunks[0].size = cut;
        CHECK(meso_packed_open(&broken, arena, "file", "zthing", "thing", &error) == MESO_ERR_INPUT);
        CHECK(strcmp(error.message, "file: chunk 'zthing' cannot be unpacked") == 0);
    }
    for (uint64_t at = 0; at < size; at++)
        for (uint32_t bit = 0; bit < 8; bit++) {
            MesoContainer broken = container;
            memcpy(copy, container.chunks[0].data, size);
            copy[at] = (uint8_t)(copy[at] ^ 1u << bit);
            broken.chunks[0].data = copy;
            MesoStatus status = meso_packed_open(&broken, arena, "file", "zthing", "thing", &error);
            CHECK(status == MESO_ERR_INPUT || (status == MESO_OK && broken.chunks[0].size == sizeof data));
        }
    free(copy);
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    static const uint32_t spreads[] = {1, 20, 60000, UINT32_MAX};
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t row = 1; row <= 4; row *= 2)
            for (uint32_t k = 0; k < 4; k++)
                test_there_and_back(&arena, (MesoPacking){k & 1 ? 4 : 2, row, k > 1}, spreads[i]);
    test_broken(&arena);
    meso_arena_release(&arena);
    return 0;
}
