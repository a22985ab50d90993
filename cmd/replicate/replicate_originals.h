/* The details that there are on the surface at rest, from what DETAILS says of them. */
#ifndef MESO_REPLICATE_ORIGINALS_H
#define MESO_REPLICATE_ORIGINALS_H

#include "cmd/replicate/replicate_maps.h"
#include "libcore/replicate/detail/surface_detail.h"

typedef struct MesoOriginals {
    uint32_t count;
    MesoDetail *details;        /* [count] by triangle */
} MesoOriginals;

/*
 * All distributions, one after another, by the tool's seed. MESO_ERR_INPUT where none has a detail, and by what they
 * name; MESO_ERR_LIMIT; MESO_ERR_MEMORY.
 */
MesoStatus meso_replicate_originals(MesoOriginals *originals, const MesoReplicateGround *ground,
                                    const MesoDetailsFile *details);

#endif
