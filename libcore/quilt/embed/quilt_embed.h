/* Quilts in space: where the vertices of the layer lie over a surface. */
#ifndef MESO_QUILT_EMBED_H
#define MESO_QUILT_EMBED_H

#include "libcore/quilt/quilt.h"
#include "libcore/shell/prisms.h"

/* Heights that occur, and 0. */
typedef struct MesoQuiltHeights {
    float low, high;
} MesoQuiltHeights;

/* How it lies over its base. */
typedef struct MesoQuiltLay {
    MesoPrismReport layer;      /* with charts, its stretch is that of the shell map; zero where there is no layer */
    uint32_t chart_count;       /* 0 without charts */
    uint32_t seam_count;        /* elements that lie in several charts */
    uint32_t flat_count;        /* tetrahedra of the charts' map without a volume */
    uint32_t plain_count;       /* triangles of the base that go by their prisms instead of it */
    float area_ratio;           /* of the atlas, largest over least */
} MesoQuiltLay;

MesoQuiltHeights meso_quilt_heights(const MesoQuilt *quilt);

/*
 * directions[vertex_count of the base]: normals, the sums of the area vectors around each vertex at unit length; +Z
 * where they vanish. Only positions and corners of the base are read. O(triangles).
 */
void meso_quilt_directions(MesoVec3 *directions, const MesoTriangulation *base);

/*
 * directions[vertex_count of the base] under which the layer of such heights neither folds nor meets itself, turned for
 * least stretch (shell/prisms.h): shorter than 1 in narrow places. Where triangles are wound against each other there is no
 * such layer, and they are those of meso_quilt_directions(); `report` is zero then. O(n log n), on `thread_count` threads
 * (0: all cores), the same for any number. MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_layer(MesoVec3 *directions, MesoPrismReport *report, const MesoTriangulation *base,
                            MesoQuiltHeights heights, uint32_t thread_count, MesoError *error);

/*
 * The place of each vertex over the base:
 *
 *     x = sum of b_i (p_i + h d_i)
 *
 * over the corners of its triangle, with its weights b and height h, positions p and directions d. What is continuous
 * in the layer is so in space.
 *
 * positions    [vertex_count of the quilt]
 * base         that the quilt was grown over, or another with the same triangles; only positions and corners are read
 * directions   [vertex_count of the base] to where height 1 lies
 *
 * O(vertices), on `thread_count` threads (0: all cores).
 */
void meso_quilt_embed(MesoVec3 *positions, const MesoQuilt *quilt, const MesoTriangulation *base,
                      const MesoVec3 *directions, uint32_t thread_count);

#endif
