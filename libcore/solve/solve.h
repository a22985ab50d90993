/*
 * Solver: Algorithms 1 and 2 of MesoGen (section 3.3), wave function collapse
 * on label domains. A slot's domain is a bit set of variants; what passes
 * across a side is the set of signed labels that the domain shows there.
 */
#ifndef MESO_SOLVE_H
#define MESO_SOLVE_H

#include "libcore/solve/assignment.h"
#include "libcore/solve/constraints.h"

typedef enum MesoVerdict {
    MESO_VERDICT_SOLVED,
    MESO_VERDICT_UNSOLVABLE,    /* proved: the initial propagation empties a slot, or disproves a
                                   quota or the rule on strands, or the search under
                                   constraints went through every choice */
    MESO_VERDICT_GAVE_UP        /* all attempts met a dead end */
} MesoVerdict;

/* A slot left with no variant, with the labels that it could have shown to its neighbours. */
typedef struct MesoDeadEnd {
    uint32_t slot, attempt;     /* attempts count from 1; 0 for initial ones */
    bool initial;               /* met while the initial constraints were applied */
    bool border[4];             /* side has no neighbour */
    uint64_t *labels[4];        /* [label words] bit set of label codes per side that the
                                   neighbour allows; all that border rules allow on a border,
                                   and where the neighbour is dead or the slot itself */
} MesoDeadEnd;

/* Label codes in bit sets: 2 * interface for +, 2 * interface + 1 for -. */
static inline uint32_t meso_label_code(int32_t label)
{
    return 2 * meso_label_interface(label) + (label < 0);
}

typedef struct MesoSolveOptions {
    uint64_t seed;
    uint32_t max_attempts;      /* at least 1 */
    uint32_t max_dead_ends;     /* kept for the report */
    const MesoConstraints *constraints;     /* NULL: none */
    void (*progress)(void *context, uint64_t done, uint64_t total);     /* slots; may be NULL */
    void *progress_context;
} MesoSolveOptions;

typedef struct MesoSolveResult {
    MesoVerdict verdict;
    const char *reason;         /* in words, where constraints have a part in the verdict; or "" */
    uint32_t attempts;          /* begun */
    uint64_t observations;      /* over all attempts */
    uint64_t backtracks;        /* choices taken back: only quotas and rules on strands call for it */
    uint64_t *violations;       /* [meso_constraint_count()] times that the search met one; without
                                   constraints not to be read */
    MesoAssignment assignment;  /* where solved */
    uint32_t dead_end_count;    /* kept; all attempts, in order */
    uint64_t dead_end_total;    /* met */
    MesoDeadEnd *dead_ends;
    uint32_t label_word_count;
} MesoSolveResult;

/*
 * Assigns variants to slots. The result depends on the arguments alone. A
 * solved assignment has passed meso_assignment_check() and
 * meso_constraints_check(). Returns MESO_OK for
 * every verdict; MESO_ERR_MEMORY, or MESO_ERR_INPUT for a set without
 * variants. Memory O(slots * (words of variants + words of labels)).
 */
MesoStatus meso_solve(MesoSolveResult *result, MesoArena *arena, const MesoTileSet *set,
                      const MesoVariantSet *variants, const MesoSlotGraph *graph,
                      const MesoSolveOptions *options, MesoError *error);

#endif
