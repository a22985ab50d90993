#include "libcore/shell/shell_map.h"

#include <string.h>

#include "libcore/shell/prisms.h"
#include "libcore/shell/shell_map_relax.h"
#include "libcore/shell/shell_stretch.h"

/* ---- building ---- */

static MesoStatus allocate(MesoShellMap *map, const MesoAtlas *atlas, MesoArena *arena, MesoError *error)
{
    for (uint32_t c = 0; c < atlas->chart_count; c++)
        map->vertex_count += atlas->charts[c].vertex_count;
    map->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)map->mesh->triangle_count, error);
    map->origins = MESO_NEW(arena, uint32_t, map->vertex_count, error);
    map->low_uv = MESO_NEW(arena, double, 2 * (size_t)map->vertex_count, error);
    map->high_uv = MESO_NEW(arena, double, 2 * (size_t)map->vertex_count, error);
    map->held = MESO_NEW(arena, uint8_t, map->vertex_count, error);
    map->plain = MESO_NEW(arena, uint8_t, map->mesh->triangle_count, error);
    return map->corners && map->origins && map->low_uv && map->high_uv && map->held && map->plain ? MESO_OK
                                                                                                   : MESO_ERR_MEMORY;
}

static void place_vertices(MesoShellMap *map, const MesoAtlas *atlas)
{
    uint32_t first = 0;
    for (uint32_t c = 0; c < atlas->chart_count; c++) {
        const MesoChart *chart = &atlas->charts[c];
        for (uint32_t i = 0; i < 3 * chart->triangle_count; i++) {
            uint32_t corner = 3 * chart->triangles[i / 3] + i % 3, v = first + chart->corners[i];
            map->corners[corner] = v;
            map->origins[v] = map->mesh->corners[corner];
            map->low_uv[2 * (size_t)v] = (double)atlas->corner_uv[corner].x / atlas->scale;
            map->low_uv[2 * (size_t)v + 1] = (double)atlas->corner_uv[corner].y / atlas->scale;
        }
        first += chart->vertex_count;
    }
    if (map->vertex_count)
        memcpy(map->high_uv, map->low_uv, 2 * (size_t)map->vertex_count * sizeof(double));
}

/* The half-edge across, in the same chart and not over a slit; MESO_NO_INDEX at the chart's border. */
static uint32_t twin_in_chart(const MesoShellMap *map, uint32_t half_edge)
{
    uint32_t twin = map->mesh->twins[half_edge];
    if (twin == MESO_NO_INDEX || map->corners[twin] != map->corners[meso_next_corner(half_edge)] ||
        map->corners[meso_next_corner(twin)] != map->corners[half_edge])
        return MESO_NO_INDEX;
    return twin;
}

static void hold_vertices(MesoShellMap *map)
{
    for (uint32_t h = 0; h < 3 * map->mesh->triangle_count; h++)
        if (twin_in_chart(map, h) == MESO_NO_INDEX) {
            map->held[map->corners[h]] = 1;
            map->held[map->corners[meso_next_corner(h)]] = 1;
        }
    for (uint32_t t = 0; t < map->mesh->triangle_count; t++) {
        MesoShellPrism prism = meso_shell_prism(map, t);
        uint32_t negative_count = 0, flat_count = 0;
        if (meso_shell_prism_stands(&prism))
            continue;
        for (uint32_t k = 0; k < 3; k++)
            map->held[map->corners[3 * (size_t)t + k]] = 1;
        meso_shell_prism_count(&prism, &negative_count, &flat_count);
        map->plain[t] = negative_count > 0;
    }
}

typedef struct Sums {
    MesoShellStretch there, back;
    uint32_t inverted_count, flat_count;
} Sums;

static Sums measure(const MesoShellMap *map)
{
    Sums sums = {0};
    for (uint32_t t = 0; t < map->mesh->triangle_count; t++) {
        MesoShellPrism prism = meso_shell_prism(map, t);
        if (!meso_shell_prism_stands(&prism)) {
            if (!map->plain[t])
                meso_shell_prism_count(&prism, &sums.inverted_count, &sums.flat_count);
            continue;
        }
        for (uint32_t part = 0; part < 3; part++) {
            MesoVec3d texture[4], shell[4];
            meso_shell_prism_part(&prism, part, texture, shell);
            meso_shell_stretch_add(&sums.there, texture, shell);
            meso_shell_stretch_add(&sums.back, shell, texture);
        }
    }
    sums.inverted_count += sums.there.inverted_count;
    return sums;
}

static bool is_no_worse(const Sums *a, const Sums *b)
{
    return meso_shell_stretch_sixth(&a->there) <= meso_shell_stretch_sixth(&b->there);
}

/* The solution of the linear system is a start only where it is a better one. */
static MesoStatus optimise(MesoShellMap *map, Sums *best, uint32_t sweeps, MesoArena *scratch, MesoError *error)
{
    size_t size = 2 * (size_t)map->vertex_count * sizeof(double);
    MesoStatus status = meso_shell_map_solve(map, scratch, error);
    if (status)
        return status;
    Sums start = measure(map);
    if (!is_no_worse(&start, best) && size)
        memcpy(map->high_uv, map->low_uv, size);
    meso_shell_map_sweep(map, sweeps);
    Sums after = measure(map);
    if (is_no_worse(&after, best))
        *best = after;
    else if (size)
        memcpy(map->high_uv, map->low_uv, size);
    return MESO_OK;
}

