/* Triangles that cut through each other. */
#ifndef MESO_CHECK_CROSSINGS_H
#define MESO_CHECK_CROSSINGS_H

#include "libcore/quilt/check/check_mesh.h"

/* Pairs of triangles. Those that lie in one plane are not counted, nor neighbours along an edge. */
typedef struct MesoCrossings {
    uint64_t between_count;     /* of different elements */
    uint64_t within_count;      /* of one */
    uint64_t one_patch_count;   /* of both kinds, those that one patch has placed: no seam is to blame */
    uint32_t element_count;     /* elements that take part */
} MesoCrossings;

/*
 * Positions are finite. On `thread_count` threads (0: all cores), the same for any number of them.
 * O(n log n + pairs of boxes that meet). MESO_ERR_MEMORY.
 */
MesoStatus meso_check_crossings(MesoCrossings *crossings, MesoArena *scratch, const MesoCheckMesh *mesh,
                                uint32_t thread_count, MesoError *error);

#endif
