/* Tiling problem: what the solver is asked. It owns nothing. */
#ifndef MESO_TILING_PROBLEM_H
#define MESO_TILING_PROBLEM_H

#include "libcore/solve/constraints.h"
#include "libcore/surface/slot_graph.h"

typedef struct MesoTilingProblem {
    const MesoTileSet *set;                 /* checked */
    const MesoVariantSet *variants;         /* of `set` */
    const MesoSlotGraph *graph;
    const MesoConstraints *constraints;     /* NULL: none */
} MesoTilingProblem;

#endif
