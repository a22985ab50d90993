#include "libcore/quilt/swatch/swatch_tile.h"

#include <math.h>
#include <stdlib.h>

#include "libcore/math/box.h"
#include "libcore/quilt/swatch/swatch_finer.h"
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

static int compare_places(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
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

/*
 * From the centres of elements alone: what stands in rows leaves a gap as wide between its last and the next tile's
 * first as from row to row, and what is strewn a small one.
 */
static MesoStatus estimate(Span *tile, const MesoSwatch *swatch, int along, Span box, MesoArena *scratch,
                           MesoError *error)
{
    uint32_t count = swatch->element_count;
    double *places = MESO_NEW(scratch, double, count, error), gap = 0;
    if (!places)
        return MESO_ERR_MEMORY;
    for (uint32_t e = 0; e < count; e++)
        places[e] = meso_along(swatch->centres[e], along);
    qsort(places, count, sizeof *places, compare_places);
    for (uint32_t e = 1; e < count; e++)
        gap = fmax(gap, places[e] - places[e - 1]);
    *tile = (Span){places[0] - gap / 2, places[count - 1] + gap / 2};
    double width = tile->high - tile->low, most = box.high - box.low;
    if (width < most / 4)       /* a few large elements around each other */
        *tile = box;
    return MESO_OK;
}

static MesoStatus find_tile(Span tile[2], const MesoSwatch *swatch, const MesoSwatchAxis axes[2], MesoBox box,
                            MesoArena *scratch, MesoError *error)
{
    Span boxes[2] = {{(double)box.low.x, (double)box.high.x}, {(double)box.low.y, (double)box.high.y}};
    MesoStatus status = MESO_OK;
    for (int k = 0; k < 2 && !status; k++)
        if (!find_known(&tile[k], swatch, &axes[k], boxes[k]))
            status = estimate(&tile[k], swatch, k, boxes[k], scratch, error);
    return status;
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

static void snap(MesoSwatch *swatch, uint32_t high)
{
    uint32_t low = swatch->mates[high];
    MesoVec3 p = swatch->positions[low];
    if (meso_swatch_mates_along_x(swatch, high))
        p.x += swatch->size.x;
    else
        p.y += swatch->size.y;
    swatch->positions[high] = p;
    MesoVec3 sum = meso_vec3_add(swatch->normals[low], swatch->normals[high]);
    swatch->normals[low] = swatch->normals[high] = meso_vec3_unit(sum, swatch->normals[low]);
}

void meso_swatch_snap(MesoSwatch *swatch)
{
    for (uint32_t v = 0; v < swatch->vertex_count; v++)
        if (swatch->mates[v] != MESO_NO_INDEX)
            snap(swatch, v);
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
    meso_swatch_snap(swatch);
    return meso_swatch_refine_period(swatch, scratch, error);
}

MesoStatus meso_swatch_place(MesoSwatch *swatch, const MesoSwatchOptions *options, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = place(swatch, options, &scratch, error);
    meso_arena_release(&scratch);
    return status;
}
