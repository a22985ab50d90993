/* Normals of a quilt in space, of which a vertex has several where edges of the swatch meet there. */
#ifndef MESO_QUILT_NORMALS_H
#define MESO_QUILT_NORMALS_H

#include "libcore/quilt/quilt.h"

/* Corners at a vertex that have their normal in common are a group. */
typedef struct MesoQuiltNormals {
    uint32_t group_count;
    uint32_t *group_begin;      /* [vertex_count + 1] groups at each vertex */
    uint32_t *local;            /* [3 * triangle_count] number of a corner's group at its vertex; NULL: all 0 */
    MesoVec3 *normals;          /* [group_count] unit */
} MesoQuiltNormals;

static inline uint32_t meso_quilt_normal_group(const MesoQuiltNormals *normals, const MesoQuilt *quilt, uint32_t corner)
{
    return normals->group_begin[quilt->corners[corner]] + (normals->local ? normals->local[corner] : 0);
}

/*
 * Sums of the area vectors at `positions` [vertex_count] around each vertex, but not across an edge of the swatch:
 * where its surface turns by over 65 degrees. Between triangles that are no neighbours in the swatch there is one where
 * they turn as far at `positions`, and both have such an edge. +Z where sums vanish. To `arena`. O(corners); the same
 * for any number of threads. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_quilt_normals(MesoQuiltNormals *normals, MesoArena *arena, const MesoQuilt *quilt,
                              const MesoSwatch *swatch, const MesoVec3 *positions, uint32_t thread_count,
                              MesoError *error);

#endif
