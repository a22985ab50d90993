/* Borders of regions, as chains of edges: what seeds lie on and streams start from. */
#ifndef MESO_BORDER_CHAINS_H
#define MESO_BORDER_CHAINS_H

#include "libcore/decor/decor_work.h"
#include "libcore/mesh/cut/chain_samples.h"

typedef struct MesoBorderChains {
    MesoBorderLoops loops;
    MesoEdgeChain *chains;      /* [count] those that a seed asks for; of loops, by falling length */
    uint32_t count;
} MesoBorderChains;

/*
 * The chains of a kind (borders, outer, inner, loop, side) in a domain; none where the region has no such. Slits belong
 * to the border. O(triangles of the domain).
 */
MesoStatus meso_border_chains(MesoDecorWork *work, const MesoDomain *domain, MesoSeedKind kind,
                              const MesoSeedSpec *spec, MesoBorderChains *chains, MesoError *error);

/* Points along chains: `count` over all, by their lengths, each chain one at least; or one every `spacing`. */
MesoStatus meso_border_samples(MesoDecorWork *work, const MesoBorderChains *chains, uint32_t count, double spacing,
                               MesoMeshPoint **points, uint32_t *point_count, MesoError *error);

#endif
