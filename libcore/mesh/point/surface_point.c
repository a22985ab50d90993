#include "libcore/mesh/point/surface_point.h"

typedef struct Point {
    double x, y, z;
} Point;

static Point minus(MesoVec3 a, MesoVec3 b)
{
    return (Point){(double)a.x - b.x, (double)a.y - b.y, (double)a.z - b.z};
}

static double dot(Point a, Point b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* On the segment from `a` along `ab`: the share of the way nearest to a + ap. */
static double nearest_share(Point ab, Point ap)
{
    double length = dot(ab, ab), s = length > 0 ? dot(ab, ap) / length : 0;
    return s < 0 ? 0 : s > 1 ? 1 : s;
}

static double squared_distance(Point ap, Point ab, Point ac, double v, double w)
{
    Point d = {ap.x - v * ab.x - w * ac.x, ap.y - v * ab.y - w * ac.y, ap.z - v * ab.z - w * ac.z};
    return dot(d, d);
}

/* Weights of the second and third corner of the nearest point; the squared distance comes back. */
static double nearest_in_triangle(MesoVec3 a, MesoVec3 b, MesoVec3 c, MesoVec3 p, double weight[2])
{
    Point ab = minus(b, a), ac = minus(c, a), ap = minus(p, a), bc = minus(c, b), bp = minus(p, b);
    double bb = dot(ab, ab), bcb = dot(ab, ac), cc = dot(ac, ac), pb = dot(ap, ab), pc = dot(ap, ac);
    double scale = bb * cc - bcb * bcb;
    double v = scale > 0 ? (cc * pb - bcb * pc) / scale : -1, w = scale > 0 ? (bb * pc - bcb * pb) / scale : -1;
    if (v >= 0 && w >= 0 && v + w <= 1) {
        weight[0] = v;
        weight[1] = w;
        return squared_distance(ap, ab, ac, v, w);
    }
    /* outside, or no area: the nearest of the three sides */
    double s[3] = {nearest_share(ab, ap), nearest_share(ac, ap), nearest_share(bc, bp)};
    const double on_side[3][2] = {{s[0], 0}, {0, s[1]}, {1 - s[2], s[2]}};
    double best = INFINITY;
    for (int i = 0; i < 3; i++) {
        double d = squared_distance(ap, ab, ac, on_side[i][0], on_side[i][1]);
        if (d < best) {
            best = d;
            weight[0] = on_side[i][0];
            weight[1] = on_side[i][1];
        }
    }
    return best;
}

/* How far x lies outside of the range of three numbers. Plain comparisons: fminf() is a call. */
static float outside(float a, float b, float c, float x)
{
    float low = a < b ? a : b, high = a < b ? b : a;
    low = low < c ? low : c;
    high = high < c ? c : high;
    float below = low - x, above = x - high;
    float out = below > above ? below : above;
    return out > 0 ? out : 0;
}

/* A bound from below, by the box around the triangle: most triangles are passed over by this alone. */
static float squared_box_distance(MesoVec3 a, MesoVec3 b, MesoVec3 c, MesoVec3 p)
{
    float x = outside(a.x, b.x, c.x, p.x), y = outside(a.y, b.y, c.y, p.y), z = outside(a.z, b.z, c.z, p.z);
    return x * x + y * y + z * z;
}

/* Of the bound, in single precision. */
static const double BOX_ROUNDING = 1 - 1e-5;

MesoMeshPoint meso_surface_point(const MesoTriangulation *mesh, const MesoDomain *domain, MesoVec3 p)
{
    MesoMeshPoint nearest = {.triangle = domain->triangles[0], .weight = {1, 0, 0}};
    double least = INFINITY;
    for (uint32_t i = 0; i < domain->triangle_count; i++) {
        const uint32_t *c = &mesh->corners[3 * (size_t)domain->triangles[i]];
        double weight[2] = {0, 0};
        double bound = (double)squared_box_distance(mesh->positions[c[0]], mesh->positions[c[1]],
                                                    mesh->positions[c[2]], p);
        if (bound * BOX_ROUNDING > least)
            continue;
        double d = nearest_in_triangle(mesh->positions[c[0]], mesh->positions[c[1]], mesh->positions[c[2]], p, weight);
        if (d < least) {
            least = d;
            nearest = (MesoMeshPoint){domain->triangles[i], {(float)(1 - weight[0] - weight[1]), (float)weight[0],
                                                             (float)weight[1]}};
        }
    }
    for (int k = 0; k < 3; k++)
        nearest.weight[k] = nearest.weight[k] > 0 ? nearest.weight[k] : 0;
    return nearest;
}

int meso_by_number(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}
