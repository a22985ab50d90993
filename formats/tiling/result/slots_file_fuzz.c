/* Reader of assignments: a good file with chunks replaced; what is read must be in range. */
#include "formats/file/container_memory.h"
#include "formats/model/model_fixture.h"
#include "formats/tiling/result/slots_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static MesoArena fixed;
static MesoTileSet set;

static MesoStatus write_example(MesoOutput *output, MesoError *error)
{
    static const uint64_t hash[2] = {1, 2};
    uint32_t tiles[3] = {0, 1, 1};
    MesoTransform transforms[3] = {0, 1, 3};
    MesoAssignment assignment = {3, tiles, transforms};
    MesoProvenance provenance = model_fixture_provenance();
    static const uint8_t quarters[3] = {1, 0, 3}, over[3] = {0, 1, 0};
    return meso_slots_write(&assignment, &set, quarters, over, hash, hash, &provenance, output, error);
}

static void check_range(const MesoSlotsFile *slots)
{
    const MesoAssignment *a = &slots->assignment;
    for (uint32_t i = 0; i < a->slot_count; i++)
        if (a->tile[i] >= slots->tile_count || a->transform[i] >= MESO_TRANSFORM_COUNT ||
            !slots->tile_names[a->tile[i]][0] || (slots->quarters && slots->quarters[i] > 3) ||
            (slots->over && slots->over[i] > 1))
            abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static MesoContainer example;
    if (example.chunk_count == 0) {
        meso_arena_init(&fixed);
        model_fixture_tile_set(&set, &fixed);
        example = container_example("slots", write_example);
    }
    MesoContainer container = example;
    MesoSlotsFile slots;
    MesoArena arena;
    MesoInput input;
    MesoError error;
    size_t length;
    container_replace_chunks(&container, data, size);
    uint8_t *bytes = container_to_memory(&container, &length);
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", bytes, length);
    if (meso_slots_read(&slots, &arena, &input, &error) == MESO_OK) {
        check_range(&slots);
        meso_slots_bind(&slots, &set, &error);
    }
    meso_arena_release(&arena);
    free(bytes);
    return 0;
}
