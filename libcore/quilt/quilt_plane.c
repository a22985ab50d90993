#include "libcore/quilt/quilt_plane.h"

/* How far outside of a triangle, as a weight, a place still belongs to it: so that none falls between two. */
#define EDGE_SLACK 1e-5f

/* What rounding leaves of the square of a distance. */
#define FREE_SHARE 0.999f

static MesoVec2 corner_place(const MesoQuiltPlane *plane, uint32_t triangle, uint32_t k)
{
    return plane->places[plane->chart->corners[3 * (size_t)triangle + k]];
}

static uint32_t clamp_cell(float at, uint32_t count)
{
    return at > 0 ? at < (float)count ? (uint32_t)at : count - 1 : 0;
}

typedef struct CellRange {
    uint32_t x0, x1, y0, y1;    /* both ends included */
} CellRange;

static CellRange cells_of(const MesoQuiltPlane *plane, uint32_t triangle)
{
    MesoVec2 a = corner_place(plane, triangle, 0), low = a, high = a;
    for (uint32_t k = 1; k < 3; k++) {
        MesoVec2 p = corner_place(plane, triangle, k);
        low = (MesoVec2){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y};
        high = (MesoVec2){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y};
    }
    float slack = 1e-4f * plane->cell;
    return (CellRange){clamp_cell((low.x - slack - plane->low.x) / plane->cell, plane->columns),
                       clamp_cell((high.x + slack - plane->low.x) / plane->cell, plane->columns),
                       clamp_cell((low.y - slack - plane->low.y) / plane->cell, plane->rows),
                       clamp_cell((high.y + slack - plane->low.y) / plane->cell, plane->rows)};
}

/* Triangles by the cells that their boxes touch: counted, then filled in. */
static MesoStatus index_triangles(MesoQuiltPlane *plane, MesoArena *arena, MesoError *error)
{
    size_t cells = (size_t)plane->columns * plane->rows;
    plane->begin = MESO_NEW(arena, uint32_t, cells + 2, error);
    if (!plane->begin)
        return MESO_ERR_MEMORY;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t t = 0; t < plane->chart->triangle_count; t++) {
            CellRange range = cells_of(plane, t);
            for (uint32_t y = range.y0; y <= range.y1; y++)
                for (uint32_t x = range.x0; x <= range.x1; x++) {
                    uint32_t *at = &plane->begin[(size_t)y * plane->columns + x + 1];
                    if (pass)
                        plane->found[*at] = t;
                    ++*at;
                }
        }
        if (pass)
            break;
        /* sums, shifted by one, so that filling in moves each to its end */
        uint32_t sum = 0;
        for (size_t i = 1; i <= cells; i++) {
            uint32_t count = plane->begin[i];
            plane->begin[i] = sum;
            sum += count;
        }
        plane->found = MESO_NEW(arena, uint32_t, sum, error);
        if (!plane->found)
            return MESO_ERR_MEMORY;
    }
    plane->begin[0] = 0;
    return MESO_OK;
}

static float square_to_segment(MesoVec2 p, MesoVec2 a, MesoVec2 b)
{
    MesoVec2 along = meso_vec2_sub(b, a), off = meso_vec2_sub(p, a);
    float square = along.x * along.x + along.y * along.y;
    float t = square > 0 ? (off.x * along.x + off.y * along.y) / square : 0;
    t = t > 0 ? t < 1 ? t : 1 : 0;
    off = (MesoVec2){off.x - t * along.x, off.y - t * along.y};
    return off.x * off.x + off.y * off.y;
}

/* The circle around the first triangle, where the chart began, to the nearest of its outer edges. */
static void measure_free(MesoQuiltPlane *plane)
{
    const MesoChart *chart = plane->chart;
    MesoVec2 sum = meso_vec2_add(corner_place(plane, 0, 0), corner_place(plane, 0, 1));
    sum = meso_vec2_add(sum, corner_place(plane, 0, 2));
    plane->middle = (MesoVec2){sum.x / 3, sum.y / 3};
    float least = INFINITY;
    for (uint32_t h = 0; h < 3 * chart->triangle_count; h++) {
        uint32_t across = plane->base->twins[3 * chart->triangles[h / 3] + h % 3];
        if (across != MESO_NO_INDEX && plane->chart_triangles[across / 3] != MESO_NO_INDEX)
            continue;
        float square = square_to_segment(plane->middle, corner_place(plane, h / 3, h % 3),
                                         corner_place(plane, h / 3, (h + 1) % 3));
        least = square < least ? square : least;
    }
    plane->free_square = least < INFINITY ? FREE_SHARE * least : 0;
}

MesoStatus meso_quilt_plane_make(MesoQuiltPlane *plane, MesoArena *arena, const MesoTriangulation *base,
                                 const MesoChart *chart, uint32_t *chart_triangles, float angle, float scale,
                                 float height_scale, float offset, MesoError *error)
{
    *plane = (MesoQuiltPlane){.base = base, .chart = chart, .height_scale = height_scale, .offset = offset,
                              .chart_triangles = chart_triangles};
    plane->places = MESO_NEW(arena, MesoVec2, chart->vertex_count, error);
    if (!plane->places)
        return MESO_ERR_MEMORY;
    float c = cosf(angle) / scale, s = sinf(angle) / scale;
    for (uint32_t v = 0; v < chart->vertex_count; v++) {
        MesoVec2 p = chart->places[v];
        plane->places[v] = (MesoVec2){c * p.x + s * p.y, c * p.y - s * p.x};
    }
    for (uint32_t t = 0; t < chart->triangle_count; t++)
        chart_triangles[chart->triangles[t]] = t;
    return meso_quilt_plane_index(plane, arena, error);
}

