/* What the steps of a quilt share. A step is one patch: chart, placement, seam, whole elements, strands. */
#ifndef MESO_QUILT_WORK_H
#define MESO_QUILT_WORK_H

#include <stdatomic.h>

#include "libcore/math/thin_plate.h"
#include "libcore/quilt/composite.h"
#include "libcore/quilt/match/match_search.h"
#include "libcore/quilt/phase/stripe_phases.h"
#include "libcore/quilt/phase/weave_pitch.h"
#include "libcore/quilt/quilt_plane.h"
#include "libcore/quilt/seam/clip.h"
#include "libcore/quilt/seam/seam_cut.h"
#include "libcore/quilt/seam/section.h"

/* How much of a triangle of the base is covered. */
typedef enum MesoCover {
    MESO_COVER_NONE,
    MESO_COVER_FRAYED,  /* geometry that may still end there: a later patch takes its place */
    MESO_COVER_DONE,
    MESO_COVER_OUTSIDE  /* of cells: of the chart */
} MesoCover;

/*
 * Patches that are made at the same time, far from each other. More would have more cores at work, but fronts to begin
 * at are few. It is no matter of threads: the result depends on it.
 */
enum { MESO_QUILT_PATCHES = 4 };

/* Placements of a patch that are looked at closely. */
enum { MESO_QUILT_TRIALS = 4 };

/* Scratch for placements and for second tasks, lent to those who ask: as many as there can be at once. */
enum { MESO_QUILT_ARENAS = MESO_QUILT_PATCHES * (MESO_QUILT_TRIALS + 1) };

typedef struct MesoArenaPool {
    MesoArena arenas[MESO_QUILT_ARENAS];
    atomic_bool lent[MESO_QUILT_ARENAS];
} MesoArenaPool;

MesoArena *meso_arena_pool_lend(MesoArenaPool *pool);
void meso_arena_pool_return(MesoArenaPool *pool, MesoArena *arena);

typedef struct MesoQuiltTally {
    MesoQuiltReport report;
    double cost_sum, square_sum;
    uint64_t moved_count;
} MesoQuiltTally;

/*
 * Rings of strands: vertices that lie equally far along a strand. A strand is cut between two of them, where its middle
 * line crosses the seam.
 */
typedef struct MesoStrandRings {
    uint32_t count;
    uint32_t *of_vertex;        /* [vertex_count] ring, or MESO_NO_INDEX where there is no strand */
    uint32_t *sizes;            /* [count] vertices */
    MesoVec3 *middles;          /* [count] */
    MesoVec3 *axes;             /* [count] unit, along the strand, either way; 0: unknown */
    float *reaches;             /* [count] the largest distance of a vertex from the middle */
    float *steps;               /* [count] mean distance to the next rings */
    uint32_t *next;             /* [2 * count] rings next to each, the first two of them; or MESO_NO_INDEX */
} MesoStrandRings;

typedef struct MesoQuiltWork {
    const MesoTriangulation *base;
    const MesoSwatch *swatch;
    MesoQuiltOptions options;   /* with defaults filled in */
    MesoMatchField field;
    uint32_t *roots;            /* [swatch->element_count] whole_roots.h */
    MesoStrandRings rings;      /* of the swatch */
    MesoComposite composite;
    uint8_t *covers;            /* [triangle_count] MesoCover */
    uint32_t *chart_triangles;  /* [triangle_count] MESO_NO_INDEX between steps */
    MesoQuiltTally tally;       /* of all steps */
    atomic_uint busy_patches;   /* that are being made ready: cores beyond these try placements */
    MesoArenaPool pool;
    bool in_phase;              /* strands are to lie in phase, at a pitch: */
    MesoWeavePitch pitch;       /* of the swatch */
    MesoStripePhases phases;    /* of the base */
    bool welds;                 /* the swatch has strands and is periodic: patches may fit vertex by vertex */

    /* lengths in units of the swatch */
    float ring;         /* at the rim of a patch, where nothing is changed */
    float strand_margin;        /* from there on strands no longer fray */
    float whole_margin;         /* how far whole elements reach, and so the rim moves in */
    float widening;     /* how far a patch reaches into what is done */
    float chart_radius;
    float seed_reach;   /* in the surface's units: how far around a seed a patch looks for what is not done */
    float seeds_apart;  /* in the surface's units: charts around such seeds do not touch */
} MesoQuiltWork;

/* The older quilt in the plane of a patch. */
typedef struct MesoOldGeometry {
    uint32_t vertex_count, triangle_count, whole_count;
    uint32_t *vertices;         /* [vertex_count] of the composite; their marks are these numbers */
    MesoVec3 *positions, *normals;      /* [vertex_count] */
    uint32_t *triangles;        /* [triangle_count] of the composite */
    uint32_t *corners;          /* [3 * triangle_count] */
    uint32_t *wholes;           /* [whole_count] of the composite */
    MesoVec3 *centres;          /* [whole_count] */
} MesoOldGeometry;