static uint32_t count_plain(const MesoShellMap *map)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < map->mesh->triangle_count; t++)
        count += map->plain[t];
    return count;
}

MesoStatus meso_shell_map_build(MesoShellMap *map, MesoShellMapReport *report, MesoArena *arena,
                                const MesoTriangulation *mesh, const MesoAtlas *atlas, const MesoVec3 *directions,
                                const MesoShellMapOptions *options, MesoError *error)
{
    const uint32_t usual_sweeps = 10;
    if (!(isfinite(options->low) && isfinite(options->high) && options->low < options->high))
        return meso_fail(error, MESO_ERR_INPUT, "no layer from height %g to %g", (double)options->low,
                         (double)options->high);
    *map = (MesoShellMap){.mesh = mesh, .directions = directions, .low = options->low, .high = options->high};
    MesoStatus status = allocate(map, atlas, arena, error);
    if (status)
        return status;
    place_vertices(map, atlas);
    hold_vertices(map);
    Sums before = measure(map), after = before;
    if (!options->plain)
        status = optimise(map, &after, options->sweeps ? options->sweeps : usual_sweeps, arena, error);
    if (report)
        *report = (MesoShellMapReport){meso_shell_stretch(&before.there), meso_shell_stretch(&after.there),
                                       meso_shell_stretch(&before.back), meso_shell_stretch(&after.back),
                                       after.inverted_count, after.flat_count, count_plain(map)};
    return status;
}

/* ---- points ---- */

typedef struct Found {
    double least;           /* weight of a corner: the more, the farther inside */
    MesoVec3d point;
} Found;

/* Looks at a triangle's tetrahedra, and keeps the best. */
static void look(const MesoShellMap *map, uint32_t triangle, MesoVec3d at, Found *found)
{
    if (map->plain[triangle])
        return;
    MesoShellPrism prism = meso_shell_prism(map, triangle);
    for (uint32_t part = 0; part < 3; part++) {
        MesoVec3d texture[4], shell[4], point = {0, 0, 0};
        meso_shell_prism_part(&prism, part, texture, shell);
        double whole = meso_tetrahedron_det(texture), least = INFINITY;
        if (!(whole > 0))
            continue;
        for (uint32_t k = 0; k < 4; k++) {
            MesoVec3d with[4] = {texture[0], texture[1], texture[2], texture[3]};
            with[k] = at;
            double weight = meso_tetrahedron_det(with) / whole;
            least = fmin(least, weight);
            point = meso_vec3d_mad(point, weight, shell[k]);
        }
        if (least > found->least)
            *found = (Found){least, point};
    }
}

/* Looks at all triangles of the chart at a corner. */
static void look_around(const MesoShellMap *map, uint32_t corner, MesoVec3d at, Found *found)
{
    uint32_t v = map->corners[corner];
    MesoFan fan = meso_fan_first(map->mesh, map->origins[v]);
    uint32_t first = fan.corner;
    do
        if (map->corners[fan.corner] == v)
            look(map, fan.corner / 3, at, found);
    while (meso_fan_next(map->mesh, &fan) && fan.corner != first);
}

/* The side of a triangle, cut at the point's height, that the point is farthest out of; 3 where it is inside. */
static uint32_t side_towards(const MesoShellMap *map, uint32_t triangle, MesoVec3d at)
{
    double share = (at.z - map->low) / (map->high - map->low), cut[3][2], least = 0;
    uint32_t side = 3;
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t axis = 0; axis < 2; axis++) {
            size_t i = 2 * (size_t)map->corners[3 * (size_t)triangle + k] + axis;
            cut[k][axis] = map->low_uv[i] + share * (map->high_uv[i] - map->low_uv[i]);
        }
    for (uint32_t k = 0; k < 3; k++) {
        const double *from = cut[k], *to = cut[(k + 1) % 3];
        double turn = (to[0] - from[0]) * (at.y - from[1]) - (to[1] - from[1]) * (at.x - from[0]);
        if (turn < least && twin_in_chart(map, 3 * triangle + k) != MESO_NO_INDEX) {
            least = turn;
            side = k;
        }
    }
    return side;
}

MesoVec3 meso_shell_map_point(const MesoShellMap *map, uint32_t triangle, float b1, float b2, float h)
{
    enum { STEPS = 256 };
    const double inside = -1e-9;
    const double b[3] = {1 - (double)b1 - b2, b1, b2};
    if (map->plain[triangle])
        return meso_prism_point(map->mesh, map->directions, triangle, b1, b2, h);
    MesoVec3d at = {0, 0, h};
    for (uint32_t k = 0; k < 3; k++) {
        size_t v = map->corners[3 * (size_t)triangle + k];
        at.x += b[k] * map->low_uv[2 * v];
        at.y += b[k] * map->low_uv[2 * v + 1];
    }
    Found found = {-INFINITY, {0, 0, 0}};
    look(map, triangle, at, &found);
    for (uint32_t step = 0; step < STEPS && found.least < inside; step++) {
        uint32_t side = side_towards(map, triangle, at);
        if (side == 3)
            break;
        triangle = twin_in_chart(map, 3 * triangle + side) / 3;
        look(map, triangle, at, &found);
    }
    /* tetrahedra reach over the triangle's cut, which is bilinear */
    for (uint32_t k = 0; k < 3 && found.least < inside; k++)
        look_around(map, 3 * triangle + k, at, &found);
    return meso_vec3d_narrow(found.point);
}
