/* Weights of constraints, of all slots and of regions, and ramps along attributes: meso-constraints(5). */
#ifndef MESO_CONSTRAINT_WEIGHTS_H
#define MESO_CONSTRAINT_WEIGHTS_H

#include "formats/tiling/constraints/constraint_names.h"
#include "libcore/mesh/polygon_mesh.h"
#include "libcore/tiling/problem/weights.h"

/* A number of every slot, made when the first ramp asks for it. */
typedef struct MesoWeightColumn {
    const MesoAttribute *attribute;
    uint32_t component;
    double *values;                 /* [slot_count] NaN where there is none */
} MesoWeightColumn;

typedef struct MesoWeightReader {
    MesoJsonReader *reader;
    const MesoConstraintNames *names;
    const MesoVariantSet *variants;
    const MesoPolygonMesh *mesh;    /* whose faces are the slots */
    uint32_t slot_count;
    bool given;                     /* there were weights */
    bool fractions;                 /* one of them is no whole number */
    uint32_t table_count, table_room;
    MesoWeight *tables;             /* [table_count * tile_count] in MESO_WEIGHT_PARTS of one; the first is of all
                                     * slots outside of regions */
    uint32_t *slot_table;           /* [slot_count] NULL until a region has weights */
    uint32_t ramp_count, ramp_room;
    MesoWeightRamp *ramps;
    uint32_t column_count, column_room;
    MesoWeightColumn *columns;   /* numbers of slots that ramps go along */
} MesoWeightReader;

/*
 * Every tile weighs 1. What the reader points to must outlive it. Problems are told to the JSON reader, here and below.
 */
void meso_weight_reader_begin(MesoWeightReader *weights);

/*
 * Weights at `field`, an object from tile names to weights, for all slots, or, where `places`
 * is not NULL, for these [count]; they go over what was there before. A missing field changes nothing.
 */
void meso_weight_reader_add(MesoWeightReader *weights, const MesoJsonField *field, const uint32_t *places,
                            uint32_t count);

/* What was read; no tables where there were no weights. Whole numbers where all are, else parts of one. */
MesoWeights meso_weight_reader_finish(MesoWeightReader *weights);

#endif
