/*
 * Cubes: the exact engine split by the bits of chains (edge_chains.h). "Cube and
 * conquer" (Heule, Kullmann, Wieringa and Biere, 2011) with conflict-directed
 * backjumping: under the bits assumed so far the engine has a few conflicts;
 * where that does not do, one more bit is assumed, each way. What a refutation
 * did not need is left out of the clause that it leaves behind. A tiling whose
 * strips are all woven together has few such bits, and each short sum of
 * them decides much; clause learning over labels does not get there.
 */
#ifndef MESO_EXACT_CUBES_H
#define MESO_EXACT_CUBES_H

#include "libcore/tiling/exact/exact.h"

/* Fewer, and there are more cubes; between 20 and 1000 the whole takes about as many conflicts. */
enum { MESO_EXACT_CUBE_CONFLICTS = 1000 };

/*
 * Answers, or MESO_SAT_UNKNOWN after about `conflict_limit` conflicts, or where
 * `stop` says so, or where the part of the cubes that is refuted grows too slowly; at
 * once where there are no chains. `cube_conflicts` are those before another bit is
 * assumed, MESO_EXACT_CUBE_CONFLICTS where nothing speaks for others. `random` chooses which way a
 * bit is assumed first. MESO_ERR_MEMORY, or what CaDiCaL fails with.
 */
MesoStatus meso_exact_conquer(MesoExact *exact, MesoSatAnswer *answer, MesoRandom *random,
                              uint32_t cube_conflicts, uint64_t conflict_limit, bool (*stop)(void *context),
                              void *context, MesoError *error);

#endif
