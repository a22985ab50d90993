/*
 * Laplacian deformation of a band of a triangle mesh (Zhou et al., "Mesh Quilting for Geometric Texture Synthesis",
 * 2006, equations 4 to 6): points of the mesh are pulled to targets, and the vertices around follow so that each keeps
 * its offset from the mean of its neighbours as well as it can.
 */
#ifndef MESO_BAND_DEFORM_H
#define MESO_BAND_DEFORM_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

/* sum weight[k] * position of v[k] is to come to `target`. Weights add up to 1; those of a vertex alone are 1, 0, 0. */
typedef struct MesoBandPull {
    uint32_t v[3];
    float weight[3];
    MesoVec3 target;
} MesoBandPull;

/*
 * Moves the vertices so that
 *
 *     sum over vertices |L(w_i) - L(v_i)|^2 + mu * sum over pulls |sum weight w - target|^2,
 *     L(v_i) = v_i - mean of the neighbours of v_i,
 *
 * is least, v before and w after, where all vertices but those within `rings` edges of a pull's keep their places. What
 * is not connected to a pull does not move; several parts of a mesh, and pulls far from each other, may come together.
 *
 * positions        [vertex_count] before in, after out; may not be finite where no band comes
 * corners          [3 * triangle_count] vertices; borders, and edges of several triangles, are nothing special
 * pulls            [pull_count]; vertices of weight 0 are not looked at
 * mu               >= 0; beyond 1e8 as 1e8: pulls that do not contradict each other are met to the precision of floats
 * rms, largest     what is left between pulls and targets, in the positions' unit; may be NULL
 *
 * O(vertex_count + triangle_count) for neighbours: pass the part that matters of a large mesh. Then a sparse system of
 * the vertices that move (sparse_cholesky.h). The same bytes everywhere. Nothing has moved on failure: MESO_ERR_INPUT
 * where positions, weights or targets are not finite, or weights of a pull add up to 0; MESO_ERR_INTERNAL for vertices
 * that are not there; MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_band_deform(MesoVec3 *positions, MesoArena *scratch, uint32_t vertex_count, const uint32_t *corners,
                            uint32_t triangle_count, const MesoBandPull *pulls, uint32_t pull_count, uint32_t rings,
                            double mu, double *rms, double *largest, MesoError *error);

#endif
