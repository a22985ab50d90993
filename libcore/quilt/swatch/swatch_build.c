#include "libcore/quilt/swatch/swatch.h"

#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/math/box.h"
#include "libcore/mesh/cut/triangulation.h"
#include "libcore/mesh/edit/ear_clip.h"
#include "libcore/mesh/edit/face_area.h"
#include "libcore/mesh/edit/mesh_orient.h"
#include "libcore/quilt/swatch/swatch_elements.h"
#include "libcore/quilt/swatch/swatch_looks.h"
#include "libcore/quilt/swatch/swatch_tile.h"

/* ---- triangles ---- */

static MesoStatus require_two_sides(const MesoOrientCounts *counts, MesoError *error)
{
    if (counts->disagreeing == 0)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_INPUT, "face %u: its surface has one side only", counts->one_sided + 1);
}

/* The faces, wound alike and in triangles, and their half-edges. */
static MesoStatus make_triangles(MesoPolygonMesh *triangles, MesoHalfEdges *edges, MesoArena *scratch,
                                 const MesoPolygonMesh *mesh, MesoError *error)
{
    MesoPolygonMesh *turned = MESO_NEW(scratch, MesoPolygonMesh, 1, error);     /* `triangles` shares names with it */
    MesoOrientCounts counts = {0};
    if (!turned)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_half_edges_join(edges, scratch, mesh, 1, error);
    if (!status)
        status = meso_half_edges_require_manifold(edges, mesh, error);
    if (!status)
        status = meso_mesh_orient(turned, scratch, mesh, edges, &counts, error);
    if (!status)
        status = require_two_sides(&counts, error);
    if (!status)
        status = meso_mesh_cut_faces(triangles, scratch, turned, error);
    if (!status)
        status = meso_half_edges_join(edges, scratch, triangles, 1, error);
    return status;
}

/* ---- vertices ---- */

/*
 * A vertex for each fan of triangles: corners that meet along an edge are one. `vertex_of` [corner_count] gets its
 * number, in the order of the mesh's vertices, and of first corners; `source` [corner_count] a corner of each.
 */
static MesoStatus number_fans(uint32_t *vertex_of, uint32_t *source, uint32_t *count, MesoArena *scratch,
                              const MesoPolygonMesh *triangles, const uint32_t *twins, MesoError *error)
{
    uint32_t corners = triangles->corner_count;
    uint32_t *parent = MESO_NEW(scratch, uint32_t, corners, error);
    uint32_t *next = MESO_NEW(scratch, uint32_t, (size_t)triangles->vertex_count + 1, error);
    if (!parent || !next)
        return MESO_ERR_MEMORY;
    meso_sets_init(parent, corners);
    for (uint32_t h = 0; h < corners; h++)
        if (twins[h] != MESO_NO_INDEX)
            meso_sets_join(parent, h, meso_next_corner(twins[h]));
    for (uint32_t h = 0; h < corners; h++)
        next[triangles->corners[h] + 1] += meso_sets_root(parent, h) == h;
    for (uint32_t v = 0; v < triangles->vertex_count; v++)
        next[v + 1] += next[v];
    *count = next[triangles->vertex_count];
    for (uint32_t h = 0; h < corners; h++) {
        uint32_t root = meso_sets_root(parent, h);
        if (root == h)
            source[vertex_of[h] = next[triangles->corners[h]]++] = h;
        else
            vertex_of[h] = vertex_of[root];
    }
    return MESO_OK;
}

/* Cyclic, or turned about x: no handedness changes. */
static MesoVec3 turn_up(MesoVec3 p, int up)
{
    return up == 0 ? (MesoVec3){p.y, p.z, p.x} : up == 1 ? (MesoVec3){p.x, -p.z, p.y} : p;
}

/* The thinnest side of the box, of equal ones the last. */
static int find_up(const MesoPolygonMesh *mesh)
{
    MesoBox box = meso_box_of(mesh->positions, mesh->vertex_count);
    MesoVec3 size = meso_vec3_sub(box.high, box.low);
    if (size.z <= size.x && size.z <= size.y)
        return 2;
    return size.y <= size.x ? 1 : 0;
}

static uint32_t element_of(const MesoAttribute *attribute, const MesoPolygonMesh *mesh, uint32_t corner)
{
    return attribute->domain == MESO_ON_CORNERS ? corner : mesh->corners[corner];
}

static MesoVec3 given_normal(const MesoAttribute *normals, const MesoPolygonMesh *mesh, uint32_t corner)
{
    uint32_t entry = normals ? meso_attribute_entry(normals, element_of(normals, mesh, corner)) : MESO_NO_INDEX;
    return entry == MESO_NO_INDEX ? (MesoVec3){0, 0, 0} : meso_attribute_vec3(normals, entry);
}

/* Sums over the corners of each vertex of the normals that they have, turned up. */
static void sum_normals(MesoSwatch *from, const MesoPolygonMesh *triangles, int up)
{
    const MesoAttribute *normals = meso_polygon_normals(triangles);
    for (uint32_t h = 0; h < triangles->corner_count; h++) {
        MesoVec3 *sum = &from->normals[from->corners[h]];
        *sum = meso_vec3_add(*sum, turn_up(given_normal(normals, triangles, h), up));
    }
}

