/*
 * Chain search: looks for bits of all chains (edge_chains.h) under which no ring contradicts
 * itself (chain_rings.h), by turning one chain after the other, and lets the exact
 * engine finish under them, which is easy then. "Simulated annealing" (Kirkpatrick,
 * Gelatt and Vecchi, 1983) at one temperature: turning a chain moves many rings at
 * once, so there is no valley to cool down into; what is won is that some thousand
 * settings are tried in the time that the engine takes for a conflict or two.
 */
#ifndef MESO_CHAIN_SEARCH_H
#define MESO_CHAIN_SEARCH_H

#include "libcore/tiling/exact/exact.h"

/*
 * MESO_SAT_YES, or MESO_SAT_UNKNOWN where `stop` says so, or nothing was found in about
 * `work` looks at an edge (5 to 10 ns each) and `conflict_limit` conflicts of the engine; at once where there are no
 * chains. The formula is the same afterwards, but for what the engine learned. Deterministic, but for `stop`. Memory of
 * meso_chain_rings_build() for the time of the call. MESO_ERR_MEMORY, or what CaDiCaL fails with.
 */
MesoStatus meso_exact_search_chains(MesoExact *exact, MesoSatAnswer *answer, MesoRandom *random, uint64_t work,
                                    uint64_t conflict_limit, bool (*stop)(void *context), void *context, MesoError *error);

#endif
