/* Reader of reports, beside a small tile set, and its writer on what was read. */
#include <stdlib.h>

#include "formats/tiling/result/report_file.h"
#include "formats/tiling/result/report_slots.h"
#include "libcore/base/bits.h"
#include "libcore/tiling/solve/suggest.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static MesoInterface interfaces[3] = {{.name = "a"}, {.name = "post", .border_only = true}, {.name = "c"}};
    static MesoTile tiles[1] = {{.name = "t", .side_count = 4, .labels = {1, 2, 3, -1}}};
    const MesoTileSet set = {.interface_count = 3, .interfaces = interfaces, .tile_count = 1, .tiles = tiles,
                             .default_rotation = true, .default_flip_x = true};
    MesoArena arena;
    MesoError error;
    MesoInput input;
    MesoReport report;
    MesoSuggestion suggestion;

    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", data, size);
    if (meso_report_read(&report, &arena, &input, &set, &error) == MESO_OK) {
        for (uint32_t d = 0; d < report.dead_end_count; d++)
            for (uint32_t k = 0; k < 4; k++)
                if (meso_bits_count(report.dead_ends[d].labels[k], 1) > 6)
                    abort();
        meso_suggest(&suggestion, &arena, &set, report.dead_end_count, report.dead_ends, &error);
    }
    MesoReportSlots slots;
    if (meso_report_slots_read(&slots, &arena, &input, 3, &error) == MESO_OK && slots.in_core[0] + slots.in_core[1] > 2)
        abort();
    meso_arena_release(&arena);
    return 0;
}
