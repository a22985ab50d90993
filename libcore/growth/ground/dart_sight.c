#include "libcore/growth/ground/dart_sight.h"

#include "libcore/growth/ground/seed_places.h"

/* Triangles within a dart's reach, above which fronts are near enough. */
enum { MANY = 1024 };

typedef struct Teller {
    const MesoDartSight *sight;
    void (*view)(void *context, const MesoDartView *view);
    void *context;
} Teller;

/* ---- exactly ---- */

static void lay_corners(const MesoWalkGround *ground, const MesoReachView *seen, MesoDartView *view)
{
    MesoComplex corners[3];
    meso_walk_corners(ground, seen->triangle, corners);
    if (seen->side == 3) {
        for (uint32_t k = 0; k < 3; k++) {
            view->corners[k][0] = corners[k].re - seen->x;
            view->corners[k][1] = corners[k].im - seen->y;
        }
        return;
    }
    uint32_t a = seen->side, b = meso_next_side(a), c = meso_previous_side(a);
    MesoComplex along = {corners[b].re - corners[a].re, corners[b].im - corners[a].im};
    MesoComplex apex = ground->faces[seen->triangle].apexes[a];
    double length = sqrt(along.re * along.re + along.im * along.im);
    view->corners[a][0] = -seen->x;
    view->corners[b][0] = length - seen->x;
    view->corners[c][0] = length * apex.re - seen->x;
    view->corners[a][1] = view->corners[b][1] = seen->y;
    view->corners[c][1] = length * apex.im + seen->y;
}

static void tell_exactly(void *context, const MesoReachView *seen)
{
    const Teller *teller = context;
    bool inside = seen->side == 3;
    MesoDartView view = {.triangle = seen->triangle, .base = seen->base, .side = inside ? 0 : seen->y,
                         .begin = inside ? -INFINITY : seen->begin - seen->x,
                         .end = inside ? INFINITY : seen->end - seen->x};
    lay_corners(teller->sight->ground, seen, &view);
    teller->view(teller->context, &view);
}

/* ---- by fronts ---- */

static MesoStatus begin_fronts(MesoDartSight *sight, MesoError *error)
{
    sight->distance = MESO_NEW(sight->arena, float, sight->mesh->vertex_count, error);
    if (!sight->distance)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < sight->mesh->vertex_count; v++)
        sight->distance[v] = INFINITY;
    return meso_geodesic_init(&sight->solver, sight->mesh, MESO_GEODESIC_FRONTS, error);
}

/* The triangles of which a vertex has the smallest number: each is met once, and only where all corners are reached. */
static void tell_triangles(const Teller *teller, uint32_t vertex)
{
    const MesoDartSight *sight = teller->sight;
    MesoFan fan = meso_fan_first(sight->mesh, vertex);
    uint32_t first = fan.corner;
    do {
        const uint32_t *c = &sight->mesh->corners[3 * (size_t)(fan.corner / 3)];
        if (vertex > c[0] || vertex > c[1] || vertex > c[2])
            continue;
        MesoDartView view = {.triangle = fan.corner / 3, .linear = true};
        for (uint32_t k = 0; k < 3; k++)
            view.corners[k][0] = (double)sight->distance[c[k]];
        if (view.corners[0][0] + view.corners[1][0] + view.corners[2][0] < INFINITY)
            teller->view(teller->context, &view);
    } while (meso_fan_next(sight->mesh, &fan) && fan.corner != first);
}

static MesoStatus tell_by_fronts(MesoDartSight *sight, const Teller *teller, const MesoSurfacePlace *place,
                                 double distance, MesoError *error)
{
    MesoGeodesicSeed seeds[3];
    const uint32_t *touched;
    uint32_t count = 0;
    MesoComplex corners[3];
    meso_walk_corners(sight->ground, place->triangle, corners);
    MesoComplex at = meso_walk_point(corners, place->weight);
    for (uint32_t k = 0; k < 3; k++)
        seeds[k] = (MesoGeodesicSeed){.vertex = sight->mesh->corners[3 * place->triangle + k],
                                      .distance = (float)hypot(corners[k].re - at.re, corners[k].im - at.im)};
    const MesoGeodesicQuery query = {.seeds = seeds, .seed_count = 3, .limit = (float)(distance + sight->longest),
                                     .target = MESO_NO_INDEX, .keep = true};
    MesoStatus status = sight->solver ? MESO_OK : begin_fronts(sight, error);
    if (!status)
        status = meso_geodesic_solve(sight->solver, &query, sight->distance, &touched, &count, error);
    for (uint32_t i = 0; i < count && !status; i++)
        tell_triangles(teller, touched[i]);
    for (uint32_t i = 0; i < count && !status; i++)
        sight->distance[touched[i]] = INFINITY;
    return status;
}

/* ---- looking ---- */

MesoStatus meso_dart_sight_init(MesoDartSight *sight, MesoArena *arena, const MesoTriangulation *mesh,
                                const MesoWalkGround *ground, uint32_t thread_count, MesoError *error)
{
    double area = 0;
    *sight = (MesoDartSight){.mesh = mesh, .ground = ground, .arena = arena};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        area += meso_place_area(mesh, t);
        sight->longest = fmax(sight->longest, ground->lengths[t]);
    }
    /* where triangles are of all sizes, as if they were as large as the longest side says, so that they are small */
    double each = fmax(area / mesh->triangle_count, 0.25 * sight->longest * sight->longest);
    sight->fine = sqrt(MANY * each / MESO_PI);
    return meso_reach_init(&sight->reach, arena, mesh, ground, thread_count, error);
}

void meso_dart_sight_release(MesoDartSight *sight)
{
    meso_geodesic_release(sight->solver);
}

MesoStatus meso_dart_look(MesoDartSight *sight, const MesoSurfacePlace *place, double distance,
                          void (*view)(void *context, const MesoDartView *view), void *context, MesoError *error)
{
    Teller teller = {sight, view, context};
    if (distance > sight->fine)
        return tell_by_fronts(sight, &teller, place, distance, error);
    return meso_reach_tell(sight->reach, place, distance, tell_exactly, &teller, error);
}
