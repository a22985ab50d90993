/* What surfaces of each roughness reflect of a map, on average around a direction: see environment.h. */
#ifndef MESO_GLOSSY_LEVELS_H
#define MESO_GLOSSY_LEVELS_H

#include "libcore/render/environment/lat_long.h"

enum { MESO_GLOSSY_LEVELS = 8 };      /* of roughness, 0 to 1 evenly */

/* Of the sizes that are fine enough for each. MESO_ERR_MEMORY alone. */
MesoStatus meso_glossy_levels_alloc(MesoLatLong levels[MESO_GLOSSY_LEVELS], MesoArena *arena, MesoError *error);

/*
 * Fills all levels but the first of two sets from their first, weighing directions as facets of that roughness
 * reflect them to an eye that looks straight on. Scratch on `arena`. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_glossy_levels_fill(MesoLatLong a[MESO_GLOSSY_LEVELS], MesoLatLong b[MESO_GLOSSY_LEVELS],
                                   MesoArena *arena, uint32_t thread_count, MesoError *error);

#endif
