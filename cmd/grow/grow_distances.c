/* Distances along the surface, from borders and from what files hold; and the places that seeds have of files. */
#include <math.h>

#include "cmd/grow/grow_sources.h"
#include "formats/decor/curve_file.h"
#include "formats/mesh/point_file.h"
#include "libcore/base/grow.h"
#include "libcore/geodesic/geodesic.h"
#include "libcore/growth/ground/growth_snap.h"

/* ---- points of files ---- */

static MesoStatus read_points(MesoGrowSources *s, const char *file, bool curve, MesoGrowPoints *points)
{
    MesoTool *tool = s->tool;
    MesoInput input;
    MesoCurves curves = {0};
    MesoStatus status = meso_grow_source_open(s, &input, file, curve ? "curve" : "points");
    if (status)
        return status;
    status = curve ? meso_curves_read(&curves, &tool->arena, &input, &tool->error)
                   : meso_points_read(&curves.points, &curves.count, &tool->arena, &input, &tool->error);
    meso_input_close(&input);
    *points = (MesoGrowPoints){.count = curves.count, .corners = curves.points, .breaks = curves.breaks};
    return status;
}

static MesoStatus snap(MesoGrowSources *s, const MesoVec3 *corners, uint32_t count, MesoMeshPoint **points)
{
    MesoTool *tool = s->tool;
    *points = MESO_NEW(&tool->arena, MesoMeshPoint, count, &tool->error);
    if (!*points)
        return MESO_ERR_MEMORY;
    return meso_growth_snap(s->ground->mesh, &tool->arena, corners, count, *points, tool->threads, &tool->error);
}

MesoStatus meso_grow_points(MesoGrowSources *s, const char *file, bool curve, MesoGrowPoints *points)
{
    MesoStatus status = read_points(s, file, curve, points);
    return status ? status : snap(s, points->corners, points->count, &points->points);
}

/* ---- seeds of distances ---- */

typedef struct Seeds {
    MesoGeodesicSeed *seeds;    /* [count] */
    uint32_t count, room;
} Seeds;

static MesoStatus add_seed(MesoGrowSources *s, Seeds *seeds, MesoGeodesicSeed seed)
{
    MesoTool *tool = s->tool;
    seeds->seeds = MESO_GROW(&tool->arena, seeds->seeds, seeds->count, seeds->room, 256, &tool->error);
    if (!seeds->seeds)
        return MESO_ERR_MEMORY;
    seeds->seeds[seeds->count++] = seed;
    return MESO_OK;
}

/* The corners of a point's triangle, from as far as they are. */
static MesoStatus add_point(MesoGrowSources *s, Seeds *seeds, const MesoMeshPoint *point)
{
    const MesoTriangulation *mesh = s->ground->mesh;
    double weight[3] = {(double)point->weight[0], (double)point->weight[1], (double)point->weight[2]};
    MesoVec3 at = meso_growth_position(s->ground, point->triangle, weight);
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 3 && !status; k++) {
        uint32_t v = mesh->corners[3 * point->triangle + k];
        float far = meso_vec3_length(meso_vec3_sub(mesh->positions[v], at));
        status = add_seed(s, seeds, (MesoGeodesicSeed){.vertex = v, .distance = far});
    }
    return status;
}

static MesoStatus add_borders(MesoGrowSources *s, Seeds *seeds)
{
    const MesoTriangulation *mesh = s->ground->mesh;
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < 6 * mesh->triangle_count && !status; i++) {
        uint32_t h = i / 2, corner = i % 2 ? meso_next_corner(h) : h;
        if (mesh->twins[h] == MESO_NO_INDEX)
            status = add_seed(s, seeds, (MesoGeodesicSeed){.vertex = mesh->corners[corner], .line = true});
    }
    if (!status && seeds->count == 0)
        return meso_grow_source_fail(s, MESO_ERR_INPUT, "the surface has no border");
    return status;
}

