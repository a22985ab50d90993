/* Exact distances of tiny random surfaces against all sequences of unfolded triangles. */
#include "libcore/base/random.h"
#include "libcore/geodesic/exact/exact_fixture.h"

/* ---- brute force ---- */

typedef struct Point {
    double x, y;
} Point;

typedef struct Brute {
    const MesoTriangulation *mesh;
    const MesoDomain *domain;
    double *row;                /* [vertex_count] straight distances from the source at the origin */
} Brute;

static double turn(Point a, Point b)
{
    return a.x * b.y - a.y * b.x;
}

/* Where the third corner comes to lie beyond side h, from a to b in the plane, on the other side than `behind`. */
static Point unfolded(const MesoTriangulation *mesh, uint32_t h, Point a, Point b, Point behind)
{
    uint32_t va = mesh->corners[h], vb = mesh->corners[meso_next_corner(h)];
    uint32_t vc = mesh->corners[meso_previous_corner(h)];
    MesoVec3 p = mesh->positions[va], q = mesh->positions[vb], r = mesh->positions[vc];
    double e3[3] = {(double)q.x - p.x, (double)q.y - p.y, (double)q.z - p.z};
    double w[3] = {(double)r.x - p.x, (double)r.y - p.y, (double)r.z - p.z};
    double n[3] = {e3[1] * w[2] - e3[2] * w[1], e3[2] * w[0] - e3[0] * w[2], e3[0] * w[1] - e3[1] * w[0]};
    double ab = meso_fixture_straight(mesh, va, vb);
    double along = (e3[0] * w[0] + e3[1] * w[1] + e3[2] * w[2]) / ab;
    double height = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / ab;
    Point e = {(b.x - a.x) / ab, (b.y - a.y) / ab};
    if (turn(e, (Point){behind.x - a.x, behind.y - a.y}) > 0)
        height = -height;
    return (Point){a.x + along * e.x - height * e.y, a.y + along * e.y + height * e.x};
}

/*
 * Into the triangle of side h, which lies from a to b, within the rays from the origin through `right` and `left`, half
 * a turn apart where `behind` says that the side goes through the origin. A shortest path has no triangle twice.
 */
static void unfold(const Brute *brute, uint32_t h, Point a, Point b, Point behind, Point right, Point left,
                   uint64_t met)
{
    const MesoTriangulation *mesh = brute->mesh;
    if (h == MESO_NO_INDEX || met >> h / 3 & 1 || (brute->domain && !meso_domain_has(brute->domain, mesh, h / 3)) ||
        !(turn(right, left) > 0 || behind.y < 0) ||
        meso_fixture_straight(mesh, mesh->corners[h], mesh->corners[meso_next_corner(h)]) == 0)
        return;
    const Point origin = {0, 0};
    met |= UINT64_C(1) << h / 3;
    Point c = unfolded(mesh, h, a, b, behind);
    double *best = &brute->row[mesh->corners[meso_previous_corner(h)]];
    if (turn(right, c) >= -1e-12 && turn(c, left) >= -1e-12)
        *best = fmin(*best, hypot(c.x, c.y));
    /* side next(h) runs from b to c, previous(h) from c to a */
    const uint32_t sides[2] = {meso_next_corner(h), meso_previous_corner(h)};
    const Point ends[2][2] = {{b, c}, {c, a}};
    for (uint32_t k = 0; k < 2; k++) {
        uint32_t twin = mesh->twins[sides[k]];
        Point p = ends[k][0], q = ends[k][1];
        Point low = turn(p, q) > 0 ? p : q, high = turn(p, q) > 0 ? q : p;
        Point r = turn(right, low) > 0 ? low : right, l = turn(high, left) > 0 ? high : left;
        if (twin != MESO_NO_INDEX && mesh->corners[twin] == mesh->corners[sides[k]])
            unfold(brute, twin, p, q, origin, r, l, met);
        else
            unfold(brute, twin, q, p, origin, r, l, met);
    }
}

/* The source at the origin of its triangle, the opposite side before it. */
static void unfold_from(const Brute *brute, uint32_t corner)
{
    const MesoTriangulation *mesh = brute->mesh;
    uint32_t next = meso_next_corner(corner), previous = meso_previous_corner(corner), twin = mesh->twins[next];
    uint32_t v = mesh->corners[corner], a = mesh->corners[next], b = mesh->corners[previous];
    double la = meso_fixture_straight(mesh, v, a), lb = meso_fixture_straight(mesh, v, b);
    brute->row[a] = fmin(brute->row[a], la);
    brute->row[b] = fmin(brute->row[b], lb);
    if (la == 0 || lb == 0)
        return;
    Point pa = {la, 0}, pb = unfolded(mesh, corner, (Point){0, 0}, pa, (Point){0, -1});
    Point behind = {0, pb.y < 1e-12 && pb.x < 0 ? -1 : 0};
    if (twin != MESO_NO_INDEX && mesh->corners[twin] == a)
        unfold(brute, twin, pa, pb, behind, pa, pb, UINT64_C(1) << corner / 3);
    else
        unfold(brute, twin, pb, pa, behind, pa, pb, UINT64_C(1) << corner / 3);
}

