/* What a solve is asked for, and what it says. */
#ifndef MESO_SOLVE_RESULT_H
#define MESO_SOLVE_RESULT_H

#include "libcore/tiling/problem/assignment.h"
#include "libcore/tiling/problem/tiling_problem.h"
#include "libcore/tiling/proof/conflict_core.h"
#include "libcore/tiling/search/hot_spots.h"

typedef enum MesoVerdict {
    MESO_VERDICT_SOLVED,
    MESO_VERDICT_UNSOLVABLE,    /* proved */
    MESO_VERDICT_GAVE_UP        /* at a limit */
} MesoVerdict;

typedef enum MesoEngine {
    MESO_ENGINE_AUTO,           /* the search; where it gives up, counting and the exact engine */
    MESO_ENGINE_WFC,            /* the search alone */
    MESO_ENGINE_EXACT           /* counting and the exact engine alone */
} MesoEngine;

/* What led to the verdict. */
typedef enum MesoDecider {
    MESO_DECIDER_PROPAGATION,   /* unsolvable: border rules and constraints alone empty a slot, or
                                   disprove a quota or the rule on strands */
    MESO_DECIDER_SEARCH,        /* solved; or unsolvable: each variant of one slot leads to a dead end
                                   at once, or, under constraints, every choice was tried */
    MESO_DECIDER_COUNTING,      /* unsolvable: the numbers of labels do not add up */
    MESO_DECIDER_PARITY,        /* unsolvable: sums modulo 2 over all edges contradict each other */
    MESO_DECIDER_PROBING,       /* unsolvable: each variant of a slot leads to a dead end, once variants
                                   elsewhere that do are excluded */
    MESO_DECIDER_EXACT,         /* solved or unsolvable */
    MESO_DECIDER_ATTEMPTS,      /* gave up: the search had its attempts, or its observations */
    MESO_DECIDER_CONFLICTS,     /* gave up: the exact engine had its conflicts */
    MESO_DECIDER_STOP           /* gave up: was told to, by `stop` */
} MesoDecider;

/* What ended the work where it gave up. */
typedef enum MesoBudget {
    MESO_BUDGET_ATTEMPTS,       /* of the search */
    MESO_BUDGET_OBSERVATIONS,
    MESO_BUDGET_CONFLICTS,      /* of the exact engine */
    MESO_BUDGET_CUTS,           /* solutions of the exact engine that a rule on strands cut off */
    MESO_BUDGET_COUNTED,        /* slots that a quota counts: too many for the exact engine */
    MESO_BUDGET_FORMULA,        /* variables of the exact engine: there would be too many */
    MESO_BUDGET_TIME            /* `stop` said so */
} MesoBudget;

/* A slot left with no variant, with the labels that it could have shown to its neighbours. */
typedef struct MesoDeadEnd {
    uint32_t slot, attempt;     /* attempts count from 1; 0 for initial ones */
    bool initial;               /* met while the initial constraints were applied */
    bool border[4];             /* side has no neighbour */
    uint64_t *labels[4];        /* [label words] bit set of label codes per side that the
                                   neighbour allows; all that border rules allow on a border,
                                   and where the neighbour is dead or the slot itself */
} MesoDeadEnd;

typedef struct MesoSolveOptions {
    uint64_t seed;
    MesoEngine engine;
    uint32_t max_attempts;      /* of the search; at least 1 */
    uint64_t max_observations;  /* of the search, over all attempts; 0: no limit */
    uint64_t max_conflicts;     /* of the exact engine; 0: MESO_SOLVE_CONFLICTS */
    uint32_t max_dead_ends;     /* kept for the report */
    void (*progress)(void *context, uint64_t done, uint64_t total);     /* slots; may be NULL */
    void *progress_context;
    bool (*proof)(void *context, const char *data, size_t size);    /* gets the exact engine's proof
                                       (DRAT), in pieces; false: cannot; may be NULL */
    void (*clause)(void *context, const int32_t *literals, uint32_t count); /* gets its clauses; may be NULL */
    void (*formula)(void *context); /* told that a formula begins: what came before is void; may be NULL */
    void *proof_context;
    bool (*stop)(void *context);    /* asked now and then: true ends the work; may be NULL */
    void *stop_context;
} MesoSolveOptions;

/* A minute or a few of the exact engine. */
enum { MESO_SOLVE_CONFLICTS = 2000000 };

/* Slots that are told with their number of dead ends. */
enum { MESO_SOLVE_HOT_SPOTS = 10 };

typedef struct MesoSolveResult {
    MesoVerdict verdict;
    MesoDecider decider;
    const char *reason;         /* in words, for the user: what proves it, or stood in the way; or "" */
    uint32_t attempts;          /* begun */
    uint64_t observations;      /* over all attempts */
    uint64_t jumps;             /* over all attempts: back to decisions that a dead end hangs on */
    uint64_t repairs;           /* over all attempts: balls of slots reopened around a dead end */
    uint64_t backtracks;        /* choices taken back: only quotas, rules on strands and what is to be
                                   kept call for it */
    uint64_t *violations;       /* [meso_constraint_count()] times that the search met one; or NULL */
    MesoAssignment assignment;  /* where solved */
    uint32_t conflict_slot;     /* where unsolvable: near which the proof begins, or MESO_NO_INDEX */
    MesoConflictCore core;      /* where meso_explain() was asked, and found one */
    bool changes_fewest;        /* solved, with variants to keep: no assignment changes fewer, as is proved */
    MesoBudget budget;          /* where gave up */
    uint32_t decided_most;      /* slots with a single variant at the search's best moment between two choices */
    uint64_t conflicts;         /* that the exact engine met */
    uint64_t conflict_limit;    /* that it might have met; 0: it was not asked */
    uint64_t dead_ends_met;     /* by the search, in all, repaired ones too */
    uint32_t hot_spot_count;    /* where not solved */
    MesoHotSpot *hot_spots;     /* slots with most of them, the most first */
    uint32_t dead_end_count;    /* kept; the first of each attempt, in order */
    uint64_t dead_end_total;    /* attempts that met one; or slots that the initial constraints empty */
    MesoDeadEnd *dead_ends;
    uint32_t label_word_count;
} MesoSolveResult;

#endif
