/* The four operators: the lines that each draws into one region. For the sources of this folder alone. */
#ifndef MESO_OPERATORS_H
#define MESO_OPERATORS_H

#include "libcore/decor/pieces.h"

/* A step at work on all of its targets. */
typedef struct MesoSplit {
    MesoDecorWork *work;
    const MesoStep *step;
    MesoCutLines lines;
    MesoCornerField field;      /* contours: of all targets */
    uint32_t largest_leaf;      /* of the targets, after the cut */
    struct MesoSplitTarget *targets;    /* [count] */
    uint32_t count;
} MesoSplit;

/* What an operator finds in a region. */
typedef struct MesoSplitTarget {
    uint32_t region;
    float *levels;              /* contour: [level_count] ascending, inside the field */
    uint32_t level_count;
    float largest;              /* of the field */
    bool points;                /* it has points for seeds */
    uint32_t *start_nodes;      /* stream: [start_count] of the lines, in order along the border, or MESO_NO_INDEX */
    uint32_t start_count;
    const char *idle;           /* why there is nothing to do; NULL: lines were drawn */
} MesoSplitTarget;

/* Each adds its lines to split->lines, or says why there are none. `domain` is the region's, not empty. */
typedef MesoStatus MesoOperator(MesoSplit *split, MesoSplitTarget *target, const MesoDomain *domain, MesoError *error);

MesoOperator meso_decor_contour, meso_decor_stream, meso_decor_voronoi, meso_decor_polyline;

#endif
