/* The check of tile sets, which everything that reads one goes through. */
#ifndef MESO_TILE_SET_CHECK_H
#define MESO_TILE_SET_CHECK_H

#include "libcore/tiling/tile/tile_set.h"

/* One call for each problem; `severity` is "error" or "warning". */
typedef void MesoProblemReport(void *context, const char *severity, const char *where,
                               const char *message);

/*
 * Looks for everything that is wrong with a tile set and calls `report` for
 * each problem: labels and indices out of range, names that are missing or
 * appear twice, values that are not finite or out of range, sweeps that leave
 * from a side that does not show their section, sets without a tile (errors);
 * interfaces that no tile uses or that nothing can match, drawings without
 * area, tiles that can never have a neighbour (warnings). A set without errors,
 * whose number `error_count` gets, may be given to every other function. `report`
 * may be NULL. O(size of the set). MESO_ERR_MEMORY alone: a wrong set is no failure of the look at it.
 */
MesoStatus meso_tile_set_check(uint32_t *error_count, const MesoTileSet *set, MesoProblemReport *report, void *context,
                               MesoError *error);

#endif