MesoStatus meso_quilt_plane_index(MesoQuiltPlane *plane, MesoArena *arena, MesoError *error)
{
    const MesoChart *chart = plane->chart;
    plane->low = (MesoVec2){INFINITY, INFINITY};
    plane->high = (MesoVec2){-INFINITY, -INFINITY};
    for (uint32_t v = 0; v < chart->vertex_count; v++) {
        MesoVec2 q = plane->places[v];
        plane->low = (MesoVec2){q.x < plane->low.x ? q.x : plane->low.x, q.y < plane->low.y ? q.y : plane->low.y};
        plane->high = (MesoVec2){q.x > plane->high.x ? q.x : plane->high.x, q.y > plane->high.y ? q.y : plane->high.y};
    }
    float width = plane->high.x - plane->low.x, depth = plane->high.y - plane->low.y;
    plane->cell = sqrtf(width * depth / (float)chart->triangle_count);
    float least = (width > depth ? width : depth) / 1024;
    plane->cell = plane->cell > least ? plane->cell : least > 0 ? least : 1;
    plane->columns = (uint32_t)(width / plane->cell) + 1;
    plane->rows = (uint32_t)(depth / plane->cell) + 1;
    measure_free(plane);
    return index_triangles(plane, arena, error);
}

void meso_quilt_plane_forget(MesoQuiltPlane *plane)
{
    for (uint32_t t = 0; t < plane->chart->triangle_count; t++)
        plane->chart_triangles[plane->chart->triangles[t]] = MESO_NO_INDEX;
}

/* Whether a triangle has a place, and the weights of corners 1 and 2 there. */
static bool weigh(const MesoQuiltPlane *plane, uint32_t triangle, MesoVec2 place, float *b1, float *b2)
{
    MesoVec2 a = corner_place(plane, triangle, 0), d = meso_vec2_sub(place, a);
    MesoVec2 e1 = meso_vec2_sub(corner_place(plane, triangle, 1), a);
    MesoVec2 e2 = meso_vec2_sub(corner_place(plane, triangle, 2), a);
    float area = meso_vec2_cross(e1, e2);
    float w1 = meso_vec2_cross(d, e2), w2 = meso_vec2_cross(e1, d);
    float slack = -EDGE_SLACK * area;
    if (!(w1 >= slack && w2 >= slack && area - w1 - w2 >= slack && area > 0))
        return false;
    *b1 = w1 / area;
    *b2 = w2 / area;
    return true;
}

uint32_t meso_quilt_plane_locate(const MesoQuiltPlane *plane, MesoVec2 place, float *b1, float *b2)
{
    float x = (place.x - plane->low.x) / plane->cell, y = (place.y - plane->low.y) / plane->cell;
    if (!(x > -0.01f && y > -0.01f && x < (float)plane->columns + 0.01f && y < (float)plane->rows + 0.01f))
        return MESO_NO_INDEX;
    size_t cell = (size_t)clamp_cell(y, plane->rows) * plane->columns + clamp_cell(x, plane->columns);
    for (uint32_t i = plane->begin[cell]; i < plane->begin[cell + 1]; i++)
        if (weigh(plane, plane->found[i], place, b1, b2))
            return plane->found[i];
    return MESO_NO_INDEX;
}

bool meso_quilt_plane_has(const MesoQuiltPlane *plane, MesoVec2 place, uint32_t *near)
{
    float b1, b2, x = place.x - plane->middle.x, y = place.y - plane->middle.y;
    if (x * x + y * y < plane->free_square)
        return true;
    if (*near != MESO_NO_INDEX && weigh(plane, *near, place, &b1, &b2))
        return true;
    *near = meso_quilt_plane_locate(plane, place, &b1, &b2);
    return *near != MESO_NO_INDEX;
}

bool meso_quilt_plane_to(const MesoQuiltPlane *plane, MesoQuiltVertex vertex, MesoVec3 *point)
{
    uint32_t t = plane->chart_triangles[vertex.triangle];
    if (t == MESO_NO_INDEX || t >= plane->chart->triangle_count || plane->chart->triangles[t] != vertex.triangle)
        return false;   /* nor is it of another chart */
    MesoVec2 a = corner_place(plane, t, 0), b = corner_place(plane, t, 1), c = corner_place(plane, t, 2);
    float b0 = 1 - vertex.b1 - vertex.b2;
    *point = (MesoVec3){b0 * a.x + vertex.b1 * b.x + vertex.b2 * c.x, b0 * a.y + vertex.b1 * b.y + vertex.b2 * c.y,
                        (vertex.height - plane->offset) / plane->height_scale};
    return true;
}

bool meso_quilt_plane_from(const MesoQuiltPlane *plane, MesoVec3 point, MesoQuiltVertex *vertex)
{
    float b1, b2;
    uint32_t t = meso_quilt_plane_locate(plane, (MesoVec2){point.x, point.y}, &b1, &b2);
    if (t == MESO_NO_INDEX)
        return false;
    *vertex = (MesoQuiltVertex){plane->chart->triangles[t], b1, b2, plane->offset + plane->height_scale * point.z};
    return true;
}
