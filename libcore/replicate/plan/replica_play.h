/*
 * Playing a plan: how much of each detail there is, as a function of the present shape alone. A detail is there while
 * its part of the surface has room enough, and it gives way to those of lower rank that come near:
 *
 *     s_k = min(S((a - from) / (to - from)), min over pairs (k, j) of 1 - s_j (1 - S((d_kj - from) / (to - from))))
 *
 * S a smooth step, d the distance now, and a how large the part is: the mean, over the originals in it, of the areas
 * of their triangles over those at rest. No history: any shape alone, in any order, the same forwards and backwards. It
 * is continuous; what a frame can change is bounded by the change of areas and distances over the ramps' lengths.
 */
#ifndef MESO_REPLICA_PLAY_H
#define MESO_REPLICA_PLAY_H

#include "libcore/base/arena.h"
#include "libcore/replicate/detail/surface_detail.h"

/* Nearer than `from` to the other one it is not there, farther than `to` all of it. */
typedef struct MesoReplicaPair {
    uint32_t other;         /* of lower rank */
    float from, to;         /* 0 < from < to */
} MesoReplicaPair;

/* How large its part of the surface is when it begins to be there, and when all of it is. */
typedef struct MesoReplicaRoom {
    uint32_t block;         /* which part; below detail_count */
    float from, to;         /* 0 <= from < to; to may be INFINITY: it never is there */
} MesoReplicaRoom;

typedef struct MesoReplicaPlan {
    uint32_t detail_count;
    MesoDetail *details;        /* [detail_count] each has a rank of its own, below detail_count */
    uint32_t *pair_begin;       /* [detail_count + 1] */
    MesoReplicaPair *pairs;     /* [pair_begin[detail_count]] by detail */
    MesoReplicaRoom *rooms;     /* [detail_count] */
} MesoReplicaPlan;

typedef struct MesoPlayer MesoPlayer;

/*
 * Makes ready to play: details by how many others they wait for, and by place. Arrays are in the arena; the plan is not
 * kept, the surface at rest has to stay. MESO_ERR_INPUT where a pair or room is not as said above, by detail;
 * MESO_ERR_MEMORY. O(details log + pairs).
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
