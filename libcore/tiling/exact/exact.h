/*
 * Exact engine: the tiling problem as a propositional formula, for CaDiCaL.
 * Variables say which label an edge carries, shared by the two sides of the
 * edge, and which pattern (see label_pattern.h) a slot holds, as far as the initial
 * propagation leaves a choice. Clauses join the two both ways: a pattern
 * implies its labels, and a label that one of the patterns with it is there.
 * A variable for each chain of edges (edge_chains.h) says what the edges share.
 */
#ifndef MESO_EXACT_H
#define MESO_EXACT_H

#include "libcore/sat/cadical_adapter.h"
#include "libcore/tiling/exact/edge_chains.h"
#include "libcore/tiling/propagate/label_pattern.h"

/* Variables with their clauses take some 600 B each: 10 GB. */
enum { MESO_EXACT_MOST_VARIABLES = 1 << 24 };

/* More chains than this are as if there were none for exact_cubes.h. */
enum { MESO_EXACT_MOST_CHAINS = 1 << 10 };

typedef struct MesoExact {
    const MesoPropagation *propagation;
    MesoLabelPatternTable patterns;
    const MesoConstraints *constraints;
    MesoArena *arena;
    MesoSat *sat;
    uint32_t variable_count;
    uint64_t clause_count;
    uint32_t *edge_first;       /* [4 * slot_count] first label variable, at the edge's lower half-edge; 0: none */
    uint32_t *slot_first;       /* [slot_count] first pattern variable; 0: the slot has one pattern */
    MesoEdgeChains chains;
    uint32_t chain_first, chain_count;  /* variables of the chains (edge_chains.h) */
    uint32_t *chain_length;     /* [chain_count] edges */
    void (*clause)(void *context, const int32_t *literals, uint32_t count);
    void *context;
} MesoExact;

typedef struct MesoExactOptions {
    const uint32_t *group;      /* as in MesoLabelPatternTable; for clauses of the caller's own */
    bool chains;                /* with variables for the chains, where there are any */
    const MesoConstraints *constraints;     /* whose weights and variants to keep guide the choices; NULL: none */
    bool (*proof)(void *context, const char *data, size_t size);    /* gets the proof; may be NULL */
    void (*clause)(void *context, const int32_t *literals, uint32_t count); /* told each clause; may be NULL */
    void *context;
    bool grows;                 /* clauses will be added after the first question */
} MesoExactOptions;

/*
 * Builds the formula for the initial states of `propagation`, none of which may be
 * empty. What it points to must outlive it; arrays live in `arena`.
 * MESO_ERR_MEMORY or MESO_ERR_LIMIT (over 2^24 variables, some 10 GB);
 * meso_exact_release() is due in any case. O(slots * patterns).
 */
MesoStatus meso_exact_init(MesoExact *exact, MesoArena *arena, const MesoPropagation *propagation,
                           const MesoExactOptions *options, MesoError *error);

void meso_exact_release(MesoExact *exact);

/*
 * Literal that holds where `slot` holds `variant` or one of the same pattern;
 * -MESO_LITERAL_TRUE where it cannot. With this, and new variables from
 * meso_exact_new_variable(), callers add what else must hold. O(patterns).
 */
int32_t meso_exact_literal(MesoExact *exact, uint32_t slot, uint32_t variant);

/* Literal that holds where side `side` of `slot`, not on a border, shows `code`. */
int32_t meso_exact_label_literal(const MesoExact *exact, uint32_t slot, uint32_t side, uint32_t code);

int32_t meso_exact_new_variable(MesoExact *exact);

/* Adds a clause; literals may be MESO_LITERAL_TRUE and its negation, and are dropped from `literals` then. */
MesoStatus meso_exact_add(MesoExact *exact, int32_t *literals, uint32_t count, MesoError *error);

/*
 * Chooses what decisions try first: where `hint` [slot_count], which may be
 * NULL, gives a state of one variant, and that is possible, this; elsewhere a
 * random variant of the initial ones, by weight, and without a hint, or with weights or variants to keep, one that fits
 * its neighbours' if any does. So without a hint every solution may be found, and they follow `random` and the
 * weights. O(slots * variants).
 */
MesoStatus meso_exact_choose_phases(MesoExact *exact, const uint32_t *hint, MesoRandom *random,
                                    MesoError *error);

/*
 * Writes a variant for each slot to `variant` [slot_count] after the answer
 * MESO_SAT_YES: of the pattern that was found the one to keep, or a random one,
 * by weight. O(slots * patterns).
 */
MesoStatus meso_exact_extract(MesoExact *exact, uint32_t *variant, MesoRandom *random,
                              MesoError *error);

#endif
