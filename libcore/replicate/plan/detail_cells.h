/*
 * Details that live, in cells of space: how many there are around a place at which distance. Not those on the other
 * side of a thin sheet, whose normals point the other way.
 */
#ifndef MESO_DETAIL_CELLS_H
#define MESO_DETAIL_CELLS_H

#include "libcore/replicate/plan/replicate_work.h"

typedef struct MesoDetailSpot MesoDetailSpot;
typedef struct MesoDetailSlot MesoDetailSlot;

typedef struct MesoDetailCells {
    float radius;               /* as wide are cells, and so far is looked */
    uint32_t mask;
    MesoDetailSlot *slots;      /* [mask + 2] in each there may be a few cells */
    MesoDetailSpot *spots;      /* [spot_count] by slot, and those that came later, in any order */
    uint32_t spot_count;
    uint32_t *next;             /* [later] */
    uint32_t first_later;       /* spot */
} MesoDetailCells;

/* Others around a place. */
typedef struct MesoVicinity {
    MesoPairCounts counts;
    float near[MESO_ORIGINAL_NEAR];     /* squared distances, ascending; INFINITY: no more */
    uint32_t nearest;                   /* detail; MESO_NO_INDEX */
} MesoVicinity;

/* With room for `later` that come; in the scratch arena. MESO_ERR_MEMORY alone. O(details). */
MesoStatus meso_cells_build(MesoDetailCells *cells, MesoReplication *r, double radius, uint32_t later,
                            MesoError *error);

/* One that has come. */
void meso_cells_put(MesoDetailCells *cells, uint32_t detail, MesoVec3 place, MesoVec3 normal);

/* One that was there from the beginning goes. */
void meso_cells_take(MesoDetailCells *cells, uint32_t detail, MesoVec3 place);

/* `self` is not seen: a detail, or MESO_NO_INDEX. */
void meso_cells_look(MesoVicinity *v, const MesoDetailCells *cells, MesoVec3 place, MesoVec3 normal, uint32_t self);

/*
 * What is around one of those that were there from the beginning, in the mean of every `stride`th by its number.
 *
 * left_out  by detail, 1: it does not count, but others see it; NULL: all count
 * counted   how many did
 */
MesoPairCounts meso_cells_mean(const MesoDetailCells *cells, uint32_t stride, const uint8_t *left_out,
                               uint32_t *counted);

#endif
