/* Vertices around which a direction field turns. */
#ifndef MESO_FIELD_SINGULARITIES_H
#define MESO_FIELD_SINGULARITIES_H

#include "libcore/field/direction_field.h"
#include "libcore/field/triangle_frames.h"

/* Directions to the power of their symmetry: the same number for all turns of a direction. */
typedef struct MesoFieldPowers {
    const MesoTriangulation *mesh;
    uint32_t symmetry;
    const MesoFrame *frames;    /* [triangle_count] */
    const MesoComplex *powers;  /* [triangle_count] of length 1 */
} MesoFieldPowers;

/* Sets the field's singularities, on `arena`. O(corners). MESO_ERR_MEMORY alone. */
MesoStatus meso_field_singularities(MesoDirectionField *field, MesoArena *arena, MesoArena *scratch,
                                    const MesoFieldPowers *powers, MesoError *error);

#endif
