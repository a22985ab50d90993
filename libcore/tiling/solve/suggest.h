/* Suggestion of the missing tile: Algorithm 3 of MesoGen (section 3.4). */
#ifndef MESO_SUGGEST_H
#define MESO_SUGGEST_H

#include "libcore/tiling/solve/solve.h"

/* Most configurations that one dead end may leave. */
enum { MESO_SUGGEST_PRODUCT = 1 << 26 };

typedef struct MesoSuggestion {
    int32_t labels[4];
    uint64_t votes;
    uint64_t identity_votes;    /* of these, under the identity */
    uint64_t candidate_count;   /* configurations with at least one vote */
} MesoSuggestion;

/*
 * Votes for side configurations: every dead end votes once for each pair of a
 * configuration and a permitted transform (the set's defaults; each element of
 * the group once) that fits its neighbours and its border rules. Ties go to
 * the configuration with more identity votes, then to the lexicographically
 * smallest in label codes. Configurations that a tile of the set already has
 * under a permitted transform are passed over. MESO_ERR_NO where no
 * configuration has a vote. O(dead ends * product of the sides' labels), with
 * sides over MESO_SUGGEST_PRODUCT refused (MESO_ERR_LIMIT).
 */
MesoStatus meso_suggest(MesoSuggestion *suggestion, MesoArena *arena, const MesoTileSet *set,
                        uint32_t dead_end_count, const MesoDeadEnd *dead_ends, MesoError *error);

/*
 * `extended` (which may be `set`) becomes `set` with a tile of the suggested configuration at the
 * end: the set's default transforms, no sweeps, no inner mesh, and the first
 * free name of "suggested-1", "suggested-2", ... Shares everything else with
 * `set`. O(tiles). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_suggestion_append(MesoTileSet *extended, MesoArena *arena, const MesoTileSet *set,
                                  const MesoSuggestion *suggestion, MesoError *error);

#endif
