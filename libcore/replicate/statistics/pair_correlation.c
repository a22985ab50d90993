#include "libcore/replicate/statistics/pair_correlation.h"

#include "libcore/math/vec3d.h"
#include "libcore/replicate/statistics/point_grid.h"

enum { BINS = 24, SOURCES = 20000, EVEN_LEAST = 20000, EVEN_A_POINT = 4 };

/* ---- the surface ---- */

static double area_of(const MesoTriangulation *mesh, const MesoVec3 *positions, uint32_t triangle)
{
    const uint32_t *c = mesh->corners + 3 * (size_t)triangle;
    MesoVec3d a = meso_vec3d(positions[c[0]]);
    MesoVec3d u = meso_vec3d_sub(meso_vec3d(positions[c[1]]), a), v = meso_vec3d_sub(meso_vec3d(positions[c[2]]), a);
    return 0.5 * meso_vec3d_length(meso_vec3d_cross(u, v));
}

double meso_surface_area(const MesoTriangulation *mesh, const MesoVec3 *positions)
{
    double area = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        area += area_of(mesh, positions, t);
    return area;
}

/* Two coordinates of the sequence R2: multiples of 1/g and 1/g^2, g the plastic number. */
static MesoMeshPoint even_point(uint32_t triangle, uint32_t i)
{
    double u = fmod(0.5 + 0.75487766624669276 * (i + 1.0), 1), v = fmod(0.5 + 0.56984029099805327 * (i + 1.0), 1);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    return (MesoMeshPoint){triangle, {(float)(1 - u - v), (float)u, (float)v}};
}

void meso_even_points(MesoMeshPoint *out, uint32_t count, const MesoTriangulation *mesh, const MesoVec3 *positions)
{
    double area = meso_surface_area(mesh, positions), sum = 0;
    uint32_t made = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        sum += area_of(mesh, positions, t);
        double due = area > 0 ? sum / area * count - 0.5 : count;
        while (made < count && made < due)
            out[made] = even_point(t, made), made++;
    }
    while (made < count)
        out[made] = even_point(mesh->triangle_count - 1, made), made++;
}

/* ---- triangles around a source ---- */

typedef struct Ball {
    const MesoTriangulation *mesh;
    const MesoVec3 *positions;
    uint32_t *stamps;       /* [triangle_count] number of the last source that had it in its ball, from 1 */
    uint32_t *queue;        /* [triangle_count] */
} Ball;

static double length2_to_segment(MesoVec3d p, MesoVec3d a, MesoVec3d b)
{
    MesoVec3d ab = meso_vec3d_sub(b, a), ap = meso_vec3d_sub(p, a);
    double l = meso_vec3d_dot(ab, ab), s = l > 0 ? meso_vec3d_dot(ap, ab) / l : 0;
    MesoVec3d d = meso_vec3d_mad(ap, -fmin(1, fmax(0, s)), ab);
    return meso_vec3d_dot(d, d);
}

/* From each triangle over those of its sides that are near: the straight way from the source crosses no others. */
static void fill_ball(Ball *ball, MesoVec3 source, uint32_t triangle, double radius, uint32_t stamp)
{
    uint32_t begin = 0, end = 0;
    MesoVec3d p = meso_vec3d(source);
    ball->queue[end++] = triangle;
    ball->stamps[triangle] = stamp;
    while (begin < end) {
        uint32_t t = ball->queue[begin++];
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            uint32_t across = ball->mesh->twins[h];
            if (across == MESO_NO_INDEX || ball->stamps[across / 3] == stamp)
                continue;
            MesoVec3d a = meso_vec3d(ball->positions[ball->mesh->corners[h]]);
            MesoVec3d b = meso_vec3d(ball->positions[ball->mesh->corners[meso_next_corner(h)]]);
            if (length2_to_segment(p, a, b) > radius * radius)
                continue;
            ball->stamps[across / 3] = stamp;
            ball->queue[end++] = across / 3;
        }
    }
}

/* ---- counts ---- */

typedef struct Places {
    const MesoMeshPoint *points;
    MesoVec3 *positions;
    uint32_t count;
    MesoPointGrid grid;
} Places;

static MesoStatus place_all(Places *places, MesoArena *arena, const MesoPointSet *set, const MesoMeshPoint *points,
                            uint32_t count, double radius, MesoError *error)
{
    places->points = points;
    places->count = count;
    places->positions = MESO_NEW(arena, MesoVec3, count, error);
    if (!places->positions)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        places->positions[i] = meso_point_position(set->mesh, set->positions, &points[i]);
    return meso_point_grid_build(&places->grid, arena, places->positions, count, (float)radius, error);
}

typedef struct Counting {
    Ball ball;
    double radius;
    uint32_t bin_count, stamp;
    const float *marks;
    double *pairs, *products;
} Counting;

