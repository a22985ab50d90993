/* What a web of details (detail_web.h) is. */
#ifndef MESO_WEB_H
#define MESO_WEB_H

#include "libcore/base/arena.h"
#include "libcore/math/vec3d.h"
#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoWeb {
    MesoArena *arena;
    uint32_t fixed_count;       /* first nodes: vertices of the surface that stay; details come behind, in order */
    uint32_t node_count, triangle_count;
    uint32_t node_room, triangle_room;
    MesoMeshPoint *points;      /* [node_count] on the surface */
    MesoVec3 *positions;        /* [node_count] in the frame */
    MesoVec3 *normals;          /* [node_count] */
    uint32_t *node_corner;      /* [node_count] a half-edge that begins there; MESO_NO_INDEX: it has been taken out */
    uint32_t *corners;          /* [3 * triangle_count] nodes; half-edges as in triangulation.h, all wound alike */
    uint32_t *twins;            /* [3 * triangle_count] or MESO_NO_INDEX */
} MesoWeb;

/* Of an arc over its chord, squared: s / sin(s), s half the angle between the normals; so far and no further. */
static inline double meso_web_arc2(MesoVec3 a, MesoVec3 b)
{
    double s2 = 0.5 * (1 - fabs((double)meso_vec3_dot(a, b)));      /* which side is outside does not matter */
    s2 = s2 > 0 ? s2 < 0.5 ? s2 : 0.5 : 0;
    double arc = 1 + s2 * (1.0 / 6 + s2 * (3.0 / 40 + s2 * (15.0 / 336)));
    return arc * arc;
}

/* Squared length of the edge between two nodes. */
static inline double meso_web_length2(const MesoWeb *web, uint32_t a, uint32_t b)
{
    MesoVec3d d = meso_vec3d_sub(meso_vec3d(web->positions[b]), meso_vec3d(web->positions[a]));
    return meso_vec3d_dot(d, d) * meso_web_arc2(web->normals[a], web->normals[b]);
}

/* Sixteen squared areas of a triangle by its squared sides. */
static inline double meso_heron(double a2, double b2, double c2)
{
    double m = b2 + c2 - a2, area = 4 * b2 * c2 - m * m;
    return area > 0 ? area : 0;
}

static inline double meso_web_area(const MesoWeb *web, uint32_t triangle)
{
    const uint32_t *c = web->corners + 3 * (size_t)triangle;
    return 0.25 * sqrt(meso_heron(meso_web_length2(web, c[0], c[1]), meso_web_length2(web, c[1], c[2]),
                                  meso_web_length2(web, c[2], c[0])));
}

/*
 * Neighbours of a node, at most `room` of them are written, in no order that means anything; returns how many there
 * are.
 */
uint32_t meso_web_ring(const MesoWeb *web, uint32_t node, uint32_t *ring, uint32_t room);

/*
 * Checks that twins are mutual, each node that has not been taken out has one fan, no two nodes are joined twice, and
 * vertices - edges + triangles is `euler`. MESO_ERR_INTERNAL with the first place that fails. For tests.
 * O(triangles * degree).
 */
MesoStatus meso_web_check(const MesoWeb *web, int64_t euler, MesoError *error);

#endif
