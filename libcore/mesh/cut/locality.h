/*
 * Numbers that follow the surface: neighbours in the mesh are neighbours in
 * memory. Fronts of distances live in the nearest caches then, and every
 * other pass gains too; files with their vertices in any order lose nothing.
 */
#ifndef MESO_LOCALITY_H
#define MESO_LOCALITY_H

#include "libcore/base/error.h"
#include "libcore/math/vec.h"

/* Meshes of fewer vertices lie in the caches whatever their order. */
enum { MESO_LOCALITY_LEAST = 65536 };

/* An order, both ways. */
typedef struct MesoLocality {
    uint32_t *old_vertex, *new_vertex;          /* [vertex_count] which comes in a place, and in which place one comes */
    uint32_t *old_triangle, *new_triangle;      /* [triangle_count] */
} MesoLocality;

/*
 * An order of vertices along a Hilbert curve through 1024^3 cells of the mesh's box, and of triangles by the first of
 * their vertices in it; what is equal comes as before.
 *
 * corners       [3 * triangle_count]
 * order         arrays of the caller's, which are filled; those of triangles are not looked at where there are none
 *
 * Positions have to be finite. O(vertices + triangles). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_locality_order(const MesoVec3 *positions, uint32_t vertex_count, const uint32_t *corners,
                               uint32_t triangle_count, const MesoLocality *order, MesoError *error);

#endif
