#include "libcore/geodesic/geodesic_samples.h"

#include "libcore/base/grow.h"
#include "libcore/mesh/cut/mesh_domain.h"

enum { BLOCK = 1024 };

/*
 * Candidates in blocks, and a tree of the blocks' farthest: node i is over 2 i and 2 i + 1, blocks are the leaves.
 * Distances only fall: what a block has on record bounds it, and is looked at again when it is the farthest of all.
 */
typedef struct Farthest {
    const float *distance;
    uint32_t candidate_count, block_room;
    uint32_t *candidates;       /* [candidate_count] vertices, ascending */
    float *bounds;              /* [2 * block_room] -1 where there is none */
    uint32_t *vertices;         /* [block_room] with that distance, the lowest of the block */
} Farthest;

/* ---- candidates ---- */

static void keep_border_alone(MesoDomainVertices *vertices, uint64_t *border, const MesoTriangulation *mesh,
                              const MesoDomain *domain)
{
    uint32_t count = meso_domain_size(domain, mesh);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t triangle = meso_domain_triangle(domain, i);
        for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++)
            if (meso_domain_across(domain, mesh, h) == MESO_NO_INDEX) {
                meso_bits_set(border, mesh->corners[h]);
                meso_bits_set(border, mesh->corners[meso_next_corner(h)]);
            }
    }
    vertices->bits = border;
}

static MesoStatus list_candidates(Farthest *farthest, MesoArena *scratch, const MesoTriangulation *mesh,
                                  const MesoSampleQuery *query, MesoError *error)
{
    MesoDomainVertices vertices;
    uint32_t words = meso_bits_words(mesh->vertex_count);
    MesoStatus status = meso_domain_vertices_init(&vertices, scratch, mesh, query->domain, error);
    if (status)
        return status;
    if (query->border_only) {
        uint64_t *border = MESO_NEW(scratch, uint64_t, words, error);
        if (!border)
            return MESO_ERR_MEMORY;
        keep_border_alone(&vertices, border, mesh, query->domain);
    }
    farthest->candidates = MESO_NEW(scratch, uint32_t, meso_bits_count(vertices.bits, words), error);
    if (!farthest->candidates)
        return MESO_ERR_MEMORY;
    for (uint32_t v = meso_domain_vertex_from(&vertices, 0); v != MESO_NO_INDEX;
         v = meso_domain_vertex_from(&vertices, v + 1))
        farthest->candidates[farthest->candidate_count++] = v;
    return MESO_OK;
}

/* ---- the farthest ---- */

/* Of one block, as its distances are now. */
static float look_at_block(Farthest *farthest, uint32_t block)
{
    uint32_t begin = block * BLOCK, end = begin + BLOCK;
    float most = -1;
    end = end < farthest->candidate_count ? end : farthest->candidate_count;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t vertex = farthest->candidates[i];
        if (farthest->distance[vertex] > most) {
            most = farthest->distance[vertex];
            farthest->vertices[block] = vertex;
        }
    }
    return most;
}

static float larger(float a, float b)
{
    return a > b ? a : b;
}

static MesoStatus init_farthest(Farthest *farthest, MesoArena *scratch, const float *distance, MesoError *error)
{
    uint32_t blocks = farthest->candidate_count / BLOCK + 1;
    farthest->distance = distance;
    farthest->block_room = 1;
    while (farthest->block_room < blocks)
        farthest->block_room *= 2;
    farthest->bounds = MESO_NEW(scratch, float, 2 * (size_t)farthest->block_room, error);
    farthest->vertices = MESO_NEW(scratch, uint32_t, farthest->block_room, error);
    if (!farthest->bounds || !farthest->vertices)
        return MESO_ERR_MEMORY;
    for (uint32_t b = 0; b < farthest->block_room; b++)
        farthest->bounds[farthest->block_room + b] = b < blocks ? look_at_block(farthest, b) : -1;
    for (uint32_t i = farthest->block_room - 1; i > 0; i--)
        farthest->bounds[i] = larger(farthest->bounds[2 * i], farthest->bounds[2 * i + 1]);
    return MESO_OK;
}

