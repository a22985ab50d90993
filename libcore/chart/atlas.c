#include "libcore/chart/atlas.h"

#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/chart/box_pack.h"
#include "libcore/chart/surface_cells.h"
#include "libcore/mesh/cut/triangle_area.h"

/* Between boxes, of the square's side. */
static const float gap = 1.0f / 512;

typedef struct Builder {
    MesoAtlas *atlas;
    MesoArena *arena, *scratch;
    const MesoTriangulation *mesh;
    MesoChartMaker maker;
    uint8_t *taken;         /* [triangle_count] of the maker */
    MesoChartOptions options;
    uint32_t chart_room;
    MesoError *error;
} Builder;

/* ---- charts ---- */

/* Its triangles are taken from then on. */
static MesoStatus add_chart(Builder *b, uint32_t seed)
{
    MesoAtlas *atlas = b->atlas;
    atlas->charts = MESO_GROW(b->arena, atlas->charts, atlas->chart_count, b->chart_room, 64, b->error);
    if (!atlas->charts)
        return MESO_ERR_MEMORY;
    MesoChart *chart = &atlas->charts[atlas->chart_count];
    MesoStatus status = meso_chart_grow(chart, b->arena, &b->maker, seed, &b->options, b->error);
    for (uint32_t i = 0; !status && i < chart->triangle_count; i++) {
        atlas->triangle_chart[chart->triangles[i]] = atlas->chart_count;
        b->taken[chart->triangles[i]] = 1;
    }
    atlas->chart_count += !status;
    return status;
}

/* A chart around the centre of each cell, of its triangles alone. */
static MesoStatus add_cells(Builder *b, const MesoSurfaceCells *cells)
{
    uint32_t n = b->mesh->triangle_count;
    uint32_t *ends = MESO_NEW(b->scratch, uint32_t, (size_t)cells->count + 1, b->error);
    uint32_t *members = MESO_NEW(b->scratch, uint32_t, n, b->error);
    if (!ends || !members)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < n; t++)
        ends[cells->cells[t] + 1]++;
    for (uint32_t c = 0; c < cells->count; c++)
        ends[c + 1] += ends[c];
    for (uint32_t t = n; t-- > 0;)
        members[--ends[cells->cells[t] + 1]] = t;
    /* each end has come down to the begin of its cell */
    MesoStatus status = MESO_OK;
    memset(b->taken, 1, n);
    for (uint32_t c = 0; c < cells->count && !status; c++) {
        uint32_t begin = ends[c + 1], end = c + 1 < cells->count ? ends[c + 2] : n;
        for (uint32_t i = begin; i < end; i++)
            b->taken[members[i]] = 0;
        status = add_chart(b, cells->centres[c]);
        for (uint32_t i = begin; i < end; i++)
            b->taken[members[i]] = 1;
    }
    return status;
}

/* Where a cell was no disk, or could not be laid flat as a whole. */
static MesoStatus add_rest(Builder *b)
{
    MesoStatus status = MESO_OK;
    for (uint32_t t = 0; t < b->mesh->triangle_count; t++)
        b->taken[t] = b->atlas->triangle_chart[t] != MESO_NO_INDEX;
    for (uint32_t t = 0; t < b->mesh->triangle_count && !status; t++)
        if (!b->taken[t])
            status = add_chart(b, t);
    return status;
}

/* ---- the square ---- */

/* A turn of the plane, and the box of a chart after it. */
typedef struct Posture {
    double cosine, sine;
    double low[2], high[2];
} Posture;

static void turn_place(const Posture *posture, MesoVec2 place, double turned[2])
{
    turned[0] = posture->cosine * place.x - posture->sine * place.y;
    turned[1] = posture->sine * place.x + posture->cosine * place.y;
}

