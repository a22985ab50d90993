/* Distributions of points on a surface, for tests and benchmarks. */
#ifndef MESO_POINTS_FIXTURE_H
#define MESO_POINTS_FIXTURE_H

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/mesh/cut/triangle_area.h"
#include "libcore/replicate/statistics/pair_correlation.h"

typedef struct MesoStrewer {
    const MesoTriangulation *mesh;
    MesoRandom random;
    double *sums;       /* [triangle_count + 1] of areas */
} MesoStrewer;

static inline double meso_fixture_share(MesoRandom *random)
{
    return (double)(meso_random_next(random) >> 11) * 0x1p-53;
}

static inline MesoStrewer meso_strewer(const MesoTriangulation *mesh, uint64_t seed)
{
    MesoStrewer s = {.mesh = mesh, .sums = calloc(mesh->triangle_count + 1, sizeof *s.sums)};
    CHECK(s.sums);
    meso_random_init(&s.random, seed, 0);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        s.sums[t + 1] = s.sums[t] + meso_triangle_area(mesh, t);
    return s;
}

static inline MesoMeshPoint meso_strew_one(MesoStrewer *s)
{
    double at = meso_fixture_share(&s->random) * s->sums[s->mesh->triangle_count];
    uint32_t low = 0, high = s->mesh->triangle_count;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        *(s->sums[middle] <= at ? &low : &high) = middle;
    }
    double u = meso_fixture_share(&s->random), v = meso_fixture_share(&s->random);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    return (MesoMeshPoint){low, {(float)(1 - u - v), (float)u, (float)v}};
}

static inline MesoMeshPoint *meso_strew_points(uint32_t count)
{
    MesoMeshPoint *points = malloc((count ? count : 1) * sizeof *points);
    CHECK(points);
    return points;
}

/* Without regard to each other. */
static inline MesoMeshPoint *meso_strew_freely(const MesoTriangulation *mesh, uint32_t count, uint64_t seed)
{
    MesoStrewer s = meso_strewer(mesh, seed);
    MesoMeshPoint *points = meso_strew_points(count);
    for (uint32_t i = 0; i < count; i++)
        points[i] = meso_strew_one(&s);
    free(s.sums);
    return points;
}

/*
 * Poisson discs: none nearer than `tightness` times the root of the area that each has; 0.8 leaves few gaps, 0.5 is
 * loose. Fewer than `*count` where no more are found.
 */
static inline MesoMeshPoint *meso_strew_discs(const MesoTriangulation *mesh, uint32_t *count, double tightness,
                                              uint64_t seed)
{
    enum { SLOTS = 1 << 20 };
    MesoStrewer s = meso_strewer(mesh, seed);
    MesoMeshPoint *points = meso_strew_points(*count);
    MesoVec3 *places = malloc((*count + 1) * sizeof *places);
    uint32_t *heads = malloc(SLOTS * sizeof *heads), *next = malloc((*count + 1) * sizeof *next), made = 0;
    CHECK(places && heads && next);
    memset(heads, 0xff, SLOTS * sizeof *heads);
    double r = tightness * sqrt(s.sums[mesh->triangle_count] / *count);
    for (uint64_t tries = 0; made < *count && tries < 2000 * (uint64_t)*count; tries++) {
        MesoMeshPoint point = meso_strew_one(&s);
        MesoVec3 p = meso_point_position(mesh, mesh->positions, &point);
        int64_t cell[3] = {(int64_t)floor(p.x / r), (int64_t)floor(p.y / r), (int64_t)floor(p.z / r)};
        bool free_there = true;
        uint32_t own = 0;
        for (int k = 0; k < 27 && free_there; k++) {
            uint64_t key = (uint64_t)(cell[0] + k % 3 - 1) * 73856093u ^ (uint64_t)(cell[1] + k / 3 % 3 - 1) * 19349663u
                           ^ (uint64_t)(cell[2] + k / 9 - 1) * 83492791u;
            uint32_t slot = (uint32_t)(key * 0x9e3779b97f4a7c15u >> 44);
            if (k == 13)
                own = slot;
            for (uint32_t i = heads[slot]; i != MESO_NO_INDEX && free_there; i = next[i])
                free_there = meso_vec3_length(meso_vec3_sub(places[i], p)) >= (float)r;
        }
        if (!free_there)
            continue;
        points[made] = point;
        places[made] = p;
        next[made] = heads[own];
        heads[own] = made++;
    }
    *count = made;
    free(s.sums);
    free(places);
    free(heads);
    free(next);
    return points;
}

/* In z = 0, the unit square in squares of two triangles, `side` a row: the place of a point. */
static inline MesoMeshPoint meso_square_point(uint32_t side, double x, double y)
{
    double u = fmin(fmax(x, 0), 1 - 1e-9) * side, v = fmin(fmax(y, 0), 1 - 1e-9) * side;
    uint32_t square = (uint32_t)v * side + (uint32_t)u;
    double a = u - floor(u), b = v - floor(v);
    bool low = a >= b;      /* corners (0,0) (1,0) (1,1), and (0,0) (1,1) (0,1) */
    return low ? (MesoMeshPoint){2 * square, {(float)(1 - a), (float)(a - b), (float)b}}
               : (MesoMeshPoint){2 * square + 1, {(float)(1 - b), (float)a, (float)(b - a)}};
}

static inline double meso_fixture_normal(MesoRandom *random)
{
    double r = sqrt(-2 * log(1 - meso_fixture_share(random)));
    return r * cos(2 * MESO_PI * meso_fixture_share(random));
}

/* A Thomas process in the unit square: groups of about `mean` around strewn middles, by a Gauss of `spread`. */
static inline MesoMeshPoint *meso_strew_groups(uint32_t side, uint32_t count, double mean, double spread, uint64_t seed)
{
    MesoRandom random;
    meso_random_init(&random, seed, 1);
    MesoMeshPoint *points = meso_strew_points(count);
    /* middles of a wider square, so that the border is as the inside: each point chooses one */
    double margin = 4 * spread, wide = 1 + 2 * margin;
    uint32_t middles = (uint32_t)fmax(1, count / mean * wide * wide + 0.5), made = 0;
    double *places = malloc(2 * sizeof *places * middles);
    CHECK(places);
    for (uint32_t i = 0; i < 2 * middles; i++)
        places[i] = wide * meso_fixture_share(&random) - margin;
    while (made < count) {
        uint32_t middle = meso_random_below(&random, middles);
        double x = places[2 * middle] + spread * meso_fixture_normal(&random);
        double y = places[2 * middle + 1] + spread * meso_fixture_normal(&random);
        if (x >= 0 && x < 1 && y >= 0 && y < 1)
            points[made++] = meso_square_point(side, x, y);
    }
    free(places);
    return points;
}

/* A grid of rows x rows in the unit square, each moved by up to `jitter` of its cell. */
static inline MesoMeshPoint *meso_strew_grid(uint32_t side, uint32_t rows, double jitter, uint64_t seed)
{
    MesoRandom random;
    meso_random_init(&random, seed, 2);
    MesoMeshPoint *points = meso_strew_points(rows * rows);
    for (uint32_t i = 0; i < rows * rows; i++) {
        double x = i % rows + 0.5 + jitter * (meso_fixture_share(&random) - 0.5);
        double y = i / rows + 0.5 + jitter * (meso_fixture_share(&random) - 0.5);
        points[i] = meso_square_point(side, x / rows, y / rows);
    }
    return points;
}

#endif
