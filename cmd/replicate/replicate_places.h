/* Where a distribution's details stand, before their sizes, headings and kinds are drawn. */
#ifndef MESO_REPLICATE_PLACES_H
#define MESO_REPLICATE_PLACES_H

#include "cmd/replicate/replicate_maps.h"

typedef struct MesoDetailPlace {
    MesoMeshPoint point;
    MesoDetailPoint said;       /* what its list or scene says of it; NAN and MESO_NO_INDEX for nothing */
} MesoDetailPlace;

typedef struct MesoDetailPlaces {
    uint32_t count;
    MesoDetailPlace *places;    /* [count] */
} MesoDetailPlaces;

/*
 * Of a list, at the nearest points of the surface; those of a Poisson distribution, and scattered ones, as dense as
 * `density` is; and the instances of a scene. Errors as of meso_replicate_originals().
 */
MesoStatus meso_replicate_places(MesoDetailPlaces *places, const MesoReplicateGround *ground,
                                 const MesoDetailDistribution *distribution, const MesoGrowthMap *density,
                                 uint64_t seed);

#endif
