/* The thinnest section: from each triangle straight inwards to what looks the other way. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/check/inspect_work.h"

enum { GRAIN = 1 << 11, SAMPLES = 1000 };

/* Rays start near the corners, so that a section that shrinks to a point is met near it. */
#define NEAR_CORNER 0.9
/* What ends a section looks away from the ray, give or take 60 degrees. */
#define OPPOSITE_COSINE 0.5

typedef struct Thinnest {
    double way;
    uint32_t triangle;
    uint64_t count;         /* of triangles over what is too thin */
} Thinnest;

typedef struct Sections {
    const MesoInspectWork *work;
    Thinnest *ranges;
    uint8_t *thin;          /* [triangle_count] */
    _Atomic uint64_t best;  /* bits of the least way so far: they sort as positive doubles do */
} Sections;

typedef struct Ray {
    const MesoInspectWork *work;
    uint32_t triangle;
    MesoVec3d origin, direction;
} Ray;

static double way_through(void *context, uint32_t item)
{
    const Ray *ray = context;
    const MesoInspectWork *work = ray->work;
    if (item == ray->triangle || work->things[item] != work->things[ray->triangle])
        return INFINITY;
    MesoInspectTriangle t = meso_inspect_triangle(work->mesh, item);
    double slope = meso_vec3d_dot(t.normal, ray->direction);
    if (!(slope > OPPOSITE_COSINE))
        return INFINITY;
    double way = meso_vec3d_dot(t.normal, meso_vec3d_sub(t.p[0], ray->origin)) / slope;
    MesoVec3d at = meso_vec3d_mad(ray->origin, way, ray->direction);
    for (uint32_t k = 0; k < 3; k++)
        if (meso_vec3d_det(t.normal, meso_vec3d_sub(t.p[(k + 1) % 3], t.p[k]), meso_vec3d_sub(at, t.p[k])) < 0)
            return INFINITY;
    return way >= 0 ? way : INFINITY;
}

/* From near corner k, or from the middle for k = 3; INFINITY where nothing is met before `limit`. */
static double section_below(const MesoInspectWork *work, uint32_t triangle, uint32_t k, double limit)
{
    MesoInspectTriangle t = meso_inspect_triangle(work->mesh, triangle);
    Ray ray = {.work = work, .triangle = triangle, .direction = meso_vec3d_scale(t.normal, -1)};
    if (meso_vec3d_dot(t.normal, t.normal) == 0)
        return INFINITY;
    for (uint32_t i = 0; i < 3; i++) {
        double weight = k == 3 ? 1.0 / 3 : i == k ? NEAR_CORNER : (1 - NEAR_CORNER) / 2;
        ray.origin = meso_vec3d_mad(ray.origin, weight, t.p[i]);
    }
    double way = limit;
    uint32_t met = meso_inspect_tree_ray(&work->tree, ray.origin, ray.direction, work->things[triangle], &way,
                                         way_through, &ray);
    return met == MESO_NO_INDEX ? INFINITY : way;
}

static double read_best(Sections *sections)
{
    uint64_t bits = atomic_load_explicit(&sections->best, memory_order_relaxed);
    double best;
    memcpy(&best, &bits, sizeof best);
    return best;
}

static void lower_best(Sections *sections, double way)
{
    uint64_t bits, seen = atomic_load_explicit(&sections->best, memory_order_relaxed);
    memcpy(&bits, &way, sizeof bits);
    while (bits < seen && !atomic_compare_exchange_weak(&sections->best, &seen, bits))
        ;
}

/* Only what is as thin as the thinnest so far is looked for, so that rays are short, or as what is too thin. */
static void measure_range(void *context, uint64_t begin, uint64_t end)
{
    Sections *sections = context;
    const MesoInspectWork *work = sections->work;
    Thinnest *range = &sections->ranges[begin / GRAIN];
    double asked = work->options->thinnest;
    *range = (Thinnest){INFINITY, MESO_NO_INDEX, 0};
    for (uint64_t i = begin; i < end; i++) {
        uint32_t t = work->tree.order[i];
        double least = INFINITY;
        for (uint32_t k = 0; k < 3; k++) {
            double limit = fmax(nextafter(read_best(sections), INFINITY), asked);
            least = fmin(least, section_below(work, t, k, limit));
        }
        if (least < asked) {
            sections->thin[t] = 1;
            range->count++;
        }
        if (least < range->way || (least == range->way && t < range->triangle)) {
            *range = (Thinnest){least, t, range->count};
            lower_best(sections, least);
        }
    }
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median over triangles at even distances along the tree. */
static double usual_thickness(const MesoInspectWork *work)
{
    double ways[SAMPLES];
    uint32_t count = 0, items = work->tree.item_count;
    for (uint32_t i = 0; i < SAMPLES && i < items; i++) {
        uint64_t at = items <= SAMPLES ? i : (uint64_t)i * items / SAMPLES;
        double way = section_below(work, work->tree.order[at], 3, INFINITY);
        if (isfinite(way))
            ways[count++] = way;
    }
    qsort(ways, count, sizeof *ways, compare_doubles);
    return count ? ways[count / 2] : 0;
}

MesoStatus meso_inspect_thickness(MesoInspectWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint64_t range_count = (work->tree.item_count + (uint64_t)GRAIN - 1) / GRAIN;
    Sections sections = {.work = work};
    sections.ranges = MESO_NEW(work->scratch, Thinnest, range_count, error);
    sections.thin = MESO_NEW(work->scratch, uint8_t, work->mesh->triangle_count, error);
    if (!sections.ranges || !sections.thin)
        return MESO_ERR_MEMORY;
    work->result->usual_thickness = usual_thickness(work);
    double limit = work->result->usual_thickness > 0 ? work->result->usual_thickness : INFINITY;
    uint64_t bits;
    memcpy(&bits, &limit, sizeof bits);
    sections.best = bits;
    meso_parallel_for(work->options->thread_count, work->tree.item_count, GRAIN, measure_range, &sections);

    Thinnest all = {INFINITY, MESO_NO_INDEX, 0};
    for (uint64_t r = 0; r < range_count; r++) {
        const Thinnest *range = &sections.ranges[r];
        all.count += range->count;
        if (range->way < all.way || (range->way == all.way && range->triangle < all.triangle)) {
            all.way = range->way;
            all.triangle = range->triangle;
        }
    }
    MesoFinding *finding = &work->result->findings[MESO_FAULT_THIN];
    *finding = (MesoFinding){all.count, isfinite(all.way) ? all.way : 0, all.triangle, MESO_NO_INDEX};
    work->result->thinnest = finding->worst;
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++)
        work->result->marks[t] |= sections.thin[t] ? 1u << MESO_FAULT_THIN : 0;
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}
