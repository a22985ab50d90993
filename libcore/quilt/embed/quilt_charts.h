/* Quilts by an atlas and a shell map: the embedding of the paper. */
#ifndef MESO_QUILT_CHARTS_H
#define MESO_QUILT_CHARTS_H

#include "libcore/quilt/embed/quilt_embed.h"

/*
 * positions[vertex_count of the quilt], over a base with twins and a corner at each vertex, whose layer is that of
 * `directions`. The stretch in `lay` becomes that of the map. Heights are a range. Scratch is not given back.
 */
MesoStatus meso_quilt_embed_charts(MesoVec3 *positions, MesoQuiltLay *lay, MesoArena *scratch,
                                   const MesoQuilt *quilt, const MesoTriangulation *base, const MesoVec3 *directions,
                                   MesoQuiltHeights heights, uint32_t thread_count, MesoError *error);

#endif
