/* Surfaces for tests of layers, and what is promised of a layer. */
#ifndef MESO_SHELL_FIXTURE_H
#define MESO_SHELL_FIXTURE_H

#include "libcore/chart/chart_fixture.h"
#include "libcore/shell/prism_bodies.h"
#include "libcore/shell/prism_layer.h"
#include "libcore/shell/prisms.h"
#include "libcore/shell/shell_stretch.h"

/* ---- surfaces ---- */

/* Two planes that meet along x = 0, the right one in z = 0; the angle between them is pi less `bend`. */
static inline MesoVec3 meso_fixture_groove_place(float column, float row, const void *context)
{
    float bend = *(const float *)context, x = 0.1f * (column - 10);
    return x < 0 ? (MesoVec3){x * cosf(bend), 0.1f * row, -x * sinf(bend)} : (MesoVec3){x, 0.1f * row, 0};
}

static inline MesoTriangulation meso_fixture_groove(float bend, float jitter)
{
    return meso_fixture_place_sheet(&(MesoFixtureSheet){20, 10, false, 0, jitter, 5, meso_fixture_groove_place, &bend});
}

static inline MesoVec3 meso_fixture_saddle_place(float column, float row, const void *context)
{
    float height = *(const float *)context, x = 0.1f * column - 1, y = 0.1f * row - 1;
    return (MesoVec3){x, y, height * (x * x - y * y)};
}

static inline MesoTriangulation meso_fixture_saddle(float height)
{
    return meso_fixture_place_sheet(&(MesoFixtureSheet){20, 20, false, 0.3f, 0.3f, 5, meso_fixture_saddle_place,
                                                        &height});
}

/* A unit sphere, pushed in by `depth` around its north pole. */
static inline MesoTriangulation meso_fixture_dented(uint32_t n, float depth)
{
    MesoTriangulation mesh = meso_fixture_sphere(n, 0.3f, 11);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        MesoVec3 p = mesh.positions[v], from = meso_vec3_sub(p, (MesoVec3){0, 0, 1});
        mesh.positions[v].z -= depth * expf(-meso_vec3_dot(from, from) / 0.15f);
    }
    return mesh;
}

/* A strip along x that turns back over itself at the height `gap`: two sheets that face each other, and the turn. */
static inline MesoVec3 meso_fixture_clip_place(float column, float row, const void *context)
{
    float gap = *(const float *)context, x = 0.1f * (column - 20), r = gap / 2, turn = 3.1415927f * r;
    float y = 0.1f * row;
    if (x < -turn / 2)
        return (MesoVec3){-(x + turn / 2), y, gap};
    if (x > turn / 2)
        return (MesoVec3){x - turn / 2, y, 0};
    return (MesoVec3){-r * cosf(x / r), y, r - r * sinf(x / r)};
}

static inline MesoTriangulation meso_fixture_clip(float gap)
{
    return meso_fixture_place_sheet(&(MesoFixtureSheet){40, 8, false, 0, 0.2f, 5, meso_fixture_clip_place, &gap});
}

/* ---- layers ---- */

static inline MesoVec3d meso_fixture_lift(const MesoTriangulation *mesh, const MesoVec3 *directions, uint32_t vertex,
                                          double height)
{
    return meso_vec3d_mad(meso_vec3d(mesh->positions[vertex]), height, meso_vec3d(directions[vertex]));
}

static inline MesoPrismBody meso_fixture_prism(const MesoTriangulation *mesh, const MesoVec3 *directions,
                                               uint32_t triangle, double low, double high)
{
    const uint32_t *v = &mesh->corners[3 * (size_t)triangle];
    MesoPrismBody body;
    for (uint32_t k = 0; k < 6; k++)
        body.corners[k] = meso_fixture_lift(mesh, directions, v[k % 3], k < 3 ? low : high);
    meso_prism_split(v, body.tetrahedra);
    return body;
}

