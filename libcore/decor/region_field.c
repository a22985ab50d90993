#include "libcore/decor/decor_work.h"
#include "libcore/math/noise.h"

/* Largest finite value on the vertices of a domain. */
static float largest_in(const MesoTriangulation *mesh, const MesoDomain *domain, const float *field)
{
    float largest = 0;
    for (uint32_t i = 0; i < domain->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            float f = field[mesh->corners[3 * (size_t)domain->triangles[i] + k]];
            if (f > largest && f < INFINITY)
                largest = f;
        }
    return largest;
}

static MesoGeodesicQuery query_from(const MesoSeeds *seeds, const MesoDomain *domain)
{
    return (MesoGeodesicQuery){
        .domain = domain, .seeds = seeds->seeds, .seed_count = seeds->count, .target = MESO_NO_INDEX,
    };
}

/* work->field, and of a blend work->other. */
static MesoStatus solve(MesoDecorWork *work, const MesoSeeds *from, const MesoSeeds *to, const MesoDomain *domain,
                        MesoError *error)
{
    const MesoGeodesicQuery queries[] = {query_from(from, domain), query_from(to, domain)};
    if (to->count == 0)
        return meso_geodesic_solve(work->solver, &queries[0], work->field, NULL, NULL, error);
    return meso_geodesic_solve_pair(work->solver, queries, (float *const[]){work->field, work->other},
                                    work->options->threads, error);
}

/* dist S / (dist S + dist S'), 1/2 where both meet; S alone where no way leads to S', and so 0. */
static void blend_fields(const MesoDecorWork *work, const MesoDomain *domain)
{
    const MesoTriangulation *mesh = &work->decor->mesh;
    /* each vertex once: what is blended is marked in the other field */
    for (uint32_t i = 0; i < domain->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = mesh->corners[3 * (size_t)domain->triangles[i] + k];
            float from = work->field[v], to = work->other[v];
            if (to < 0)
                continue;
            work->other[v] = -1;
            if (from == INFINITY || to == INFINITY)
                work->field[v] = from == INFINITY ? (to == INFINITY ? INFINITY : 1) : 0;
            else
                work->field[v] = from + to > 0 ? from / (from + to) : 0.5f;
        }
}

/* Seeds of noise go with the seed of the job. `size` is what frequencies are relative to. */
static float noise_at(const MesoDecorWork *work, const MesoNoise *noise, MesoVec3 p, float size)
{
    uint64_t seed = noise->seed + work->options->seed * 0x9e3779b97f4a7c15u;
    return meso_noise(meso_vec3_scale(p, noise->frequency / size), seed);
}

/* Vertices that nothing has reached stay infinitely far. */
static MesoStatus perturb_field(MesoDecorWork *work, const MesoNoise *noise, const MesoDomain *domain, float size,
                                float largest, MesoError *error)
{
    const MesoTriangulation *mesh = &work->decor->mesh;
    float gain = noise->relative ? noise->gain * largest : noise->gain;
    /* each vertex once: the other field is free, and marks them */
    for (uint32_t i = 0; i < domain->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++)
            work->other[mesh->corners[3 * (size_t)domain->triangles[i] + k]] = 1;
    for (uint32_t i = 0; i < domain->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = mesh->corners[3 * (size_t)domain->triangles[i] + k];
            if (work->other[v] < 0)
                continue;
            work->other[v] = -1;
            float value = work->field[v] + gain * noise_at(work, noise, mesh->positions[v], noise->relative ? size : 1);
            if (!isfinite(gain) || (isfinite(work->field[v]) && !isfinite(value)))
                return meso_fail(error, MESO_ERR_INPUT, "noise of gain %g takes the field beyond the largest number",
                                 (double)noise->gain);
            work->field[v] = value;
        }
    return MESO_OK;
}

MesoStatus meso_decor_field(MesoDecorWork *work, const MesoFieldSpec *spec, uint32_t region, const MesoDomain *domain,
                              MesoFieldFacts *facts, MesoError *error)
{
    *facts = (MesoFieldFacts){0};
    MesoSeeds from = {0}, to = {0};
    MesoStatus status = meso_decor_seeds(work, &spec->from, region, domain, &from, error);
    if (!status && spec->blend)
        status = meso_decor_seeds(work, &spec->to, region, domain, &to, error);
    if (status || from.count == 0 || (spec->blend && to.count == 0))
        return status;
    facts->seeded = true;
    facts->points = from.point_count > 0;
    status = solve(work, &from, &to, domain, error);
    if (status)
        return status;
    if (spec->blend)
        blend_fields(work, domain);
    facts->largest = largest_in(&work->decor->mesh, domain, work->field);
    if (spec->noise.of == MESO_NOISE_OF_FIELD) {
        status = perturb_field(work, &spec->noise, domain, (float)sqrt(work->decor->tree.regions[region].area),
                               facts->largest, error);
        facts->largest = largest_in(&work->decor->mesh, domain, work->field);
    }
    return status;
}

const char *meso_decor_flat_reason(const MesoFieldFacts *facts)
{
    return facts->seeded ? "it is too coarse: all of its vertices are seeds"
                         : "it has nothing to measure distances from, or nothing to go to";
}

MesoStatus meso_decor_perturb(MesoDecorWork *work, const MesoNoise *noise, float size, MesoError *error)
{
    const MesoTriangulation *mesh = &work->decor->mesh;
    float gain = noise->relative ? noise->gain * size : noise->gain;
    MesoStatus status = meso_decor_normals(work, error);
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    MesoVec3 *moved = status ? NULL : MESO_NEW(work->scratch, MesoVec3, mesh->vertex_count, error);
    if (!moved)
        return MESO_ERR_MEMORY;
    size = noise->relative ? size : 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float shift = gain * noise_at(work, noise, mesh->positions[v], size);
        moved[v] = meso_vec3_add(mesh->positions[v], meso_vec3_scale(work->normals[v], shift));
        if (!meso_decor_may_stand(moved[v]))
            return meso_fail(error, MESO_ERR_INPUT, "noise of gain %g takes vertices beyond the largest coordinate, %g",
                             (double)gain, (double)MESO_COORDINATE_LIMIT);
    }
    status = meso_geodesic_set_positions(work->solver, moved, error);
    meso_arena_rewind(work->scratch, mark);
    return status;
}
