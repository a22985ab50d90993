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

static inline void meso_box_add(MesoBox *box, MesoVec3 p)
{
    box->low = (MesoVec3){fminf(box->low.x, p.x), fminf(box->low.y, p.y), fminf(box->low.z, p.z)};
    box->high = (MesoVec3){fmaxf(box->high.x, p.x), fmaxf(box->high.y, p.y), fmaxf(box->high.z, p.z)};
}

/* The box around `points` [count]. */
static inline MesoBox meso_box_of(const MesoVec3 *points, uint32_t count)
{
    MesoBox box = meso_box_empty();
    for (uint32_t i = 0; i < count; i++)
        meso_box_add(&box, points[i]);
    return box;
}

/* Adds the cube of side 2 `radius` around `p`. */
static inline void meso_box_add_around(MesoBox *box, MesoVec3 p, float radius)
{
    meso_box_add(box, (MesoVec3){p.x - radius, p.y - radius, p.z - radius});
    meso_box_add(box, (MesoVec3){p.x + radius, p.y + radius, p.z + radius});
}

#endif