static inline void meso_fixture_part(const MesoPrismBody *body, uint32_t part, MesoVec3d corners[4])
{
    for (uint32_t k = 0; k < 4; k++)
        corners[k] = body->corners[body->tetrahedra[part][k]];
}

/* All tetrahedra of all splits between pairs of heights have a volume, and the right sign. */
static inline void meso_fixture_check_stands(const MesoTriangulation *mesh, const MesoVec3 *directions, float low,
                                             float high)
{
    enum { LEVELS = 5 };
    static const uint32_t orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (uint32_t pair = 0; pair < LEVELS * LEVELS; pair++) {
            uint32_t i = pair / LEVELS, j = pair % LEVELS;
            if (i >= j)
                continue;
            double step = ((double)high - low) / (LEVELS - 1), from = low + step * i, to = low + step * j;
            MesoPrismBody body = meso_fixture_prism(mesh, directions, t, from, to);
            for (uint32_t order = 0; order < 6; order++) {
                meso_prism_split(orders[order], body.tetrahedra);
                for (uint32_t k = 0; k < 3; k++) {
                    MesoVec3d corners[4];
                    meso_fixture_part(&body, k, corners);
                    CHECK(meso_tetrahedron_det(corners) > 0);
                }
            }
        }
}

static inline bool meso_fixture_is_inside(const MesoVec3d corners[4], MesoVec3d point, double margin)
{
    double whole = meso_tetrahedron_det(corners);
    for (uint32_t k = 0; k < 4; k++) {
        MesoVec3d part[4] = {corners[0], corners[1], corners[2], corners[3]};
        part[k] = point;
        if (!(meso_tetrahedron_det(part) > margin * whole))
            return false;
    }
    return true;
}

/* Inside one of the prism's tetrahedra, evenly. */
static inline MesoVec3d meso_fixture_inner_point(const MesoPrismBody *body, MesoRandom *random)
{
    MesoVec3d corners[4], point = {0, 0, 0};
    double weights[4], sum = 0;
    meso_fixture_part(body, meso_random_below(random, 3), corners);
    for (uint32_t k = 0; k < 4; k++)
        sum += weights[k] = 1.0001 + meso_fixture_signed(random);
    for (uint32_t k = 0; k < 4; k++)
        point = meso_vec3d_mad(point, weights[k] / sum, corners[k]);
    return point;
}

/* Whether the box along z and x holds the point: what can be told soon. */
static inline bool meso_fixture_may_hold(const MesoVec3d corners[4], MesoVec3d point)
{
    uint32_t below[2] = {0, 0};
    for (uint32_t k = 0; k < 4; k++) {
        below[0] += corners[k].x < point.x;
        below[1] += corners[k].z < point.z;
    }
    return below[0] % 4 != 0 && below[1] % 4 != 0;
}

/* No inner point of a prism lies in another one, by itself: points against all tetrahedra. */
static inline void meso_fixture_check_apart(const MesoTriangulation *mesh, const MesoVec3 *directions, float low,
                                            float high)
{
    enum { POINTS = 3 };
    MesoRandom random;
    meso_random_init(&random, 7, 0);
    MesoPrismBody *bodies = malloc(mesh->triangle_count * sizeof *bodies);
    CHECK(bodies);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        bodies[t] = meso_fixture_prism(mesh, directions, t, low, high);
    for (uint32_t t = 0; t < mesh->triangle_count * POINTS; t++) {
        MesoVec3d point = meso_fixture_inner_point(&bodies[t / POINTS], &random);
        for (uint32_t other = 0; other < mesh->triangle_count; other++)
            for (uint32_t k = 0; k < 3 && other != t / POINTS; k++) {
                MesoVec3d corners[4];
                meso_fixture_part(&bodies[other], k, corners);
                if (meso_fixture_may_hold(corners, point))
                    CHECK(!meso_fixture_is_inside(corners, point, 1e-7));
            }
    }
    free(bodies);
}

#endif
