/* The nearest of some triangles at each centre of a grid of voxels. */
#ifndef MESO_NEAREST_FACES_H
#define MESO_NEAREST_FACES_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

/* Voxel (x, y, z), stored at (z * count[1] + y) * count[0] + x, has its centre at low + ((x, y, z) + 0.5) * side. */
typedef struct MesoVoxelGrid {
    uint32_t count[3];
    float side;
    MesoVec3 low;
} MesoVoxelGrid;

static inline size_t meso_voxel_count(const MesoVoxelGrid *grid)
{
    return (size_t)grid->count[0] * grid->count[1] * grid->count[2];
}

static inline MesoVec3 meso_voxel_centre(const MesoVoxelGrid *grid, uint32_t x, uint32_t y, uint32_t z)
{
    return (MesoVec3){grid->low.x + ((float)x + 0.5f) * grid->side, grid->low.y + ((float)y + 0.5f) * grid->side,
                      grid->low.z + ((float)z + 0.5f) * grid->side};
}

/* The scratch that one call needs. */
size_t meso_nearest_faces_scratch(const MesoVoxelGrid *grid);

/*
 * Writes for each voxel a face that is near to its centre.
 *
 * faces               [voxels] MESO_NO_INDEX where none of the faces comes into the grid
 * squares             [voxels] scratch
 * positions, corners  of the mesh
 * list                [list_count] the faces in question
 * scratch             [meso_nearest_faces_scratch()] bytes, aligned to 4
 *
 * Voxels within a voxel of a face have it by exact distances. From there squares spread by an exact transform, line by
 * line in x, y and z (Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions", 2012), with the face
 * that they are of: rarely more than half a voxel farther than the nearest. O(voxels + what boxes around the faces
 * hold).
 */
void meso_nearest_faces(uint32_t *faces, float *squares, const MesoVoxelGrid *grid, const MesoVec3 *positions,
                        const uint32_t *corners, const uint32_t *list, uint32_t list_count, void *scratch);

#endif
