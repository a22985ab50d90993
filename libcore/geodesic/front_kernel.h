/*
 * The step of a front at a vertex u of known distance: what it tells the
 * vertices at the ends of up to eight spokes, for the triangles between
 * spokes that follow each other. Written three times: here for one spoke after
 * the other, and for vectors of four and of eight; operations and their order
 * are the same, and so are the results.
 *
 * Side u-i of a triangle u, i, p lies in the plane from (0,0) to (l,0), and p
 * at (px,py) above. The front that has reached u and i comes
 *
 *  - from a source at (sx,-sy) below, d(u) from u and d(i) from i, if it is
 *    circular: d(p) = |p - s|;
 *  - as a line with the gradient (gx,gy), where gx = (d(i) - d(u)) / l, if it
 *    is planar: d(p) = d(u) + gx px + gy py.
 *
 * Both count only if what reaches p has crossed the side between u and i, t of
 * the way from u. d(u), d(i) and l have to make a triangle, or u and i belong
 * to no common source; of a planar front, to no common line. And p is never
 * farther away than d(u) and its spoke.
 *
 * A front is planar if either of u and i has it so, and p has what the nearer
 * of them has to where it has crossed: so the front from an end of a line is
 * circular beyond it, and both parts keep to themselves.
 */
#ifndef MESO_FRONT_KERNEL_H
#define MESO_FRONT_KERNEL_H

#include "libcore/geodesic/geodesic_solver.h"

typedef struct MesoFrontStep {
    const MesoGeodesicRow *rows;
    uint32_t vertex;
    const uint32_t *spokes;     /* [count]; MESO_RING_SLACK vertices of the mesh may be read from any of them on */
    uint32_t count;             /* 2 to 8 */
    bool closed;                /* a triangle stands between the last and the first, too */
    float floor;                /* nothing that comes through a triangle is nearer */
} MesoFrontStep;

typedef struct MesoFrontSide {
    float du, l, inverse;
    float sx, sy, gx, gy;
    bool planar_u, planar_i;
} MesoFrontSide;

/* What reaches a vertex: INFINITY where nothing does. */
typedef struct MesoFrontArrival {
    float distance;
    bool planar;
} MesoFrontArrival;

/* Seeds inside a side are allowed to be a little too near to both of its ends. */
#define MESO_FRONT_SLACK 0.9999f

static inline bool meso_front_is_common(float du, float di, float l, bool planar)
{
    return __builtin_fabsf(du - di) <= l && (planar || l * MESO_FRONT_SLACK <= du + di);
}

static inline MesoFrontSide meso_front_side(float du, bool planar_u, float di, bool planar_i, float l, float squared)
{
    MesoFrontSide side = {.du = du, .l = l, .inverse = 1 / l, .planar_u = planar_u, .planar_i = planar_i};
    float difference = du - di, sum = du + di;
    if (planar_u || planar_i) {
        side.gx = -difference * side.inverse;
        float rest = 1 - side.gx * side.gx;
        side.gy = __builtin_sqrtf(rest > 0 ? rest : 0);
    } else {
        side.sx = (squared + difference * sum) * (0.5f * side.inverse);
        float rest = (du - side.sx) * (du + side.sx);
        side.sy = __builtin_sqrtf(rest > 0 ? rest : 0);
    }
    return side;
}

/* At the corner that faces a side; `dot` and `area` are of the spokes to i and to that corner. */
static inline MesoFrontArrival meso_front_across(const MesoFrontSide *side, float dot, float area, float least)
{
    float px = dot * side->inverse, py = area * side->inverse, t, whole;
    MesoFrontArrival found = {0, false};
    if (side->planar_u || side->planar_i) {
        t = side->gy * px - side->gx * py;
        whole = side->l * side->gy;
        found.distance = (side->du + side->gx * px) + side->gy * py;
        found.planar = t < 0.5f * whole ? side->planar_u : side->planar_i;
    } else {
        float x = px - side->sx, y = py + side->sy;
        t = side->sx * py + px * side->sy;
        whole = side->l * y;
        found.distance = __builtin_sqrtf(x * x + y * y);
    }
    found.distance = found.distance > least ? found.distance : least;
    return 0 <= t && t <= whole ? found : (MesoFrontArrival){INFINITY, false};
}

/*
 * Distances that are told to the ends of the spokes, planar ones with their sign bit set, to `found` [8]; returns a
 * bit for each that is lower than the one that it has.
 */
static inline uint32_t meso_front_step_plain(const MesoFrontStep *step, float *found)
{
    const MesoGeodesicRow *u = &step->rows[step->vertex];
    uint32_t n = step->count, lower = 0;
    float x[8], y[8], z[8], squared[8], told[8];
    float du = __builtin_fabsf(u->distance);
    bool planar_u = __builtin_signbit(u->distance);
    for (uint32_t i = 0; i < n; i++) {
        const MesoGeodesicRow *row = &step->rows[step->spokes[i]];
        x[i] = row->x - u->x;
        y[i] = row->y - u->y;
        z[i] = row->z - u->z;
        squared[i] = (x[i] * x[i] + y[i] * y[i]) + z[i] * z[i];
        told[i] = row->distance;
    }
    uint32_t sides = step->closed ? n : n - 1;
    float dot[8], area[8], l[8];
    MesoFrontArrival from_before[8], from_next[8];
    for (uint32_t i = 0; i < sides; i++) {
        uint32_t k = i + 1 < n ? i + 1 : 0;
        float cx = y[i] * z[k] - z[i] * y[k], cy = z[i] * x[k] - x[i] * z[k], cz = x[i] * y[k] - y[i] * x[k];
        dot[i] = (x[i] * x[k] + y[i] * y[k]) + z[i] * z[k];
        area[i] = __builtin_sqrtf((cx * cx + cy * cy) + cz * cz);
    }
    for (uint32_t i = 0; i < n; i++) {
        uint32_t next = i + 1 < n ? i + 1 : 0, before = i > 0 ? i - 1 : n - 1;
        float di = __builtin_fabsf(told[i]);
        bool planar_i = __builtin_signbit(told[i]);
        l[i] = __builtin_sqrtf(squared[i]);
        from_before[next].distance = from_next[before].distance = INFINITY;
        if (!meso_front_is_common(du, di, l[i], planar_u || planar_i))
            continue;
        MesoFrontSide side = meso_front_side(du, planar_u, di, planar_i, l[i], squared[i]);
        if (i < sides)
            from_before[next] = meso_front_across(&side, dot[i], area[i], step->floor);
        if (before < sides)
            from_next[before] = meso_front_across(&side, dot[before], area[before], step->floor);
    }
    for (uint32_t i = 0; i < n; i++) {
        MesoFrontArrival best = {du + l[i], planar_u};
        if (from_before[i].distance < best.distance)
            best = from_before[i];
        if (from_next[i].distance < best.distance)
            best = from_next[i];
        lower |= (uint32_t)(best.distance < __builtin_fabsf(told[i])) << i;
        found[i] = best.planar ? -best.distance : best.distance;
    }
    return lower;
}

#endif