/* The first of the farthest candidates; MESO_NO_INDEX where there are none. */
static uint32_t find_farthest(Farthest *farthest, float *distance)
{
    float *bounds = farthest->bounds;
    for (;;) {
        uint32_t i = 1;
        while (i < farthest->block_room)
            i = bounds[2 * i] == bounds[i] ? 2 * i : 2 * i + 1;
        uint32_t block = i - farthest->block_room, vertex = farthest->vertices[block];
        *distance = bounds[1];
        if (bounds[1] < 0)
            return MESO_NO_INDEX;
        if (farthest->distance[vertex] == bounds[i])
            return vertex;
        bounds[i] = look_at_block(farthest, block);
        while (i /= 2)
            bounds[i] = larger(bounds[2 * i], bounds[2 * i + 1]);
    }
}

/* ---- what is given ---- */

static MesoStatus solve_given(MesoGeodesicSolver *solver, const MesoSampleQuery *query, float *distance,
                              MesoError *error)
{
    MesoGeodesicQuery given = {.domain = query->domain, .seeds = query->given, .seed_count = query->given_count,
                               .target = MESO_NO_INDEX};
    return meso_geodesic_solve(solver, &given, distance, NULL, NULL, error);
}

static uint32_t farthest_candidate(const Farthest *farthest, const float *distance)
{
    uint32_t best = farthest->candidate_count ? farthest->candidates[0] : MESO_NO_INDEX;
    for (uint32_t i = 1; i < farthest->candidate_count; i++)
        if (distance[farthest->candidates[i]] > distance[best])
            best = farthest->candidates[i];
    return best;
}

/* What is given counts as farther away than it is; there are no samples yet. */
static MesoStatus loosen(float *distance, float slack, MesoArena *scratch, const MesoTriangulation *mesh,
                         const MesoDomain *domain, MesoError *error)
{
    MesoDomainVertices vertices;
    MesoStatus status = meso_domain_vertices_init(&vertices, scratch, mesh, domain, error);
    if (status)
        return status;
    for (uint32_t v = meso_domain_vertex_from(&vertices, 0); v != MESO_NO_INDEX;
         v = meso_domain_vertex_from(&vertices, v + 1))
        distance[v] = slack < 1 ? distance[v] / (1 - slack) : INFINITY;
    return MESO_OK;
}

/* ---- samples ---- */

static MesoStatus take(MesoSamples *samples, uint32_t *room, float *distance, MesoArena *arena,
                       MesoGeodesicSolver *solver, const MesoSampleQuery *query, uint32_t vertex, MesoError *error)
{
    uint32_t radius_room = *room;
    samples->vertices = MESO_GROW(arena, samples->vertices, samples->count, *room, 64, error);
    samples->radii = MESO_GROW(arena, samples->radii, samples->count, radius_room, 64, error);
    if (!samples->vertices || !samples->radii)
        return MESO_ERR_MEMORY;
    samples->vertices[samples->count] = vertex;
    samples->radii[samples->count++] = distance[vertex];
    MesoGeodesicSeed seed = {vertex, 0, false};
    MesoGeodesicQuery from = {.domain = query->domain, .seeds = &seed, .seed_count = 1, .target = MESO_NO_INDEX,
                              .keep = true};
    return meso_geodesic_solve(solver, &from, distance, NULL, NULL, error);
}

MesoStatus meso_geodesic_sample(MesoSamples *samples, float *distance, MesoArena *arena, const MesoTriangulation *mesh,
                                MesoGeodesicSolver *solver, const MesoSampleQuery *query, MesoError *error)
{
    MesoArena scratch;
    Farthest farthest = {0};
    uint32_t room = 0, start = query->start;
    meso_arena_init(&scratch);
    *samples = (MesoSamples){0};
    MesoStatus status = solve_given(solver, query, distance, error);
    if (!status)
        status = list_candidates(&farthest, &scratch, mesh, query, error);
    if (!status && start == MESO_NO_INDEX && query->given_count > 0 && query->slack >= 1)
        start = farthest_candidate(&farthest, distance);
    if (!status && query->slack > 0)
        status = loosen(distance, query->slack, &scratch, mesh, query->domain, error);
    if (!status && start != MESO_NO_INDEX && query->count > 0)
        status = take(samples, &room, distance, arena, solver, query, start, error);
    if (!status)
        status = init_farthest(&farthest, &scratch, distance, error);
    while (!status) {
        float most;
        uint32_t vertex = find_farthest(&farthest, &most);
        samples->radius = vertex == MESO_NO_INDEX ? 0 : most;
        if (samples->count >= query->count || !(samples->radius > 0 && samples->radius >= query->radius))
            break;
        status = take(samples, &room, distance, arena, solver, query, vertex, error);
    }
    meso_arena_release(&scratch);
    return status;
}
