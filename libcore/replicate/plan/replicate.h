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

#include "libcore/replicate/web/detail_web.h"
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
    MESO_REPLICATE_PLAN,    /* born by density, and none dies: what a plan that is played has to have */
    MESO_REPLICATE_PAPER,   /* the paper's rule (paper_rule.h), of 500 originals at most, for comparison */
    MESO_REPLICATE_LIVE     /* born and dying by density, as the surface is from frame to frame */
} MesoReplicateMode;

/* What says where details are born, but for the paper's rule. */
typedef enum MesoReplicateBirths {
    MESO_BIRTHS_USUAL,      /* statistics where they stand in groups, or are few and none longer than wide; or exemplars */
    MESO_BIRTHS_EXEMPLARS,  /* triangles of originals with others inside */
    MESO_BIRTHS_STATISTICS  /* how many others there are at which distance (pair_target.h) */
} MesoReplicateBirths;

typedef struct MesoReplicateOptions {
    const MesoClip *clip;
    /* [original_count]; rank, copied, radius and born are not read. Faster where they come by triangle. */
    const MesoDetail *originals;
    uint32_t original_count;
    MesoReplicateMode mode;
    MesoReplicateBirths births;
    double alpha;               /* of the paper's rule: over the largest area at rest; 0: 1.1 */
    double beta;                /* and of the smallest; 0: 0.9 */
    double gamma;               /* share of their distance by which each of two that merge moves a frame; 0: 0.1 */
    double mu;                  /* share of its size by which a detail grows or shrinks a frame, at most; 0: 0.1 */
    uint32_t substeps;          /* a frame is gone through in so many steps, on straight lines; 0: 1 */
    double ramp;                /* of a length, and twice of an area, over which a detail comes and goes; 0: 0.06 */
    uint64_t seed;
    uint32_t thread_count;      /* 0: all cores; the same plan for any */
} MesoReplicateOptions;

/* What has become of a detail. */
typedef struct MesoDetailFate {
    int32_t died;           /* the frame from which on it shrinks; MESO_DETAIL_LIVES */
    uint32_t into;          /* a detail beside it, which takes its room; MESO_NO_INDEX */
} MesoDetailFate;

#define MESO_DETAIL_LIVES INT32_MAX

/* A detail beside another when that was born. */
typedef struct MesoNeighbour {
    uint32_t detail;
    float distance;
} MesoNeighbour;

typedef struct MesoReplication MesoReplication;

enum { MESO_REPLICA_MOST = 1 << 26 };   /* details */

/*
 * Starts with the originals on the surface at rest. MESO_ERR_INPUT where a detail has no place on the surface;
 * MESO_ERR_LIMIT, MESO_ERR_MEMORY. O(n) of the surface and details.
 */
MesoStatus meso_replicate_begin(MesoReplication **out, const MesoReplicateOptions *options, MesoError *error);

/*
 * Goes through a frame: details are born that its stretch asks for, and die where it has shrunk. Frames come in an
 * order that is part of what the outcome is a function of; time passes by the difference of their numbers.
 * MESO_ERR_INPUT by frame and vertex where a place is no number, MESO_ERR_LIMIT where more than MESO_REPLICA_MOST
 * details are due, MESO_ERR_MEMORY. O(surface + details).
 */
MesoStatus meso_replicate_step(MesoReplication *replication, uint32_t frame, MesoError *error);

/* What there is so far; as long as the replication lives, and no step is done. */
const MesoDetail *meso_replicate_details(const MesoReplication *replication, uint32_t *count);
const MesoWeb *meso_replicate_web(const MesoReplication *replication);

/*
 * [count] shares of their sizes, in [0,1]: those born begin at 0 and grow, those dead shrink. Not of mode PLAN: there
 * play says it.
 */
const float *meso_replicate_grown(const MesoReplication *replication);

/* [count] */
const MesoDetailFate *meso_replicate_fates(const MesoReplication *replication);

/* The plan of what has been gone through. Arrays are in the arena. */
MesoStatus meso_replicate_plan(MesoReplicaPlan *plan, MesoArena *arena, const MesoReplication *replication,
                               MesoError *error);

/* Memory that it takes, in bytes. */
size_t meso_replicate_bytes(const MesoReplication *replication);

void meso_replicate_release(MesoReplication *replication);

#endif
