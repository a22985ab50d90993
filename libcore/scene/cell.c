#include "libcore/scene/cell.h"

#include <math.h>

#include "libcore/math/bezier.h"
#include "libcore/math/box.h"

/* Of a side, in edges of the cell: what modellers and matrices leave of 0 and 1. */
static const float SIDE_SLACK = 1e-6f;

MesoVec3 meso_cell_point(const MesoCage *cage, MesoVec3 p)
{
    return meso_cage_blend(cage, p.x, p.y, p.z / MESO_CELL_HEIGHT);
}

static bool is_whole(float x)
{
    return fabsf(x) <= SIDE_SLACK || fabsf(x - 1) <= SIDE_SLACK;
}

MesoVec3 meso_cell_body_point(const MesoCage *cage, MesoVec3 p)
{
    bool x_whole = is_whole(p.x), y_whole = is_whole(p.y);
    if (x_whole || y_whole)
        p = (MesoVec3){x_whole ? rintf(p.x) : meso_cell_round(p.x), y_whole ? rintf(p.y) : meso_cell_round(p.y),
                       meso_cell_round(p.z)};
    return meso_cell_point(cage, p);
}

/* ---- derivatives ---- */

/* F_x, F_y and F_z. */
static void derive(const MesoCage *cage, MesoVec3 at, MesoVec3 d[3])
{
    MesoVec3 p[4], *rise = d + 2;
    float height = cage->low + (cage->high - cage->low) * at.z / MESO_CELL_HEIGHT;
    for (uint32_t i = 0; i < 4; i++)
        p[i] = meso_vec3_mad(cage->base[i], height, cage->rise[i]);
    d[0] = meso_vec3_lerp(meso_vec3_sub(p[0], p[3]), meso_vec3_sub(p[1], p[2]), at.y);
    d[1] = meso_vec3_lerp(meso_vec3_sub(p[2], p[3]), meso_vec3_sub(p[1], p[0]), at.x);
    *rise = meso_vec3_lerp(meso_vec3_lerp(cage->rise[3], cage->rise[0], at.x),
                           meso_vec3_lerp(cage->rise[2], cage->rise[1], at.x), at.y);
    *rise = meso_vec3_scale(*rise, (cage->high - cage->low) / MESO_CELL_HEIGHT);
}

void meso_cell_bend(const MesoCage *cage, MesoMeshVertex *vertices, uint64_t count)
{
    for (uint64_t i = 0; i < count; i++) {
        MesoVec3 d[3], n = vertices[i].normal;
        derive(cage, vertices[i].position, d);
        MesoVec3 x = meso_vec3_cross(d[1], d[2]), y = meso_vec3_cross(d[2], d[0]), z = meso_vec3_cross(d[0], d[1]);
        MesoVec3 bent = meso_vec3_mad(meso_vec3_mad(meso_vec3_scale(x, n.x), n.y, y), n.z, z);
        vertices[i].normal = meso_vec3_direction(bent, n);
        vertices[i].position = meso_cell_point(cage, vertices[i].position);
    }
}

/* The largest sum of a row of the products of all pairs is not below the square of the norm. */
static float norm_of(const MesoVec3 d[3])
{
    float square = 0;
    for (uint32_t i = 0; i < 3; i++) {
        float row = 0;
        for (uint32_t k = 0; k < 3; k++)
            row += fabsf(meso_vec3_dot(d[i], d[k]));
        square = fmaxf(square, row);
    }
    return sqrtf(square);
}

static float distance(MesoVec3 a, MesoVec3 b)
{
    return meso_vec3_length(meso_vec3_sub(a, b));
}

/* Second derivatives are F_xy, F_yz and F_xz alone; along a unit vector each counts twice the product of two parts. */
MesoCellStretch meso_cell_stretch(const MesoCage *cage)
{
    MesoCellStretch stretch = {0, 0};
    MesoVec3 d[8][3];
    for (uint32_t i = 0; i < 8; i++) {
        derive(cage, (MesoVec3){(float)(i & 1), (float)(i >> 1 & 1), MESO_CELL_HEIGHT * (float)(i >> 2)}, d[i]);
        stretch.most = fmaxf(stretch.most, norm_of(d[i]));
    }
    float xy = fmaxf(distance(d[0][0], d[2][0]), distance(d[4][0], d[6][0]));
    float xz = fmaxf(distance(d[0][0], d[4][0]), distance(d[2][0], d[6][0])) / MESO_CELL_HEIGHT;
    float yz = fmaxf(distance(d[0][1], d[4][1]), distance(d[1][1], d[5][1])) / MESO_CELL_HEIGHT;
    stretch.bend = xy + xz + yz;
    return stretch;
}

