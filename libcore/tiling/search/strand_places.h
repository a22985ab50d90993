/*
 * What a rule on strands forbids in a place whatever stands elsewhere: excluded
 * before any search begins. A variant may break the rule by itself, or have a
 * strand on its own that stays apart. And where strands can neither end nor fork
 * on a piece of the surface, each of them closes to a ring there: no variant
 * with a part of one may stand on that piece under no_loops. Where they cannot
 * end, each has a cycle: none may under acyclic.
 */
#ifndef MESO_STRAND_PLACES_H
#define MESO_STRAND_PLACES_H

#include "libcore/tiling/propagate/propagate.h"

/*
 * As meso_propagation_init(), without the variants above, up to a fixed point of both; the same
 * where the constraints have no rule on strands. MESO_ERR_MEMORY, or MESO_ERR_LIMIT
 * as meso_strand_search_init(). meso_propagation_release() is due in any case.
 */
MesoStatus meso_strand_places_init(MesoPropagation *propagation, MesoArena *arena,
                                   const MesoTilingProblem *problem, MesoError *error);

#endif
