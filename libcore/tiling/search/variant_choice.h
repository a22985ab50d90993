/* Choice of a variant for an observed slot: what is to be kept, quotas, weights. */
#ifndef MESO_VARIANT_CHOICE_H
#define MESO_VARIANT_CHOICE_H

#include "libcore/tiling/propagate/propagate.h"

/*
 * A variant of the state of `slot`. The first of these that applies, in turn:
 * the one to keep, where `keeping` and still possible; where a quota still
 * needs f of the m slots that are free to count for it, one of its variants
 * with the chance f / m at least; otherwise any. Among several, each has the
 * chance of its weight. Without constraints (NULL) each has the same.
 * O(quotas * words + size of the state).
 */
uint32_t meso_choose_variant(const MesoPropagation *propagation, const MesoConstraints *constraints,
                             uint32_t slot, bool keeping, MesoRandom *random);

#endif
