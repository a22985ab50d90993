/* How much a quilt looks like its swatch, window by window. */
#ifndef MESO_CHECK_LIKENESS_H
#define MESO_CHECK_LIKENESS_H

#include "libcore/quilt/quilt.h"

/* Lengths in units of the swatch: means of distances to the nearest triangle, from the window's vertices to the swatch
 * and from the swatch's to the window. */
typedef struct MesoLikeness {
    uint32_t window_count, swatch_window_count;     /* 0: the tile is too small, or there is too little in it */
    double distance, largest_distance;  /* of the quilt's windows from what is most like them: mean, worst */
    double swatch_distance;             /* the same for windows of the swatch, and places at least a radius away */
    double radius;                      /* of a window */
} MesoLikeness;

typedef struct MesoLikenessOptions {
    float scale, height_scale, offset;  /* as of MesoQuiltOptions, none 0 but the offset */
    uint32_t thread_count;              /* for the table of the swatch; 0: all cores */
} MesoLikenessOptions;

/*
 * Windows lie at random places of the surface, the same in each call, and not where a border is within them, or within
 * a whole element's width of them. They are
 * seen in the layer, from their tangent plane: what bends with the surface is straight there. Whole elements, which need
 * not bend, are seen as they are in space, standing where the layer has their middle. Windows are turned as
 * the swatch is in them on the whole, laid where the cost of equation 3 is least, and moved until it does not become
 * less.
 *
 * `base` is what the quilt's places refer to, `positions` [quilt->vertex_count] where they are in space; without, NULL,
 * whole elements are seen in the layer too. MESO_ERR_LIMIT, MESO_ERR_MEMORY. O(quilt + base) and the windows, which
 * are up to 32; where triangles of the base are large against the swatch, O(quilt) for each.
 */
MesoStatus meso_check_likeness(MesoLikeness *likeness, MesoArena *scratch, const MesoQuilt *quilt,
                               const MesoSwatch *swatch, const MesoVec3 *positions, const MesoTriangulation *base,
                               const MesoLikenessOptions *options, MesoError *error);

#endif
