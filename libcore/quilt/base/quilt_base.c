#include "libcore/quilt/base/quilt_base.h"

#include <string.h>

#include "libcore/quilt/base/base_border.h"

void meso_quilt_base_release(MesoQuiltBase *base)
{
    meso_triangulation_release(&base->mesh);
    *base = (MesoQuiltBase){0};
}

static bool has_border(const MesoTriangulation *mesh)
{
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->twins[h] == MESO_NO_INDEX)
            return true;
    return false;
}

/* ---- inside ---- */

static float distance_to_side(const MesoTriangulation *mesh, uint32_t vertex, uint32_t h)
{
    MesoVec3 a = mesh->positions[mesh->corners[h]], b = mesh->positions[mesh->corners[meso_next_corner(h)]];
    MesoVec3 side = meso_vec3_sub(b, a), p = meso_vec3_sub(mesh->positions[vertex], a);
    float square = meso_vec3_dot(side, side), share = square > 0 ? meso_vec3_dot(p, side) / square : 0;
    share = fminf(fmaxf(share, 0), 1);
    return meso_vec3_length(meso_vec3_mad(p, -share, side));
}

/* Vertices next to a vertex on the border come no nearer to it than its two sides along the border. */
static void lower_around(float *inside, const MesoTriangulation *mesh, uint32_t border_side)
{
    MesoFan fan = meso_fan_first(mesh, mesh->corners[border_side]);
    do {
        for (uint32_t k = 1, c = fan.corner; k < 3; k++) {
            c = meso_next_corner(c);
            uint32_t v = mesh->corners[c];
            inside[v] = fminf(inside[v], distance_to_side(mesh, v, border_side));
        }
    } while (meso_fan_next(mesh, &fan));
}

/*
 * Its sign alone is exact, and it is linear in each triangle: distance from the border for the vertices next to it,
 * `edge` for those further inside. Before the extension. `inside` [vertex_count].
 */
static void measure_inside(float *inside, const MesoTriangulation *mesh, float edge)
{
    uint32_t count = 3 * mesh->triangle_count;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        inside[v] = edge;
    for (uint32_t h = 0; h < count; h++)
        if (mesh->twins[h] == MESO_NO_INDEX) {
            lower_around(inside, mesh, h);
            uint32_t apex = mesh->corners[meso_previous_corner(h)];
            inside[apex] = fminf(inside[apex], distance_to_side(mesh, apex, h));
        }
    /* triangles of no area, too, have an inside */
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        inside[v] = fmaxf(inside[v], 1e-6f * edge);
    for (uint32_t h = 0; h < count; h++)
        if (mesh->twins[h] == MESO_NO_INDEX)
            inside[mesh->corners[h]] = inside[mesh->corners[meso_next_corner(h)]] = 0;
}

static MesoStatus extend(MesoQuiltBase *base, MesoBaseMesh *work, MesoArena *arena, const MesoTriangulation *original,
                         float edge, float reach, MesoError *error)
{
    if (!has_border(&work->mesh))
        return MESO_OK;
    MesoStatus status = meso_base_free_borders(work, error);
    if (status)
        return status;
    uint32_t first = work->mesh.vertex_count;
    float *inside = base->inside = MESO_NEW(arena, float, first, error);
    if (!inside)
        return MESO_ERR_MEMORY;
    measure_inside(inside, &work->mesh, edge);
    if (reach <= 0)
        return MESO_OK;
    float *depths;
    status = meso_base_extend(work, &depths, arena, original, edge, reach, error);
    if (status)
        return status;
    base->inside = depths;
    memcpy(base->inside, inside, first * sizeof *inside);
    for (uint32_t v = first; v < work->mesh.vertex_count; v++)
        base->inside[v] = -depths[v];
    return MESO_OK;
}

/* ---- what is carried over ---- */

static MesoStatus carry_places(MesoQuiltBase *base, const MesoBaseMesh *work, MesoArena *arena, MesoError *error)
{
    size_t count = work->mesh.triangle_count;
    base->triangles = MESO_NEW(arena, uint32_t, count, error);
    base->corner_weights = MESO_NEW(arena, MesoVec2, 3 * count, error);
    if (!base->triangles || !base->corner_weights)
        return MESO_ERR_MEMORY;
    memcpy(base->triangles, work->triangles, count * sizeof *base->triangles);
    memcpy(base->corner_weights, work->corner_weights, 3 * count * sizeof *base->corner_weights);
    return MESO_OK;
}

static MesoStatus carry_guide(MesoQuiltBase *base, const MesoBaseMesh *work, MesoArena *arena, const MesoVec3 *guide,
                              MesoError *error)
{
    const MesoTriangulation *mesh = &work->mesh;
    base->guide = MESO_NEW(arena, MesoVec3, mesh->triangle_count, error);
    if (!base->guide)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corner = &mesh->corners[3 * (size_t)t];
        MesoVec3 a = mesh->positions[corner[0]], wanted = guide[work->triangles[t]];
        MesoVec3 area = meso_vec3_cross(meso_vec3_sub(mesh->positions[corner[1]], a),
                                        meso_vec3_sub(mesh->positions[corner[2]], a));
        MesoVec3 normal = meso_vec3_direction(area, (MesoVec3){0, 0, 0});
        MesoVec3 flat = meso_vec3_mad(wanted, -meso_vec3_dot(wanted, normal), normal);
        base->guide[t] = meso_vec3_unit(flat, wanted);
    }
    return MESO_OK;
}

MesoStatus meso_quilt_base_build(MesoQuiltBase *base, MesoArena *arena, const MesoTriangulation *original,
                                 const MesoVec3 *guide, float edge, float reach, MesoError *error)
{
    *base = (MesoQuiltBase){0};
    MesoBaseMesh work;
    MesoStatus status = meso_base_mesh_copy(&work, original, error);
    if (status)
        return status;
    status = meso_base_refine(&work, edge, error);
    if (!status)
        status = extend(base, &work, arena, original, edge, reach, error);
    if (!status)
        status = carry_places(base, &work, arena, error);
    if (!status && guide)
        status = carry_guide(base, &work, arena, guide, error);
    if (!status) {
        base->mesh = work.mesh;
        work.mesh = (MesoTriangulation){0};
    } else {
        *base = (MesoQuiltBase){0};
    }
    meso_base_mesh_release(&work);
    return status;
}
