#include "libcore/decor/border_chains.h"
#include "libcore/geodesic/geodesic_samples.h"

/* Where no count is given, more samples than this are somebody's mistake of scale. */
enum { MOST_SAMPLES = 1 << 16 };

/* All vertices of the border, as lines that samples keep away from. */
static MesoStatus border_seeds(MesoDecorWork *work, const MesoDomain *domain, MesoGeodesicSeed **seeds, uint32_t *count,
                               MesoError *error)
{
    MesoBorderChains chains;
    MesoStatus status = meso_border_chains(work, domain, MESO_SEED_BORDERS, NULL, &chains, error);
    if (status)
        return status;
    *seeds = MESO_NEW(work->scratch, MesoGeodesicSeed, chains.loops.side_count, error);
    *count = *seeds ? chains.loops.side_count : 0;
    for (uint32_t i = 0; i < *count; i++)
        (*seeds)[i] = (MesoGeodesicSeed){.vertex = chains.loops.vertices[i], .line = true};
    return *seeds ? MESO_OK : MESO_ERR_MEMORY;
}

/* A vertex of the domain, drawn for the region: where nothing is given, the first sample. */
static uint32_t drawn_start(const MesoDecorWork *work, uint32_t region, const MesoDomain *domain)
{
    uint64_t draw = meso_decor_random(work, region, MESO_DRAW_SAMPLE) % (3 * (uint64_t)domain->triangle_count);
    return work->decor->mesh.corners[3 * (size_t)domain->triangles[draw / 3] + draw % 3];
}

MesoStatus meso_decor_poisson(MesoDecorWork *work, const MesoSeedSpec *spec, uint32_t region, const MesoDomain *domain,
                              uint32_t **vertices, uint32_t *count, MesoError *error)
{
    double root = sqrt(work->decor->tree.regions[region].area);
    float radius = spec->relative ? (float)(root * (double)spec->spacing) : spec->spacing;
    MesoSampleQuery query = {
        .domain = domain, .start = MESO_NO_INDEX, .border_only = spec->on_border, .radius = radius,
        .slack = spec->from_border ? spec->border_slack : 0,
        .count = spec->count ? spec->count : MOST_SAMPLES,
    };
    MesoGeodesicSeed *given = NULL;
    MesoSamples samples;
    MesoStatus status = MESO_OK;
    if (spec->from_border && !spec->on_border)
        status = border_seeds(work, domain, &given, &query.given_count, error);
    query.given = given;
    if (!status && query.given_count == 0 && !spec->on_border)
        query.start = drawn_start(work, region, domain);
    if (!status)
        status = meso_geodesic_sample(&samples, work->other, work->scratch, &work->decor->mesh, work->solver, &query,
                                      error);
    *vertices = status ? NULL : samples.vertices;
    *count = status ? 0 : samples.count;
    return status;
}