static MesoStatus take_uvs(MesoSwatch *from, const uint32_t *source, MesoArena *scratch,
                           const MesoPolygonMesh *triangles, MesoError *error)
{
    const MesoAttribute *uv = meso_polygon_attribute_on(triangles, "uv", MESO_ON_CORNERS);
    if (!uv)
        uv = meso_polygon_attribute_on(triangles, "uv", MESO_ON_VERTICES);
    if (!uv || uv->width < 2)
        return MESO_OK;
    MesoVec2 *at = MESO_NEW(scratch, MesoVec2, triangles->corner_count, error);
    from->uvs = MESO_NEW(scratch, MesoVec2, from->vertex_count, error);
    if (!at || !from->uvs)
        return MESO_ERR_MEMORY;
    for (uint32_t h = 0; h < triangles->corner_count; h++) {
        uint32_t entry = meso_attribute_entry(uv, element_of(uv, triangles, h));
        if (entry != MESO_NO_INDEX)
            at[h] = meso_attribute_vec2(uv, entry);
    }
    for (uint32_t v = 0; v < from->vertex_count; v++)
        from->uvs[v] = at[source[v]];
    for (uint32_t h = 0; h < triangles->corner_count && !from->corner_uvs; h++)
        if (memcmp(&at[h], &from->uvs[from->corners[h]], sizeof *at) != 0)
            from->corner_uvs = at;
    return MESO_OK;
}

/* The arrays by vertices and triangles, not sorted; `edges` are those of `triangles`. */
static MesoStatus gather(MesoSwatch *from, MesoArena *scratch, const MesoPolygonMesh *triangles,
                         const MesoHalfEdges *edges, int up, MesoError *error)
{
    uint32_t *source = MESO_NEW(scratch, uint32_t, triangles->corner_count, error);
    from->corners = MESO_NEW(scratch, uint32_t, triangles->corner_count, error);
    if (!source || !from->corners ||
        number_fans(from->corners, source, &from->vertex_count, scratch, triangles, edges->twin, error))
        return MESO_ERR_MEMORY;
    from->triangle_count = triangles->face_count;
    from->twins = edges->twin;
    from->positions = MESO_NEW(scratch, MesoVec3, from->vertex_count, error);
    from->normals = MESO_NEW(scratch, MesoVec3, from->vertex_count, error);
    from->materials = MESO_NEW(scratch, uint32_t, from->triangle_count, error);
    if (!from->positions || !from->normals || !from->materials)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < from->vertex_count; v++)
        from->positions[v] = turn_up(triangles->positions[triangles->corners[source[v]]], up);
    sum_normals(from, triangles, up);
    return take_uvs(from, source, scratch, triangles, error);
}

/* ---- outward ---- */

/* Six times the volume of the cone from `o` to a triangle. */
static double cone(MesoVec3 o, MesoVec3 a, MesoVec3 b, MesoVec3 c)
{
    MesoAreaVector area = meso_area_between(a, b, c);
    MesoAreaVector to = {(double)a.x - o.x, (double)a.y - o.y, (double)a.z - o.z};
    return meso_area_dot(area, to);
}

static MesoVec3 loop_centre(const MesoSwatch *swatch, uint32_t loop)
{
    double sum[3] = {0, 0, 0};
    uint32_t begin = swatch->loop_begin[loop], end = swatch->loop_begin[loop + 1];
    for (uint32_t i = begin; i < end; i++) {
        MesoVec3 p = swatch->positions[swatch->loop_vertices[i]];
        sum[0] += (double)p.x;
        sum[1] += (double)p.y;
        sum[2] += (double)p.z;
    }
    double n = end - begin;
    return (MesoVec3){(float)(sum[0] / n), (float)(sum[1] / n), (float)(sum[2] / n)};
}

/* Six times the volumes of all elements, with their open ends closed by cones. */
static void sum_volumes(double *volumes, const MesoSwatch *swatch)
{
    for (uint32_t e = 0; e < swatch->element_count; e++)
        for (uint32_t t = swatch->triangle_begin[e]; t < swatch->triangle_begin[e + 1]; t++) {
            const uint32_t *corners = swatch->corners + 3 * (size_t)t;
            volumes[e] += cone(swatch->centres[e], swatch->positions[corners[0]], swatch->positions[corners[1]],
                               swatch->positions[corners[2]]);
        }
    for (uint32_t l = 0; l < swatch->loop_count; l++) {
        MesoVec3 middle = loop_centre(swatch, l);
        uint32_t begin = swatch->loop_begin[l], end = swatch->loop_begin[l + 1];
        uint32_t e = meso_swatch_element(swatch, swatch->loop_vertices[begin]);
        for (uint32_t i = begin; i < end; i++) {
            MesoVec3 a = swatch->positions[swatch->loop_vertices[i]];
            MesoVec3 b = swatch->positions[swatch->loop_vertices[i + 1 < end ? i + 1 : begin]];
            volumes[e] += cone(swatch->centres[e], b, a, middle);
        }
    }
}

