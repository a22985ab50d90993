/* Windows of a quilt: what lies around a place of its surface, with the surface laid flat. */
#ifndef MESO_CHECK_LAYER_H
#define MESO_CHECK_LAYER_H

#include "libcore/quilt/check/check_places.h"
#include "libcore/quilt/check/check_window.h"
#include "libcore/quilt/quilt_plane.h"

/* Where a whole element stands: its middle in space and in the layer, and what is up there. */
typedef struct MesoStand {
    MesoVec3 middle, up;
    MesoQuiltVertex foot;       /* that of its vertices which is the nearest to under its middle, at its mean height */
    MesoVec3 aside;             /* from there to under the middle */
} MesoStand;

typedef struct MesoCheckLayer {
    const MesoQuilt *quilt;
    const MesoVec3 *positions;  /* or NULL */
    const MesoTriangulation *base;
    float scale, height_scale, offset;
    MesoPlaces places;
    MesoChartMaker maker;
    /* by triangle of the base, the triangles of the quilt whose first corner is over it */
    uint32_t *begin, *triangles;
    uint32_t *visits, visit;    /* [triangle_count of the base] the last window that has seen it */
    uint32_t *queue;
    uint32_t *chart_triangles, *patch_triangles;    /* [triangle_count of the base] MESO_NO_INDEX between windows */
    uint32_t *locals;
    uint32_t *stand_of;         /* [vertex_count of the quilt] the whole element that it is of, or MESO_NO_INDEX */
    MesoStand *stands;          /* [element_count] */
} MesoCheckLayer;

/*
 * `scale`, `height_scale` and `offset` are those that it was grown with, `positions` [quilt->vertex_count] where its
 * vertices are in space; without, NULL, whole elements are seen in the layer, too. All stays the caller's. To be
 * released where it succeeds. O(quilt + base). MESO_ERR_MEMORY.
 */
MesoStatus meso_check_layer_init(MesoCheckLayer *layer, MesoArena *arena, const MesoQuilt *quilt,
                                 const MesoSwatch *swatch, const MesoVec3 *positions, const MesoTriangulation *base,
                                 float scale, float height_scale, float offset, MesoError *error);
void meso_check_layer_release(MesoCheckLayer *layer);

/* How large windows are, in units of the swatch. */
typedef struct MesoWindowSize {
    float radius, reach;        /* as of MesoWindow */
    float clear;                /* no border is so near to a window's middle */
} MesoWindowSize;

/*
 * The window around the next random place, in units of the swatch, turned anyhow; `found`: there is one, with the
 * surface laid flat all over it. To `arena`. O(what is near); where triangles of the base are large against the
 * swatch, O(quilt). MESO_ERR_MEMORY.
 */
MesoStatus meso_check_layer_window(MesoWindow *window, bool *found, MesoCheckLayer *layer, MesoArena *arena,
                                   MesoRandom *random, MesoWindowSize size, MesoError *error);

/* The swatch's `home` there, laid over the surface in one piece. */
typedef struct MesoLaidSwatch {
    const MesoSwatch *swatch;
    MesoVec2 home;              /* what comes to be in the middle */
    uint32_t *locals;           /* [swatch->vertex_count] as of meso_window_init() */
} MesoLaidSwatch;

/*
 * The same with the swatch itself in the quilt's stead, bent as a patch is: by a chart of a patch's size, whose middle
 * is as far away as most of a patch is from its own. The same place where `random` is the same. `turn`: of the swatch
 * in the window. O(swatch + patch). MESO_ERR_MEMORY.
 */
MesoStatus meso_check_layer_laid(MesoWindow *window, bool *found, double *turn, MesoCheckLayer *layer,
                                 const MesoLaidSwatch *laid, MesoArena *arena, MesoRandom *random, MesoWindowSize size,
                                 MesoError *error);

#endif
