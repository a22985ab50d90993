/* Whether two prisms meet: by their hulls where they have no vertex in common, else by their tetrahedra. */
#ifndef MESO_PRISM_BODIES_H
#define MESO_PRISM_BODIES_H

#include "libcore/math/vec3d.h"

/* Corners 0 to 2 below, 3 to 5 above. */
typedef struct MesoPrismBody {
    MesoVec3d corners[6];
    uint8_t tetrahedra[3][4];
} MesoPrismBody;

/*
 * Whether a plane lies between the convex hulls. May be told false where they are closer than about a thousandth of
 * their size; never true where they meet.
 */
bool meso_prism_hulls_apart(const MesoPrismBody *a, const MesoPrismBody *b);

/* Whether no tetrahedron of one goes into one of the other; touching is apart. */
bool meso_prism_tetrahedra_apart(const MesoPrismBody *a, const MesoPrismBody *b);

#endif
