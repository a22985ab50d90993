/* Where a report says that it failed: slots, without a tile set. */
#ifndef MESO_REPORT_SLOTS_H
#define MESO_REPORT_SLOTS_H

#include "formats/file/input.h"
#include "libcore/base/arena.h"

typedef struct MesoReportSlots {
    uint32_t slot_count;
    bool core;                  /* it names a set that cannot hold together */
    uint32_t *dead_ends;        /* [slot_count] that were met there, of those that it tells of */
    uint8_t *in_core;           /* [slot_count] 1: in that set */
} MesoReportSlots;

/*
 * Reads a report of meso-solve (report_file.h) about a surface of `slot_count` slots into `arena`. MESO_ERR_INPUT
 * names the file and the place of what is wrong, another number of slots and one beyond the last among it;
 * MESO_ERR_MEMORY. O(size of the file + slots).
 */
MesoStatus meso_report_slots_read(MesoReportSlots *slots, MesoArena *arena, const MesoInput *input, uint32_t slot_count,
                                  MesoError *error);

#endif