MesoCellStretch meso_kind_stretch(const MesoScene *scene, const MesoSweptKind *kind)
{
    MesoCellStretch stretch = {1, 0};
    if (scene->deform == MESO_SWEEP_CURVES)
        return stretch;
    stretch.most = 0;
    for (uint32_t i = 0; i < kind->instance_count; i++) {
        MesoCellStretch own = meso_cell_stretch(&scene->cages[scene->sweeps[kind->instance_begin + i].cage]);
        stretch = (MesoCellStretch){fmaxf(stretch.most, own.most), fmaxf(stretch.bend, own.bend)};
    }
    return stretch;
}

/* ---- sweeps ---- */

static MesoVec3 along(const MesoVec3 d[3], MesoVec3 v)
{
    return meso_vec3_mad(meso_vec3_mad(meso_vec3_scale(d[0], v.x), v.y, d[1]), v.z, d[2]);
}

void meso_sweep_trajectory(const MesoScene *scene, const MesoSweepInstance *sweep, MesoVec3 p[4])
{
    for (uint32_t i = 0; i < 4; i++)
        p[i] = sweep->p[i];
    if (scene->deform == MESO_SWEEP_CURVES)
        return;
    const MesoCage *cage = &scene->cages[sweep->cage];
    for (uint32_t end = 0; end < 2; end++) {
        uint32_t at = 3 * end, beside = 1 + end;
        MesoVec3 d[3];
        derive(cage, sweep->p[at], d);
        p[at] = meso_cell_point(cage, sweep->p[at]);
        p[beside] = meso_vec3_add(p[at], along(d, meso_vec3_sub(sweep->p[beside], sweep->p[at])));
    }
}

float meso_sweep_growth(const MesoScene *scene, const MesoSweepInstance *sweep, bool at_end)
{
    if (scene->deform == MESO_SWEEP_CURVES)
        return 1;
    MesoVec3 d[3], y = meso_vec3_direction(sweep->up[at_end], (MesoVec3){0, 0, 1});
    derive(&scene->cages[sweep->cage], sweep->p[at_end ? 3 : 0], d);
    MesoVec3 x = meso_vec3_cross(y, sweep->direction[at_end]), a = along(d, x), b = along(d, y);
    MesoVec3 none = {0, 0, 0}, sine = meso_vec3_cross(meso_vec3_direction(a, none), meso_vec3_direction(b, none));
    return sqrtf(meso_vec3_length(a)) * sqrtf(meso_vec3_length(b)) * sqrtf(meso_vec3_length(sine));
}

MesoVec3 meso_sweep_middle(const MesoScene *scene, const MesoSweepInstance *sweep, float v)
{
    MesoVec3 p = meso_bezier_point(sweep->p, v);
    return scene->deform == MESO_SWEEP_CURVES ? p : meso_cell_point(&scene->cages[sweep->cage], p);
}

MesoSweepHull meso_sweep_hull(const MesoScene *scene, const MesoSweepInstance *sweep, float radius)
{
    MesoSweepHull hull = {.count = 4, .reach = radius};
    if (scene->deform == MESO_SWEEP_CURVES) {
        for (uint32_t i = 0; i < 4; i++)
            hull.points[i] = sweep->p[i];
        return hull;
    }
    MesoBox box = meso_box_empty();
    for (uint32_t i = 0; i < 4; i++)
        meso_box_add_around(&box, sweep->p[i], radius);
    hull.count = 8;
    hull.reach = 0;
    for (uint32_t i = 0; i < 8; i++)
        hull.points[i] = meso_cell_point(&scene->cages[sweep->cage], meso_box_corner(box.low, box.high, i));
    return hull;
}

MesoCage *meso_cages_from(const MesoScene *scene, MesoVec3 origin, MesoArena *arena, MesoError *error)
{
    MesoCage *moved = MESO_NEW(arena, MesoCage, scene->cage_count, error);
    for (uint32_t c = 0; moved && c < scene->cage_count; c++) {
        moved[c] = scene->cages[c];
        for (uint32_t i = 0; i < 4; i++)
            moved[c].base[i] = meso_vec3_sub(moved[c].base[i], origin);
    }
    return moved;
}
