/*
 * Patterns: what is done to a surface, step by step ("DecoSurf: Recursive
 * Geodesic Patterns on Triangle Meshes", Nazzaro, Puppo, Pellacini 2021). Each
 * step selects regions and splits them along lines of geodesic fields, moves
 * them, paints them, or hands them to rules. A pattern is data alone; whoever reads it
 * owns its arrays.
 *
 * Regions form a tree, whose root is the surface. Steps run in a scope, a
 * region: the root, or the region that a macro is applied to. Paths, shares of area and
 * numbers of regions are the scope's.
 */
#ifndef MESO_PATTERN_H
#define MESO_PATTERN_H

#include <stdbool.h>

#include "libcore/math/vec.h"
#include "libcore/scene/material.h"

/* A closed range; an unset one is {-INFINITY, INFINITY}. */
typedef struct MesoRange {
    float low, high;
} MesoRange;

/* ---- which regions ---- */

typedef enum MesoSelectLevel {
    MESO_SELECT_DEFAULT,    /* leaves; with a path, the nodes that it names, and their leaves unless the step groups */
    MESO_SELECT_LEAVES,
    MESO_SELECT_NODES       /* as they are named, inner ones too: fields live on the whole, all leaves are sliced */
} MesoSelectLevel;

/* All of its conditions hold; the filters by number come last, in this order. */
typedef struct MesoSelector {
    const char *path;       /* names joined by '/', '*' any one, '**' any number, "." the scope; NULL: all in it */
    const char **tags;      /* [tag_count] any of these; 0: any tag */
    uint32_t tag_count;
    MesoSelectLevel level;
    MesoRange borders, corners, aspect;
    MesoRange area, area_share;     /* in scene units, and of the scope */
    bool has_point;
    MesoVec3 point;         /* the region that has the surface's point nearest to it */
    uint32_t colors, color; /* neighbours have different colours below `colors` where that can be; 0: no matter */
    float share;            /* of regions, drawn at random; 1: all */
    uint32_t every, from;   /* region number from, from + every, ...; every 0 or 1: all from there */
    uint32_t largest;       /* so many by area; 0: all */
} MesoSelector;

/* ---- where fields begin ---- */

typedef enum MesoSeedKind {
    MESO_SEED_BORDERS,      /* all of the region */
    MESO_SEED_OUTER,        /* the longest loop */
    MESO_SEED_INNER,        /* all others */
    MESO_SEED_LOOP,         /* loop number `loop`, by falling length */
    MESO_SEED_SIDE,         /* its part between corners number `corners[0]` and [1], in its direction */
    MESO_SEED_POINT,        /* of the region, nearest to `point` */
    MESO_SEED_FACE,         /* face of the surface file and weights of its corners */
    MESO_SEED_ALONG,        /* samples of `of`: `count` of them, or one every `spacing` */
    MESO_SEED_POISSON       /* farthest points */
} MesoSeedKind;

typedef struct MesoSeedSpec {
    MesoSeedKind kind;
    MesoSeedKind of;        /* of samples along a border: borders, outer, inner, loop, side */
    uint32_t loop, corners[2];
    MesoVec3 point;
    uint32_t face;
    float weight[3];
    uint32_t count;         /* of samples; 0: as many as the distances allow */
    float spacing;          /* between samples along a border; radius of Poisson samples: their least distance */
    bool relative;          /* spacing as a share of the root of the region's area */
    bool on_border;         /* Poisson samples of borders alone */
    bool from_border;       /* as the paper has it: the first lies farthest from the border, none near to it */
    float border_slack;     /* from 0 to 1: those keep only 1 - slack of their distance from it */
} MesoSeedSpec;

/* A union. */
typedef struct MesoSeedSet {
    const MesoSeedSpec *specs;
    uint32_t count;
} MesoSeedSet;

/* ---- fields ---- */

typedef enum MesoNoiseOf { MESO_NOISE_NONE, MESO_NOISE_OF_METRIC, MESO_NOISE_OF_FIELD } MesoNoiseOf;

/* Perlin's, along the normals before distances are measured, or added to the field. */
typedef struct MesoNoise {
    MesoNoiseOf of;
    float gain;             /* largest shift, in scene units; of a field, in its own */
    float frequency;        /* cells a scene unit */
    bool relative;          /* to the root of the region's area; the gain of a field, to its largest value */
    uint64_t seed;
} MesoNoise;

