/*
 * Listings of slots as text: which tile each holds, for scripts and spreadsheets, out and in.
 *
 * CSV (RFC 4180; a first line with the columns' names, in any order; the last three may be missing):
 *
 *     slot,tile,turn,flip,corner
 *     0,reed turn,1,0,2
 *
 * JSON:
 *
 *     {"format": "meso-slots", "version": 1,
 *      "inputs": {"tiles": "XXH3-128, 32 digits", "surface": the same},
 *      "slots": [{"slot": 0, "tile": "reed turn", "turn": 1, "flip": false, "corner": 2}, ...],
 *      "provenance": {...}}     which the caller adds, and readers pass over
 *
 * turn     quarter turns counter-clockwise, 0 to 3, after the flip; 0 where it is missing
 * flip     1 (true) where the tile is mirrored, x to -x; 0 (false)
 * corner   the corner of the face that is the slot's first, 0 to 3; written where slots are oriented
 *
 * Every slot from 0 on is listed once, in any order.
 */
#ifndef MESO_SLOTS_TEXT_H
#define MESO_SLOTS_TEXT_H

#include <jansson.h>

#include "formats/file/input.h"
#include "formats/file/output.h"
#include "formats/tiling/result/slots_content.h"

MesoStatus meso_slots_write_csv(const MesoSlotsFile *slots, MesoOutput *output, MesoError *error);

/* NULL when memory is out. */
json_t *meso_slots_to_json(const MesoSlotsFile *slots);

/*
 * Reads either, into `arena`; for meso_slots_read(). MESO_ERR_INPUT names line or
 * place. O(size of the file).
 */
MesoStatus meso_slots_text_read(MesoSlotsFile *slots, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
