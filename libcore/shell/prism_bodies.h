/* Whether two prisms meet: by their hulls where they have no vertex in common, else by their tetrahedra. */
#ifndef MESO_PRISM_BODIES_H
#define MESO_PRISM_BODIES_H

#include "libcore/math/four.h"
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

/*
 * The hull in floats, for what most pairs need: a plane that is clearly between both. Corners about an origin near to
 * all bodies; the last one three times.
 */
typedef struct MesoPrismHull {
    MesoFour x[2], y[2], z[2];
    MesoVec3 centre, rise;      /* and from the lower corners to the upper ones, on the mean */
} MesoPrismHull;

MesoPrismHull meso_prism_hull(const MesoPrismBody *body, MesoVec3d origin);

/*
 * True only where a plane lies between the hulls, and rounding cannot tell otherwise: one along the first one's rise,
 * across the way from one to the other; or one along a wall of either. `size`: no coordinate is larger.
 */
bool meso_prism_hulls_clear(const MesoPrismHull *a, const MesoPrismHull *b, float size);
bool meso_prism_walls_clear(const MesoPrismHull *a, const MesoPrismHull *b, float size);

/* Whether no tetrahedron of one goes into one of the other; touching is apart. */
bool meso_prism_tetrahedra_apart(const MesoPrismBody *a, const MesoPrismBody *b);

#endif