static void count_from(Counting *c, const Places *places, MesoVec3 from, uint32_t source, double *bins)
{
    const MesoPointGrid *grid = &places->grid;
    for (uint32_t cell = 0; cell < MESO_POINT_CELLS; cell++) {
        MesoPointRange range = meso_point_grid_range(grid, from, cell);
        for (uint32_t i = range.begin; i < range.end; i++) {
            uint32_t other = grid->order[i];
            if (grid->keys[i] != range.key || other == source
                || c->ball.stamps[places->points[other].triangle] != c->stamp)
                continue;
            double d = meso_vec3_length(meso_vec3_sub(grid->places[i], from));
            if (!(d < c->radius))
                continue;
            uint32_t bin = (uint32_t)(d / c->radius * c->bin_count);
            bin = bin < c->bin_count ? bin : c->bin_count - 1;
            bins[bin]++;
            if (source != MESO_NO_INDEX && c->products)
                c->products[bin] += (double)c->marks[source] * c->marks[other];
        }
    }
}

static double mean_of(const float *marks, uint32_t count)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += marks[i];
    return count ? sum / count : 0;
}

static void conclude(MesoPairCorrelation *out, const Counting *c, const double *even, const MesoPointSet *set,
                     uint32_t even_count)
{
    double mean = set->marks ? mean_of(set->marks, set->count) : 0;
    for (uint32_t b = 0; b < out->bin_count; b++) {
        double expected = set->count > 1 ? even[b] * (set->count - 1.0) / even_count : 0;
        out->g[b] = expected > 0 ? c->pairs[b] / expected : 1;
        if (set->marks)
            out->marks[b] = c->pairs[b] > 0 && mean != 0 ? c->products[b] / c->pairs[b] / (mean * mean) : 1;
    }
}

static MesoStatus correlate(MesoPairCorrelation *out, MesoArena *arena, const MesoPointSet *set,
                            const MesoPairOptions *options, MesoError *error)
{
    uint32_t even_count = set->count < EVEN_LEAST / EVEN_A_POINT ? EVEN_LEAST : EVEN_A_POINT * set->count;
    uint32_t limit = options->source_limit ? options->source_limit : SOURCES;
    uint32_t sources = set->count < limit ? set->count : limit;
    MesoMeshPoint *points = MESO_NEW(arena, MesoMeshPoint, even_count, error);
    double *even = MESO_NEW(arena, double, out->bin_count, error);
    Counting c = {.ball = {set->mesh, set->positions, MESO_NEW(arena, uint32_t, set->mesh->triangle_count, error),
                           MESO_NEW(arena, uint32_t, set->mesh->triangle_count, error)},
                  .radius = options->radius, .bin_count = out->bin_count, .marks = set->marks,
                  .pairs = MESO_NEW(arena, double, out->bin_count, error)};
    if (set->marks)
        c.products = MESO_NEW(arena, double, out->bin_count, error);
    if (!points || !even || !c.ball.stamps || !c.ball.queue || !c.pairs || (set->marks && !c.products))
        return MESO_ERR_MEMORY;
    meso_even_points(points, even_count, set->mesh, set->positions);
    Places details, evens;
    MesoStatus status = place_all(&details, arena, set, set->points, set->count, c.radius, error);
    if (status == MESO_OK)
        status = place_all(&evens, arena, set, points, even_count, c.radius, error);
    for (uint32_t s = 0; s < sources && status == MESO_OK; s++) {
        uint32_t source = (uint32_t)((uint64_t)s * set->count / sources);
        c.stamp = s + 1;
        fill_ball(&c.ball, details.positions[source], set->points[source].triangle, c.radius, c.stamp);
        count_from(&c, &details, details.positions[source], source, c.pairs);
        count_from(&c, &evens, details.positions[source], MESO_NO_INDEX, even);
    }
    if (status == MESO_OK)
        conclude(out, &c, even, set, even_count);
    return status;
}

MesoStatus meso_pair_correlation(MesoPairCorrelation *out, MesoArena *arena, const MesoPointSet *set,
                                 const MesoPairOptions *options, MesoError *error)
{
    *out = (MesoPairCorrelation){.bin_count = options->bin_count ? options->bin_count : BINS,
                                 .radius = options->radius, .area = meso_surface_area(set->mesh, set->positions)};
    out->density = out->area > 0 ? set->count / out->area : 0;
    out->g = MESO_NEW(arena, double, out->bin_count, error);
    if (set->marks)
        out->marks = MESO_NEW(arena, double, out->bin_count, error);
    if (!out->g || (set->marks && !out->marks))
        return MESO_ERR_MEMORY;
    MesoArenaMark mark = meso_arena_mark(arena);
    MesoStatus status = correlate(out, arena, set, options, error);
    meso_arena_rewind(arena, mark);
    return status;
}

double meso_pair_difference(const MesoPairCorrelation *a, const MesoPairCorrelation *b)
{
    double sum = 0;
    for (uint32_t i = 0; i < a->bin_count; i++)
        sum += fabs(a->g[i] - b->g[i]);
    return a->bin_count ? sum / a->bin_count : 0;
}
