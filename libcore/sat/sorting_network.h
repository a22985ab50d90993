/*
 * Counting with clauses: a sorting network over literals puts those that hold first, so
 * that one of its outputs says whether so many do (Eén and Sörensson, "Translating
 * pseudo-Boolean constraints into SAT", 2006; the network is Batcher's odd-even merge sort).
 */
#ifndef MESO_SORTING_NETWORK_H
#define MESO_SORTING_NETWORK_H

#include "libcore/sat/cadical_adapter.h"

/* Comparators of a network for `count` literals: each has two new variables, and six clauses of 14 literals in all. */
uint64_t meso_sort_comparators(uint32_t count);

/* Where clauses go, and variables come from. */
typedef struct MesoClauses {
    MesoStatus (*add)(void *context, int32_t *literals, uint32_t count, MesoError *error);
    int32_t (*new_variable)(void *context);
    void *context;
} MesoClauses;

/*
 * Sorts items[count], which has room for the next power of two: afterwards items[i] is a
 * literal that holds exactly where more than i of them do. MESO_LITERAL_TRUE and its
 * negation may be among them, before and after; no clause has them. O(count * log^2(count))
 * clauses. What `add` fails with.
 */
MesoStatus meso_sort_literals(const MesoClauses *clauses, int32_t *items, uint32_t count, MesoError *error);

#endif
