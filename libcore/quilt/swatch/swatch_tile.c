#include "libcore/quilt/swatch/swatch_tile.h"

#include <math.h>
#include <stdlib.h>

#include "libcore/math/box.h"
#include "libcore/quilt/swatch/swatch_period.h"

typedef struct Span {
    double low, high;
} Span;

static MesoStatus find_periods(MesoSwatch *swatch, MesoSwatchAxis axes[2], const MesoSwatchOptions *options,
                               MesoArena *scratch, MesoError *error)
{
    double given[2] = {(double)options->period.x, (double)options->period.y};
    for (int k = 0; k < 2; k++) {
        bool wanted = options->periodic < 0 || (options->periodic >> k & 1);
        axes[k].period = given[k];
        MesoStatus status = wanted ? meso_swatch_find_period(swatch, &axes[k], scratch, error) : MESO_OK;
        if (status)
            return status;
        if (options->periodic > 0 && wanted && !axes[k].periodic)
            return meso_fail(error, MESO_ERR_INPUT, "the swatch is not periodic along %s", k == 0 ? "x" : "y");
    }
    return MESO_OK;
}

/* ---- the tile ---- */

static Span span_of_centres(const MesoSwatch *swatch, int along)
{
    Span span = {INFINITY, -INFINITY};
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        double at = meso_along(swatch->centres[e], along);
        span.low = fmin(span.low, at);
        span.high = fmax(span.high, at);
    }
    return span;
}

static int compare_radii(const void *a, const void *b)
{
    float p = *(const float *)a, q = *(const float *)b;
    return (p > q) - (p < q);
}

/*
 * How many elements stand side by side: those that are not small parts on others, like stems, whose reach is less than
 * half of the middle one's.
 */
static MesoStatus count_bodies(uint32_t *count, const MesoSwatch *swatch, MesoArena *scratch, MesoError *error)
{
    float *radii = MESO_NEW(scratch, float, swatch->element_count, error);
    if (!radii)
        return MESO_ERR_MEMORY;
    for (uint32_t e = 0; e < swatch->element_count; e++)
        radii[e] = swatch->radii[e];
    qsort(radii, swatch->element_count, sizeof *radii, compare_radii);
    float least = radii[swatch->element_count / 2] / 2;
    *count = 0;
    for (uint32_t e = 0; e < swatch->element_count; e++)
        *count += swatch->radii[e] >= least;
    return MESO_OK;
}

/*
 * Mean distance between `count` elements whose centres span `x` and `y`, from (x + s) (y + s) = count s^2; where `wide`
 * is the tile's other side, or 0, from (x + s) wide = count s^2.
 */
static double spacing(double count, double x, double y, double wide)
{
    if (wide > 0)
        return (wide + sqrt(wide * wide + 4 * count * wide * x)) / (2 * count);
    return count > 1 ? (x + y + sqrt((x + y) * (x + y) + 4 * (count - 1) * x * y)) / (2 * (count - 1)) : 0;
}

/* Where strands or a period say it. */
static bool find_known(Span *tile, const MesoSwatch *swatch, const MesoSwatchAxis *axis, Span box)
{
    bool low = axis->low_count > 0, high = axis->high_count > 0;
    if (!low && !high && !axis->periodic)
        return false;
    tile->low = low ? axis->low_end : box.low;
    tile->high = high ? axis->high_end : box.high;
    if (!axis->periodic)
        return tile->high > tile->low;
    if (!low) {
        Span centres = span_of_centres(swatch, axis->along);
        tile->low = (centres.low + centres.high - axis->period) / 2;
    }
    tile->high = tile->low + axis->period;
    return true;
}