/* dist S, or blend S, S' = dist S / (dist S + dist S'). */
typedef struct MesoFieldSpec {
    MesoSeedSet from, to;
    bool blend;
    MesoNoise noise;
} MesoFieldSpec;

/* ---- steps ---- */

typedef enum MesoStepKind {
    MESO_STEP_CONTOUR,
    MESO_STEP_STREAM,
    MESO_STEP_VORONOI,
    MESO_STEP_POLYLINE,
    MESO_STEP_PAINT,
    MESO_STEP_DISPLACE,
    MESO_STEP_MACRO,        /* its steps, with each selected region as the scope */
    MESO_STEP_GROW
} MesoStepKind;

typedef enum MesoLevelUnit {
    MESO_LEVEL_SCENE,       /* as they are; of blend, between 0 and 1 */
    MESO_LEVEL_SHARE,       /* of the field's largest value in the region */
    MESO_LEVEL_SIZE         /* of the root of the region's area */
} MesoLevelUnit;

/* values, or `count` equally spaced ones between 0 and the largest, or one every `every`. */
typedef struct MesoLevels {
    const float *values;
    uint32_t value_count;
    uint32_t count;
    float every;
    MesoLevelUnit unit;
} MesoLevels;

/* Height over the region, from 0 at its border: height * gain(bias(d / largest d)) (Schlick 1994). */
typedef struct MesoDisplacement {
    float height;           /* along the normals; negative: a pit */
    bool relative;          /* in units of the largest distance from the region's border */
    float bias, gain;       /* 0.5: linear */
    float jitter;           /* of the height, by region: within [1 - jitter, 1 + jitter] */
} MesoDisplacement;

typedef enum MesoPaintBy {
    MESO_PAINT_ALL,         /* the first */
    MESO_PAINT_CYCLE,       /* by number among brothers */
    MESO_PAINT_RANDOM,
    MESO_PAINT_RAMP         /* between them, by the field's mean over the region when it was made */
} MesoPaintBy;

/* What a tag's children get right after a split: painting, name, displacement. No child is told of twice. */
typedef struct MesoAfterSplit {
    const char *tag;        /* NULL: all */
    const char *name;       /* NULL: the tag's */
    bool painted, displaced;
    MesoPaintBy by;
    const uint32_t *materials;  /* [material_count] of the pattern */
    uint32_t material_count;
    MesoDisplacement displacement;
} MesoAfterSplit;

typedef struct MesoStep MesoStep;

/* Steps with a name; `steps` run with the region that it is applied to as scope. */
typedef struct MesoMacro {
    const char *name;
    const MesoStep *steps;
    uint32_t step_count;
} MesoMacro;

/* What may be done to which regions, and how likely. */
typedef struct MesoRule {
    MesoSelector where;     /* tags and shape */
    MesoMacro macro;
    float weight;
    uint32_t most;          /* how often along a line of descent; 0: no limit */
} MesoRule;

/* Regions that get one choice together (gTangle, Santoni and Pellacini 2016). */
typedef enum MesoGrouping {
    MESO_GROUP_NONE,        /* each for itself */
    MESO_GROUP_TYPE,        /* by tag */
    MESO_GROUP_SHAPE,       /* by tag, borders and corners */
    MESO_GROUP_CYCLIC       /* by tag and number among brothers, modulo `cycle` */
} MesoGrouping;

typedef struct MesoGrowth {
    const MesoRule *rules;
    uint32_t rule_count;
    uint32_t depth;         /* rounds */
    float smallest;         /* regions under this share of the scope's area stay */
    MesoGrouping grouping;
    uint32_t cycle;
    float rest;             /* weight of leaving a group as it is, for good */
} MesoGrowth;

struct MesoStep {
    MesoStepKind kind;
    const char *place;      /* "steps[3]", for messages */
    MesoSelector on;
    MesoFieldSpec field;            /* contour, stream; voronoi: its `from` */
    MesoLevels levels;              /* contour */
    uint32_t line_count;            /* stream */
    const MesoSeedSpec *points;     /* [point_count] polyline */
    uint32_t point_count;
    bool closed;                    /* polyline */
    const MesoAfterSplit *after;    /* [after_count]; paint and displace: one */
    uint32_t after_count;
    MesoMacro macro;
    MesoGrowth growth;
};

typedef struct MesoPattern {
    const MesoStep *steps;
    uint32_t step_count;
    const MesoMaterial *materials;      /* [material_count]; the first is what nothing else has painted */
    const char *const *material_names;  /* [material_count] */
    uint32_t material_count;
} MesoPattern;

#endif
