/*
 * Assignment files (.slots), version 1.0; 2.0 where there is a chunk `orient`, 3.0 where there is one `over`,
 * without which the rest means something else: a reader that does not know it
 * must refuse the file. Chunks:
 *
 *     prov      provenance, JSON text
 *     inputs    u64[4]: XXH3-128 of the tile set's file, then of the surface's, high words first
 *     names     names of the tiles, each ended by a zero byte, in tile order
 *     tile      u32[slot_count]
 *     xform     u8[slot_count] MesoTransform, relative to the slot's orientation
 *     orient    u8[slot_count] 0..3: corner of the face in the surface's file that is the
 *               slot's corner 0 (see orientation.h); without the chunk always the first
 *     over      u8[slot_count] 1 where the face is turned over about its first corner, before `orient` counts;
 *               edges whose faces still disagree are cut (mesh_wind.h). Without the chunk the surface is
 *               taken as its file winds it
 */
#ifndef MESO_SLOTS_FILE_H
#define MESO_SLOTS_FILE_H

#include "formats/file/container.h"
#include "formats/product/provenance.h"
#include "formats/tiling/result/slots_content.h"

/* `quarters` [slot_count] is the orientation; NULL, or all 0: as in the surface's file. `over` as in MesoSlotsFile. */
MesoStatus meso_slots_write(const MesoAssignment *assignment, const MesoTileSet *set,
                            const uint8_t *quarters, const uint8_t *over, const uint64_t tiles_hash[2],
                            const uint64_t surface_hash[2], const MesoProvenance *provenance,
                            MesoOutput *output, MesoError *error);

/* Copies to `arena`; a listing (slots_text.h) is read too. Checks the file alone; meso_assignment_check()
 * checks it against a surface. */
MesoStatus meso_slots_read(MesoSlotsFile *slots, MesoArena *arena, const MesoInput *input,
                           MesoError *error);

/*
 * Turns the tile numbers of the file to those of `set`, by name; the names in
 * `slots` have served then, and are gone. MESO_ERR_INPUT names a tile that a
 * slot uses and the set lacks, and leaves all as it was. O(slot_count).
 */
MesoStatus meso_slots_bind(MesoSlotsFile *slots, const MesoTileSet *set, MesoError *error);

#endif
