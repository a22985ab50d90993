/* Deformations for test clips, from files (.deform.json, "meso-deform", version 1): meso-deform(5). */
#ifndef MESO_DEFORM_FILE_H
#define MESO_DEFORM_FILE_H

#include "formats/file/input.h"
#include "libcore/base/arena.h"
#include "libcore/replicate/deform/deform.h"

enum { MESO_DEFORM_VERSION = 1, MESO_DEFORM_STEPS = 1 << 10 };

typedef struct MesoDeformFile {
    uint32_t step_count;        /* at least one */
    const MesoDeformStep *steps;
} MesoDeformFile;

/*
 * Reads the steps that are to deform a mesh. What a step leaves out is as meso_deform_usual() has it.
 *
 * positions  [count] of the mesh
 *
 * MESO_ERR_INPUT names the file and the place, the line and column where the JSON itself is broken, and a newer
 * version. O(size + steps * count).
 */
MesoStatus meso_deform_read(MesoDeformFile *file, MesoArena *arena, const MesoInput *input, const MesoVec3 *positions,
                            uint32_t count, MesoError *error);

#endif
