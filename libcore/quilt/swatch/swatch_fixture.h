/* What holds of every swatch, and whether its triangles cut each other. */
#ifndef MESO_SWATCH_FIXTURE_H
#define MESO_SWATCH_FIXTURE_H

#include <math.h>
#include <stdlib.h>

#include "libcore/base/check.h"
#include "libcore/mesh/cut/triangulation.h"
#include "libcore/quilt/swatch/swatch.h"

/* What swatch.h promises of the arrays. */
static inline void check_swatch(const MesoSwatch *s)
{
    uint32_t open = 0;
    CHECK(s->vertex_begin[0] == 0 && s->vertex_begin[s->element_count] == s->vertex_count);
    CHECK(s->triangle_begin[0] == 0 && s->triangle_begin[s->element_count] == s->triangle_count);
    for (uint32_t e = 0; e < s->element_count; e++)
        for (uint32_t h = 3 * s->triangle_begin[e]; h < 3 * s->triangle_begin[e + 1]; h++) {
            uint32_t twin = s->twins[h], from = s->corners[h], to = s->corners[meso_next_corner(h)];
            CHECK(from >= s->vertex_begin[e] && from < s->vertex_begin[e + 1]);
            open += twin == MESO_NO_INDEX;
            CHECK(twin == MESO_NO_INDEX || (s->twins[twin] == h && s->corners[twin] == to &&
                                            s->corners[meso_next_corner(twin)] == from));
            CHECK(s->materials[h / 3] < s->material_count);
        }
    CHECK(open == s->open_edge_count && s->loop_begin[s->loop_count] == open);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        MesoVec3 p = s->positions[v];
        CHECK(fabsf(meso_vec3_length(s->normals[v]) - 1) < 1e-5f && p.z >= 0 && p.z <= s->size.z * (1 + 1e-6f));
        uint32_t mate = s->mates[v];
        if (mate == MESO_NO_INDEX)
            continue;
        MesoVec3 q = s->positions[mate];
        CHECK(s->mates[mate] == MESO_NO_INDEX && q.z == p.z && memcmp(&s->normals[v], &s->normals[mate], 12) == 0);
        CHECK((p.x == q.x + s->size.x && p.y == q.y) || (p.x == q.x && p.y == q.y + s->size.y));
    }
}

/* Vertices, edges and faces of an element; closed ones have 2 less twice their genus. */
static inline int64_t element_euler(const MesoSwatch *s, uint32_t e)
{
    int64_t half_edges = 3 * ((int64_t)s->triangle_begin[e + 1] - s->triangle_begin[e]), open = 0;
    for (uint32_t h = 3 * s->triangle_begin[e]; h < 3 * s->triangle_begin[e + 1]; h++)
        open += s->twins[h] == MESO_NO_INDEX;
    return (int64_t)s->vertex_begin[e + 1] - s->vertex_begin[e] - (half_edges + open) / 2 + half_edges / 3;
}

/* ---- triangles that cut each other ---- */

typedef struct FixtureTriangle {
    double low[3], high[3], at[3][3];
    uint32_t triangle;
} FixtureTriangle;

static int compare_lows(const void *a, const void *b)
{
    double p = ((const FixtureTriangle *)a)->low[0], q = ((const FixtureTriangle *)b)->low[0];
    return (p > q) - (p < q);
}

static inline double fixture_volume(const double a[3], const double b[3], const double c[3], const double d[3])
{
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
        w[k] = d[k] - a[k];
    }
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/* Whether a side of the one goes through the other. */
static inline bool side_cuts(const FixtureTriangle *a, const FixtureTriangle *b)
{
    for (int k = 0; k < 3; k++) {
        const double *p = a->at[k], *q = a->at[(k + 1) % 3];
        bool above = fixture_volume(b->at[0], b->at[1], b->at[2], p) > 0;
        if (above == (fixture_volume(b->at[0], b->at[1], b->at[2], q) > 0))
            continue;
        bool r = fixture_volume(p, q, b->at[0], b->at[1]) > 0, s = fixture_volume(p, q, b->at[1], b->at[2]) > 0;
        if (r == s && s == (fixture_volume(p, q, b->at[2], b->at[0]) > 0))
            return true;
    }
    return false;
}

static inline bool share_vertex(const MesoSwatch *s, uint32_t a, uint32_t b)
{
    for (int k = 0; k < 9; k++)
        if (s->corners[3 * a + (uint32_t)k / 3] == s->corners[3 * b + (uint32_t)k % 3])
            return true;
    return false;
}

static inline bool boxes_meet(const FixtureTriangle *a, const FixtureTriangle *b)
{
    return a->low[1] <= b->high[1] && b->low[1] <= a->high[1] && a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

/* Pairs of triangles without a common vertex that cut each other, of one element or two. */
static inline uint32_t count_cuts(const MesoSwatch *s)
{
    uint32_t count = 0;
    FixtureTriangle *all = calloc(s->triangle_count, sizeof *all);
    CHECK(all);
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        all[t].triangle = t;
        for (int c = 0; c < 3; c++) {
            MesoVec3 p = s->positions[s->corners[3 * t + (uint32_t)c]];
            double at[3] = {(double)p.x, (double)p.y, (double)p.z};
            for (int k = 0; k < 3; k++) {
                all[t].at[c][k] = at[k];
                all[t].low[k] = c == 0 ? at[k] : fmin(all[t].low[k], at[k]);
                all[t].high[k] = c == 0 ? at[k] : fmax(all[t].high[k], at[k]);
            }
        }
    }
    qsort(all, s->triangle_count, sizeof *all, compare_lows);
    for (uint32_t i = 0; i < s->triangle_count; i++)
        for (uint32_t j = i + 1; j < s->triangle_count && all[j].low[0] <= all[i].high[0]; j++)
            if (boxes_meet(&all[i], &all[j]) && !share_vertex(s, all[i].triangle, all[j].triangle) &&
                (side_cuts(&all[i], &all[j]) || side_cuts(&all[j], &all[i])))
                count++;
    free(all);
    return count;
}

#endif
