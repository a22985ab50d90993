/* Boxes along the axes. */
#ifndef MESO_BOX_H
#define MESO_BOX_H

#include <stdbool.h>

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

/* Adds another box; one around nothing adds nothing. */
static inline void meso_box_join(MesoBox *box, const MesoBox *other)
{
    if (!(other->low.x <= other->high.x))
        return;
    meso_box_add(box, other->low);
    meso_box_add(box, other->high);
}

/* The box, wider by `reach` at each side: as if that much had been around all that it was made of. */
static inline MesoBox meso_box_wider(MesoBox box, float reach)
{
    const MesoVec3 r = {reach, reach, reach};
    return (MesoBox){meso_vec3_sub(box.low, r), meso_vec3_add(box.high, r)};
}

/* Whether some of `inner`, which is around something, is beside `box`. */
static inline bool meso_box_sticks_out(const MesoBox *inner, const MesoBox *box)
{
    return inner->low.x < box->low.x || inner->low.y < box->low.y || inner->low.z < box->low.z ||
           inner->high.x > box->high.x || inner->high.y > box->high.y || inner->high.z > box->high.z;
}

#endif
