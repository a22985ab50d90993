#include "libcore/chart/chart.h"

#include <string.h>

#include "libcore/chart/chart_flatten.h"
#include "libcore/chart/chart_growth.h"
#include "libcore/chart/simple_border.h"

/* ---- one disk of the growth ---- */

/* The first triangles of a growth, and their flattening. */
typedef struct Flattening {
    MesoDisk disk;
    MesoPoint seed[3];      /* the seed in its own plane, its first side along x */
    MesoVec2 *places;       /* [vertex_count] */
    double ratio;
    bool fits;              /* not flipped, within the bound, no overlap */
} Flattening;

static MesoStatus collect_disk(MesoDisk *disk, MesoChartMaker *maker, const MesoChartGrowth *growth, uint32_t count,
                               double size, MesoPoint seed[3], MesoError *error)
{
    const MesoTriangulation *mesh = maker->mesh;
    MesoArena *scratch = meso_chart_scratch(maker);
    MesoFlatTriangle *flat = MESO_NEW_BARE(scratch, MesoFlatTriangle, count, error);
    uint32_t *border = MESO_NEW_BARE(scratch, uint32_t, 6 * (size_t)count, error);
    if (!flat || !border)
        return MESO_ERR_MEMORY;
    *disk = (MesoDisk){growth->vertex_ends[count - 1], count, growth->corners, flat, 0, border};
    for (uint32_t t = count; t-- > 0;) {
        MesoVec3 positions[3];
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t h = 3 * growth->triangles[t] + k, across = meso_chart_across(mesh, h);
            positions[k] = mesh->positions[mesh->corners[h]];
            /* numbers of triangles beyond the first ones are larger, and so is none */
            if (across != MESO_NO_INDEX && maker->triangle_numbers[across / 3] < count)
                continue;
            border[2 * disk->border_count] = growth->corners[3 * t + k];
            border[2 * disk->border_count++ + 1] = growth->corners[3 * t + (k + 1) % 3];
        }
        flat[t] = meso_flat_triangle(positions, size, seed);
    }
    return MESO_OK;
}

static void scale_places(MesoPoint *places, uint32_t count, double by)
{
    for (uint32_t v = 0; v < count; v++)
        places[v] = (MesoPoint){by * places[v].x, by * places[v].y};
}

/* Takes over a candidate that is not flipped and not beyond the bound. */
static void keep_if_fit(Flattening *flattening, MesoPoint *kept, const MesoPoint *places, double bound)
{
    MesoAreaScales scales = meso_area_scales(&flattening->disk, places);
    if (!(scales.least > 0 && scales.largest <= bound * scales.least))
        return;
    memcpy(kept, places, flattening->disk.vertex_count * sizeof *kept);
    flattening->ratio = scales.largest / scales.least;
    flattening->fits = true;
}

/*
 * A place for a triangle's corner `k`: beyond the side of the two others, as in the triangle's own plane, but no
 * farther from the middle than it is along the surface.
 */
static MesoPoint unfold(const MesoFlatTriangle *flat, const uint32_t *corner, uint32_t k, const MesoPoint *places,
                        double distance)
{
    MesoPoint a = places[corner[(k + 1) % 3]], b = places[corner[(k + 2) % 3]];
    MesoPoint g = flat->gradients[k], h = flat->gradients[(k + 2) % 3];
    double square = g.x * g.x + g.y * g.y, x = b.x - a.x, y = b.y - a.y;
    double along = -(g.x * h.x + g.y * h.y) / square, up = 1 / (2 * flat->area * square);   /* in sides */
    MesoPoint p = {a.x + along * x - up * y, a.y + along * y + up * x};
    double length = sqrt(p.x * p.x + p.y * p.y), by = length > distance ? distance / length : 1;
    return (MesoPoint){by * p.x, by * p.y};
}

/* The seed as it is, then each triangle beside those before it. */
static void unfold_all(Flattening *flattening, MesoPoint *places, const MesoChartGrowth *growth)
{
    const MesoDisk *disk = &flattening->disk;
    const MesoPoint *seed = flattening->seed;
    MesoPoint centre = {(seed[0].x + seed[1].x + seed[2].x) / 3, (seed[0].y + seed[1].y + seed[2].y) / 3};
    uint32_t known = 3;
    for (uint32_t k = 0; k < 3; k++)
        places[disk->corners[k]] = (MesoPoint){seed[k].x - centre.x, seed[k].y - centre.y};
    for (uint32_t t = 1; t < disk->triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t *corner = &disk->corners[3 * (size_t)t];
            if (corner[k] != known)
                continue;
            places[known] = unfold(&disk->triangles[t], corner, k, places, growth->distances[known]);
            known++;
        }
}

static void relax(Flattening *flattening, MesoPoint *kept, MesoPoint *places, MesoRigidSteps *steps,
                  uint32_t relaxations, double bound)
{
    for (uint32_t i = 0; i < relaxations; i++) {
        meso_rigid_step(steps, places);
        keep_if_fit(flattening, kept, places, bound);
    }
}

