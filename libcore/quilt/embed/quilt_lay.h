/* A quilt laid over its base, in one of several ways. */
#ifndef MESO_QUILT_LAY_H
#define MESO_QUILT_LAY_H

#include "libcore/quilt/embed/quilt_embed.h"

typedef enum MesoQuiltEmbedding {
    MESO_QUILT_PRISMS,      /* along directions of least stretch (shell/prisms.h) */
    MESO_QUILT_NORMALS,     /* along normals, as far as these do not fold */
    MESO_QUILT_CHARTS,      /* the paper's: an atlas, and the shell map over it (shell/shell_map.h) */
} MesoQuiltEmbedding;
#define MESO_QUILT_EMBEDDINGS 3

#define MESO_QUILT_EMBEDDING_NAMES "prisms|normals|charts"

/* By one of these names. */
MesoQuiltEmbedding meso_quilt_embedding_named(const char *name);

/*
 * positions[vertex_count of the quilt] in space. Only positions and corners of the base are read.
 *
 * The map of charts is continuous, also from chart to chart, since the upper texture coordinates are held on their borders:
 * each vertex goes by the chart of its own triangle, and an element across a seam is not torn. Beyond borders of the surface
 * it is continued by the tetrahedron there.
 *
 * Where triangles of the base are wound against each other there is no layer, and they are meso_quilt_directions() that
 * heights go along, whatever is asked for. O(n log n). `lay` may be NULL. MESO_ERR_MEMORY, MESO_ERR_LIMIT.
 */
MesoStatus meso_quilt_lay(MesoVec3 *positions, MesoQuiltLay *lay, const MesoQuilt *quilt,
                            const MesoTriangulation *base, MesoQuiltEmbedding embedding, uint32_t thread_count,
                            MesoError *error);

#endif
