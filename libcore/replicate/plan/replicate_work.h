/* What a replication knows while it goes through a clip. */
#ifndef MESO_REPLICATE_WORK_H
#define MESO_REPLICATE_WORK_H

#include "libcore/replicate/plan/exemplars.h"
#include "libcore/replicate/plan/replicate.h"
#include "libcore/replicate/web/edge_balance.h"

enum { MESO_BIRTH_NEAR = 24, MESO_EDGE_BINS = 32 };

/* Of fewer each birth is looked at longer. */
enum { MESO_FEW_DETAILS = 4096 };

/* Edges between details, by squared length: what there is too much of now pushes those away that are born. */
typedef struct MesoEdgePush {
    float bins_a_square;            /* bins of a squared length */
    double least2;                  /* nearer, squared, than this there are none at rest */
    double rest[MESO_EDGE_BINS];    /* share of all edges */
    float push[MESO_EDGE_BINS + 1]; /* what it costs to be born at that distance; 0 beyond the last */
} MesoEdgePush;

static inline float meso_push_at(const MesoEdgePush *edges, float length2)
{
    float at = length2 * edges->bins_a_square;
    return edges->push[at < MESO_EDGE_BINS ? (int)at : MESO_EDGE_BINS];
}

/* How much larger triangles are than others at rest, and so may be later. */
typedef struct MesoTolerance {
    uint32_t count;
    float *rest;            /* [count] of some triangles: area over what their corners have each */
    float *weights;         /* [count] rest to the power of what is told by `power` and the spread now, less than 0 */
    bool plain;             /* that is 0 */
    double power;
    double spread;          /* deviation over mean of edges at rest */
    MesoEdgePush edges;
} MesoTolerance;

enum { MESO_TARGET_BINS = 24 };

/* Others by distance. */
typedef struct MesoPairCounts {
    double of[MESO_TARGET_BINS];
} MesoPairCounts;

typedef struct MesoPairTarget {
    double radius;              /* of the largest distance */
    MesoPairCounts rest;        /* a detail's, in the mean */
    MesoPairCounts weights;     /* of a difference, squared */
    MesoPairCounts debt;        /* of births and deaths of a step so far */
    double border_share;        /* of what is around a detail, for its distance, that is beyond the border */
    double core2;               /* nearer, squared, than this are hardly any */
    MesoEdgeRest edges;         /* of the web */
    MesoEdgeBalance edge_debt;  /* likewise */
    bool grouped;               /* there are far more pairs at small distances than of details strewn freely */
} MesoPairTarget;

struct MesoReplication {
    MesoArena arena, scratch;
    MesoReplicateOptions options;
    const MesoTriangulation *rest;
    MesoTriangulation now;          /* `rest` with the positions of the frame: not owned */
    MesoVec3 *normals;              /* [rest->vertex_count] of the frame */
    float *rest_areas;              /* [rest->triangle_count] */
    MesoWeb web;
    MesoExemplars exemplars;
    uint32_t detail_count, detail_room;
    MesoDetail *details;
    float *grown;                   /* [detail_count] */
    MesoDetailFate *fates;          /* [detail_count] */
    uint32_t *copies;               /* [original_count] births so far of which it is the original */
    float *areas;                   /* [detail_count] at rest, of the cell of what it is a copy of */
    uint32_t *blocks;               /* [detail_count] part of the surface in which births are counted */
    uint32_t *near_begin;           /* [detail_count + 1] */
    uint32_t near_room;
    MesoNeighbour *near;            /* those around it that were there before */
    MesoNeighbour *above;           /* [original_count] the nearest of lower rank, at rest; or MESO_NO_INDEX */
    MesoTolerance tolerance;
    MesoPairTarget pairs;
    bool by_pairs;                  /* births are (pair_target.h) */
    struct MesoPaperRule *paper;    /* where that is the mode */
    uint32_t merging_count, merging_room;
    uint32_t (*mergings)[2];        /* [merging_count] details that come nearer to each other: kept, given */
    MesoVec3 *before, *between;     /* [rest->vertex_count] positions of the last frame, and of a step, with substeps */
    uint32_t step_count;
    int64_t last_frame;             /* that has been gone through; -1: none */
    double passing;                 /* frames that pass in this step */
    uint32_t block_count;
    double *due;                    /* [block_count] details due in a block, less those there */
};

/* So that blocks do not all come to their next detail at once: of one; in all as good as nothing. */
static inline double meso_phase_of(uint32_t block)
{
    double at = (block + 0.5) * 0.6180339887498949;
    return 0.9 * (at - floor(at) - 0.5);
}

/* What a copy that there is of an original counts, beside a misfit: all have about as many, and kinds their shares. */
#define MESO_COPY_COST 0.1

/* Of details more than are due in a block, so that some die. Births begin at a half too few: what trembles changes
   nothing. */
#define MESO_SURPLUS 0.6

/* A detail that will be born. */
typedef struct MesoBirth {
    uint32_t copied;
    MesoVec3 place;     /* in the plane of its triangle of the web, not yet on the surface */
    uint32_t beside;    /* detail at the corner that it is nearest to */
    uint32_t block;     /* in which it was due */
} MesoBirth;

/*
 * Those that the best of similar exemplars puts into a triangle of the web that has a detail; how many. `cost`: of the
 * worst of them, how far the distances around it are from what they are at rest.
 */
uint32_t meso_choose_births(const MesoReplication *r, uint32_t triangle, uint32_t limit,
                            MesoBirth births[MESO_EXEMPLAR_INSIDE], double *cost);

/* Adds a detail to the web, in or near a triangle of it, and to what is known. */
MesoStatus meso_give_birth(MesoReplication *r, uint32_t triangle, const MesoBirth *birth, int32_t frame,
                           MesoError *error);

/* Takes a detail out of the web, at a frame; another one beside it takes its room. False where the web would break. */
bool meso_let_die(MesoReplication *r, uint32_t detail, int32_t frame);

/* Details die where there are more than are due. MESO_ERR_MEMORY alone. */
MesoStatus meso_thin_out(MesoReplication *r, int32_t frame, MesoError *error);

/*
 * Ranks of originals, so that those of high rank give way first and the others lie as evenly as they can be then: from
 * the most crowded on, in each block about as many. MESO_ERR_MEMORY alone. O(originals).
 */
MesoStatus meso_rank_by_crowd(MesoReplication *r, MesoError *error);

static inline bool meso_lives(const MesoReplication *r, uint32_t detail)
{
    return r->fates[detail].died == MESO_DETAIL_LIVES;
}

/* Fills `above`. MESO_ERR_MEMORY alone. */
MesoStatus meso_find_above(MesoReplication *r, MesoError *error);

/* Of a detail that has no direction: none, and no time is lost on it. */
static inline MesoVec3 meso_heading(const MesoReplication *r, const MesoVec3 *positions, uint32_t detail)
{
    const MesoVec3 none = {0, 0, 0};
    return meso_detail_aspect(&r->details[detail]) == 1 ? none
                                                        : meso_detail_heading(r->rest, positions, &r->details[detail]);
}

/* From a detail to another, in the norm of the first, whose heading is that. */
static inline float meso_distance(const MesoReplication *r, const MesoVec3 *places, uint32_t detail, MesoVec3 heading,
                                  uint32_t other)
{
    return sqrtf(meso_detail_norm2(meso_vec3_sub(places[other], places[detail]), heading,
                                   meso_detail_aspect(&r->details[detail])));
}

#endif
