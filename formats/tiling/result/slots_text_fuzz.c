/* Reader of listings: what it accepts is in range, and its listings, read back, are the same. */
#include <stdlib.h>
#include <string.h>

#include "formats/tiling/result/slots_text.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_range(const MesoSlotsFile *slots)
{
    const MesoAssignment *a = &slots->assignment;
    for (uint32_t s = 0; s < a->slot_count; s++)
        if (a->tile[s] >= slots->tile_count || a->transform[s] >= MESO_TRANSFORM_COUNT ||
            !slots->tile_names[a->tile[s]][0] || (slots->quarters && slots->quarters[s] > 3) ||
            (slots->over && slots->over[s] > 1))
            abort();
}

static void check_same(const MesoSlotsFile *slots, const MesoSlotsFile *again)
{
    const MesoAssignment *a = &slots->assignment, *b = &again->assignment;
    if (a->slot_count != b->slot_count || memcmp(a->transform, b->transform, a->slot_count) != 0 ||
        !slots->quarters != !again->quarters || !slots->over != !again->over)
        abort();
    for (uint32_t s = 0; s < a->slot_count; s++)
        if (strlen(slots->tile_names[a->tile[s]]) != strlen(again->tile_names[b->tile[s]]))
            abort();
}

static void read_back(const MesoSlotsFile *slots, MesoArena *arena)
{
    MesoSlotsFile again;
    MesoInput input;
    MesoError error;
    json_t *root = meso_slots_to_json(slots);
    char *text = root ? json_dumps(root, 0) : NULL;
    if (!text)
        abort();
    meso_input_wrap(&input, "again", text, strlen(text));
    if (meso_slots_text_read(&again, arena, &input, &error) != MESO_OK)
        abort();
    check_same(slots, &again);
    free(text);
    json_decref(root);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    MesoArena arena;
    MesoError error;
    MesoInput input;
    MesoSlotsFile slots;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", data, size);
    if (meso_slots_text_read(&slots, &arena, &input, &error) == MESO_OK) {
        check_range(&slots);
        read_back(&slots, &arena);
    }
    meso_arena_release(&arena);
    return 0;
}
