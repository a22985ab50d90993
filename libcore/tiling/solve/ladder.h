/*
 * The ladder of a solve, shared by its rungs: each leaves the verdict "gave up" in the result, or a better
 * one. For solve.c, search_rungs.c and exact_rungs.c alone.
 */
#ifndef MESO_LADDER_H
#define MESO_LADDER_H

#include "libcore/tiling/search/constrained_search.h"
#include "libcore/tiling/search/search.h"
#include "libcore/tiling/solve/solve_result.h"

/* Conflicts that the exact engine has before further attempts, and again before probing: about a second. */
enum { MESO_LADDER_FIRST_CONFLICTS = 3000 };

typedef struct MesoLadder {
    const MesoTilingProblem *problem;
    const MesoSolveOptions *options;
    MesoSolveResult *result;
    MesoArena *arena;               /* of the result */
    MesoArena scratch;
    MesoArena hot_arena;            /* of `hot_spots`, which are there from the first dead end on */
    MesoHotSpots hot_spots;
    MesoPropagation propagation;
    MesoSearch plain;               /* the search where no constraint calls for ways back */
    MesoConstrainedSearch constrained;  /* where one does */
    uint32_t *best_variant;         /* [slot_count] where the best attempt ended; MESO_NO_INDEX: undecided. NULL: none
                                       failed yet */
    uint32_t best_open;             /* slots that it left undecided */
} MesoLadder;

/* Whether the caller wants the work to end; and the verdict that it then has. */
bool meso_ladder_told_to_stop(const MesoLadder *ladder);
void meso_ladder_stop(MesoLadder *ladder);

/* Tells the progress; false where the search is to stop. `ladder` is a MesoLadder. */
bool meso_ladder_tick(void *ladder);

/* Takes variant[slot_count] as the solution, once checked. */
MesoStatus meso_ladder_accept(MesoLadder *ladder, const uint32_t *variant, MesoDecider decider, MesoError *error);

/* Lets the exact engine have its conflicts; and `most` of them, or what is left. */
void meso_ladder_allow_conflicts(MesoLadder *ladder);
uint64_t meso_ladder_conflicts_left(const MesoLadder *ladder, uint64_t most);

/* Whether there is a rung left to climb. */
bool meso_ladder_undecided(const MesoLadder *ladder);

/* ---- rungs of the search ---- */

/* The dead ends that there are before any choice. */
MesoStatus meso_rung_initial_dead_ends(MesoLadder *ladder, MesoError *error);

/* Before the first attempt; then attempts from sub-seeds, up to `last` in all. */
void meso_rung_prepare_search(MesoLadder *ladder);
MesoStatus meso_rung_search(MesoLadder *ladder, uint32_t last, MesoError *error);

/* The same under quotas, rules on strands, or with an assignment to keep. `*disproved` where slots that are decided
 * already break the rule on strands. */
MesoStatus meso_rung_prepare_constrained(MesoLadder *ladder, bool *disproved, MesoError *error);
MesoStatus meso_rung_constrained(MesoLadder *ladder, MesoError *error);

/* ---- rungs of the exact engine ---- */

/* With chains or without, by `conflicts` at most, and by cubes with `cubes` beyond them. */
MesoStatus meso_rung_exact(MesoLadder *ladder, bool chains, uint64_t conflicts, uint64_t cubes, MesoError *error);

/*
 * The exact engine, for a while, and by cubes; then, where it did not do, probing, and the engine
 * anew on what that leaves, without chains: where there are many solutions, but few are near, they
 * lead it astray. `constrained`: the engine alone.
 */
MesoStatus meso_rung_exact_at_length(MesoLadder *ladder, bool constrained, MesoError *error);

/* The assignment that was found, with as few changes as the exact engine finds. */
MesoStatus meso_rung_fewest_changes(MesoLadder *ladder, MesoError *error);

#endif
