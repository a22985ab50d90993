#include "libcore/decor/border_chains.h"

#include <stdlib.h>

static MesoEdgeChain whole_loop(const MesoBorderLoops *loops, uint32_t loop)
{
    uint32_t first = loops->loops[loop].first;
    return (MesoEdgeChain){loops->loops[loop].count, true, loops->half_edges + first, loops->vertices + first};
}

/* The longest loop that has not come yet; of equal ones, the first. */
static uint32_t next_longest(const MesoBorderLoops *loops, const uint8_t *taken)
{
    uint32_t best = MESO_NO_INDEX;
    for (uint32_t i = 0; i < loops->loop_count; i++)
        if (!taken[i] && (best == MESO_NO_INDEX || loops->loops[i].length > loops->loops[best].length))
            best = i;
    return best;
}

/* Place in a loop of its corner number `number`, counted around it again and again; MESO_NO_INDEX without corners. */
static uint32_t corner_place(const MesoBorderLoops *loops, uint32_t loop, uint32_t number)
{
    const MesoBorderLoop *l = &loops->loops[loop];
    uint32_t left = l->corner_count ? number % l->corner_count : 0;
    for (uint32_t i = 0; i < l->count && l->corner_count; i++)
        if (loops->corners[l->first + i] && left-- == 0)
            return i;
    return MESO_NO_INDEX;
}

/* From one corner to another in the loop's direction, once around the seam of its arrays where it must. */
static MesoStatus side_of_loop(MesoEdgeChain *side, MesoArena *arena, const MesoBorderLoops *loops, uint32_t loop,
                               const uint32_t *corners, MesoError *error)
{
    const MesoBorderLoop *l = &loops->loops[loop];
    uint32_t from = corner_place(loops, loop, corners[0]), to = corner_place(loops, loop, corners[1]);
    *side = (MesoEdgeChain){0};
    if (from == MESO_NO_INDEX)
        return MESO_OK;
    uint32_t count = to > from ? to - from : to + l->count - from;
    uint32_t *half_edges = MESO_NEW(arena, uint32_t, count, error), *vertices = MESO_NEW(arena, uint32_t, count, error);
    if (!half_edges || !vertices)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        half_edges[i] = loops->half_edges[l->first + (from + i) % l->count];
        vertices[i] = loops->vertices[l->first + (from + i) % l->count];
    }
    *side = (MesoEdgeChain){count, false, half_edges, vertices};
    return MESO_OK;
}

static bool is_asked(MesoSeedKind kind, const MesoSeedSpec *spec, uint32_t rank)
{
    switch (kind) {
    case MESO_SEED_OUTER:
        return rank == 0;
    case MESO_SEED_INNER:
        return rank > 0;
    case MESO_SEED_LOOP:
    case MESO_SEED_SIDE:
        return rank == spec->loop;
    default:
        return true;
    }
}

MesoStatus meso_border_chains(MesoDecorWork *work, const MesoDomain *domain, MesoSeedKind kind,
                              const MesoSeedSpec *spec, MesoBorderChains *chains, MesoError *error)
{
    MesoArena *arena = work->scratch;
    MesoBorderLoops *loops = &chains->loops;
    chains->count = 0;
    MesoStatus status = meso_border_loops_find(loops, arena, &work->decor->mesh, domain, true, error);
    chains->chains = status ? NULL : MESO_NEW(arena, MesoEdgeChain, loops->loop_count, error);
    uint8_t *taken = chains->chains ? MESO_NEW(arena, uint8_t, loops->loop_count, error) : NULL;
    if (!taken)
        return MESO_ERR_MEMORY;
    for (uint32_t rank = 0; rank < loops->loop_count && !status; rank++) {
        uint32_t loop = next_longest(loops, taken);
        taken[loop] = 1;
        if (!is_asked(kind, spec, rank))
            continue;
        MesoEdgeChain *chain = &chains->chains[chains->count];
        if (kind == MESO_SEED_SIDE)
            status = side_of_loop(chain, arena, loops, loop, spec->corners, error);
        else
            *chain = whole_loop(loops, loop);
        chains->count += chain->count > 0;
    }
    return status;
}

/* More samples than this are somebody's mistake of scale. */
enum { MOST_SAMPLES = 1 << 20 };

MesoStatus meso_border_samples(MesoDecorWork *work, const MesoBorderChains *chains, uint32_t count, double spacing,
                               MesoMeshPoint **points, uint32_t *point_count, MesoError *error)
{
    const MesoTriangulation *mesh = &work->decor->mesh;
    double total = 0;
    uint64_t all = 0;
    for (uint32_t i = 0; i < chains->count; i++)
        total += meso_chain_length(mesh, &chains->chains[i]);
    if (spacing > 0 && total / spacing > MOST_SAMPLES)
        return meso_fail(error, MESO_ERR_INPUT, "%.0f samples along one border, over the limit of %d", total / spacing,
                         MOST_SAMPLES);
    uint32_t *counts = MESO_NEW(work->scratch, uint32_t, chains->count, error);
    if (!counts)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < chains->count; i++) {
        double length = meso_chain_length(mesh, &chains->chains[i]);
        double apart = spacing > 0 ? spacing : count > 0 ? total / count : length;
        counts[i] = apart > 0 ? meso_chain_sample_count(length, apart, 1) : 1;
        if (chains->count == 1 && count > 0)
            counts[i] = count;
        all += counts[i];
    }
    *points = MESO_NEW(work->scratch, MesoMeshPoint, all, error);
    if (!*points)
        return MESO_ERR_MEMORY;
    *point_count = 0;
    for (uint32_t i = 0; i < chains->count; i++) {
        meso_chain_sample(mesh, &chains->chains[i], counts[i], chains->chains[i].closed ? 0 : 0.5, false,
                          *points + *point_count);
        *point_count += counts[i];
    }
    return MESO_OK;
}
