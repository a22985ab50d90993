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
        double share = -meso_vec3d_dot(at, way) / square;
        at = meso_vec3d_mad(at, share < 1 ? share : 1, way);
    }
    return false;
}

/* ---- hulls in floats ---- */

MesoPrismHull meso_prism_hull(const MesoPrismBody *body, MesoVec3d origin)
{
    MesoPrismHull hull;
    MesoVec3 p[6], low = {0, 0, 0}, high = {0, 0, 0};
    for (uint32_t k = 0; k < 6; k++)
        p[k] = meso_vec3d_narrow(meso_vec3d_sub(body->corners[k], origin));
    for (uint32_t k = 0; k < 3; k++) {
        low = meso_vec3_mad(low, 1.0f / 3, p[k]);
        high = meso_vec3_mad(high, 1.0f / 3, p[k + 3]);
    }
    for (uint32_t i = 0; i < 2; i++) {
        const MesoVec3 *q = &p[4 * i], *last = &p[i ? 5 : 3], *third = &p[i ? 5 : 2];
        hull.x[i] = (MesoFour){q[0].x, q[1].x, third->x, last->x};
        hull.y[i] = (MesoFour){q[0].y, q[1].y, third->y, last->y};
        hull.z[i] = (MesoFour){q[0].z, q[1].z, third->z, last->z};
    }
    hull.centre = meso_vec3_lerp(low, high, 0.5f);
    hull.rise = meso_vec3_sub(high, low);
    return hull;
}

/* How far corners lie along an axis. */
static inline MesoFour along(const MesoPrismHull *hull, int i, MesoVec3 axis)
{
    return hull->x[i] * axis.x + hull->y[i] * axis.y + hull->z[i] * axis.z;
}

static inline float least_of(MesoFour a)
{
    a = meso_four_least(a, MESO_FOUR_SHUFFLE(a, a, 2, 3, 0, 1));
    a = meso_four_least(a, MESO_FOUR_SHUFFLE(a, a, 1, 0, 3, 2));
    return a[0];
}

/* Whether a plane across `axis`, which leads from b to a, is between them. */
static inline bool is_clear(const MesoPrismHull *a, const MesoPrismHull *b, MesoVec3 axis, float size)
{
    const float rounding = 2e-6f;       /* four times what two sums of three products can be off by */
    float low = least_of(meso_four_least(along(a, 0, axis), along(a, 1, axis)));
    float high = -least_of(meso_four_least(-along(b, 0, axis), -along(b, 1, axis)));
    return low - high > rounding * size * (fabsf(axis.x) + fabsf(axis.y) + fabsf(axis.z));
}

bool meso_prism_hulls_clear(const MesoPrismHull *a, const MesoPrismHull *b, float size)
{
    MesoVec3 way = meso_vec3_sub(a->centre, b->centre);
    float square = meso_vec3_dot(a->rise, a->rise);
    return is_clear(a, b, square > 0 ? meso_vec3_mad(way, -meso_vec3_dot(way, a->rise) / square, a->rise) : way, size);
}

/* The lower corners are the first three of the hull, and the fourth is above the first. */
static inline MesoVec3 lower_corner(const MesoPrismHull *hull, int k)
{
    return (MesoVec3){hull->x[0][k], hull->y[0][k], hull->z[0][k]};
}

bool meso_prism_walls_clear(const MesoPrismHull *a, const MesoPrismHull *b, float size)
{
    MesoVec3 way = meso_vec3_sub(a->centre, b->centre);
    for (int i = 0; i < 6; i++) {
        const MesoPrismHull *of = i < 3 ? a : b;
        MesoVec3 side = meso_vec3_sub(lower_corner(of, (i + 1) % 3), lower_corner(of, i % 3));
        MesoVec3 across = meso_vec3_cross(side, of->rise);
        if (meso_vec3_dot(across, way) < 0)
            across = meso_vec3_scale(across, -1);
        if (is_clear(a, b, across, size))
            return true;
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
        low[0] = s < low[0] ? s : low[0], high[0] = s > high[0] ? s : high[0];
        low[1] = t < low[1] ? t : low[1], high[1] = t > high[1] ? t : high[1];
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
