/* Any bytes as a tile set of either kind; what is accepted must survive being written. */
#include <stdlib.h>
#include <string.h>

#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/tiling/tile/variant.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void read_again(const MesoTileSet *set)
{
    MesoArena arena;
    MesoError error;
    MesoTileSet again;
    meso_arena_init(&arena);
    json_t *json = meso_tiles_to_json(set);
    if (!json || meso_tiles_from_json(&again, &arena, json, "again", &error) != MESO_OK)
        abort();
    json_t *json_again = meso_tiles_to_json(&again);
    if (!json_equal(json, json_again))
        abort();
    json_decref(json_again);
    json_decref(json);
    meso_arena_release(&arena);
}

static void ignore(void *context, const char *severity, const char *where, const char *message)
{
    (void)context, (void)severity, (void)where, (void)message;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    MesoArena arena;
    MesoInput input;
    MesoTileSet set;
    MesoVariantSet variants;
    MesoError error;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", size ? data : (const uint8_t *)"", size);
    if (meso_tiles_read(&set, &arena, &input, &error) == MESO_OK) {
        read_again(&set);
        if (meso_variant_set_build(&variants, &arena, &set, &error) != MESO_OK)
            abort();
    }
    meso_tiles_survey(&set, &arena, &input, ignore, NULL, &error);
    meso_arena_release(&arena);
    return 0;
}
