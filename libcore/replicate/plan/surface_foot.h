/* What lies under a place near a surface: found by walking there, so that the other side of a thin part is not met. */
#ifndef MESO_SURFACE_FOOT_H
#define MESO_SURFACE_FOOT_H

#include "libcore/replicate/web/web.h"

/* The point of a surface under a place, from one on; at a border, the nearest of the triangle there. */
MesoMeshPoint meso_point_towards(const MesoTriangulation *mesh, const MesoVec3 *positions, MesoMeshPoint from,
                                 MesoVec3 place);

/* The triangle of a web under a place, from one on. `beyond`: it lies outside, and that is the last one on the way. */
uint32_t meso_web_triangle(const MesoWeb *web, uint32_t from, MesoVec3 place, bool *beyond);

#endif
