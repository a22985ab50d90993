/*
 * The state of a replication between two steps, as arrays to be stored: a replication that is begun with the same
 * options and goes on from them gives the same bytes as one that was never interrupted.
 */
#ifndef MESO_REPLICATE_STATE_H
#define MESO_REPLICATE_STATE_H

#include "libcore/replicate/plan/replicate.h"

typedef struct MesoReplicaState {
    uint32_t step_count;
    double power;                   /* of the tolerance (split_order.h) */
    uint32_t detail_count;
    const MesoDetail *details;      /* [detail_count] */
    const uint32_t *blocks;         /* [detail_count] */
    const uint32_t *near_begin;     /* [detail_count + 1] */
    const MesoNeighbour *near;      /* [near_begin[detail_count]] those that were there before */
    int64_t last_frame;             /* that has been gone through; -1: none */
    const float *grown;             /* [detail_count]; NULL: all of those that live, none of the others */
    const MesoDetailFate *fates;    /* [detail_count]; NULL: when and into what they died is not known */
    uint32_t merging_count;         /* of the paper's rule */
    const uint32_t (*mergings)[2];  /* [merging_count] details: which is kept, and which goes into it */
    uint32_t node_count, triangle_count;    /* of the web */
    const uint32_t *node_corner;    /* [node_count] */
    const uint32_t *corners;        /* [3 * triangle_count] */
    const uint32_t *twins;          /* [3 * triangle_count] */
} MesoReplicaState;

/* Arrays are the replication's own: they are so until its next step. */
MesoReplicaState meso_replicate_state(const MesoReplication *replication);

/*
 * Goes to a state; `replication` has been begun, and no more. Arrays are copied. MESO_ERR_INPUT where it is no state of
 * this surface and these originals; MESO_ERR_LIMIT, MESO_ERR_MEMORY; it can only be released then. O(details log).
 */
MesoStatus meso_replicate_resume(MesoReplication *replication, const MesoReplicaState *state, MesoError *error);

#endif
