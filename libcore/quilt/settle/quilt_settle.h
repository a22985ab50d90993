/*
 * Whole elements of a finished quilt as bodies in space: of the size and the shape that they have in the swatch, however
 * the surface bends under them, moved a little so that neighbours stand as they do in the swatch and do not cut each
 * other, and some more of them where there is room.
 *
 * Growth lays elements out in the plane of a chart, and the layer widens and narrows them with the surface. That is what
 * strands need, so as to go on; a nut is to be a nut everywhere.
 */
#ifndef MESO_QUILT_SETTLE_H
#define MESO_QUILT_SETTLE_H

#include "libcore/quilt/embed/quilt_embed.h"

typedef struct MesoSettleOptions {
    float scale, height_scale, offset;  /* as of MesoQuiltOptions; height_scale 0: as `scale` */
    float overhang;         /* elements may reach beyond a border by so much, in the surface's units */
    uint32_t thread_count;  /* 0: all cores; no effect on the bytes */
    bool partial;           /* the quilt is to cover a part of the surface: nothing is added */
} MesoSettleOptions;

/*
 * Settles the whole elements of a quilt that meso_quilt_finish() has left, in place; its arrays are anew in `arena`. Quilts
 * without whole elements stay as they are.
 *
 * - An element lies in space as a copy of that of the swatch, moved and turned as fits best where the layer of
 *   meso_quilt_layer() has it; small ones that stand in a larger one of the swatch go with that.
 * - Where all elements are whole: those around each other move towards the places that they have around each other in
 *   the swatch, and turn as what is around them lies, as far as the surface lets them; where the swatch would have a
 *   further one and there is room, it is added. What stands at a side of the swatch has around it what all those have
 *   that are like it.
 * - What still cuts another one gives way, or goes if it was added. Where elements reach through each other, or lie over
 *   each other, that is by small steps, and of two in one place the one goes around which less stands as in the swatch.
 * - Where they do so and cut each other in the swatch as well, they stay where and as they were, bent with the layer,
 *   but of nearly their own volume; what is added cuts nothing.
 * - Where there are strands, elements stand where the strands have them; such that grow from a strand, with that place of
 *   theirs.
 * - Vertices get the triangle, the weights and the height that have the layer put them where they are. Where the layer is
 *   too low for that, an element is bent too.
 *
 * surface  that the quilt's places refer to, with twins
 *
 * Elements that stay keep their order, and what is added comes last. Counts are added to the quilt's report. O(n log n)
 * for n triangles, but for elements that cut each other. On one thread, but for the layer. MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_settle(MesoQuilt *quilt, MesoArena *arena, const MesoTriangulation *surface,
                             const MesoSwatch *swatch, const MesoSettleOptions *options, MesoError *error);

#endif