/* What a seam is to know of the chart, whatever the placement: by cells of one grid over its plane. */
typedef struct MesoSeamGround {
    uint32_t columns, rows;
    MesoVec2 low;
    float cell;
    uint8_t *covers;            /* [columns * rows] MesoCover, or MESO_COVER_OUTSIDE */
    uint8_t *layers;            /* strands of the older quilt that lie over each other */
    float *rim;                 /* distance to where the surface goes on and the chart does not */
    float *outside;             /* distance to the chart, outside of it */
    float *undone;              /* distance to what is not done, and not at the rim */
} MesoSeamGround;

/*
 * One patch. Steps whose charts have no triangle in common, nor neighbouring ones, may be made at the same time: of the
 * work they change only what lies under their charts. What they add to the quilt comes after, one by one.
 */
typedef struct MesoQuiltStep {
    uint32_t seed, patch;
    MesoArena *beside;          /* where there may be two of its tasks at the same time: scratch for the second */
    MesoChartMaker *maker;
    MesoQuiltTally *tally;
    float tightness;            /* of the margins: 1, or less where a patch was too small for them */
    MesoChart chart;
    MesoQuiltPlane plane;
    MesoOldGeometry old;
    MesoStrandRings old_rings;  /* of what is there */
    MesoSeamGround ground;
    uint8_t *old_fixed;         /* [old_rings.count] not 0: at the rim, they stay as they are */
    MesoMatchPoint *points;     /* [point_count] of the older quilt, that the placement is to match */
    float *point_weights;
    uint32_t *point_origins;    /* vertices of the swatch that they are copies of, or lie next to */
    uint32_t point_count;
    MesoMatch match;
    float turn_cos, turn_sin;
    MesoSeamGrid seam;
    float *rim;                 /* [seam cells] distance to the rim of the patch; 0 outside */
    MesoThinPlate warp;         /* what is added to the new side */
    float warp_limit;           /* the longest way of any of its points */
    float warp_reach;           /* distance from the seam at which that has faded out */
    MesoArenaMark before_sides[2];  /* of its arena and of `beside`: what comes then goes where sides are cut anew */
} MesoQuiltStep;

/* What is to be done for one side of a seam: 0 the older one, 1 the new one. */
typedef MesoStatus MesoSideTask(void *context, int side, MesoArena *arena, MesoError *error);

/* Both sides, at the same time where the step may and a core is idle; of errors the older side's. */
MesoStatus meso_quilt_both(MesoSideTask *task, void *context, const MesoQuiltStep *step, const MesoQuiltWork *work,
                           MesoArena *arena, MesoError *error);

/* From the swatch to the plane and back. */
static inline MesoVec2 meso_step_turn(const MesoQuiltStep *step, MesoVec2 p)
{
    return (MesoVec2){step->turn_cos * p.x - step->turn_sin * p.y, step->turn_sin * p.x + step->turn_cos * p.y};
}

static inline MesoVec2 meso_step_unturn(const MesoQuiltStep *step, MesoVec2 p)
{
    return (MesoVec2){step->turn_cos * p.x + step->turn_sin * p.y, step->turn_cos * p.y - step->turn_sin * p.x};
}

static inline MesoVec3 meso_step_from_swatch(const MesoQuiltStep *step, MesoVec3 s)
{
    MesoVec2 p = meso_step_turn(step, meso_vec2_sub((MesoVec2){s.x, s.y}, step->match.shift));
    return (MesoVec3){p.x, p.y, s.z};
}

static inline MesoVec3 meso_step_to_swatch(const MesoQuiltStep *step, MesoVec3 p)
{
    MesoVec2 s = meso_vec2_add(meso_step_unturn(step, (MesoVec2){p.x, p.y}), step->match.shift);
    return (MesoVec3){s.x, s.y, p.z};
}

/* A point of the new side where the warp has it. */
MesoVec3 meso_step_warp(const MesoQuiltStep *step, MesoVec3 p);

/* Loads the quilt over the chart; composite marks are set until meso_old_geometry_forget(). */
MesoStatus meso_old_geometry_load(MesoQuiltStep *step, MesoQuiltWork *work, MesoArena *arena, MesoError *error);
void meso_old_geometry_forget(const MesoQuiltStep *step, MesoQuiltWork *work);

/* Placements, best first. */
MesoStatus meso_quilt_place(MesoMatch *matches, uint32_t *found, uint32_t wanted, MesoQuiltStep *step,
                            const MesoQuiltWork *work, MesoArena *arena, MesoError *error);
