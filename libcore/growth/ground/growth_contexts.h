/*
 * What a grammar's maps and fields are on one surface, and the answers to what rules ask of a place: all but what has
 * grown, which is the engine's.
 */
#ifndef MESO_GROWTH_CONTEXTS_H
#define MESO_GROWTH_CONTEXTS_H

#include "libcore/growth/ground/growth_maps.h"
#include "libcore/growth/language/grammar_run.h"

typedef enum MesoGrowthFieldKind {
    MESO_GROWTH_TOWARDS,        /* the direction `vector`, laid into the triangle */
    MESO_GROWTH_TO_POINT,       /* towards the point `vector` */
    MESO_GROWTH_UPHILL,         /* along the gradient of `map` */
    MESO_GROWTH_GIVEN,          /* `vectors` [triangle_count], laid into the triangle */
    MESO_GROWTH_LINE,           /* the same, either of the two ways: that which is nearer to the heading */
    MESO_GROWTH_ANY             /* a random one each time, of the draw */
} MesoGrowthFieldKind;

typedef struct MesoGrowthField {
    MesoGrowthFieldKind kind;
    bool reversed;
    double vector[3];
    uint32_t map;
    const MesoVec3 *vectors;
} MesoGrowthField;

typedef struct MesoGrowthContexts {
    const MesoGrowthGround *ground;
    uint32_t map_count, field_count;
    const MesoGrowthMap *maps;          /* by the grammar's numbers */
    const MesoGrowthField *fields;
    uint64_t noise;                     /* seed of noise() */
} MesoGrowthContexts;

/* The value of a map at a point. Finite, if its values are. O(1). */
double meso_growth_map_at(const MesoGrowthContexts *contexts, uint32_t map, uint32_t triangle,
                          const double weight[3]);

/*
 * Answers a look-up at a tip: maps (here, ahead, to the side, the length of the gradient), noise, height, slope,
 * curvature. Averages ahead are over the straight way there, as far as there is one. Not MESO_LOOK_CLEAR and
 * MESO_LOOK_MEETS. O(1), and O(crossings) where it walks.
 */
double meso_growth_answer(const MesoGrowthContexts *contexts, const MesoTip *tip, MesoGrowthLook look, uint32_t map,
                          double a, double b);

/* Where a field leads at a tip, of length 1 in its triangle's frame; 0 where it leads nowhere. `draw`: for random
 * ones. */
MesoComplex meso_growth_direction(const MesoGrowthContexts *contexts, uint32_t field, const MesoTip *tip,
                                  uint64_t draw);

/*
 * Turns a tip's heading towards a field by `share` of the angle between (MESO_GROWTH_FACE). False, and stays, where
 * the field leads nowhere.
 */
bool meso_growth_face(const MesoGrowthContexts *contexts, uint32_t field, double share, uint64_t draw, MesoTip *tip);

#endif
