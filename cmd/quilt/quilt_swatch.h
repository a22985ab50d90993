/* Swatches of meso-quilt: by recipe or from a file, repeated where they are periodic and small. */
#ifndef MESO_QUILT_SWATCH_H
#define MESO_QUILT_SWATCH_H

#include "cmd/quilt/quilt_arguments.h"
#include "libcore/quilt/swatch/swatch.h"

typedef struct MesoQuiltSwatch {
    MesoPolygonMesh mesh;       /* as the recipe or the file has it */
    MesoSwatch swatch;          /* what the quilt is grown from */
    MesoVec3 tile;              /* its size before it was repeated */
} MesoQuiltSwatch;

/* The recipe's mesh. MESO_ERR_USAGE for what is out of range. */
MesoStatus meso_quilt_swatch_make(MesoPolygonMesh *mesh, MesoQuiltArguments *arguments);

/*
 * By --swatch, or from the operand `path`; `input` must stay open as long as the swatch is used where there is one.
 * What was found about periods is said.
 */
MesoStatus meso_quilt_swatch_read(MesoQuiltSwatch *swatch, MesoQuiltArguments *arguments, MesoInput *input,
                                  const char *path);

/* Writes the mesh of the recipe as .ply, .obj or .off, as -o says. */
MesoStatus meso_quilt_swatch_write(const MesoPolygonMesh *mesh, MesoQuiltArguments *arguments);

/* What a report says of it. */
void meso_quilt_swatch_report(json_t *report, const MesoQuiltSwatch *swatch);

#endif
