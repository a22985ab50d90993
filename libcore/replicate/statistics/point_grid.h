/* Points of space in cells, to find those near a place. */
#ifndef MESO_POINT_GRID_H
#define MESO_POINT_GRID_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef struct MesoPointGrid {
    float cell;
    MesoVec3 corner;        /* least of all coordinates */
    uint32_t count, mask;
    uint32_t *begin;        /* [mask + 2] by hash of the cell */
    uint32_t *order;        /* [count] points by cell, ascending in each */
    uint64_t *keys;         /* [count] cell of order[i] */
    MesoVec3 *places;       /* [count] position of order[i] */
} MesoPointGrid;

/* cell  at least as wide as what is asked for later. O(count). MESO_ERR_MEMORY alone. */
MesoStatus meso_point_grid_build(MesoPointGrid *grid, MesoArena *arena, const MesoVec3 *positions, uint32_t count,
                                 float cell, MesoError *error);

/* Those of a cell have its key; others have come to the same place. */
typedef struct MesoPointRange {
    uint32_t begin, end;
    uint64_t key;
} MesoPointRange;

enum { MESO_POINT_CELLS = 27 };

/* One of the MESO_POINT_CELLS cells in and around that of a place: what is nearer than a cell's width is in them. */
MesoPointRange meso_point_grid_range(const MesoPointGrid *grid, MesoVec3 place, uint32_t cell);

#endif
