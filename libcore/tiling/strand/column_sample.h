/* Some columns of a kind of sweeps, by which its steps are chosen. */
#ifndef MESO_COLUMN_SAMPLE_H
#define MESO_COLUMN_SAMPLE_H

#include "libcore/scene/scene.h"

enum { MESO_MOST_PAIRS = 64, MESO_MOST_SAMPLED = 2 * MESO_MOST_PAIRS };

/* Two neighbouring columns of a sample, and which joint of the kind's they are. */
typedef struct MesoColumnPair {
    uint32_t columns[2];
    uint32_t joint;
} MesoColumnPair;

/* Some neighbouring columns of a kind, as a kind of their own. */
typedef struct MesoColumnSample {
    MesoSweepColumn columns[MESO_MOST_SAMPLED];
    uint32_t numbers[MESO_MOST_SAMPLED]; /* of the kind */
    bool sharp[MESO_MOST_SAMPLED];       /* a corner, where a column that is off is seen whichever way */
    MesoColumnPair pairs[MESO_MOST_PAIRS];
    uint32_t pair_count;
    MesoSweptKind kind;
    MesoScene scene;
    float radius;       /* of a cap */
} MesoColumnSample;

/*
 * Of pairs of columns that join between the ends: the outermost four, the one that is farthest apart, and all, or some
 * all around, more of them where the shape changes along the way. O(columns).
 */
MesoColumnSample meso_column_sample(const MesoScene *scene, const MesoSweptKind *kind);

#endif