static Posture posture_at(const MesoChart *chart, double cosine, double sine)
{
    Posture posture = {cosine, sine, {INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (uint32_t v = 0; v < chart->vertex_count; v++) {
        double turned[2];
        turn_place(&posture, chart->places[v], turned);
        for (uint32_t k = 0; k < 2; k++) {
            posture.low[k] = fmin(posture.low[k], turned[k]);
            posture.high[k] = fmax(posture.high[k], turned[k]);
        }
    }
    return posture;
}

/* Of some turns that of the smallest box, which then lies on its longer side. */
static Posture best_posture(const MesoChart *chart)
{
    enum { TURNS = 16 };
    Posture best = posture_at(chart, 1, 0);
    double least = INFINITY;
    for (uint32_t i = 0; i < TURNS; i++) {
        double t = (double)i / TURNS, cosine = (1 - t * t) / (1 + t * t), sine = 2 * t / (1 + t * t);
        Posture posture = posture_at(chart, cosine, sine);
        double area = (posture.high[0] - posture.low[0]) * (posture.high[1] - posture.low[1]);
        if (area < least) {
            least = area;
            best = posture;
        }
    }
    if (best.high[1] - best.low[1] > best.high[0] - best.low[0])
        best = posture_at(chart, -best.sine, best.cosine);
    return best;
}

static void set_uvs(Builder *b, const MesoChart *chart, const Posture *posture, MesoVec2 low, double side)
{
    for (uint32_t c = 0; c < 3 * chart->triangle_count; c++) {
        double turned[2];
        turn_place(posture, chart->places[chart->corners[c]], turned);
        double x = low.x + turned[0] - posture->low[0], y = low.y + turned[1] - posture->low[1];
        MesoVec2 uv = {(float)(x / side), (float)(y / side)};
        b->atlas->corner_uv[3 * (size_t)chart->triangles[c / 3] + c % 3] = uv;
    }
}

static MesoStatus pack_charts(Builder *b)
{
    uint32_t count = b->atlas->chart_count;
    float side = 1;
    Posture *postures = MESO_NEW(b->scratch, Posture, count, b->error);
    MesoVec2 *sizes = MESO_NEW(b->scratch, MesoVec2, count, b->error);
    MesoVec2 *lows = MESO_NEW(b->scratch, MesoVec2, count, b->error);
    if (!postures || !sizes || !lows)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < count; c++) {
        postures[c] = best_posture(&b->atlas->charts[c]);
        sizes[c] = (MesoVec2){(float)(postures[c].high[0] - postures[c].low[0]),
                              (float)(postures[c].high[1] - postures[c].low[1])};
    }
    MesoStatus status = meso_boxes_pack(lows, &side, b->scratch, sizes, count, gap, b->error);
    for (uint32_t c = 0; c < count && !status; c++)
        set_uvs(b, &b->atlas->charts[c], &postures[c], lows[c], side);
    b->atlas->scale = 1 / side;
    return status;
}

/* ---- the whole ---- */

/* Over triangles that have an area. */
static float ratio_of_all(const Builder *b)
{
    double least = INFINITY, largest = 0;
    for (uint32_t t = 0; t < b->mesh->triangle_count; t++) {
        const MesoVec2 *uv = &b->atlas->corner_uv[3 * (size_t)t];
        double area = meso_triangle_area(b->mesh, t);
        double image = ((double)uv[1].x - uv[0].x) * ((double)uv[2].y - uv[0].y) -
                       ((double)uv[1].y - uv[0].y) * ((double)uv[2].x - uv[0].x);
        if (!(area > 0 && image > 0))
            continue;
        least = fmin(least, image / area);
        largest = fmax(largest, image / area);
    }
    return largest > least ? (float)(largest / least) : 1;
}

static MesoStatus build_atlas(Builder *b)
{
    uint32_t n = b->mesh->triangle_count;
    MesoSurfaceCells cells;
    b->atlas->triangle_chart = MESO_NEW(b->arena, uint32_t, n, b->error);
    b->atlas->corner_uv = MESO_NEW(b->arena, MesoVec2, 3 * (size_t)n, b->error);
    b->taken = MESO_NEW(b->scratch, uint8_t, n, b->error);
    if (!b->atlas->triangle_chart || !b->atlas->corner_uv || !b->taken)
        return MESO_ERR_MEMORY;
    memset(b->atlas->triangle_chart, 0xff, n * sizeof *b->atlas->triangle_chart);
    b->maker.taken = b->taken;
    double area = 0;
    for (uint32_t t = 0; t < n; t++)
        area += meso_triangle_area(b->mesh, t);
    double radius = b->options.radius > 0 ? b->options.radius : sqrt(area / (4 * MESO_PI));
    MesoStatus status = meso_surface_cells(&cells, b->scratch, b->mesh, radius, b->error);
    /* distances from centroid to centroid are longer than along the surface, but end before the corners */
    b->options.radius = (float)(2 * radius);
    if (!status)
        status = add_cells(b, &cells);
    if (!status)
        status = add_rest(b);
    if (!status)
        status = pack_charts(b);
    if (!status)
        b->atlas->largest_ratio = ratio_of_all(b);
    return status;
}

MesoStatus meso_atlas_build(MesoAtlas *atlas, MesoArena *arena, const MesoTriangulation *mesh,
                            const MesoChartOptions *options, MesoError *error)
{
    MesoArena scratch;
    Builder builder = {.atlas = atlas, .arena = arena, .scratch = &scratch, .mesh = mesh, .options = *options,
                       .error = error};
    *atlas = (MesoAtlas){.largest_ratio = 1, .scale = 1};
    if (mesh->triangle_count > 1u << 28)
        return meso_fail(error, MESO_ERR_LIMIT, "%u triangles are too many for an atlas", mesh->triangle_count);
    MesoStatus status = meso_chart_maker_init(&builder.maker, mesh, error);
    if (status)
        return status;
    meso_arena_init(&scratch);
    status = build_atlas(&builder);
    meso_arena_release(&scratch);
    meso_chart_maker_release(&builder.maker);
    return status;
}
