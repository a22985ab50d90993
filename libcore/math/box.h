/* Boxes along the axes. */
#ifndef MESO_BOX_H
#define MESO_BOX_H

#include "libcore/math/vec.h"

typedef struct MesoBox {
    MesoVec3 low, high;
} MesoBox;

/* The box around nothing: low is above high. */
static inline MesoBox meso_box_empty(void)
{
    return (MesoBox){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

/* Plain comparisons: fminf() is a call. What is not a number adds nothing. */
static inline void meso_box_add(MesoBox *box, MesoVec3 p)
{
    box->low.x = p.x < box->low.x ? p.x : box->low.x;
    box->low.y = p.y < box->low.y ? p.y : box->low.y;
    box->low.z = p.z < box->low.z ? p.z : box->low.z;
    box->high.x = p.x > box->high.x ? p.x : box->high.x;
    box->high.y = p.y > box->high.y ? p.y : box->high.y;
    box->high.z = p.z > box->high.z ? p.z : box->high.z;
}

/* The box around `points` [count]. */
static inline MesoBox meso_box_of(const MesoVec3 *points, uint32_t count)
{
    MesoBox box = meso_box_empty();
    for (uint32_t i = 0; i < count; i++)
        meso_box_add(&box, points[i]);
    return box;
}

/* Corner 0..7 of a box. */
static inline MesoVec3 meso_box_corner(MesoVec3 low, MesoVec3 high, uint32_t i)
{
    return (MesoVec3){i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
}

/* Adds the cube of side 2 `radius` around `p`. */
static inline void meso_box_add_around(MesoBox *box, MesoVec3 p, float radius)
{
    meso_box_add(box, (MesoVec3){p.x - radius, p.y - radius, p.z - radius});
    meso_box_add(box, (MesoVec3){p.x + radius, p.y + radius, p.z + radius});
}

#endif