/* Half as long as the triangles' sides are. */
static double fineness(const MesoGrowSources *s)
{
    const MesoWalkGround *walk = &s->ground->walk;
    double sum = 0;
    for (uint32_t t = 0; t < walk->triangle_count; t++)
        sum += walk->lengths[t];
    return 0.5 * sum / walk->triangle_count;
}

enum { MOST_SAMPLES = 1 << 22 };

/* Points so near to each other that the curve between them does not matter. */
static MesoStatus sample_curve(MesoGrowSources *s, const MesoGrowPoints *curve, MesoVec3 **samples, uint32_t *count)
{
    MesoTool *tool = s->tool;
    double step = fineness(s);
    uint32_t room = 0;
    *samples = NULL;
    *count = 0;
    for (uint32_t i = 0; i < curve->count; i++) {
        MesoVec3 from = curve->corners[i > 0 ? i - 1 : 0], to = curve->corners[i];
        bool begins = i == 0 || (curve->breaks && curve->breaks[i]);
        double length = begins ? 0 : (double)meso_vec3_length(meso_vec3_sub(to, from));
        double parts = step > 0 ? fmin(ceil(length / step), MOST_SAMPLES) : 1;
        for (uint32_t k = 1; k <= (uint32_t)fmax(parts, 1) && *count < MOST_SAMPLES; k++) {
            *samples = MESO_GROW(&tool->arena, *samples, *count, room, 256, &tool->error);
            if (!*samples)
                return MESO_ERR_MEMORY;
            (*samples)[(*count)++] = meso_vec3_lerp(from, to, (float)(k / fmax(parts, 1)));
        }
    }
    return MESO_OK;
}

static MesoStatus add_file(MesoGrowSources *s, Seeds *seeds)
{
    bool curve = s->source->kind == MESO_MAP_CURVE;
    MesoGrowPoints points;
    MesoVec3 *samples;
    uint32_t count;
    MesoStatus status = read_points(s, s->source->values[0].text, curve, &points);
    if (!status)
        status = sample_curve(s, &points, &samples, &count);
    if (!status && !curve)
        count = points.count;
    if (!status)
        status = snap(s, curve ? samples : points.corners, count, &points.points);
    for (uint32_t i = 0; !status && i < count; i++)
        status = add_point(s, seeds, &points.points[i]);
    return status;
}

/* ---- maps ---- */

/* Where no path leads, as far as anything is, or the surface is large. */
static void fill_gaps(const MesoGrowSources *s, float *distance)
{
    uint32_t count = s->ground->mesh->vertex_count;
    float most = (float)s->ground->extent;
    for (uint32_t v = 0; v < count; v++)
        most = distance[v] < INFINITY && distance[v] > most ? distance[v] : most;
    for (uint32_t v = 0; v < count; v++)
        distance[v] = distance[v] < INFINITY ? distance[v] : most;
}

MesoStatus meso_grow_map_distance(MesoGrowSources *s, MesoGrowthMap *map)
{
    MesoTool *tool = s->tool;
    MesoGeodesicSolver *solver = NULL;
    Seeds seeds = {0};
    float *distance = MESO_NEW(&tool->arena, float, s->ground->mesh->vertex_count, &tool->error);
    MesoStatus status = distance ? MESO_OK : MESO_ERR_MEMORY;
    if (!status)
        status = s->source->kind == MESO_MAP_BORDER ? add_borders(s, &seeds) : add_file(s, &seeds);
    if (!status)
        status = meso_geodesic_init(&solver, s->ground->mesh, MESO_GEODESIC_FRONTS, &tool->error);
    const MesoGeodesicQuery query = {.seeds = seeds.seeds, .seed_count = seeds.count, .target = MESO_NO_INDEX};
    if (!status)
        status = meso_geodesic_solve(solver, &query, distance, NULL, NULL, &tool->error);
    meso_geodesic_release(solver);
    if (!status)
        fill_gaps(s, distance);
    map->domain = MESO_GROWTH_BY_VERTEX;
    map->values = distance;
    return status;
}
