/*
 * An order of elimination for sparse symmetric matrices that keeps their factors
 * sparse: approximate minimum degree (Amestoy, Davis and Duff, "An Approximate
 * Minimum Degree Ordering Algorithm", 1996).
 */
#ifndef MESO_MINIMUM_DEGREE_H
#define MESO_MINIMUM_DEGREE_H

#include <stdint.h>

#include "libcore/base/arena.h"

/*
 * order       [count] the node that is eliminated first, second, ...; owned by the caller
 * begins      [count + 1] where the neighbours of a node begin in `neighbours`
 * neighbours  both ways, each once, none its own
 *
 * By integers alone, the same everywhere. About O(|neighbours| log count) on meshes; slow where single nodes have
 * neighbours by the thousand. MESO_ERR_MEMORY.
 */
MesoStatus meso_minimum_degree(uint32_t *order, MesoArena *scratch, uint32_t count, const size_t *begins,
                               const uint32_t *neighbours, MesoError *error);

#endif
