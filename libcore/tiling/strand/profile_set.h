/* Kinds of sweeps, before they have instances, with where each comes from. */
#ifndef MESO_PROFILE_SET_H
#define MESO_PROFILE_SET_H

#include "libcore/scene/scene.h"

/* Places where the blends of a kind are looked at, with both ends. */
enum { MESO_KIND_BLENDS = 5 };

/* Where a swept kind of the scene comes from. */
typedef struct MesoKindOrigin {
    uint32_t tile, sweep;               /* sweep is MESO_NO_INDEX for a cap */
    uint32_t start_side, end_side;      /* of the tile; equal for a cap */
    uint32_t start_section, end_section;
    bool mirrored;                      /* the tile's transform flips */
    float off[MESO_KIND_BLENDS];        /* what columns that were dropped are off those that stay, at most */
} MesoKindOrigin;

/* How coarse columns may be, in units of the profiles. */
typedef struct MesoColumnLimits {
    float off;          /* what is dropped is off what is left, at most; 0 keeps all */
    float longest;      /* of the chords, as what bends sections bends chords; 0: of any length */
} MesoColumnLimits;

typedef struct MesoProfileSet {
    uint32_t kind_count, column_count;
    MesoSweptKind *kinds;       /* [kind_count] by tile, mirrored, then sweeps before caps; no instances yet */
    MesoKindOrigin *origins;    /* [kind_count] */
    MesoSweepColumn *columns;
    uint32_t *tile_kinds;       /* [2 * tile_count + 1]: kinds of tile t unmirrored from 2 t, mirrored from 2 t + 1 */
} MesoProfileSet;

#endif