static MesoStatus begin_conformal(Flattening *flattening, MesoPoint *kept, MesoPoint *places, MesoArena *scratch,
                                  double bound, MesoError *error)
{
    const MesoDisk *disk = &flattening->disk;
    MesoStatus status = meso_flatten_conformal(places, scratch, disk, error);
    if (status)
        return status;
    /* triangles that are flipped have no scale: the sum of all, which have signs, is that of the border */
    double flat = 0, whole = 0;
    for (uint32_t t = 0; t < disk->triangle_count; t++) {
        MesoJacobian map = meso_jacobian(disk, places, t);
        flat += disk->triangles[t].area * meso_jacobian_area(&map);
        whole += disk->triangles[t].area;
    }
    if (flat > 0) {
        scale_places(places, disk->vertex_count, sqrt(whole / flat));
        keep_if_fit(flattening, kept, places, bound);
    }
    return MESO_OK;
}

/* Area scales that differ by more show that what is unfolded was no good beginning. */
#define UNFOLDED_RATIO 1.5

/* Rigid steps from triangles unfolded, if that will do, or else from a conformal map: the last of them that fits. */
static MesoStatus find_places(Flattening *flattening, MesoPoint *kept, MesoChartMaker *maker,
                              const MesoChartGrowth *growth, const MesoChartOptions *options, double bound,
                              MesoError *error)
{
    MesoArena *scratch = meso_chart_scratch(maker);
    MesoPoint *places = MESO_NEW(scratch, MesoPoint, flattening->disk.vertex_count, error);
    if (!places)
        return MESO_ERR_MEMORY;
    MesoRigidSteps *steps = NULL;
    if (options->relaxations) {
        steps = meso_rigid_steps_new(scratch, &flattening->disk, error);
        if (!steps)
            return error->status;
    }
    if (maker->unfolds && steps) {
        unfold_all(flattening, places, growth);
        relax(flattening, kept, places, steps, options->relaxations, fmin(bound, UNFOLDED_RATIO));
        if (flattening->fits)
            return MESO_OK;
    }
    MesoStatus status = begin_conformal(flattening, kept, places, scratch, bound, error);
    if (!status && steps)
        relax(flattening, kept, places, steps, options->relaxations, bound);
    return status;
}

/* The seed's centroid to 0,0, its first side along x, the area as on the surface. */
static void set_places(Flattening *flattening, MesoPoint *places)
{
    const MesoDisk *disk = &flattening->disk;
    MesoAreaScales scales = meso_area_scales(disk, places);
    MesoPoint a = places[disk->corners[0]], b = places[disk->corners[1]], c = places[disk->corners[2]];
    MesoPoint centre = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3}, side = {b.x - a.x, b.y - a.y};
    double by = 1 / sqrt(scales.total * (side.x * side.x + side.y * side.y));
    for (uint32_t v = 0; v < disk->vertex_count; v++) {
        double x = places[v].x - centre.x, y = places[v].y - centre.y;
        flattening->places[v] = (MesoVec2){(float)(by * (x * side.x + y * side.y)),
                                           (float)(by * (y * side.x - x * side.y))};
    }
}

static bool has_flips(const Flattening *flattening)
{
    const uint32_t *c = flattening->disk.corners;
    for (uint32_t t = 0; t < flattening->disk.triangle_count; t++, c += 3)
        if (!(meso_turn(flattening->places[c[0]], flattening->places[c[1]], flattening->places[c[2]]) > 0))
            return true;
    return false;
}

/* The first `count` triangles. Does not fail where they cannot be laid flat: `fits` says so. */
static MesoStatus flatten_first(Flattening *flattening, MesoChartMaker *maker, const MesoChartGrowth *growth,
                                uint32_t count, const MesoChartOptions *options, MesoError *error)
{
    MesoArena *scratch = meso_chart_scratch(maker);
    double bound = options->largest_ratio > 0 ? options->largest_ratio : 4;
    *flattening = (Flattening){.ratio = 1};
    MesoStatus status = collect_disk(&flattening->disk, maker, growth, count, 1e-6 * options->radius,
                                     flattening->seed, error);
    if (status)
        return status;
    uint32_t vertex_count = flattening->disk.vertex_count;
    MesoPoint *kept = MESO_NEW(scratch, MesoPoint, vertex_count, error);
    flattening->places = MESO_NEW(scratch, MesoVec2, vertex_count, error);
    if (!kept || !flattening->places)
        return MESO_ERR_MEMORY;
    if (count == 1) {
        memcpy(kept, flattening->seed, sizeof flattening->seed);
        flattening->fits = true;
    } else {
        status = find_places(flattening, kept, maker, growth, options, bound, error);
    }
    /* equations without a solution: with what has been found before */
    status = status == MESO_ERR_INPUT ? MESO_OK : status;
    if (status || !flattening->fits)
        return status;
    set_places(flattening, kept);
    flattening->fits = !has_flips(flattening);
    if (flattening->fits)
        status = meso_border_is_simple(&flattening->fits, scratch, flattening->places, flattening->disk.border,
                                       flattening->disk.border_count, error);
    return status;
}

