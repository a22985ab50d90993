/* The layer above a surface, and back from space to it. */
#include "libcore/math/vec3d.h"
#include "libcore/quilt/settle/settle_work.h"

/* Steps of Newton's method in one triangle, and triangles of a walk. */
enum { NEWTON_LIMIT = 8, WALK_LIMIT = 256 };

/* Weights that may be less than 0 without another triangle being looked for: places on an edge. */
#define WEIGHT_SLACK 1e-6

/* Weights less than that are those of a place that is not to be solved for in this triangle. */
#define FAR_OUTSIDE 1.0

typedef struct Prism {
    MesoVec3d p[3], d[3];
} Prism;

static Prism prism_of(const MesoSettleWork *work, uint32_t triangle)
{
    Prism prism;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t v = work->surface->corners[3 * (size_t)triangle + k];
        prism.p[k] = meso_vec3d(work->surface->positions[v]);
        prism.d[k] = meso_vec3d(work->directions[v]);
    }
    return prism;
}

/* b [3] weights, b[0] is what is left of 1. */
static MesoVec3d mix(const MesoVec3d *v, const double *b)
{
    return meso_vec3d_mad(meso_vec3d_mad(meso_vec3d_scale(v[0], b[0]), b[1], v[1]), b[2], v[2]);
}

/*
 * Solves sum b_i (p_i + h d_i) = x from where it begins; false where that does not come near, and b says then which way it
 * is. Far outside of the prism one step says as much: the prism's sides meet somewhere.
 */
static bool solve(double *b, double *h, const Prism *prism, MesoVec3d x)
{
    const double first_height = *h;
    for (int i = 0; i < NEWTON_LIMIT; i++) {
        MesoVec3d corner[3];
        for (int k = 0; k < 3; k++)
            corner[k] = meso_vec3d_mad(prism->p[k], *h, prism->d[k]);
        MesoVec3d up = mix(prism->d, b), miss = meso_vec3d_sub(x, mix(corner, b));
        MesoVec3d u = meso_vec3d_sub(corner[1], corner[0]), v = meso_vec3d_sub(corner[2], corner[0]);
        double det = meso_vec3d_det(u, v, up);
        if (!(fabs(det) > 0))
            return false;
        double s = meso_vec3d_det(miss, v, up) / det, t = meso_vec3d_det(u, miss, up) / det;
        b[1] += s;
        b[2] += t;
        b[0] = 1 - b[1] - b[2];
        *h += meso_vec3d_det(u, v, miss) / det;
        if (i == 0 && (b[0] < -FAR_OUTSIDE || b[1] < -FAR_OUTSIDE || b[2] < -FAR_OUTSIDE)) {
            *h = first_height;
            return false;
        }
        if (fabs(s) < 1e-9 && fabs(t) < 1e-9)
            return true;
    }
    return false;
}

/* The corner with the least weight, of those across from which the surface goes on if there are such below 0. */
static uint32_t way_out(const MesoSettleWork *work, uint32_t triangle, const double *b)
{
    uint32_t least = MESO_NO_INDEX;
    for (uint32_t k = 0; k < 3; k++) {
        bool open = work->surface->twins[3 * (size_t)triangle + (k + 1) % 3] != MESO_NO_INDEX;
        if (open && b[k] < -WEIGHT_SLACK && (least == MESO_NO_INDEX || b[k] < b[least]))
            least = k;
    }
    return least;
}

/* How far a place is beyond those sides of its triangle that are borders. */
static float distance_beyond(const MesoSettleWork *work, uint32_t triangle, const Prism *prism, const double *b)
{
    double most = 0;
    MesoVec3d u = meso_vec3d_sub(prism->p[1], prism->p[0]), v = meso_vec3d_sub(prism->p[2], prism->p[0]);
    double area = meso_vec3d_length(meso_vec3d_cross(u, v));
    for (uint32_t k = 0; k < 3; k++) {
        if (work->surface->twins[3 * (size_t)triangle + (k + 1) % 3] != MESO_NO_INDEX)
            continue;
        double side = meso_vec3d_length(meso_vec3d_sub(prism->p[(k + 2) % 3], prism->p[(k + 1) % 3]));
        double far = side > 0 ? -b[k] * area / side : 0;
        most = far > most ? far : most;
    }
    return (float)most;
}

bool meso_settle_locate(MesoQuiltVertex *place, float *beyond, const MesoSettleWork *work, MesoVec3 point)
{
    uint32_t triangle = place->triangle, before = MESO_NO_INDEX;
    const MesoVec3d x = meso_vec3d(point);
    double h = (double)place->height, b[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    for (int step = 0; step < WALK_LIMIT; step++) {
        Prism prism = prism_of(work, triangle);
        bool found = solve(b, &h, &prism, x);
        uint32_t out = way_out(work, triangle, b);
        uint32_t next = out == MESO_NO_INDEX ? out : work->surface->twins[3 * (size_t)triangle + (out + 1) % 3] / 3;
        if ((out == MESO_NO_INDEX || next == before) && !found)
            return false;
        if (out == MESO_NO_INDEX || next == before) {
            *beyond = distance_beyond(work, triangle, &prism, b);
            *place = (MesoQuiltVertex){triangle, (float)b[1], (float)b[2], (float)h};
            return true;
        }
        before = triangle;
        triangle = next;
        b[0] = b[1] = b[2] = 1.0 / 3;
    }
    return false;
}

MesoVec3 meso_settle_point(const MesoSettleWork *work, MesoQuiltVertex place)
{
    return meso_prism_point(work->surface, work->directions, place.triangle, place.b1, place.b2, place.height);
}

MesoVec3 meso_settle_up(const MesoSettleWork *work, MesoQuiltVertex place)
{
    const uint32_t *v = &work->surface->corners[3 * (size_t)place.triangle];
    MesoVec3 up = meso_vec3_scale(work->directions[v[0]], 1 - place.b1 - place.b2);
    up = meso_vec3_mad(meso_vec3_mad(up, place.b1, work->directions[v[1]]), place.b2, work->directions[v[2]]);
    return meso_vec3_direction(up, (MesoVec3){0, 0, 1});
}
