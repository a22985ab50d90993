/* Columns of a kind of sweeps at a level of detail, and the sides between them, for each use of a shape. */
#ifndef MESO_SHAPE_COLUMNS_H
#define MESO_SHAPE_COLUMNS_H

#include "libcore/base/arena.h"
#include "libcore/scene/sweep.h"

/* What a shape is made for: to throw a shadow, with normals that may be far from its own; to be seen; and to be looked
 * at. Its vertices have more than positions for the last alone. */
typedef enum MesoShapeUse {
    MESO_SHAPE_SHADOW, MESO_SHAPE_SEEN, MESO_SHAPE_WHOLE
} MesoShapeUse;
enum { MESO_SHAPE_USES = 3 };

/* From one column, as a number in those kept, to another; from outside, the second is on the left. */
typedef struct MesoColumnSide {
    uint32_t from, to;
} MesoColumnSide;

typedef struct MesoShapeColumns {
    uint32_t count, side_count;
    const uint32_t *kept;           /* [count] columns of the kind */
    const MesoColumnSide *sides;    /* [side_count] */
    const MesoSweepColumn *stand_ins;   /* [count] what is drawn in place of those kept; NULL: they are */
    bool closed;                    /* sections are loops of sides: what looks away is behind what does not */
    float reach;                    /* the surface may lie so far before bands that stand for it; 0: it is there */
    uint32_t place_count;
    const uint32_t *places;         /* [place_count] of `kept`, some of them twice: each side is between two in a row, */
    const uint32_t *place_sides;    /* its number where the first is, */
    const uint8_t *joined;          /* and 1; where there is none, 0 */
    MesoSweepPlaces on_ring;        /* where these are */
} MesoShapeColumns;

/*
 * Columns within `tolerance` (scene units; 0: all) of the kind's own, with `scale` scene units to a unit of the
 * profiles. To be seen and to be looked at there are the same sides, but columns that lie where others do, as at
 * corners, are kept to be looked at alone. Columns that stand for others are moved out of the bend, so that a section
 * is as wide as the kind's, seen from any side, in the mean. A loop that is not larger than the tolerance throws its
 * shadow as two or three bands across it. Lives in `arena`. O(columns * those that a column may stand for).
 * MESO_ERR_MEMORY alone.
 */
MesoStatus meso_shape_columns(MesoShapeColumns *columns, MesoArena *arena, const MesoScene *scene,
                              const MesoSweptKind *kind, float scale, float tolerance, MesoShapeUse use,
                              MesoError *error);

#endif