/* Half-edge k of a turned triangle was its half-edge 2 - k. */
static uint32_t turned_half_edge(uint32_t h)
{
    return h == MESO_NO_INDEX ? h : h / 3 * 3 + (2 - h % 3);
}

static void turn_element(MesoSwatch *swatch, uint32_t element)
{
    for (uint32_t t = swatch->triangle_begin[element]; t < swatch->triangle_begin[element + 1]; t++) {
        uint32_t *corners = swatch->corners + 3 * (size_t)t, *twins = swatch->twins + 3 * (size_t)t, kept = corners[1];
        corners[1] = corners[2];
        corners[2] = kept;
        kept = twins[0];
        twins[0] = turned_half_edge(twins[2]);
        twins[1] = turned_half_edge(twins[1]);
        twins[2] = turned_half_edge(kept);
        if (swatch->corner_uvs) {
            MesoVec2 *uvs = swatch->corner_uvs + 3 * (size_t)t, uv = uvs[1];
            uvs[1] = uvs[2];
            uvs[2] = uv;
        }
    }
}

/* Sheets enclose nothing, but for rounding: they stay as most of their faces are. */
static MesoStatus turn_outward(MesoSwatch *swatch, bool *turned, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    double *volumes = MESO_NEW(&scratch, double, swatch->element_count, error);
    if (volumes)
        sum_volumes(volumes, swatch);
    for (uint32_t e = 0; volumes && e < swatch->element_count; e++) {
        double reach = (double)swatch->radii[e];
        if (volumes[e] < -1e-6 * reach * reach * reach) {
            turn_element(swatch, e);
            *turned = true;
        }
    }
    meso_arena_release(&scratch);
    return volumes ? MESO_OK : MESO_ERR_MEMORY;
}

/* The normals given, turned to the side to which the faces around look; or the sum of those. */
static MesoStatus finish_normals(MesoSwatch *swatch, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoAreaVector *sums = MESO_NEW(&scratch, MesoAreaVector, swatch->vertex_count, error);
    for (uint32_t h = 0; sums && h < 3 * swatch->triangle_count; h++) {
        const uint32_t *corners = swatch->corners + h / 3 * 3;
        MesoAreaVector area = meso_area_between(swatch->positions[corners[0]], swatch->positions[corners[1]],
                                                swatch->positions[corners[2]]);
        MesoAreaVector *sum = &sums[swatch->corners[h]];
        *sum = (MesoAreaVector){sum->x + area.x, sum->y + area.y, sum->z + area.z};
    }
    for (uint32_t v = 0; sums && v < swatch->vertex_count; v++) {
        double length = sqrt(meso_area_dot(sums[v], sums[v]));
        MesoVec3 face = {0, 0, 1}, given = swatch->normals[v];
        if (length > 0)
            face = (MesoVec3){(float)(sums[v].x / length), (float)(sums[v].y / length), (float)(sums[v].z / length)};
        swatch->normals[v] = meso_vec3_unit(meso_vec3_dot(given, face) < 0 ? meso_vec3_scale(given, -1) : given, face);
    }
    meso_arena_release(&scratch);
    return sums ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- all of it ---- */

static MesoStatus build(MesoSwatch *swatch, MesoArena *arena, const MesoPolygonMesh *mesh,
                        const MesoSwatchOptions *options, MesoArena *scratch, MesoError *error)
{
    MesoPolygonMesh triangles;
    MesoHalfEdges edges;
    MesoSwatch from = {0};
    bool turned = false;
    int up = options->up < 0 ? find_up(mesh) : options->up;
    if (mesh->face_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "a swatch without faces");
    MesoStatus status = make_triangles(&triangles, &edges, scratch, mesh, error);
    if (!status)
        status = gather(&from, scratch, &triangles, &edges, up, error);
    MesoSwatch looks = {0};
    if (!status)
        status = meso_swatch_find_looks(&looks, from.materials, arena, &triangles, error);
    if (!status)
        status = meso_swatch_sort(swatch, arena, &from, error);
    if (status)
        return status;
    swatch->material_count = looks.material_count;
    swatch->looks = looks.looks;
    swatch->material_names = looks.material_names;
    meso_swatch_measure(swatch);
    status = meso_swatch_find_loops(swatch, arena, error);
    if (!status)
        status = turn_outward(swatch, &turned, error);
    if (!status && turned)
        status = meso_swatch_find_loops(swatch, arena, error);
    if (!status)
        status = finish_normals(swatch, error);
    if (!status)
        status = meso_swatch_place(swatch, options, error);
    if (status)
        return status;
    meso_swatch_measure(swatch);
    meso_swatch_find_kinds(swatch);
    return MESO_OK;
}

MesoStatus meso_swatch_build(MesoSwatch *swatch, MesoArena *arena, const MesoPolygonMesh *mesh,
                             const MesoSwatchOptions *options, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    *swatch = (MesoSwatch){0};
    MesoStatus status = build(swatch, arena, mesh, options, &scratch, error);
    meso_arena_release(&scratch);
    return status;
}
