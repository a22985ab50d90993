/* Where growth starts: places for the seeds of a grammar, each with its heading and the key of its branch. */
#ifndef MESO_GROWTH_SEEDS_H
#define MESO_GROWTH_SEEDS_H

#include "libcore/growth/ground/growth_contexts.h"

/* A branch before its first command. */
typedef struct MesoGrowthStart {
    MesoTip tip;
    uint32_t seed;              /* of the grammar: its code begins at seeds[seed].entry */
    uint64_t key;
} MesoGrowthStart;

/* Points that files name, for the seeds that want them: by seed of the grammar. */
typedef struct MesoGrowthPlaces {
    uint32_t count;
    const MesoMeshPoint *points;        /* [count] */
    const uint8_t *breaks;              /* [count] 1: nothing leads here from the point before; NULL: none */
    const uint32_t *begin;              /* [seed_count + 1] into points; for points and curves. A curve's are the
                                         * corners of polylines, open, straight in space between them */
} MesoGrowthPlaces;

typedef struct MesoGrowthStarts {
    uint32_t count;
    MesoGrowthStart *starts;            /* [count] in the order of the grammar's seeds, and of each its places */
} MesoGrowthStarts;

/*
 * Tries the places of each seed in order: its `where` must hold, its `field` gives the heading (a random one, by the
 * key, where there is none or it leads nowhere), at most `count` are taken. Places keep their numbers, and so their
 * keys, whether or not those before them are taken. Poisson radii may be expressions of the place: no seed is within
 * the radius of another then, where they change by less than half of the way, and there is none where the radius is
 * below a 4096th of the surface's extent. MESO_ERR_INPUT where a value is no number, with the line of the grammar's
 * text; MESO_ERR_LIMIT for more than 2^31 places, or some 2^24 of `poisson`; MESO_ERR_MEMORY.
 */
MesoStatus meso_growth_seeds(MesoGrowthStarts *out, MesoArena *arena, const MesoGrammar *grammar,
                             const MesoGrowthContexts *contexts, const MesoGrowthPlaces *places, uint64_t seed,
                             uint32_t thread_count, MesoError *error);

#endif