/* All pairs: straight parts, joined at vertices (Floyd and Warshall). */
static double *brute_distances(const MesoTriangulation *mesh, const MesoDomain *domain)
{
    uint32_t n = mesh->vertex_count;
    double *all = malloc((size_t)n * n * sizeof *all);
    CHECK(all && mesh->triangle_count <= 64);
    for (uint32_t i = 0; i < n * n; i++)
        all[i] = i / n == i % n ? 0 : INFINITY;
    for (uint32_t c = 0; c < 3 * mesh->triangle_count; c++)
        if (!domain || meso_domain_has(domain, mesh, c / 3))
            unfold_from(&(Brute){mesh, domain, all + (size_t)mesh->corners[c] * n}, c);
    for (uint32_t k = 0; k < n; k++)
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t j = 0; j < n; j++)
                all[i * n + j] = fmin(all[i * n + j], all[i * n + k] + all[k * n + j]);
    return all;
}

static void compare(const MesoTriangulation *mesh, const MesoDomain *domain)
{
    uint32_t n = mesh->vertex_count;
    double *all = brute_distances(mesh, domain);
    for (uint32_t s = 0; s < n; s++) {
        MesoExactGeodesicSeed seed = {s, 0, false};
        double *distance = meso_fixture_exact_query(mesh, &(MesoExactGeodesicQuery){.domain = domain, .seeds = &seed,
                                                                            .seed_count = 1,
                                                                            .target = MESO_NO_INDEX});
        for (uint32_t v = 0; v < n; v++)
            if (distance[v] != -1 && distance[s] != -1)
                CHECK(distance[v] == all[s * n + v] || meso_is_near(distance[v], all[s * n + v], 1e-11));
        free(distance);
    }
    free(all);
}

/* ---- surfaces ---- */

static float draw(MesoRandom *random)
{
    return (float)(meso_random_below(random, 1 << 20)) / (1 << 20);
}

/* Moves all vertices; on a small lattice many come to lie on each other. */
static void disturb(MesoTriangulation *mesh, MesoRandom *random, float amount, float lattice)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (float *x = &mesh->positions[v].x; x <= &mesh->positions[v].z; x++) {
            *x += amount * (draw(random) - 0.5f);
            if (lattice > 0)
                *x = roundf(*x / lattice) * lattice;
        }
}

/* Labels 0 and 1 at random, and the walls between them. */
static void label(MesoTriangulation *mesh, MesoRandom *random)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        mesh->labels[t] = meso_random_below(random, 4) == 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->twins[h] != MESO_NO_INDEX && mesh->labels[h / 3] != mesh->labels[mesh->twins[h] / 3])
            mesh->walls[h / 3] |= (uint8_t)(1u << h % 3);
    CHECK(meso_triangulation_check(mesh, NULL) == MESO_OK);
}

/* A band with one half turn, whose last triangles meet wound against each other. */
static MesoTriangulation make_moebius(void)
{
    enum { COUNT = 9 };
    MesoVec3 positions[COUNT];
    uint32_t corners[3 * COUNT];
    for (uint32_t v = 0; v < COUNT; v++) {
        float a = 6.2831853f * (float)v / COUNT;
        positions[v] = (MesoVec3){cosf(2 * a), sinf(2 * a), 0.3f * cosf(a)};
        corners[3 * v] = v;
        corners[3 * v + 1] = (v + 1) % COUNT;
        corners[3 * v + 2] = (v + 2) % COUNT;
    }
    return meso_fixture_triangulation(positions, COUNT, corners, COUNT);
}

static MesoTriangulation make(uint32_t kind)
{
    switch (kind) {
    case 0: return meso_fixture_sheet(3, 3, 0.5f);
    case 1: return meso_fixture_ball(2);
    case 2: return meso_fixture_torus(4, 3, 0.4f);
    case 3: return make_moebius();
    default: return meso_fixture_tube(4, 2, 1);
    }
}

int main(void)
{
    const uint8_t member[2] = {1, 0};
    const MesoDomain domain = {.member = member};
    MesoRandom random;
    meso_random_init(&random, 5, 0);
    for (uint32_t round = 0; round < 100; round++) {
        MesoTriangulation mesh = make(round % 5);
        disturb(&mesh, &random, round % 3 == 0 ? 0.2f : 1, round % 4 == 3 ? 0.5f : 0);
        compare(&mesh, NULL);
        label(&mesh, &random);
        compare(&mesh, &domain);
        meso_triangulation_release(&mesh);
    }
    return 0;
}