/* Closed elements, or strands side by side along `k`: half of their mean spacing around their centres. */
static MesoStatus estimate(Span *tile, const MesoSwatch *swatch, int k, Span box, const MesoSwatchAxis *other, double wide,
                           MesoArena *scratch, MesoError *error)
{
    Span along = span_of_centres(swatch, k), across = span_of_centres(swatch, 1 - k);
    uint32_t bodies = 0;
    MesoStatus status = count_bodies(&bodies, swatch, scratch, error);
    if (status)
        return status;
    double x = along.high - along.low, y = across.high - across.low;
    bool side_by_side = other->low_count > 0 && other->low_count == other->high_count;
    double gap = !side_by_side          ? spacing(bodies, x, y, wide)
                 : other->low_count > 1 ? x / (other->low_count - 1)
                                        : 0;
    *tile = (Span){along.low - gap / 2, along.high + gap / 2};
    double width = tile->high - tile->low, most = box.high - box.low;
    if (!(width > most / 4 && width < 2 * most))    /* nothing that stands in rows */
        *tile = box;
    return MESO_OK;
}

static MesoStatus find_tile(Span tile[2], const MesoSwatch *swatch, const MesoSwatchAxis axes[2], MesoBox box,
                            MesoArena *scratch, MesoError *error)
{
    bool known[2];
    Span boxes[2] = {{(double)box.low.x, (double)box.high.x}, {(double)box.low.y, (double)box.high.y}};
    for (int k = 0; k < 2; k++)
        known[k] = find_known(&tile[k], swatch, &axes[k], boxes[k]);
    for (int k = 0; k < 2; k++) {
        if (known[k])
            continue;
        double wide = known[1 - k] ? tile[1 - k].high - tile[1 - k].low : 0;
        MesoStatus status = estimate(&tile[k], swatch, k, boxes[k], &axes[1 - k], wide, scratch, error);
        if (status)
            return status;
    }
    return MESO_OK;
}

/* ---- to the origin ---- */

static void move_to_origin(MesoSwatch *swatch, const Span tile[2], MesoBox box)
{
    double low[3] = {tile[0].low, tile[1].low, (double)box.low.z};
    for (uint32_t v = 0; v < swatch->vertex_count; v++) {
        MesoVec3 *p = &swatch->positions[v];
        *p = (MesoVec3){(float)((double)p->x - low[0]), (float)((double)p->y - low[1]), (float)((double)p->z - low[2])};
    }
    swatch->size = (MesoVec3){(float)(tile[0].high - tile[0].low), (float)(tile[1].high - tile[1].low),
                              box.high.z - box.low.z};
}

/* Mates get one place and one normal. `high` is a period away from its mate along the direction that is further. */
static void snap(MesoSwatch *swatch, uint32_t high)
{
    uint32_t low = swatch->mates[high];
    MesoVec3 p = swatch->positions[low], q = swatch->positions[high];
    if (fabsf(q.x - p.x) > fabsf(q.y - p.y))
        p.x += swatch->period.x;
    else
        p.y += swatch->period.y;
    swatch->positions[high] = p;
    MesoVec3 sum = meso_vec3_add(swatch->normals[low], swatch->normals[high]);
    swatch->normals[low] = swatch->normals[high] = meso_vec3_unit(sum, swatch->normals[low]);
}

static MesoStatus place(MesoSwatch *swatch, const MesoSwatchOptions *options, MesoArena *scratch, MesoError *error)
{
    MesoSwatchAxis axes[2];
    Span tile[2];
    MesoBox box = meso_box_of(swatch->positions, swatch->vertex_count);
    MesoStatus status = meso_swatch_find_ends(axes, scratch, swatch, error);
    if (!status)
        status = find_periods(swatch, axes, options, scratch, error);
    if (!status)
        status = find_tile(tile, swatch, axes, box, scratch, error);
    if (status)
        return status;
    move_to_origin(swatch, tile, box);
    swatch->periodic_x = axes[0].periodic;
    swatch->periodic_y = axes[1].periodic;
    swatch->period = (MesoVec2){axes[0].periodic ? swatch->size.x : 0, axes[1].periodic ? swatch->size.y : 0};
    for (uint32_t v = 0; v < swatch->vertex_count; v++)
        if (swatch->mates[v] != MESO_NO_INDEX)
            snap(swatch, v);
    return MESO_OK;
}

MesoStatus meso_swatch_place(MesoSwatch *swatch, const MesoSwatchOptions *options, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = place(swatch, options, &scratch, error);
    meso_arena_release(&scratch);
    return status;
}
