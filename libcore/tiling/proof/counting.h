/*
 * Counting provers: reasons why there is no assignment that clause learning does
 * not see. All sides of an inner edge match in pairs, so for each connected piece
 * of the surface
 *
 *  - each interface is shown on an even number of inner sides (parity), and
 *  - as often flipped as not (balance).
 *
 * Parity looks for a set of interfaces that the tiles of each slot all show
 * equally often modulo 2, and that comes out odd in all; balance for weights of
 * the interfaces, of opposite sign when flipped, by which the tiles of all slots
 * together come out above 0 whatever they are.
 */
#ifndef MESO_COUNTING_H
#define MESO_COUNTING_H

#include "libcore/tiling/propagate/label_pattern.h"

typedef struct MesoCountingProof {
    bool found;                 /* else nothing was proved */
    bool parity;                /* else balance */
    uint32_t first_slot;        /* of the piece */
    uint64_t slot_count;        /* of the piece */
    int64_t *weights;           /* [interface_count] 0 or 1 with parity */
} MesoCountingProof;

/*
 * Looks for a proof that the initial states of `table` have no assignment.
 * Everything lives in `arena`. O(slots * log(slots)) and a limited effort for the
 * weights. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_counting_prove(MesoCountingProof *proof, MesoArena *arena, MesoLabelPatternTable *table,
                               MesoError *error);

/* The proof in words, by the names of the interfaces, in `arena`; NULL when memory is out. */
const char *meso_counting_explain(const MesoCountingProof *proof, MesoArena *arena,
                                  const MesoTileSet *set, MesoError *error);

/* Whether `proof` holds: counts again, in whole numbers, from the slots. For tests. */
MesoStatus meso_counting_check(const MesoCountingProof *proof, bool *holds, MesoArena *arena,
                               MesoLabelPatternTable *table, MesoError *error);

#endif
