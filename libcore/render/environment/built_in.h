/* Environments that need no file: a clear sky with the sun, and a studio. */
#ifndef MESO_BUILT_IN_H
#define MESO_BUILT_IN_H

#include "libcore/render/environment/lat_long.h"

typedef enum MesoBuiltIn { MESO_BUILT_IN_SKY, MESO_BUILT_IN_STUDIO } MesoBuiltIn;

/*
 * The sky of "A Practical Analytic Model for Daylight" (Preetham, Shirley, Smits 1999) in clear air, the sun half way
 * up at the left of the default camera, over a grey ground; or a large soft lamp there, weak ones from above and from
 * the right, narrow ones behind, in a dim room with a light floor. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_built_in_draw(MesoLatLong *map, MesoArena *arena, MesoBuiltIn which, MesoError *error);

#endif
