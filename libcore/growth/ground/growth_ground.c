#include "libcore/growth/ground/growth_ground.h"

#include "libcore/base/parallel.h"
#include "libcore/math/box.h"

typedef struct Build {
    MesoGrowthGround *ground;
    const MesoTriangulation *mesh;
} Build;

static MesoVec3 corner_position(const MesoTriangulation *mesh, uint32_t corner)
{
    return mesh->positions[mesh->corners[corner]];
}

/* Of the triangle as it is wound, twice its area long. */
static MesoVec3 area_normal(const MesoTriangulation *mesh, uint32_t triangle)
{
    MesoVec3 a = corner_position(mesh, 3 * triangle), b = corner_position(mesh, 3 * triangle + 1);
    MesoVec3 c = corner_position(mesh, 3 * triangle + 2);
    return meso_vec3_cross(meso_vec3_sub(b, a), meso_vec3_sub(c, a));
}

static float corner_angle(const MesoTriangulation *mesh, uint32_t corner)
{
    MesoVec3 at = corner_position(mesh, corner);
    MesoVec3 a = meso_vec3_sub(corner_position(mesh, meso_next_corner(corner)), at);
    MesoVec3 b = meso_vec3_sub(corner_position(mesh, meso_previous_corner(corner)), at);
    return atan2f(meso_vec3_length(meso_vec3_cross(a, b)), meso_vec3_dot(a, b));
}

static const MesoVec3 UPRIGHT = {0, 0, 1};

/* ---- normals ---- */

static MesoVec3 vertex_normal(const MesoTriangulation *mesh, uint32_t vertex)
{
    MesoVec3 sum = {0, 0, 0};
    MesoFan fan = meso_fan_first(mesh, vertex);
    uint32_t first = fan.corner;
    do {
        MesoVec3 unit = meso_vec3_unit(area_normal(mesh, fan.corner / 3), (MesoVec3){0, 0, 0});
        float angle = corner_angle(mesh, fan.corner);
        sum = meso_vec3_mad(sum, fan.turned ? -angle : angle, unit);
    } while (meso_fan_next(mesh, &fan) && fan.corner != first);
    return meso_vec3_unit(sum, UPRIGHT);
}

static void find_normals(void *context, uint64_t begin, uint64_t end)
{
    const Build *build = context;
    for (uint64_t v = begin; v < end; v++) {
        bool has = build->mesh->vertex_corner[v] != MESO_NO_INDEX;
        build->ground->normals[v] = has ? vertex_normal(build->mesh, (uint32_t)v) : UPRIGHT;
    }
}

/* ---- curvatures ---- */

/*
 * How much the normals of a triangle's corners spread: twice the mean curvature times the area, where normals are
 * linear in it. Without a division, so that slivers do no harm.
 */
static double spread(const Build *build, uint32_t triangle)
{
    const MesoTriangulation *mesh = build->mesh;
    MesoVec3 n = meso_vec3_unit(area_normal(mesh, triangle), (MesoVec3){0, 0, 0});
    double sum = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t corner = 3 * triangle + k;
        MesoVec3 side = meso_vec3_sub(corner_position(mesh, meso_previous_corner(corner)),
                                      corner_position(mesh, meso_next_corner(corner)));
        MesoVec3 normal = build->ground->normals[mesh->corners[corner]];
        bool against = build->ground->against && build->ground->against[triangle] >> k & 1;
        sum += (against ? -0.5 : 0.5) * (double)meso_vec3_dot(normal, meso_vec3_cross(n, side));
    }
    return sum;
}

static float vertex_curvature(const Build *build, uint32_t vertex)
{
    double turns = 0, area = 0;
    MesoFan fan = meso_fan_first(build->mesh, vertex);
    uint32_t first = fan.corner;
    do {
        double part = spread(build, fan.corner / 3);
        turns += fan.turned ? -part : part;
        area += 0.5 * (double)meso_vec3_length(area_normal(build->mesh, fan.corner / 3));
    } while (meso_fan_next(build->mesh, &fan) && fan.corner != first);
    double mean = 0.5 * turns / area;
    return isfinite(mean) && fabs(mean) < (double)HUGE_VALF ? (float)mean : 0;
}

static void find_curvatures(void *context, uint64_t begin, uint64_t end)
{
    const Build *build = context;
    for (uint64_t v = begin; v < end; v++)
        if (build->mesh->vertex_corner[v] != MESO_NO_INDEX)
            build->ground->curvatures[v] = vertex_curvature(build, (uint32_t)v);
}

/* ---- windings ---- */

static bool is_wound_alike(const MesoWalkGround *walk)
{
    for (uint32_t t = 0; t < walk->triangle_count; t++)
        if (walk->faces[t].marks & 7)
            return false;
    return true;
}

/* A vertex's normal is that of the triangle in which meso_fan_first() begins. */
static MesoStatus find_windings(MesoGrowthGround *ground, MesoArena *arena, MesoError *error)
{
    if (is_wound_alike(&ground->walk))
        return MESO_OK;
    ground->against = MESO_NEW(arena, uint8_t, ground->mesh->triangle_count, error);
    if (!ground->against)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < ground->mesh->vertex_count; v++) {
        if (ground->mesh->vertex_corner[v] == MESO_NO_INDEX)
            continue;
        MesoFan fan = meso_fan_first(ground->mesh, v);
        uint32_t first = fan.corner;
        do {
            if (fan.turned)
                ground->against[fan.corner / 3] |= (uint8_t)(1u << fan.corner % 3);
        } while (meso_fan_next(ground->mesh, &fan) && fan.corner != first);
    }
    return MESO_OK;
}

