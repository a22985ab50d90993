#include "libcore/growth/march/chart_walk.h"

#include <string.h>

/* A line under way, that goes along x from 0 to `length`; what is mirrored in the image is seen in a mirror. */
typedef struct Line {
    const MesoGeometryImage *image;
    double from[2];
    MesoComplex back;       /* turns the line's direction onto x */
    double length;
} Line;

MesoChartPlace meso_chart_place(const MesoGeometryImage *image, uint32_t triangle, bool turned,
                                const double weight[3])
{
    const MesoVec2 *uv = &image->uv[3 * (size_t)triangle];
    MesoChartPlace place = {.triangle = triangle, .turned = turned};
    for (uint32_t k = 0; k < 3; k++) {
        place.weight[k] = weight[k];
        place.at[0] += weight[k] * uv[k].x;
        place.at[1] += weight[k] * uv[k].y;
    }
    return place;
}

/* Corners of a triangle as the line sees them, counter-clockwise. */
static void see(const Line *line, uint32_t triangle, MesoComplex seen[3])
{
    const MesoVec2 *uv = &line->image->uv[3 * (size_t)triangle];
    double area = ((double)uv[1].x - uv[0].x) * ((double)uv[2].y - uv[0].y) -
                  ((double)uv[1].y - uv[0].y) * ((double)uv[2].x - uv[0].x);
    for (uint32_t k = 0; k < 3; k++) {
        seen[k] = meso_complex_times((MesoComplex){uv[k].x - line->from[0], uv[k].y - line->from[1]}, line->back);
        seen[k].im = area < 0 ? -seen[k].im : seen[k].im;
    }
}

/* The side that the line of the walk comes in by; where all corners are on one side, the nearest is on the other. */
static uint32_t entry_side(const MesoComplex seen[3])
{
    uint32_t nearest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        if (seen[k].im >= 0 && !(seen[meso_next_side(k)].im >= 0))
            return k;
        nearest = fabs(seen[k].im) < fabs(seen[nearest].im) ? k : nearest;
    }
    return seen[nearest].im >= 0 ? meso_previous_side(nearest) : nearest;
}

static double clamp(double x, double low, double high)
{
    return fmin(fmax(x, low), high);
}

/* Of a point that lies inside, but for rounding. */
static void weigh_inside(const MesoComplex seen[3], MesoComplex at, double weight[3])
{
    double parts[3], sum = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoComplex a = seen[meso_next_side(k)], b = seen[meso_previous_side(k)];
        parts[k] = fmax(0, (a.re - at.re) * (b.im - at.im) - (a.im - at.im) * (b.re - at.re));
        sum += parts[k];
    }
    for (uint32_t k = 0; k < 3; k++)
        weight[k] = sum > 0 ? parts[k] / sum : 1.0 / 3;
}

/* Where the line crosses a side, as a share of it. */
static double share_of(const Line *line, MesoComplex begin, MesoComplex end)
{
    double dx = end.re - begin.re, dy = end.im - begin.im, share = -begin.im / dy;
    double x = begin.re + share * dx;
    if (fabs(dy) < fabs(dx) && !(x >= 0 && x <= line->length))
        share = (clamp(x, 0, line->length) - begin.re) / dx;
    return share >= 0 ? fmin(share, 1) : 0;
}

static void weigh_on(uint32_t side, double share, double weight[3])
{
    weight[meso_previous_side(side)] = 0;
    weight[side] = 1 - share;
    weight[meso_next_side(side)] = share;
}

static void tell_piece(const MesoChartTell *tell, const MesoChartPlace *from, uint32_t enters, uint32_t leaves,
                       const double weight[3])
{
    if (!tell || !tell->options->piece)
        return;
    MesoComplex corners[3];
    MesoWalkPiece piece = {tell->walk, from->triangle, from->turned, (uint8_t)enters, (uint8_t)leaves,
                           {{0, 0}, {0, 0}}};
    meso_walk_corners(tell->ground, from->triangle, corners);
    piece.ends[0] = meso_walk_point(corners, from->weight);
    piece.ends[1] = meso_walk_point(corners, weight);
    tell->options->piece(tell->options->context, &piece);
}

/* To the other triangle of a side, the same point. */
static void cross(const MesoGeometryImage *image, const MesoTriangulation *mesh, MesoChartPlace *place,
                  uint32_t half_edge, double share)
{
    uint32_t across = mesh->twins[half_edge];
    bool turns = mesh->corners[across] == mesh->corners[half_edge];
    double weight[3];
    weigh_on(across % 3, turns ? share : 1 - share, weight);
    *place = meso_chart_place(image, across / 3, place->turned != turns, weight);
}

/* Whether the line ends before it crosses the side, which it leaves the triangle by: in what is on its left of it. */
static bool ends_before(const Line *line, MesoComplex begin, MesoComplex end)
{
    double x = line->length - begin.re, y = -begin.im;
    return (end.re - begin.re) * y - (end.im - begin.im) * x >= 0;
}

uint32_t meso_chart_walk(const MesoGeometryImage *image, const MesoTriangulation *mesh, MesoChartPlace *place,
                         const double to[2], const MesoChartTell *tell, uint32_t *crossings, uint32_t limit)
{
    MesoComplex way = {to[0] - place->at[0], to[1] - place->at[1]}, seen[3];
    Line line = {image, {place->at[0], place->at[1]}, meso_complex_conjugate(meso_complex_unit(way)),
                 sqrt(way.re * way.re + way.im * way.im)};
    double weight[3];
    see(&line, place->triangle, seen);
    uint32_t entry = entry_side(seen), enters = 3;
    for (;;) {
        uint32_t far = meso_previous_side(entry);
        uint32_t exit = seen[far].im >= 0 ? meso_next_side(entry) : far, half_edge = 3 * place->triangle + exit;
        MesoComplex begin = seen[exit], end = seen[meso_next_side(exit)];
        if (ends_before(&line, begin, end)) {
            weigh_inside(seen, (MesoComplex){line.length, 0}, weight);
            tell_piece(tell, place, enters, 3, weight);
            *place = meso_chart_place(image, place->triangle, place->turned, weight);
            return MESO_NO_INDEX;
        }
        double share = share_of(&line, begin, end);
        weigh_on(exit, share, weight);
        tell_piece(tell, place, enters, exit, weight);
        bool is_seam = image->seams[place->triangle] >> exit & 1;
        if (is_seam || *crossings >= limit) {
            *place = meso_chart_place(image, place->triangle, place->turned, weight);
            return is_seam ? half_edge : MESO_NO_INDEX;
        }
        cross(image, mesh, place, half_edge, share);
        see(&line, place->triangle, seen);
        entry = enters = mesh->twins[half_edge] % 3;
        ++*crossings;
    }
}
