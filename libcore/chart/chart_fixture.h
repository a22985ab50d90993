/* Surfaces for tests of charts, and what is promised of a chart. */
#ifndef MESO_CHART_FIXTURE_H
#define MESO_CHART_FIXTURE_H

#include "libcore/chart/chart.h"
#include "libcore/chart/simple_border.h"
#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/mesh/cut/triangle_area.h"

/* ---- surfaces ---- */

static inline MesoVec3 meso_fixture_flat_place(float column, float row, const void *context)
{
    float side = *(const float *)context;
    /* turned out of the coordinate planes */
    return (MesoVec3){3 + side * (0.8f * column - 0.48f * row), 1 + side * (0.6f * column + 0.64f * row),
                      side * 0.6f * row};
}

typedef struct MesoFixtureCylinder {
    float columns, side, radius;    /* a turn in columns; the height of a row */
} MesoFixtureCylinder;

static inline MesoVec3 meso_fixture_cylinder_place(float column, float row, const void *context)
{
    const MesoFixtureCylinder *cylinder = context;
    float angle = 6.2831853f * column / cylinder->columns;
    return (MesoVec3){cylinder->radius * cosf(angle), cylinder->radius * sinf(angle), cylinder->side * row};
}

static inline MesoVec3 meso_fixture_bumpy_place(float column, float row, const void *context)
{
    float height = *(const float *)context, x = 0.1f * column, y = 0.1f * row;
    return (MesoVec3){x, y, height * sinf(3.1f * x + 0.4f) * sinf(2.7f * y + 0.9f)};
}

static inline MesoTriangulation meso_fixture_flat(uint32_t columns, uint32_t rows, float side)
{
    return meso_fixture_place_sheet(&(MesoFixtureSheet){columns, rows, false, 0.3f, 0.3f, 5, meso_fixture_flat_place,
                                                        &side});
}

/* Squares of the given side, joined around; bent at the sides of the columns alone where these are straight. */
static inline MesoTriangulation meso_fixture_cylinder(uint32_t columns, uint32_t rows, float side, bool straight)
{
    MesoFixtureCylinder cylinder = {(float)columns, side, side * (float)columns / 6.2831853f};
    return meso_fixture_place_sheet(&(MesoFixtureSheet){columns, rows, true, straight ? 0 : 0.25f, 0.25f, 6,
                                                        meso_fixture_cylinder_place, &cylinder});
}

static inline MesoTriangulation meso_fixture_bumpy(uint32_t columns, uint32_t rows, float height)
{
    return meso_fixture_place_sheet(&(MesoFixtureSheet){columns, rows, false, 0.3f, 0.3f, 8, meso_fixture_bumpy_place,
                                                        &height});
}

/* ---- charts ---- */

/* The chart's sides without a neighbour in the chart, as its triangles run, into `border` [6 * triangle_count]. */
static inline uint32_t meso_fixture_border(const MesoChart *chart, uint32_t *border)
{
    uint32_t count = 0, corner_count = 3 * chart->triangle_count;
    for (uint32_t h = 0; h < corner_count; h++) {
        uint32_t a = chart->corners[h], b = chart->corners[meso_next_corner(h)];
        bool joined = false;
        for (uint32_t other = 0; other < corner_count && !joined; other++)
            joined = chart->corners[other] == b && chart->corners[meso_next_corner(other)] == a;
        if (!joined) {
            border[2 * count] = a;
            border[2 * count++ + 1] = b;
        }
    }
    return count;
}

/* One loop that meets no vertex twice, and Euler's number 1: by sides alone, without the mesh's neighbours. */
static inline void meso_fixture_check_disk(const MesoChart *chart)
{
    uint32_t *border = malloc(6 * sizeof *border * chart->triangle_count);
    uint32_t *next = malloc(chart->vertex_count * sizeof *next);
    CHECK(border && next);
    uint32_t count = meso_fixture_border(chart, border);
    memset(next, 0xff, chart->vertex_count * sizeof *next);
    for (uint32_t b = 0; b < count; b++) {
        CHECK(next[border[2 * b]] == MESO_NO_INDEX);
        next[border[2 * b]] = border[2 * b + 1];
    }
    uint32_t at = border[0], length = 0;
    do {
        at = next[at];
        length++;
    } while (at != border[0] && length <= count);
    CHECK(length == count);
    uint32_t edge_count = (3 * chart->triangle_count + count) / 2;
    CHECK(chart->vertex_count + chart->triangle_count == edge_count + 1);
    free(border);
    free(next);
}

/* Whether no two triangles overlap, each pair by itself: a separating side is one of theirs. */
static inline bool meso_fixture_are_apart(const MesoVec2 a[3], const MesoVec2 b[3])
{
    for (uint32_t turn = 0; turn < 2; turn++) {
        const MesoVec2 *p = turn ? b : a, *q = turn ? a : b;
        for (uint32_t k = 0; k < 3; k++) {
            bool apart = true;
            for (uint32_t i = 0; i < 3; i++)
                apart = apart && meso_turn(p[k], p[(k + 1) % 3], q[i]) <= 0;
            if (apart)
                return true;
        }
    }
    return false;
}

/* No flip, no overlap, the area kept, the ratio as told, the seed in its place. */
static inline void meso_fixture_check_places(const MesoChart *chart, const MesoTriangulation *mesh)
{
    double flat = 0, whole = 0, least = INFINITY, largest = 0;
    MesoVec2 *places = malloc(3 * sizeof *places * chart->triangle_count);
    CHECK(places);
    for (uint32_t c = 0; c < 3 * chart->triangle_count; c++) {
        uint32_t corner = 3 * chart->triangles[c / 3] + c % 3;
        CHECK(mesh->corners[corner] == chart->vertices[chart->corners[c]]);
        places[c] = chart->places[chart->corners[c]];
    }
    for (uint32_t t = 0; t < chart->triangle_count; t++) {
        const MesoVec2 *p = &places[3 * t];
        double area = meso_triangle_area(mesh, chart->triangles[t]), image = 0.5 * meso_turn(p[0], p[1], p[2]);
        CHECK(image > 0);
        flat += image;
        whole += area;
        least = fmin(least, image / area);
        largest = fmax(largest, image / area);
        for (uint32_t other = 0; other < t; other++)
            CHECK(meso_fixture_are_apart(p, &places[3 * other]));
    }
    CHECK(fabs(flat / whole - 1) < 1e-5);
    CHECK(fabs(largest / least / chart->area_ratio - 1) < 1e-3);
    MesoVec2 centre = meso_vec2_add(meso_vec2_add(places[0], places[1]), places[2]);
    CHECK(meso_vec2_length(centre) < 1e-5f * (float)sqrt(flat));
    CHECK(fabsf(places[0].y - places[1].y) < 1e-5f * (float)sqrt(flat) && places[1].x > places[0].x);
    free(places);
}

#endif
