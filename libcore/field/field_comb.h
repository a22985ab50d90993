/* Directions from their powers, each turned to be like its neighbours. */
#ifndef MESO_FIELD_COMB_H
#define MESO_FIELD_COMB_H

#include "libcore/field/triangle_frames.h"

/* Sets `directions` [triangle_count]. From the guided triangles on, then from the first of each part. O(triangles). */
MesoStatus meso_field_comb(MesoVec3 *directions, MesoArena *scratch, const MesoFieldPowers *powers,
                           const MesoVec3 *guides, const float *weights, MesoError *error);

#endif
