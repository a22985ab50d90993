/* Points of space, put onto a surface. */
#ifndef MESO_SURFACE_POINT_H
#define MESO_SURFACE_POINT_H

#include "libcore/mesh/cut/triangulation.h"

/*
 * The nearest point of a domain that has triangles; of equal ones, in the first triangle. O(triangles of the
 * domain).
 */
MesoMeshPoint meso_surface_point(const MesoTriangulation *mesh, const MesoDomain *domain, MesoVec3 p);

/* Order of 32-bit numbers, for qsort() and bsearch(). */
int meso_by_number(const void *a, const void *b);

#endif
