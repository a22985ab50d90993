#include "libcore/replicate/plan/surface_foot.h"

enum { WALK_LIMIT = 10000, WEB_WALK_LIMIT = 64 };

/* Weights of the foot of a place in a triangle's plane; false where that has no area. */
static bool weights_in(const MesoVec3 corners[3], MesoVec3 place, double w[3])
{
    MesoVec3 u = meso_vec3_sub(corners[1], corners[0]), v = meso_vec3_sub(corners[2], corners[0]);
    MesoVec3 p = meso_vec3_sub(place, corners[0]);
    double uu = meso_vec3_dot(u, u), uv = meso_vec3_dot(u, v), vv = meso_vec3_dot(v, v);
    double pu = meso_vec3_dot(p, u), pv = meso_vec3_dot(p, v), det = uu * vv - uv * uv;
    if (!(det > 0))
        return false;
    w[1] = (vv * pu - uv * pv) / det;
    w[2] = (uu * pv - uv * pu) / det;
    w[0] = 1 - w[1] - w[2];
    return true;
}

static uint32_t least_weight(const double w[3])
{
    uint32_t least = w[1] < w[0];
    return w[2] < w[least] ? 2 : least;
}

static MesoMeshPoint point_of(uint32_t triangle, const double w[3])
{
    MesoMeshPoint point = {.triangle = triangle};
    double sum = 0;
    for (uint32_t k = 0; k < 3; k++)
        sum += fmax(0, w[k]);
    for (uint32_t k = 0; k < 3; k++)
        point.weight[k] = (float)(fmax(0, w[k]) / sum);
    return point;
}

MesoMeshPoint meso_point_towards(const MesoTriangulation *mesh, const MesoVec3 *positions, MesoMeshPoint from,
                                 MesoVec3 place)
{
    uint32_t triangle = from.triangle, before = MESO_NO_INDEX;
    for (uint32_t steps = 0; steps < WALK_LIMIT; steps++) {
        const uint32_t *c = mesh->corners + 3 * (size_t)triangle;
        const MesoVec3 corners[3] = {positions[c[0]], positions[c[1]], positions[c[2]]};
        double w[3];
        if (!weights_in(corners, place, w))
            break;
        uint32_t least = least_weight(w);
        uint32_t across = mesh->twins[3 * triangle + (least + 1) % 3];
        /* on a ridge the foot lies beyond the side from both */
        if (w[least] >= 0 || across == MESO_NO_INDEX || across / 3 == before)
            return point_of(triangle, w);
        before = triangle;
        triangle = across / 3;
    }
    return from;
}

uint32_t meso_web_triangle(const MesoWeb *web, uint32_t from, MesoVec3 place, bool *beyond)
{
    uint32_t triangle = from, before = MESO_NO_INDEX;
    *beyond = false;
    for (uint32_t steps = 0; steps < WEB_WALK_LIMIT; steps++) {
        const uint32_t *c = web->corners + 3 * (size_t)triangle;
        const MesoVec3 corners[3] = {web->positions[c[0]], web->positions[c[1]], web->positions[c[2]]};
        double w[3];
        if (!weights_in(corners, place, w))
            break;
        uint32_t least = least_weight(w), across = web->twins[3 * triangle + (least + 1) % 3];
        *beyond = w[least] < 0 && across == MESO_NO_INDEX;
        if (w[least] >= 0 || across == MESO_NO_INDEX || across / 3 == before)
            break;
        before = triangle;
        triangle = across / 3;
    }
    return triangle;
}
