/* What files of assignments say, in whichever form. */
#ifndef MESO_SLOTS_CONTENT_H
#define MESO_SLOTS_CONTENT_H

#include "libcore/tiling/problem/assignment.h"

typedef struct MesoSlotsFile {
    MesoAssignment assignment;
    uint64_t tiles_hash[2], surface_hash[2];
    bool anonymous;                 /* a listing that has no hashes: they are 0 */
    uint32_t tile_count;
    const char **tile_names;        /* [tile_count] */
    const char *provenance;         /* JSON text; {} of a listing */
    uint8_t *quarters;              /* [slot_count] orientation; NULL: as in the surface's file */
    uint8_t *over;                  /* [slot_count] 1: the face is turned over before (mesh_wind.h); NULL: the surface is
                                       taken as its file winds it */
} MesoSlotsFile;

#endif
