/* Parts of one PLY file, put together. */
#ifndef MESO_PLY_JOIN_H
#define MESO_PLY_JOIN_H

#include "formats/file/input.h"
#include "formats/file/output.h"

/*
 * Writes to `output` what meso_ply_write() would have written of the whole: the bytes of `parts` [count], which it
 * wrote of selections (selection.h) that leave nothing out and have nothing twice, in any order. O(bytes), with
 * little memory. MESO_ERR_INPUT, naming the file, for what is no such part, or one of another product, and where a
 * part is missing.
 */
MesoStatus meso_ply_join(const MesoInput *parts, uint32_t count, MesoOutput *output, MesoError *error);

#endif
