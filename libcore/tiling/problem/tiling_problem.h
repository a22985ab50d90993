/* Tiling problem: what the solver is asked. It owns nothing. */
#ifndef MESO_TILING_PROBLEM_H
#define MESO_TILING_PROBLEM_H

#include "libcore/mesh/slot_graph.h"
#include "libcore/tiling/problem/constraints.h"

typedef struct MesoTilingProblem {
    const MesoTileSet *set;                 /* checked */
    const MesoVariantSet *variants;         /* of `set` */
    const MesoSlotGraph *graph;
    const MesoConstraints *constraints;     /* NULL: none */
} MesoTilingProblem;

#endif
