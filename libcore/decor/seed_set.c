#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/decor/border_chains.h"
#include "libcore/mesh/point/surface_point.h"

/* A set being filled in one region. */
typedef struct Seeding {
    MesoDecorWork *work;
    uint32_t region;
    const MesoDomain *domain;
    MesoSeeds *seeds;
    MesoError *error;
} Seeding;

static MesoStatus add_seed(Seeding *s, MesoGeodesicSeed seed)
{
    MesoSeeds *seeds = s->seeds;
    seeds->seeds = MESO_GROW(s->work->scratch, seeds->seeds, seeds->count, seeds->room, 64, s->error);
    if (!seeds->seeds)
        return MESO_ERR_MEMORY;
    seeds->seeds[seeds->count++] = seed;
    return MESO_OK;
}

static MesoStatus add_chains(Seeding *s, const MesoSeedSpec *spec)
{
    MesoBorderChains chains;
    MesoStatus status = meso_border_chains(s->work, s->domain, spec->kind, spec, &chains, s->error);
    for (uint32_t c = 0; c < chains.count && !status; c++) {
        const MesoEdgeChain *chain = &chains.chains[c];
        for (uint32_t i = 0; i < chain->count && !status; i++)
            status = add_seed(s, (MesoGeodesicSeed){.vertex = chain->vertices[i], .line = true});
        if (!status && !chain->closed) {
            uint32_t h = chain->half_edges[chain->count - 1], begin = s->work->decor->mesh.corners[h];
            uint32_t end = s->work->decor->mesh.corners[meso_next_corner(h)];
            end = end == chain->vertices[chain->count - 1] ? begin : end;
            status = add_seed(s, (MesoGeodesicSeed){.vertex = end, .line = true});
        }
    }
    return status;
}

/* A point inside a triangle is seen from its three corners along straight lines. */
static MesoStatus add_point(Seeding *s, const MesoMeshPoint *point)
{
    const MesoTriangulation *mesh = &s->work->decor->mesh;
    const uint32_t *corners = &mesh->corners[3 * (size_t)point->triangle];
    MesoVec3 p = {0, 0, 0};
    MesoSeeds *seeds = s->seeds;
    seeds->point_list = MESO_GROW(s->work->scratch, seeds->point_list, seeds->point_count, seeds->point_room, 64,
                                  s->error);
    if (!seeds->point_list)
        return MESO_ERR_MEMORY;
    seeds->point_list[seeds->point_count++] = *point;
    for (int k = 0; k < 3; k++)
        p = meso_vec3_add(p, meso_vec3_scale(mesh->positions[corners[k]], point->weight[k]));
    for (int k = 0; k < 3; k++)
        if (point->weight[k] >= 1)
            return add_seed(s, (MesoGeodesicSeed){.vertex = corners[k]});
    MesoStatus status = MESO_OK;
    for (int k = 0; k < 3 && !status; k++) {
        float distance = meso_vec3_length(meso_vec3_sub(mesh->positions[corners[k]], p));
        status = add_seed(s, (MesoGeodesicSeed){.vertex = corners[k], .distance = distance});
    }
    return status;
}

/* A vertex as a point of a triangle of the domain; false where it has none there. */
static bool vertex_point(const MesoTriangulation *mesh, const MesoDomain *domain, uint32_t vertex, MesoMeshPoint *point)
{
    MesoFan fan = meso_fan_first(mesh, vertex);
    uint32_t first = fan.corner;
    do {
        if (meso_domain_has(domain, mesh, fan.corner / 3)) {
            *point = (MesoMeshPoint){.triangle = fan.corner / 3};
            point->weight[fan.corner % 3] = 1;
            return true;
        }
    } while (meso_fan_next(mesh, &fan) && fan.corner != first);
    return false;
}

static double spacing_of(const Seeding *s, const MesoSeedSpec *spec)
{
    double root = sqrt(s->work->decor->tree.regions[s->region].area);
    return spec->relative ? root * (double)spec->spacing : (double)spec->spacing;
}

static MesoStatus add_samples(Seeding *s, const MesoSeedSpec *spec)
{
    MesoBorderChains chains;
    MesoMeshPoint *points;
    uint32_t count = 0;
    MesoStatus status = meso_border_chains(s->work, s->domain, spec->of, spec, &chains, s->error);
    if (!status && chains.count > 0)
        status = meso_border_samples(s->work, &chains, spec->count, spec->count ? 0 : spacing_of(s, spec), &points,
                                     &count, s->error);
    for (uint32_t i = 0; i < count && !status; i++)
        status = add_point(s, &points[i]);
    return status;
}

static MesoStatus add_nearest(Seeding *s, MesoVec3 p)
{
    MesoMeshPoint nearest = meso_surface_point(&s->work->decor->mesh, s->domain, p);
    return add_point(s, &nearest);
}

static MesoStatus add_poisson(Seeding *s, const MesoSeedSpec *spec)
{
    const MesoTriangulation *mesh = &s->work->decor->mesh;
    uint32_t *vertices, count = 0;
    MesoStatus status = meso_decor_poisson(s->work, spec, s->region, s->domain, &vertices, &count, s->error);
    for (uint32_t i = 0; i < count && !status; i++) {
        MesoMeshPoint point;
        status = vertex_point(mesh, s->domain, vertices[i], &point) ? add_point(s, &point) : MESO_OK;
    }
    return status;
}

MesoStatus meso_decor_face_point(const MesoDecorWork *work, const MesoSeedSpec *spec, MesoVec3 *point, MesoError *error)
{
    const MesoPolygonMesh *surface = work->decor->surface;
    *point = (MesoVec3){0, 0, 0};
    if (!surface || spec->face >= surface->face_count)
        return meso_fail(error, MESO_ERR_INPUT, "no face %u: the surface has %u, counted from 0", spec->face,
                         surface ? surface->face_count : 0);
    const uint32_t *corners = &surface->corners[meso_polygon_begin(surface, spec->face)];
    for (int k = 0; k < 3; k++)
        *point = meso_vec3_add(*point, meso_vec3_scale(surface->positions[corners[k]], spec->weight[k]));
    return MESO_OK;
}

static MesoStatus add_face_point(Seeding *s, const MesoSeedSpec *spec)
{
    MesoVec3 p;
    MesoStatus status = meso_decor_face_point(s->work, spec, &p, s->error);
    return status ? status : add_nearest(s, p);
}

MesoStatus meso_decor_seeds(MesoDecorWork *work, const MesoSeedSet *set, uint32_t region, const MesoDomain *domain,
                            MesoSeeds *seeds, MesoError *error)
{
    Seeding s = {work, region, domain, seeds, error};
    MesoStatus status = MESO_OK;
    *seeds = (MesoSeeds){0};
    for (uint32_t i = 0; i < set->count && !status; i++) {
        const MesoSeedSpec *spec = &set->specs[i];
        switch (spec->kind) {
        case MESO_SEED_POINT:
            status = add_nearest(&s, spec->point);
            break;
        case MESO_SEED_FACE:
            status = add_face_point(&s, spec);
            break;
        case MESO_SEED_ALONG:
            status = add_samples(&s, spec);
            break;
        case MESO_SEED_POISSON:
            status = add_poisson(&s, spec);
            break;
        default:
            status = add_chains(&s, spec);
        }
    }
    return status;
}
