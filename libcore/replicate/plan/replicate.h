/*
 * Details that replicate while a surface deforms: a plan of a clip. Where the surface stretches details are born
 * between those that there are, as they lie around each other at rest; the plan that comes out of it is played
 * (replica_play.h), at any of the clip's shapes and between them.
 *
 * "Real-Time Continuous Self-Replicating Details for Shape Deformation", Rohmer, Hahmann and Cani 2015; but births are
 * due by density and not by the largest triangle there was, since that grows with the number of details; exemplars are
 * local; and of several the one is taken whose distances fit.
 */
#ifndef MESO_REPLICATE_H
#define MESO_REPLICATE_H

#include "libcore/replicate/plan/detail_web.h"
#include "libcore/replicate/plan/replica_play.h"

/* A sequence of shapes of one surface. */
typedef struct MesoClip {
    const MesoTriangulation *rest;
    uint32_t frame_count;
    /* [rest->vertex_count]; the next call may use the memory again; NULL, with the error filled, where there is none */
    const MesoVec3 *(*positions)(void *context, uint32_t frame, MesoError *error);
    void *context;
} MesoClip;

typedef enum MesoReplicateMode {
    MESO_REPLICATE_PLAN,
    MESO_REPLICATE_PAPER    /* the paper's rule (paper_rule.h), of 500 originals at most, for comparison */
} MesoReplicateMode;

typedef struct MesoReplicateOptions {
    const MesoClip *clip;
    /* [original_count]; rank, copied, radius and born are not read. Faster where they come by triangle. */
    const MesoDetail *originals;
    uint32_t original_count;
    MesoReplicateMode mode;
    double alpha;               /* of the paper's rule: over the largest area at rest; 0: 1.1 */
    double ramp;                /* of a distance over which a detail comes and goes; 0: 0.06 */
    uint64_t seed;
    uint32_t thread_count;      /* 0: all cores; the same plan for any */
} MesoReplicateOptions;

/* A detail beside another when that was born. */
typedef struct MesoNeighbour {
    uint32_t detail;
    float distance;
} MesoNeighbour;

typedef struct MesoReplication MesoReplication;

enum { MESO_REPLICA_MOST = 1 << 26 };   /* details */

/*
 * Starts with the originals on the surface at rest. MESO_ERR_INPUT where a detail has no place on the surface, or the
 * surface has one side only; MESO_ERR_LIMIT, MESO_ERR_MEMORY. O(n) of the surface and details.
 */
MesoStatus meso_replicate_begin(MesoReplication **out, const MesoReplicateOptions *options, MesoError *error);

/*
 * Goes through a frame: details are born that its stretch asks for. Frames come in an order that is part of what the
 * plan is a function of. MESO_ERR_INPUT by frame and vertex where a place is no number, MESO_ERR_LIMIT where more than
 * MESO_REPLICA_MOST details are due, MESO_ERR_MEMORY. O(surface + details).
 */
MesoStatus meso_replicate_step(MesoReplication *replication, uint32_t frame, MesoError *error);

/* What there is so far; as long as the replication lives, and no step is done. */
const MesoDetail *meso_replicate_details(const MesoReplication *replication, uint32_t *count);
const MesoWeb *meso_replicate_web(const MesoReplication *replication);

/* The plan of what has been gone through. Arrays are in the arena. */
MesoStatus meso_replicate_plan(MesoReplicaPlan *plan, MesoArena *arena, const MesoReplication *replication,
                               MesoError *error);

void meso_replicate_release(MesoReplication *replication);

#endif
