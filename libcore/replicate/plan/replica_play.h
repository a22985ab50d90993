/*
 * Playing a plan: how much of each detail there is, as a function of the present shape alone. Details give way to
 * those of lower rank that come near:
 *
 *     s_k = min over pairs (k, j) of 1 - s_j (1 - S((d_kj - from) / (to - from)))
 *
 * S a smooth step and d the distance now; without s_j where the pair holds always. No history: any shape alone, in any
 * order, the same forwards and backwards. It is continuous; what a frame can change is bounded by the change of
 * distances over the ramps' lengths.
 */
#ifndef MESO_REPLICA_PLAY_H
#define MESO_REPLICA_PLAY_H

#include "libcore/base/arena.h"
#include "libcore/replicate/detail/surface_detail.h"

/* Nearer than `from` to the other one it is not there, farther than `to` all of it. */
typedef struct MesoReplicaPair {
    uint32_t other;         /* of lower rank */
    bool always;            /* whether the other one is there or not: how near its place is says how the surface is */
    float from, to;         /* 0 < from < to; to may be INFINITY: it never is where the other one is */
} MesoReplicaPair;

typedef struct MesoReplicaPlan {
    uint32_t detail_count;
    MesoDetail *details;        /* [detail_count] each has a rank of its own, below detail_count */
    uint32_t *pair_begin;       /* [detail_count + 1] */
    MesoReplicaPair *pairs;     /* [pair_begin[detail_count]] by detail */
} MesoReplicaPlan;

typedef struct MesoPlayer MesoPlayer;

/*
 * Makes ready to play: details by how many others they wait for, and by place. Arrays are in the arena; the plan is not
 * kept. MESO_ERR_INPUT where a pair is not as said above, by detail; MESO_ERR_LIMIT, MESO_ERR_MEMORY. O(details log +
 * pairs).
 */
MesoStatus meso_player_build(MesoPlayer **player, MesoArena *arena, const MesoTriangulation *rest,
                             const MesoReplicaPlan *plan, MesoError *error);

/*
 * Plays a shape.
 *
 * grown      [detail_count] shares in [0,1]
 * positions  [rest->vertex_count] of the shape
 *
 * One thread a player at a time calls it; it uses `thread_count` (0: all cores), the same for any. O(details + pairs).
 */
void meso_player_play(MesoPlayer *player, float *grown, const MesoVec3 *positions, uint32_t thread_count);

#endif
