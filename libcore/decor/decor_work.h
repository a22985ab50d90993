/* The state of a pattern at work; for the sources of this folder alone. */
#ifndef MESO_DECOR_WORK_H
#define MESO_DECOR_WORK_H

#include "libcore/decor/decor.h"
#include "libcore/decor/region/region_shape.h"
#include "libcore/mesh/cut/border_loops.h"
#include "libcore/geodesic/geodesic.h"
#include "libcore/mesh/cut/mesh_cut.h"

typedef struct MesoDecorWork {
    MesoDecor *decor;           /* mesh, tree */
    const MesoPattern *pattern;
    const MesoDecorOptions *options;
    MesoGeodesicSolver *solver;
    MesoArena *scratch;         /* of one step */
    bool placed;                /* the error names its step */

    /* Made anew after each cut: */
    MesoArena tables;
    MesoArenaMark tables_begin;
    MesoRegionLists lists;
    uint8_t *member;            /* [region_count] zeroes between uses */
    float *field, *other;       /* [field_room >= vertex_count], owned */
    uint32_t field_room;
    float *face_areas;          /* [faces of the surface] as they were */
    MesoVec3 *normals;          /* [vertex_count] where a step needs them, in the scratch; else NULL */
} MesoDecorWork;

/* A region that a step is done to. */
typedef struct MesoTarget {
    uint32_t region;
    uint32_t scope;
} MesoTarget;

typedef struct MesoTargets {
    MesoTarget *targets;
    uint32_t count;
} MesoTargets;

/* Makes what depends on cuts anew. */
MesoStatus meso_decor_refresh(MesoDecorWork *work, MesoError *error);

/* What is drawn for a region in a step. */
typedef enum MesoDecorDraw { MESO_DRAW_SELECT, MESO_DRAW_HEIGHT, MESO_DRAW_MATERIAL, MESO_DRAW_SAMPLE } MesoDecorDraw;

/* Random bits of a region and a step: the same whatever else is done. */
uint64_t meso_decor_random(const MesoDecorWork *work, uint32_t region, MesoDecorDraw draw);

/* The same between 0 and 1. */
float meso_decor_random_share(const MesoDecorWork *work, uint32_t region, MesoDecorDraw draw);

/* Unit normals of all vertices: means of the triangles' area vectors; +Z where those vanish. */
MesoStatus meso_decor_normals(MesoDecorWork *work, MesoError *error);

/* Tells the job's owner that a step does nothing, or less than it says. */
void meso_decor_note(const MesoDecorWork *work, const MesoStep *step, const char *text);

/* Shape of a region as it is now. */
MesoStatus meso_decor_shape(MesoDecorWork *work, uint32_t region, MesoRegionShape *shape, MesoError *error);

/* ---- of the sources, in the order of a step ---- */

/* region_select.c: the regions of a step, for each scope by number; none is within another. */
MesoStatus meso_decor_select(MesoDecorWork *work, const MesoSelector *selector, const uint32_t *scopes,
                             uint32_t scope_count, MesoTargets *targets, MesoError *error);

/* seed_set.c */
typedef struct MesoSeeds {
    MesoGeodesicSeed *seeds;
    uint32_t count, room;
    MesoMeshPoint *point_list;      /* [point_count] of them that are points, and not lines */
    uint32_t point_count, point_room;
} MesoSeeds;

/* The seeds of a set in a region, which has the domain. A set that has none there is empty, and no error. */
MesoStatus meso_decor_seeds(MesoDecorWork *work, const MesoSeedSet *set, uint32_t region, const MesoDomain *domain,
                            MesoSeeds *seeds, MesoError *error);

/* Where a point of a face of the file was; it is found again on what has become of the surface. MESO_ERR_INPUT. */
MesoStatus meso_decor_face_point(const MesoDecorWork *work, const MesoSeedSpec *spec, MesoVec3 *point,
                                 MesoError *error);

/* region_field.c: work->field on the vertices of the domain. */
typedef struct MesoFieldFacts {
    float largest;      /* that is finite */
    bool seeded;        /* there are seeds, on both sides of a blend */
    bool points;        /* `from` has points: what a contour cuts out are dots */
} MesoFieldFacts;

/* Why there is nothing to do in a field whose largest value is 0. */
const char *meso_decor_flat_reason(const MesoFieldFacts *facts);

MesoStatus meso_decor_field(MesoDecorWork *work, const MesoFieldSpec *spec, uint32_t region, const MesoDomain *domain,
                            MesoFieldFacts *facts, MesoError *error);

/*
 * Until meso_geodesic_set_positions() with the mesh's own, distances are measured on the surface with its vertices
 * moved along their normals; the surface itself stays. `size` is the length that relative noise is in units of.
 */
MesoStatus meso_decor_perturb(MesoDecorWork *work, const MesoNoise *noise, float size, MesoError *error);

/* Samples by farthest points, in poisson.c. */
MesoStatus meso_decor_poisson(MesoDecorWork *work, const MesoSeedSpec *spec, uint32_t region, const MesoDomain *domain,
                              uint32_t **vertices, uint32_t *count, MesoError *error);

/* operators.c: lines of a step in all of its targets, cut; children made. */
MesoStatus meso_decor_split(MesoDecorWork *work, const MesoStep *step, const MesoTargets *targets, MesoError *error);

/* Whether a vertex may be moved there: what is written can be read again. */
static inline bool meso_decor_may_stand(MesoVec3 p)
{
    return fabsf(p.x) <= MESO_COORDINATE_LIMIT && fabsf(p.y) <= MESO_COORDINATE_LIMIT &&
           fabsf(p.z) <= MESO_COORDINATE_LIMIT;
}

/* displace.c, paint.c */
MesoStatus meso_decor_displace(MesoDecorWork *work, const MesoStep *step, const MesoDisplacement *displacement,
                               const uint32_t *regions, uint32_t count, MesoError *error);
void meso_decor_paint(MesoDecorWork *work, const MesoAfterSplit *paint, const uint32_t *regions, uint32_t count);

/* grow.c */
MesoStatus meso_decor_grow(MesoDecorWork *work, const MesoStep *step, const MesoTargets *targets, MesoError *error);

/* decor_run.c: steps in scopes; what grow and macros come back to. */
MesoStatus meso_decor_run_steps(MesoDecorWork *work, const MesoStep *steps, uint32_t step_count,
                                const uint32_t *scopes, uint32_t scope_count, MesoError *error);

#endif