/* ---- the chart ---- */

static MesoStatus copy_chart(MesoChart *chart, MesoArena *arena, const MesoChartGrowth *growth,
                             const Flattening *flattening, double radius, MesoError *error)
{
    uint32_t n = flattening->disk.vertex_count, count = flattening->disk.triangle_count;
    *chart = (MesoChart){.vertex_count = n, .triangle_count = count, .area_ratio = (float)flattening->ratio,
                         .radius = (float)radius};
    chart->vertices = MESO_NEW(arena, uint32_t, n, error);
    chart->triangles = MESO_NEW(arena, uint32_t, count, error);
    chart->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)count, error);
    chart->places = MESO_NEW(arena, MesoVec2, n, error);
    if (!chart->vertices || !chart->triangles || !chart->corners || !chart->places)
        return MESO_ERR_MEMORY;
    memcpy(chart->vertices, growth->vertices, n * sizeof *chart->vertices);
    memcpy(chart->triangles, growth->triangles, count * sizeof *chart->triangles);
    memcpy(chart->corners, growth->corners, 3 * (size_t)count * sizeof *chart->corners);
    memcpy(chart->places, flattening->places, n * sizeof *chart->places);
    return MESO_OK;
}

/* How many of the first triangles belong to a radius; at least the seed. */
static uint32_t count_within(const MesoChartGrowth *growth, double radius, uint32_t count)
{
    while (count > 1 && growth->reaches[count - 1] > radius)
        count--;
    return count;
}

static MesoStatus flatten_most(MesoChart *chart, MesoArena *arena, MesoChartMaker *maker,
                               const MesoChartGrowth *growth, const MesoChartOptions *options, MesoError *error)
{
    const double shrinking = 0.8;
    MesoArena *scratch = meso_chart_scratch(maker);
    double radius = options->radius;
    uint32_t count = growth->triangle_count;
    for (;;) {
        Flattening flattening;
        MesoArenaMark mark = meso_arena_mark(scratch);
        MesoStatus status = flatten_first(&flattening, maker, growth, count, options, error);
        if (!status && (flattening.fits || count == 1))
            status = copy_chart(chart, arena, growth, &flattening, radius, error);
        meso_arena_rewind(scratch, mark);
        if (status || flattening.fits || count == 1)
            return status;
        if (!(growth->reaches[count - 1] > 0) || !isfinite(radius)) {
            count /= 2;         /* no radius tells triangles apart that lie in one place, or beyond all measures */
            continue;
        }
        for (uint32_t before = count; count == before; count = count_within(growth, radius, count))
            radius *= shrinking;
    }
}

MesoStatus meso_chart_grow(MesoChart *chart, MesoArena *arena, MesoChartMaker *maker, uint32_t seed,
                           const MesoChartOptions *options, MesoError *error)
{
    MesoError unused;
    MesoChartGrowth growth;
    MesoArena *scratch = meso_chart_scratch(maker);
    MesoArenaMark mark = meso_arena_mark(scratch);
    error = error ? error : &unused;
    MesoStatus status = meso_chart_growth_run(&growth, maker, seed, options->radius, error);
    if (!status)
        status = flatten_most(chart, arena, maker, &growth, options, error);
    meso_chart_growth_forget(&growth, maker);
    meso_arena_rewind(scratch, mark);
    return status;
}

MesoVec2 meso_chart_direction(const MesoChart *chart, const MesoTriangulation *mesh, uint32_t triangle,
                              MesoVec3 direction)
{
    const uint32_t *corners = &chart->corners[3 * (size_t)triangle];
    MesoVec3 positions[3];
    for (uint32_t k = 0; k < 3; k++)
        positions[k] = mesh->positions[chart->vertices[corners[k]]];
    MesoVec3 p = meso_vec3_sub(positions[1], positions[0]), q = meso_vec3_sub(positions[2], positions[0]);
    double pp = meso_vec3_dot(p, p), pq = meso_vec3_dot(p, q), qq = meso_vec3_dot(q, q), area = pp * qq - pq * pq;
    double dp = meso_vec3_dot(direction, p), dq = meso_vec3_dot(direction, q);
    if (!(area > 0))
        return (MesoVec2){0, 0};
    float u = (float)((qq * dp - pq * dq) / area), v = (float)((pp * dq - pq * dp) / area);
    MesoVec2 a = chart->places[corners[0]], b = meso_vec2_sub(chart->places[corners[1]], a);
    MesoVec2 c = meso_vec2_sub(chart->places[corners[2]], a);
    return (MesoVec2){u * b.x + v * c.x, u * b.y + v * c.y};
}
