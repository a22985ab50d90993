/* Triangles of a disk, laid flat; in double precision. */
#ifndef MESO_CHART_FLATTEN_H
#define MESO_CHART_FLATTEN_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef struct MesoPoint {
    double x, y;
} MesoPoint;

/* A triangle in its own plane: the gradients there of the functions that are 1 at a corner and 0 at the others. */
typedef struct MesoFlatTriangle {
    MesoPoint gradients[3];
    double area;
} MesoFlatTriangle;

typedef struct MesoDisk {
    uint32_t vertex_count, triangle_count;
    const uint32_t *corners;            /* [3 * triangle_count] */
    const MesoFlatTriangle *triangles;  /* [triangle_count] */
    uint32_t border_count;
    const uint32_t *border;             /* [2 * border_count] sides of the border, as their triangles run */
} MesoDisk;

/*
 * From the positions of a triangle's corners: the first side along x where the triangle is not thin. One that is
 * thinner than 1e-4 of its longest side is taken to be that high; `size` is the longest side where there is none.
 */
MesoFlatTriangle meso_flat_triangle(const MesoVec3 positions[3], double size, MesoPoint places[3]);

/* x and y of the image of a triangle's plane: columns of the linear map. */
typedef struct MesoJacobian {
    MesoPoint x, y;
} MesoJacobian;

static inline MesoJacobian meso_jacobian(const MesoDisk *disk, const MesoPoint *places, uint32_t triangle)
{
    MesoJacobian map = {{0, 0}, {0, 0}};
    const MesoFlatTriangle *flat = &disk->triangles[triangle];
    for (uint32_t k = 0; k < 3; k++) {
        MesoPoint at = places[disk->corners[3 * (size_t)triangle + k]], g = flat->gradients[k];
        map.x.x += at.x * g.x, map.x.y += at.y * g.x;
        map.y.x += at.x * g.y, map.y.y += at.y * g.y;
    }
    return map;
}

static inline double meso_jacobian_area(const MesoJacobian *map)
{
    return map->x.x * map->y.y - map->x.y * map->y.x;
}

/* How much areas grow: `least` is not above 0 where a triangle is flipped, or a place is not finite. */
typedef struct MesoAreaScales {
    double least, largest;
    double total;           /* flat area over area */
} MesoAreaScales;

MesoAreaScales meso_area_scales(const MesoDisk *disk, const MesoPoint *places);

/*
 * Least squares conformal map with two vertices of the border held. `places` [vertex_count] are of any scale.
 * MESO_ERR_INPUT where there is none in double precision, MESO_ERR_MEMORY.
 */
MesoStatus meso_flatten_conformal(MesoPoint *places, MesoArena *scratch, const MesoDisk *disk, MesoError *error);

/* As rigid as possible: one matrix for all steps, factored once. */
typedef struct MesoRigidSteps MesoRigidSteps;

/* On the arena. NULL with `error` filled as above. */
MesoRigidSteps *meso_rigid_steps_new(MesoArena *arena, const MesoDisk *disk, MesoError *error);

/* One step: each triangle's nearest rotation, then the places that fit them best. The first vertex stays. */
void meso_rigid_step(MesoRigidSteps *steps, MesoPoint *places);

#endif