/*
 * Takes a placement; then moves and turns it by less than a voxel or so until it fits. False where nothing is there to
 * fit.
 */
bool meso_quilt_align(MesoQuiltStep *step, const MesoQuiltWork *work);
void meso_quilt_choose(MesoQuiltStep *step, const MesoQuiltWork *work, MesoMatch match);

/* Looks at the chart, once a step; then where the new side of a placement is. */
MesoStatus meso_quilt_ground(MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena, MesoError *error);
MesoStatus meso_quilt_seam(MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena, MesoError *error);

/* Marks what the patch covers; whether the seed is done. */
bool meso_quilt_cover(const MesoQuiltStep *step, MesoQuiltWork *work);

/* Pairs of whole elements; then old ones are taken away, and new ones placed. */
typedef struct MesoWholePairs {
    uint32_t count;             /* new elements that may be placed */
    uint32_t *elements;         /* [count] of the swatch */
    MesoVec3 *centres;          /* [count] in the plane, not warped */
    uint32_t *partners;         /* [count] of the old ones, or MESO_NO_INDEX */
} MesoWholePairs;

MesoStatus meso_quilt_pair_wholes(MesoWholePairs *pairs, const MesoQuiltStep *step, const MesoQuiltWork *work,
                                  MesoArena *arena, MesoError *error);
/* What becomes of whole elements: which old ones go, and which new ones come. */
typedef struct MesoWholePlan {
    bool *old_dies;             /* [old.whole_count] */
    uint32_t count;
    uint32_t *elements;         /* [count] of the swatch */
    MesoQuiltVertex *centres;   /* [count] */
    MesoQuiltVertex *places;    /* their vertices, one element after the other */
} MesoWholePlan;

MesoStatus meso_quilt_plan_wholes(MesoWholePlan *plan, const MesoWholePairs *pairs, const MesoQuiltStep *step,
                                  const MesoQuiltWork *work, MesoArena *arena, MesoError *error);
MesoStatus meso_quilt_commit_wholes(const MesoWholePlan *plan, const MesoQuiltStep *step, MesoQuiltWork *work,
                                    MesoError *error);

/* Rings of all strands of a swatch. Some scratch stays in the arena. */
MesoStatus meso_strands_find_rings(MesoStrandRings *rings, const MesoSwatch *swatch, MesoArena *arena,
                                   MesoError *error);
/* Those of what is there: rings of the swatch, as far as they hang together. */
MesoStatus meso_strands_old_rings(MesoStrandRings *rings, const MesoOldGeometry *old, const MesoQuiltWork *work,
                                  MesoArena *arena, MesoError *error);

/* Of these, which stay as they are, wherever the swatch comes to lie. */
MesoStatus meso_strands_fix_old(uint8_t **old_fixed, const MesoQuiltStep *step, const MesoQuiltWork *work,
                                MesoArena *arena, MesoError *error);

/*
 * How far each ring lies on its own side of the seam, in the plane's units. A strand that both sides have is seen where
 * it lies between both, so that one of them has it, and only one.
 */
typedef struct MesoRingShares {
    float *old_values;          /* [old_rings.count] */
    float *new_values;          /* [rings.count of the swatch] -INFINITY: not on the chart */
    MesoVec3 *old_ways, *new_ways;      /* [the same] beside a strand, to where the other side has it */
    uint8_t *old_has, *new_has; /* [the same] whether it has */
    const MesoVec3 *new_middles, *new_axes;     /* [rings.count of the swatch] as they lie in the plane */
    MesoVec3 *places;           /* [vertex_count of the swatch] of strands, warped */
    uint32_t pull_count;
    MesoVec3 *pulls_from;       /* [pull_count] middles of new rings */
    MesoVec3 *pulls_apart;      /* [pull_count] the way to the older strand from there */
} MesoRingShares;

MesoStatus meso_strands_share(MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                              MesoArena *arena, MesoError *error);

/* Strands of one side, cut between the rings that it has and those that it has not. */
typedef struct MesoStrandSide {
    uint32_t vertex_count, triangle_count;
    MesoVec3 *positions;        /* [vertex_count] */
    float *values;              /* [vertex_count] those of their rings: positive where kept */
    uint32_t *vertices;         /* [vertex_count] of the composite, or of the swatch */
    uint32_t *triangles;        /* [triangle_count] of the composite, or of the swatch */
    uint32_t *corners;          /* [3 * triangle_count] */
    MesoClip clip;
    MesoVec3 *clipped;          /* [clip vertices] */
    MesoSection *sections;      /* [loops that close] */
    MesoVec3 *axes;             /* [sections] along the strand, away from this side */
    uint32_t *partners;         /* [sections] of the other side, or MESO_NO_INDEX */
    MesoVec3 *moves;            /* [sections] what each is to move by */
    MesoVec3 *turns;            /* [sections] what its axis is to turn to */
    MesoVec3 *besides;          /* [sections] the way to the partner's strand, beside both */
    uint32_t *rings;            /* [sections] ring of each */
    uint32_t section_count;
} MesoStrandSide;

