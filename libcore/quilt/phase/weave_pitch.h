/* How far the strands of a woven swatch are apart, and where they lie. */
#ifndef MESO_WEAVE_PITCH_H
#define MESO_WEAVE_PITCH_H

#include <stdbool.h>
#include <stdint.h>

#include "libcore/math/vec.h"

typedef struct MesoWeavePitch {
    double pitches[2];      /* of strands across x, and of those across y */
    double offsets[2];      /* x, and y, of one of them */
    bool alike;             /* both pitches: by one in twenty */
    bool chequered;         /* so they are, and neighbours are above and below by turns */
} MesoWeavePitch;

/*
 * Of middles of rings [count] and axes there: those along y by their x, and those along x by their y. The pitch is the
 * largest of which most lie at whole multiples, |sum e^(2 pi i x / pitch)| / count, and fewer of those next to it.
 * Whether they are chequered is told by their heights z, as |sum z e^(pi i (x / pitch + y / pitch))|. False where
 * either are not there, lie anywhere, or leave out many multiples. `size`: of the swatch. O(count).
 */
bool meso_weave_pitch(MesoWeavePitch *pitch, const MesoVec3 *middles, const MesoVec3 *axes, uint32_t count,
                      MesoVec2 size);

#endif
