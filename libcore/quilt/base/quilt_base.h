/*
 * The surface of a quilt, made ready to be grown over: its triangles small against the swatch, and continued beyond its
 * borders, so that the texture runs through them and is cut there at the end.
 */
#ifndef MESO_QUILT_BASE_H
#define MESO_QUILT_BASE_H

#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoQuiltBase {
    MesoTriangulation mesh;     /* labels 0; owned */
    uint32_t *triangles;        /* [mesh.triangle_count] triangle of the original that it lies in; beyond a border, the
                                   one at which it was put */
    MesoVec2 *corner_weights;   /* [3 * mesh.triangle_count] weights of its corners 1 and 2; beyond a border outside
                                   of 0 to 1 */
    float *inside;              /* [mesh.vertex_count] 0 on the borders of the original, above 0 on it, below 0 beyond:
                                   the distance from the border there; NULL where it has none */
    MesoVec3 *guide;            /* [mesh.triangle_count] in its plane, unit or 0; NULL where the original has none */
} MesoQuiltBase;

/*
 * From a mesh whose triangles are wound alike. Vertices of the original keep their numbers, and triangles that are not
 * split do.
 *
 * guide    [original->triangle_count] or NULL
 * edge     longer edges are split, in the middle, on both sides, so that what comes out lies in the original
 * reach    how far borders are extended: base_border.h; 0: not at all. Less at sharp corners of holes; holes that are
 *          smaller are closed
 *
 * Where there are borders, no triangle of the original has all of its vertices on them: its inside is told by that. The
 * arrays but the mesh's own are in the arena. O(what comes out); where nothing is long, and no border, the copy and a
 * look at each edge. MESO_ERR_INPUT where neighbours are wound against each other, MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_base_build(MesoQuiltBase *base, MesoArena *arena, const MesoTriangulation *original,
                                 const MesoVec3 *guide, float edge, float reach, MesoError *error);

void meso_quilt_base_release(MesoQuiltBase *base);

#endif
