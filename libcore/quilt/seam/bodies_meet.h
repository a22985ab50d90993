/* Whether two small bodies meet: some triangle of one crosses one of the other. */
#ifndef MESO_BODIES_MEET_H
#define MESO_BODIES_MEET_H

#include <stddef.h>

#include "libcore/math/vec.h"

typedef struct MesoBodyPart {
    const MesoVec3 *points;     /* [point_count] */
    const uint32_t *corners;    /* [3 * triangle_count], counted from `first` */
    uint32_t triangle_count;
    uint32_t first;             /* number of points[0] in corners */
    uint32_t point_count;
} MesoBodyPart;

/*
 * Whether an edge of one goes through a triangle of the other, either way. Bodies that only touch may be told to meet
 * or not. O(triangles in the common box, squared).
 */
bool meso_bodies_meet(const MesoBodyPart *a, const MesoBodyPart *b);

/* The same of two triangles: p[3], q[3]. */
bool meso_triangles_cross(const MesoVec3 *p, const MesoVec3 *q);

#endif