/* What a side is to have: its sections are the same, but most of what asks for them needs nothing else. */
typedef enum MesoCutExtent {
    MESO_CUT_ALL,       /* all that is kept, and what is deformed with it */
    MESO_CUT_ENDS       /* only triangles at the cut */
} MesoCutExtent;

MesoStatus meso_strands_cut(MesoStrandSide *old_side, MesoStrandSide *new_side, MesoCutExtent extent,
                            MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                            MesoArena *arena, MesoError *error);
/* The same, as `shares` says already. */
MesoStatus meso_strands_cut_shared(MesoStrandSide *old_side, MesoStrandSide *new_side, MesoCutExtent extent,
                                   const MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                                   MesoArena *arena, MesoError *error);
/*
 * Pairs sections that lie across the seam from each other, up to `reach` times a strand's own reach beside its way: as
 * many as can be, those nearest to each other on the whole; and says what they are to move by. `flaws`: strands that
 * end. O(sections^3) at worst.
 */
MesoStatus meso_strands_pair(MesoStrandSide *old_side, MesoStrandSide *new_side, float *flaws, float reach,
                             const MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                             MesoArena *scratch, MesoError *error);
/* Takes away rings at ends without partner that lie in other strands, in `shares`; whether there were any. */
bool meso_strands_draw_back(MesoRingShares *shares, const MesoStrandSide *old_side, const MesoStrandSide *new_side,
                            const MesoQuiltStep *step, const MesoQuiltWork *work);
/* Both sides moved half of the way to each other, as their sections at the seam say. */
typedef struct MesoStrandJoint {
    MesoStrandSide old_side, new_side;
} MesoStrandJoint;

MesoStatus meso_strands_plan(MesoStrandJoint *joint, const MesoStrandSide *old_side,
                             const MesoStrandSide *new_side, MesoRingShares *shares, const MesoQuiltStep *step,
                             const MesoQuiltWork *work, MesoArena *arena, MesoError *error);
/* Joins them in the composite, and closes what has no partner. */
MesoStatus meso_strands_commit(const MesoStrandJoint *joint, const MesoQuiltStep *step, MesoQuiltWork *work,
                               MesoArena *arena, MesoError *error);
/* `reach` of meso_strands_pair() once sides are as near to each other as they can be. */
#define MESO_REACH_LAST 1.5f

/* Strands of both sides of which each triangle is either there or not. */
typedef struct MesoStrandWeld {
    MesoStrandSide old_side, new_side;
    uint32_t *same;             /* [new vertex_count] old vertex in the same place, or MESO_NO_INDEX */
    bool *old_stays, *new_comes;    /* [triangle_count] of either side */
} MesoStrandWeld;

/* `welded`: whether both sides fit so that no triangle needs to be cut, wherever something is done. */
MesoStatus meso_strands_try_weld(MesoStrandWeld *weld, bool *welded, const MesoStrandSide *old_side,
                                 const MesoStrandSide *new_side, const MesoQuiltStep *step, const MesoQuiltWork *work,
                                 MesoArena *arena, MesoError *error);
MesoStatus meso_strands_commit_weld(const MesoStrandWeld *weld, const MesoQuiltStep *step, MesoQuiltWork *work,
                                    MesoArena *arena, MesoError *error);

/* A patch around step->seed, made ready. Its parts are in the arena. */
typedef struct MesoQuiltPatch {
    MesoQuiltStep step;
    bool welded;
    MesoStrandWeld weld;        /* where it is; else: */
    MesoStrandJoint joint;
    MesoWholePlan wholes;
    bool laid_out;              /* marks in the work are to be taken back */
    MesoArena *trial_arenas[MESO_QUILT_TRIALS];     /* of the pool, while it is made ready; or NULL */
} MesoQuiltPatch;

MesoStatus meso_quilt_prepare(MesoQuiltPatch *patch, MesoQuiltWork *work, MesoArena *arena, MesoError *error);
/* Adds it to the quilt; whether the seed is done then. To be called also where preparing has failed, for the marks. */
MesoStatus meso_quilt_commit(MesoQuiltPatch *patch, MesoStatus prepared, bool *done, MesoQuiltWork *work,
                             MesoArena *arena, MesoError *error);

#endif
