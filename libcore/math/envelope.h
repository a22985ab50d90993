/*
 * Small symmetric positive definite systems whose numbers lie near the diagonal: A = L D L' within the envelope, from
 * the first number of each row to its diagonal (Jennings, "A compact storage scheme for the solution of symmetric
 * linear simultaneous equations", 1966). There is nothing to analyse, and rows are contiguous: faster than
 * sparse_cholesky.h where rows are short.
 *
 * By additions, multiplications and divisions in one order: the same bytes everywhere.
 */
#ifndef MESO_ENVELOPE_H
#define MESO_ENVELOPE_H

#include <stdint.h>

#include "libcore/base/arena.h"

typedef struct MesoEnvelope {
    uint32_t count;         /* unknowns */
    uint32_t *firsts;       /* [count] the column of the first number of each row */
    size_t *begins;         /* [count] where that is */
    double *values;         /* rows of A, then of L; the diagonals are those of A, then of D */
} MesoEnvelope;

/* With zeros. `firsts` [count] no larger than their row's own number; they must stay. MESO_ERR_MEMORY. */
MesoStatus meso_envelope_new(MesoEnvelope *envelope, MesoArena *arena, uint32_t count, uint32_t *firsts,
                             MesoError *error);

/* A number of the lower triangle, firsts[row] <= column <= row. */
static inline double *meso_envelope_at(const MesoEnvelope *envelope, uint32_t row, uint32_t column)
{
    return &envelope->values[envelope->begins[row] + (column - envelope->firsts[row])];
}

/*
 * Puts L and D in the place of A. O(sum of the squares of the rows' lengths). MESO_ERR_INPUT where A is not positive
 * definite as far as doubles tell.
 */
MesoStatus meso_envelope_factor(MesoEnvelope *envelope, MesoError *error);

/* Solves A X = B for three right sides: `x` [count * 3], row by row, B in, X out. */
void meso_envelope_solve(const MesoEnvelope *envelope, double *x);

#endif
