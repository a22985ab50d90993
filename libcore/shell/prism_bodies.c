#include "libcore/shell/prism_bodies.h"

/* ---- hulls ---- */

static uint32_t farthest(const MesoPrismBody *body, MesoVec3d along, double sign)
{
    uint32_t best = 0;
    double most = -INFINITY;
    for (uint32_t k = 0; k < 6; k++) {
        double s = sign * meso_vec3d_dot(body->corners[k], along);
        if (s > most) {
            most = s;
            best = k;
        }
    }
    return best;
}

static MesoVec3d centre(const MesoPrismBody *body)
{
    MesoVec3d sum = {0, 0, 0};
    for (uint32_t k = 0; k < 6; k++)
        sum = meso_vec3d_mad(sum, 1.0 / 6, body->corners[k]);
    return sum;
}

/*
 * Gilbert's method ("An iterative procedure for computing the minimum of a quadratic form on a convex set", 1966): a
 * point of the difference of the hulls goes towards the origin; its direction is that of a plane between them as soon
 * as the whole difference lies on one side.
 */
bool meso_prism_hulls_apart(const MesoPrismBody *a, const MesoPrismBody *b)
{
    enum { STEPS = 32 };
    MesoVec3d at = meso_vec3d_sub(centre(a), centre(b));
    for (uint32_t step = 0; step < STEPS; step++) {
        MesoVec3d nearest = meso_vec3d_sub(a->corners[farthest(a, at, -1)], b->corners[farthest(b, at, 1)]);
        if (meso_vec3d_dot(nearest, at) > 0)
            return true;
        MesoVec3d way = meso_vec3d_sub(nearest, at);
        double square = meso_vec3d_dot(way, way);
        if (!(square > 0))
            return false;
        at = meso_vec3d_mad(at, fmin(-meso_vec3d_dot(at, way) / square, 1), way);
    }
    return false;
}

/* ---- tetrahedra ---- */

typedef struct Tetrahedron {
    MesoVec3d corners[4];
} Tetrahedron;

static Tetrahedron part(const MesoPrismBody *body, uint32_t number)
{
    Tetrahedron part;
    for (uint32_t k = 0; k < 4; k++)
        part.corners[k] = body->corners[body->tetrahedra[number][k]];
    return part;
}

/* Whether a plane across `axis` has them on its two sides; what rounding makes of a common point is on both. */
static bool is_between(const Tetrahedron *a, const Tetrahedron *b, MesoVec3d axis)
{
    const double rounding = 1e-9;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t k = 0; k < 4; k++) {
        double s = meso_vec3d_dot(meso_vec3d_sub(a->corners[k], a->corners[0]), axis);
        double t = meso_vec3d_dot(meso_vec3d_sub(b->corners[k], a->corners[0]), axis);
        low[0] = fmin(low[0], s), high[0] = fmax(high[0], s);
        low[1] = fmin(low[1], t), high[1] = fmax(high[1], t);
    }
    double slack = rounding * (high[0] - low[0] + high[1] - low[1]);
    return slack > 0 && (high[0] <= low[1] + slack || high[1] <= low[0] + slack);
}

static MesoVec3d face_axis(const Tetrahedron *body, uint32_t without)
{
    MesoVec3d p = body->corners[(without + 1) & 3];
    return meso_vec3d_cross(meso_vec3d_sub(body->corners[(without + 2) & 3], p),
                            meso_vec3d_sub(body->corners[(without + 3) & 3], p));
}

/* Planes along a face of one, or along an edge of each: one of them is between convex bodies that are apart. */
static bool are_apart(const Tetrahedron *a, const Tetrahedron *b)
{
    static const uint8_t edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    for (uint32_t k = 0; k < 4; k++)
        if (is_between(a, b, face_axis(a, k)) || is_between(a, b, face_axis(b, k)))
            return true;
    for (uint32_t k = 0; k < 6; k++) {
        MesoVec3d along = meso_vec3d_sub(a->corners[edges[k][1]], a->corners[edges[k][0]]);
        for (uint32_t l = 0; l < 6; l++) {
            MesoVec3d other = meso_vec3d_sub(b->corners[edges[l][1]], b->corners[edges[l][0]]);
            if (is_between(a, b, meso_vec3d_cross(along, other)))
                return true;
        }
    }
    return false;
}

static bool has_volume(const Tetrahedron *body)
{
    MesoVec3d p = body->corners[0], a = meso_vec3d_sub(body->corners[1], p), b = meso_vec3d_sub(body->corners[2], p);
    return meso_vec3d_det(a, b, meso_vec3d_sub(body->corners[3], p)) != 0;
}

bool meso_prism_tetrahedra_apart(const MesoPrismBody *a, const MesoPrismBody *b)
{
    for (uint32_t i = 0; i < 3; i++) {
        Tetrahedron one = part(a, i);
        for (uint32_t j = 0; j < 3 && has_volume(&one); j++) {
            Tetrahedron other = part(b, j);
            if (has_volume(&other) && !are_apart(&one, &other))
                return false;
        }
    }
    return true;
}
