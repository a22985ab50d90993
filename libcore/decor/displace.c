#include <stdio.h>

#include "libcore/base/random.h"
#include "libcore/decor/decor_work.h"

/*
 * Schlick, "Fast Alternatives to Perlin's Bias and Gain Functions" (Graphics Gems IV, 1994). At 0 and 1 they divide
 * by zero.
 */
static float clamped(float a)
{
    return a < 1e-4f ? 1e-4f : a > 1 - 1e-4f ? 1 - 1e-4f : a;
}

static float bias(float x, float a)
{
    return x / ((1 / a - 2) * (1 - x) + 1);
}

static float gain(float x, float a)
{
    return x < 0.5f ? bias(2 * x, 1 - a) / 2 : 1 - bias(2 - 2 * x, 1 - a) / 2;
}

static float height_of(const MesoDecorWork *work, const MesoDisplacement *d, uint32_t region, float largest)
{
    float jitter = d->jitter * (2 * meso_decor_random_share(work, region, MESO_DRAW_HEIGHT) - 1);
    return d->height * (1 + jitter) * (d->relative ? largest : 1);
}

/* Moves the vertices of a domain; work->field has their distances from its border, and marks those that were moved. */
static MesoStatus move_vertices(MesoDecorWork *work, const MesoDisplacement *d, const MesoDomain *domain,
                                float largest, float height, MesoError *error)
{
    MesoTriangulation *mesh = &work->decor->mesh;
    float a = clamped(d->bias), b = clamped(d->gain);
    for (uint32_t i = 0; i < domain->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = mesh->corners[3 * (size_t)domain->triangles[i] + k];
            float x = work->field[v] / largest;
            if (!(x > 0 && x <= 1))
                continue;
            work->field[v] = 0;
            mesh->positions[v] = meso_vec3_add(mesh->positions[v],
                                               meso_vec3_scale(work->normals[v], height * gain(bias(x, a), b)));
            if (!meso_decor_may_stand(mesh->positions[v]))
                return meso_fail(error, MESO_ERR_INPUT, "a height of %g takes vertices beyond the largest coordinate, %g",
                                 (double)height, (double)MESO_COORDINATE_LIMIT);
        }
    return MESO_OK;
}

static MesoStatus displace_region(MesoDecorWork *work, const MesoDisplacement *d, uint32_t region,
                                  const MesoDomain *domain, bool *flat, MesoError *error)
{
    static const MesoSeedSpec borders = {.kind = MESO_SEED_BORDERS};
    static const MesoFieldSpec spec = {.from = {&borders, 1}};
    MesoFieldFacts facts;
    MesoStatus status = meso_decor_field(work, &spec, region, domain, &facts, error);
    *flat = !status && !(facts.largest > 0);
    if (!status && !*flat)
        status = move_vertices(work, d, domain, facts.largest, height_of(work, d, region, facts.largest), error);
    return status;
}

static void tell_flat(const MesoDecorWork *work, const MesoStep *step, uint32_t flat, uint32_t count)
{
    char text[160];
    snprintf(text, sizeof text, "%u of %u regions are not displaced: they have no border to rise from, or no vertex "
             "inside", flat, count);
    if (flat > 0)
        meso_decor_note(work, step, text);
}

MesoStatus meso_decor_displace(MesoDecorWork *work, const MesoStep *step, const MesoDisplacement *displacement,
                               const uint32_t *regions, uint32_t count, MesoError *error)
{
    const MesoRegionTree *tree = &work->decor->tree;
    uint32_t flat_count = 0;
    MesoStatus status = meso_decor_normals(work, error);
    for (uint32_t i = 0; i < count && !status; i++) {
        MesoDomain domain;
        bool flat = false;
        MesoArenaMark mark = meso_arena_mark(work->scratch);
        status = meso_region_domain(&domain, work->member, work->scratch, tree, &work->lists, &work->decor->mesh,
                                    regions[i], error);
        if (!status)
            status = displace_region(work, displacement, regions[i], &domain, &flat, error);
        flat_count += flat;
        meso_region_domain_end(tree, regions[i], work->member);
        meso_arena_rewind(work->scratch, mark);
    }
    work->normals = NULL;
    if (!status)
        tell_flat(work, step, flat_count, count);
    return status ? status : meso_geodesic_set_positions(work->solver, work->decor->mesh.positions, error);
}
