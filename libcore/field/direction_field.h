/*
 * Direction field: a direction in each triangle of a surface, as smooth as it
 * can be: "Globally Optimal Direction Fields" (Knoeppel et al. 2013), with
 * unknowns in triangles, so that singularities are vertices.
 */
#ifndef MESO_DIRECTION_FIELD_H
#define MESO_DIRECTION_FIELD_H

#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoDirectionField {
    uint32_t symmetry;          /* 1 and more: directions are known up to turns by 2 pi / symmetry */
    MesoVec3 *directions;       /* [triangle_count] unit, in the triangle's plane */
    uint32_t singularity_count;
    uint32_t *singularities;    /* [singularity_count] vertices, ascending; none of a border */
    float *indices;             /* [singularity_count] turns of the field around them: multiples of 1 / symmetry */
} MesoDirectionField;

/*
 * The field of least energy: of directions as complex numbers to the power `symmetry`, differences across sides, each
 * carried over to its neighbour's plane.
 *
 * guides    [triangle_count] directions to hold to, of any length; their part along the triangle counts. NULL: none
 * weights   [triangle_count] how strongly: at 1 as strongly as to all neighbours together; 0: free. NULL: all free
 *
 * Parts of the surface without a guide have the smoothest of all fields, and of several equally smooth one that is near
 * to the longest side of the box around all. Triangles wound against each other are not joined. Combed: along a tree
 * of neighbours each direction is that of its `symmetry` turns which is most alike, from a guide where there is one.
 *
 * The indices of a closed surface add up to its Euler number. Same arguments, same bytes. One sparse factorisation of
 * two unknowns a triangle, and up to 24 solutions. MESO_ERR_LIMIT for 2^30 triangles, MESO_ERR_MEMORY; MESO_ERR_INPUT
 * where weights are not numbers.
 */
MesoStatus meso_direction_field_smooth(MesoDirectionField *field, MesoArena *arena, const MesoTriangulation *mesh,
                                       uint32_t symmetry, const MesoVec3 *guides, const float *weights,
                                       MesoError *error);

/*
 * Directions of the largest absolute curvature, from how normals turn ("Estimating Curvatures and Their Derivatives on
 * Triangle Meshes", Rusinkiewicz 2004).
 *
 * directions  [triangle_count] unit, in the triangle's plane; either of the two ways
 * weights     [triangle_count] how marked they are: (|k1| - |k2|) / (|k1| + |k2|); 0 where both are alike, as on a
 *             sphere or a symmetric saddle, and where the surface is flat: bends less than 1e-4 over a triangle
 *
 * O(triangles). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_principal_directions(MesoVec3 *directions, float *weights, MesoArena *scratch,
                                     const MesoTriangulation *mesh, MesoError *error);

#endif
