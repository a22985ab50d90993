/* Reader of the lines of a sweep over seeds: what it accepts is ascending, and reads back as the same. */
#include <stdlib.h>
#include <string.h>

#include "formats/tiling/result/seed_lines.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint64_t problem[2] = {0, 0};
    MesoArena arena;
    MesoError error;
    MesoInput input;
    MesoSeedLine *lines;
    uint32_t count;

    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", data, size);
    if (meso_seed_lines_read(&lines, &count, &arena, &input, &problem, 1, &error) == MESO_OK)
        for (uint32_t i = 0; i < count; i++) {
            MesoSeedLine *again;
            uint32_t one;
            char *text = meso_arena_print(&arena, &error, "%s\n", lines[i].text);
            if (!text || (i && lines[i - 1].seed >= lines[i].seed))
                abort();
            meso_input_wrap(&input, "again", text, strlen(text));
            if (meso_seed_lines_read(&again, &one, &arena, &input, &problem, 1, &error) != MESO_OK || one != 1 ||
                again->seed != lines[i].seed || again->tile_squares != lines[i].tile_squares)
                abort();
        }
    meso_arena_release(&arena);
    return 0;
}
