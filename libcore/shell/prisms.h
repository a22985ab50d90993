/*
 * Prisms: the layer above a triangle mesh, one prism a triangle. A point of
 * triangle (p_0, p_1, p_2) with weights b_i and height h lies at
 *
 *     x = sum b_i (p_i + h d_i)
 *
 * which is continuous from prism to prism, since neighbours have the same
 * directions d_i at their common vertices. Compare "Mesh Quilting for
 * Geometric Texture Synthesis" (Zhou et al. 2006, section 3.2), which moves
 * texture coordinates in the charts of an atlas: here the directions move
 * instead, and there are neither charts nor borders that must be held.
 */
#ifndef MESO_PRISMS_H
#define MESO_PRISMS_H

#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoPrismOptions {
    float low, high;        /* heights that occur, low <= high; low may be negative */
    bool optimise;          /* directions for least stretch; else normals, scaled to keep the thickness */
    uint32_t thread_count;  /* 0: all cores; no effect on the bytes */
} MesoPrismOptions;

/* Stretch as in shell_stretch.h, of the whole map, from flat prisms of the triangles' shapes and the same heights. */
typedef struct MesoPrismReport {
    double stretch_before, stretch_after;                   /* from flat into space */
    double stretch_before_inverse, stretch_after_inverse;   /* and back: the paper's */
    uint32_t limited_count; /* vertices whose directions were made shorter */
    float least_limit;      /* the least of them, as a share; 1: none; 0: a vertex that no direction suits */
    uint32_t inverted_count;/* tetrahedra of negative volume: none */
} MesoPrismReport;

/*
 * The directions for a mesh whose triangles are wound alike.
 *
 * directions   [vertex_count], about 1 long: heights are lengths. Shorter where the layer would fold
 * report       may be NULL
 *
 * Every prism between any two heights from `low` to `high`, split into three tetrahedra in any way, has them all
 * positive, and so the layer does not fold; it does not meet itself either, where sides of the surface face each other
 * (what lies between is shared out). Triangles lower than floats can tell are not looked at, and a vertex that is
 * behind one of its own triangles whatever the direction gets none: all heights are at the vertex.
 *
 * Optimised, the stretch is never above that of the normals. Thickness over a vertex is kept; the direction turns.
 *
 * About O(n log n) for layers not much thicker than triangles are long; as the square of the thickness beyond.
 * Prisms that meet are looked for on several cores; the same bytes for any number. MESO_ERR_INPUT for triangles wound
 * against each other and for heights that are not finite or wrong way around, MESO_ERR_MEMORY.
 */
MesoStatus meso_prisms_build(MesoVec3 *directions, MesoPrismReport *report, MesoArena *scratch,
                             const MesoTriangulation *mesh, const MesoPrismOptions *options, MesoError *error);

/* The point with weights (1 - b1 - b2, b1, b2) in `triangle` at height `h`. */
static inline MesoVec3 meso_prism_point(const MesoTriangulation *mesh, const MesoVec3 *directions, uint32_t triangle,
                                        float b1, float b2, float h)
{
    const uint32_t *v = &mesh->corners[3 * (size_t)triangle];
    const float b[3] = {1 - b1 - b2, b1, b2};
    MesoVec3 x = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        x = meso_vec3_mad(x, b[k], meso_vec3_mad(mesh->positions[v[k]], h, directions[v[k]]));
    return x;
}

#endif
