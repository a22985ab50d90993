/*
 * Sparse symmetric positive definite systems: A = L D L', by rows (the up-looking method of Davis, "Direct Methods for
 * Sparse Linear Systems", 2006, chapter 4), in an order of its own (minimum_degree.h). What depends on the pattern
 * alone is done once; numbers may come again and again.
 *
 * By additions, multiplications and divisions in an order that follows from the pattern: the same bytes everywhere.
 */
#ifndef MESO_SPARSE_CHOLESKY_H
#define MESO_SPARSE_CHOLESKY_H

#include <stdint.h>

#include "libcore/base/arena.h"

/* An entry of the lower triangle, row >= column; entries of one place add up. */
typedef struct MesoTriplet {
    uint32_t row, column;
    double value;
} MesoTriplet;

typedef struct MesoCholesky {
    uint32_t count;         /* unknowns */
    uint32_t *order;        /* [count] the unknown that is eliminated first, second, ... */
    uint32_t *places;       /* [count] when an unknown is eliminated */
    size_t *column_begins;  /* [count + 1] of the columns of L, by place */
    double *values;         /* [column_begins[count]] of L; its diagonal of ones is not stored */
    double *pivots;         /* [count] D, by place */

    /*
     * Columns that follow each other, each with all rows of the next one and that one itself, are a bunch: whoever has
     * one of its columns has those behind it too, and its rows are listed once.
     */
    uint32_t *bunch_ends;   /* [count] the place behind the last column of a column's bunch */
    size_t *column_lists;   /* [count] where the rows of a column begin in: */
    uint32_t *column_rows;  /* [row_begins[count]] unknowns, in the order of their elimination */
    size_t *row_begins;     /* [count + 1] of the rows of L, by place */
    uint32_t *row_bunches;  /* [row_begins[count]] first places of bunches, ascending */

    /* What a factorisation writes to while it runs. */
    double *work;           /* [count] by unknown */
    uint32_t *marks;        /* [count] by unknown */
    size_t *column_ends;    /* [count] */
    size_t *triplet_begins; /* [count + 1] triplets by the later of their two places */
    uint32_t *triplet_list; /* [triplet_room] */
    size_t triplet_room;
} MesoCholesky;

/*
 * Finds the order and the places of all numbers from the pattern of A; values are not looked at. Diagonals are part of
 * the pattern, given or not. Results go to `arena`, with what meso_cholesky_factor() needs.
 *
 * MESO_ERR_INTERNAL for a triplet out of the lower triangle, MESO_ERR_LIMIT for 2^32 triplets or more, MESO_ERR_MEMORY.
 * 8 bytes an entry of L, and some more: on a mesh of n vertices, some 30 n log2(n) of them for a stencil of two rings.
 */
MesoStatus meso_cholesky_analyse(MesoCholesky *factor, MesoArena *arena, uint32_t count, const MesoTriplet *triplets,
                                 size_t triplet_count, MesoError *error);

/*
 * The numbers of L and D. Triplets in any order, no more than were analysed and in none but their places.
 *
 * MESO_ERR_INPUT where A is not positive definite as far as doubles tell; then the factor must not be solved with, but
 * may be factored again. MESO_ERR_INTERNAL for triplets in other places.
 */
MesoStatus meso_cholesky_factor(MesoCholesky *factor, const MesoTriplet *triplets, size_t triplet_count,
                                MesoError *error);

/*
 * Solves A X = B for `width` right sides at once, fastest for 1 to 3.
 *
 * x    [count * width], row by row: B in, X out
 *
 * Does not change the factor: may be called from several threads. O(width * entries of L).
 */
void meso_cholesky_solve(const MesoCholesky *factor, double *x, uint32_t width);

#endif