/* ---- planes ---- */

static MesoFour four_of(MesoVec3 a)
{
    return (MesoFour){a.x, a.y, a.z, 0};
}

static MesoGrowthFlat flat_of(const MesoTriangulation *mesh, const MesoVec3 *normals, uint32_t triangle)
{
    const uint32_t *c = &mesh->corners[3 * (size_t)triangle];
    MesoVec3 a = mesh->positions[c[0]], along = meso_vec3_sub(mesh->positions[c[1]], a);
    MesoVec3 over = meso_vec3_sub(mesh->positions[c[2]], a), normal = meso_vec3_cross(along, over);
    float square = meso_vec3_dot(normal, normal), inverse = square > 0 ? 1 / square : 0;
    bool agrees = square > 0;
    for (uint32_t k = 0; k < 3; k++)
        agrees &= meso_vec3_dot(normal, normals[c[k]]) > 0;
    return (MesoGrowthFlat){four_of(a), four_of(meso_vec3_scale(normal, agrees ? sqrtf(inverse) : 0)),
                            four_of(meso_vec3_scale(meso_vec3_cross(over, normal), inverse)),
                            four_of(meso_vec3_scale(meso_vec3_cross(normal, along), inverse))};
}

static void find_flats(void *context, uint64_t begin, uint64_t end)
{
    const Build *build = context;
    for (uint64_t t = begin; t < end; t++)
        build->ground->flats[t] = flat_of(build->mesh, build->ground->normals, (uint32_t)t);
}

/* ---- building ---- */

static double along(MesoVec3 up, MesoVec3 p)
{
    return (double)up.x * p.x + (double)up.y * p.y + (double)up.z * p.z;
}

static void measure(MesoGrowthGround *ground)
{
    const MesoTriangulation *mesh = ground->mesh;
    MesoBox box = meso_box_empty();
    ground->bottom = INFINITY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (mesh->vertex_corner[v] == MESO_NO_INDEX)
            continue;
        meso_box_add(&box, mesh->positions[v]);
        ground->bottom = fmin(ground->bottom, along(ground->up, mesh->positions[v]));
    }
    bool empty = !(box.low.x <= box.high.x);
    double x = (double)box.high.x - box.low.x, y = (double)box.high.y - box.low.y, z = (double)box.high.z - box.low.z;
    ground->extent = empty ? 0 : sqrt(x * x + y * y + z * z);
    ground->bottom = empty ? 0 : ground->bottom;
}

MesoStatus meso_growth_ground_build(MesoGrowthGround *ground, MesoArena *arena, const MesoTriangulation *mesh,
                                    MesoVec3 up, uint32_t thread_count, MesoError *error)
{
    *ground = (MesoGrowthGround){.mesh = mesh, .up = meso_vec3_unit(up, UPRIGHT)};
    ground->normals = MESO_NEW(arena, MesoVec3, mesh->vertex_count, error);
    ground->curvatures = MESO_NEW(arena, float, mesh->vertex_count, error);
    ground->flats = MESO_NEW(arena, MesoGrowthFlat, mesh->triangle_count, error);
    if (!ground->normals || !ground->curvatures || !ground->flats)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_walk_ground_build(&ground->walk, arena, mesh, NULL, thread_count, error);
    if (!status)
        status = find_windings(ground, arena, error);
    if (status)
        return status;
    Build build = {ground, mesh};
    meso_parallel_for(thread_count, mesh->vertex_count, 4096, find_normals, &build);
    meso_parallel_for(thread_count, mesh->vertex_count, 4096, find_curvatures, &build);
    meso_parallel_for(thread_count, mesh->triangle_count, 4096, find_flats, &build);
    measure(ground);
    return MESO_OK;
}

/* ---- at a point ---- */

MesoVec3 meso_growth_position(const MesoGrowthGround *ground, uint32_t triangle, const double weight[3])
{
    double at[3];
    MesoTip tip = {.triangle = triangle, .weight = {weight[0], weight[1], weight[2]}};
    meso_tip_position(ground->mesh, &tip, at);
    return (MesoVec3){(float)at[0], (float)at[1], (float)at[2]};
}

/* Of a corner's numbers, as a share of its own: less than 0 where they count the other way. */
static float share_of_corner(const MesoGrowthGround *ground, uint32_t triangle, uint32_t k, double weight, bool turned)
{
    bool against = ground->against && ground->against[triangle] >> k & 1;
    return (float)(against != turned ? -weight : weight);
}

MesoVec3 meso_growth_normal(const MesoGrowthGround *ground, uint32_t triangle, const double weight[3], bool turned)
{
    MesoVec3 sum = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        sum = meso_vec3_mad(sum, share_of_corner(ground, triangle, k, weight[k], turned),
                            ground->normals[ground->mesh->corners[3 * (size_t)triangle + k]]);
    float length = meso_vec3_length(sum);
    if (length > 1e-6f)
        return meso_vec3_scale(sum, 1 / length);
    MesoVec3 flat = meso_vec3_unit(area_normal(ground->mesh, triangle), UPRIGHT);
    return turned ? meso_vec3_scale(flat, -1) : flat;
}

double meso_growth_curvature(const MesoGrowthGround *ground, uint32_t triangle, const double weight[3], bool turned)
{
    double sum = 0;
    for (uint32_t k = 0; k < 3; k++)
        sum += (double)share_of_corner(ground, triangle, k, weight[k], turned) *
               (double)ground->curvatures[ground->mesh->corners[3 * (size_t)triangle + k]];
    return sum;
}
