#include "libcore/decor/border_chains.h"
#include "libcore/decor/operators.h"
#include "libcore/mesh/point/surface_point.h"
#include "libcore/geodesic/exact/geodesic_path.h"

/* A weight above this is a vertex, below it none at all. */
static const float NEARLY_ONE = 1 - 1e-5f, NEARLY_NONE = 1e-5f;

static MesoCutNode node_of(const MesoTriangulation *mesh, const MesoMeshPoint *point)
{
    uint32_t first = 3 * point->triangle;
    for (uint32_t k = 0; k < 3; k++)
        if (point->weight[k] >= NEARLY_ONE)
            return (MesoCutNode){MESO_AT_VERTEX, mesh->corners[first + k], {0}};
    for (uint32_t k = 0; k < 3; k++)
        if (point->weight[k] <= NEARLY_NONE) {
            uint32_t side = (k + 1) % 3, end = (k + 2) % 3;
            float sum = point->weight[side] + point->weight[end];
            return (MesoCutNode){MESO_ON_EDGE, first + side, {point->weight[end] / sum}};
        }
    return (MesoCutNode){MESO_IN_TRIANGLE, point->triangle, {point->weight[1], point->weight[2]}};
}

/* The vertex of the border nearest to a point in space; false where there is no border. */
static bool nearest_on_border(const MesoTriangulation *mesh, const MesoBorderLoops *loops, MesoVec3 p,
                              MesoCutNode *node)
{
    float least = INFINITY;
    for (uint32_t i = 0; i < loops->side_count; i++) {
        float distance = meso_vec3_length(meso_vec3_sub(mesh->positions[loops->vertices[i]], p));
        if (distance < least) {
            least = distance;
            *node = (MesoCutNode){MESO_AT_VERTEX, loops->vertices[i], {0}};
        }
    }
    return least < INFINITY;
}

static MesoStatus place_points(MesoSplit *split, const MesoDomain *domain, MesoCutNode *nodes, MesoError *error)
{
    MesoDecorWork *work = split->work;
    const MesoTriangulation *mesh = &work->decor->mesh;
    const MesoStep *step = split->step;
    MesoBorderChains chains;
    MesoStatus status = meso_border_chains(work, domain, MESO_SEED_BORDERS, NULL, &chains, error);
    for (uint32_t i = 0; i < step->point_count && !status; i++) {
        MesoVec3 p = step->points[i].point;
        if (step->points[i].kind == MESO_SEED_FACE)
            status = meso_decor_face_point(work, &step->points[i], &p, error);
        bool end = !step->closed && (i == 0 || i + 1 == step->point_count);
        MesoMeshPoint point = meso_surface_point(mesh, domain, p);
        /* only between borders does an open line divide anything: its ends are drawn to them */
        if (!status && !(end && nearest_on_border(mesh, &chains.loops, p, &nodes[i])))
            nodes[i] = node_of(mesh, &point);
    }
    return status;
}

MesoStatus meso_decor_polyline(MesoSplit *split, MesoSplitTarget *target, const MesoDomain *domain, MesoError *error)
{
    MesoDecorWork *work = split->work;
    const MesoStep *step = split->step;
    MesoCutNode *nodes = MESO_NEW(work->scratch, MesoCutNode, step->point_count, error);
    MesoStatus status = nodes ? place_points(split, domain, nodes, error) : MESO_ERR_MEMORY;
    uint32_t parts = step->closed ? step->point_count : step->point_count - 1;
    for (uint32_t i = 0; i < parts && !status; i++) {
        MesoCutNode from = nodes[i], to = nodes[(i + 1) % step->point_count];
        MesoGeodesicPath path;
        if (from.kind == to.kind && from.element == to.element && from.share[0] == to.share[0] &&
            from.share[1] == to.share[1])
            continue;
        status = meso_geodesic_path(&work->decor->mesh, domain, from, to, i, work->scratch, &split->lines, &path,
                                    error);
        if (status == MESO_ERR_NO) {
            target->idle = "its points are on parts that are not joined";
            status = MESO_OK;
        }
    }
    return status;
}
