/* How much a quilt looks like its swatch, window by window. */
#ifndef MESO_CHECK_LIKENESS_H
#define MESO_CHECK_LIKENESS_H

#include "libcore/quilt/quilt.h"

/* Lengths in units of the swatch: means of distances to the nearest triangle, from the window's vertices to the swatch
 * and from the swatch's to the window. */
typedef struct MesoLikeness {
    uint32_t window_count, swatch_window_count;     /* 0: the tile is too small, or there is too little in it */
    uint32_t laid_window_count;
    double distance, largest_distance;  /* of the quilt's windows from what is most like them: mean, worst */
    double swatch_distance;             /* the same for windows of the swatch, and places at least a radius away */
    double laid_distance;               /* the same, of such bent over the surface, where the quilt's are */
    double ratio;                       /* of the quilt's distance to that: 1 where it adds nothing to the bending */
    double ratio_error;                 /* its standard error, as windows differ */
    double radius;                      /* of a window */
} MesoLikeness;

typedef struct MesoLikenessOptions {
    float scale, height_scale, offset;  /* as of MesoQuiltOptions, none 0 but the offset */
    uint32_t window_count;              /* at most; 0: 32 */
    uint32_t thread_count;              /* for the table of the swatch; 0: all cores */
} MesoLikenessOptions;

/*
 * Windows lie at random places of the surface, the same in each call, and not where a border is within them, or within
 * a whole element's width of them. They are seen in the layer, with the surface laid flat by a chart of the window:
 * what bends with it is straight there. Whole elements, which need not bend, are seen as they are in space, standing
 * where the layer has their middle. Windows are turned as the swatch is in them, as most of their edges say that lie
 * within patches; where there are patches of several turns, by the best of these. They are laid where the cost of
 * equation 3 is least, and moved and turned until it does not become less.
 *
 * The swatch's own windows are at random places of it, and laid elsewhere on it; as they are, and bent over the surface
 * in the same places as the quilt's (check_layer.h), as one patch without a seam would be. Distances so small as the
 * steps of moving are all alike: a swatch that is exactly periodic has ratio 1 where it is laid without fault.
 *
 * `base` is what the quilt's places refer to, `positions` [quilt->vertex_count] where they are in space; without, NULL,
 * whole elements are seen in the layer too. MESO_ERR_LIMIT, MESO_ERR_MEMORY. O(quilt + base) and the windows; where
 * triangles of the base are large against the swatch, O(quilt) for each.
 */
MesoStatus meso_check_likeness(MesoLikeness *likeness, MesoArena *scratch, const MesoQuilt *quilt,
                               const MesoSwatch *swatch, const MesoVec3 *positions, const MesoTriangulation *base,
                               const MesoLikenessOptions *options, MesoError *error);

#endif
