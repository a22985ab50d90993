/* Cells that hang together, and borders through vertices: what the nearest seeds become before borders are drawn. */
#include <stdatomic.h>

#include "libcore/base/grow.h"
#include "libcore/base/parallel.h"
#include "libcore/geodesic/cells/nearest_seeds.h"

/* Triangles or vertices that one thread goes through at a time. */
enum { SLOTS = MESO_NEAREST_SEEDS, GRAIN = 1 << 15 };

typedef struct Joiner {
    const MesoTriangulation *mesh;
    const MesoDomain *domain;
    MesoNearestSeeds *nearest;
    uint64_t *joined;           /* a bit a vertex number: sides within its cell lead to the cell's nearest vertex */
    uint64_t *met;              /* likewise, on the walk that is under way */
    atomic_uchar *descends;     /* by vertex number: 1 where a side of its cell leads nearer to the seed */
    uint32_t met_count, met_room, stray_count, stray_room;
    uint32_t *met_list, *strays;    /* vertices; strays are to be looked at yet */
    MesoArena *arena;
    MesoError *error;
} Joiner;

static uint32_t number_of(const Joiner *joiner, uint32_t vertex)
{
    return meso_domain_vertex_number(&joiner->nearest->vertices, vertex);
}

static bool is_nearer(const Joiner *joiner, uint32_t a, uint32_t b)
{
    float to_a = meso_seed_slots(joiner->nearest, a)->distance[0];
    float to_b = meso_seed_slots(joiner->nearest, b)->distance[0];
    return to_a != to_b ? to_a < to_b : a < b;
}

/* Notes the vertices that have a side to one of their cell that is nearer to the seed; two threads may note the same. */
static void note_descents(void *context, uint64_t begin, uint64_t end)
{
    const Joiner *joiner = context;
    const MesoTriangulation *mesh = joiner->mesh;
    for (uint64_t i = begin; i < end; i++) {
        const uint32_t *corners = mesh->corners + 3 * (size_t)meso_domain_triangle(joiner->domain, (uint32_t)i);
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = corners[k], b = corners[k == 2 ? 0 : k + 1];
            uint32_t farther = number_of(joiner, is_nearer(joiner, a, b) ? b : a);
            if (meso_seed_slots(joiner->nearest, a)->seed[0] == meso_seed_slots(joiner->nearest, b)->seed[0])
                atomic_store_explicit(&joiner->descends[farther], 1, memory_order_relaxed);
        }
    }
}

static MesoStatus add_stray(Joiner *joiner, uint32_t vertex)
{
    joiner->strays = MESO_GROW(joiner->arena, joiner->strays, joiner->stray_count, joiner->stray_room, 64,
                               joiner->error);
    if (!joiner->strays)
        return MESO_ERR_MEMORY;
    joiner->strays[joiner->stray_count++] = vertex;
    return MESO_OK;
}

/* Vertices from which no side leads nearer to the seed: the nearest of their cell, and those that may be strays. */
static MesoStatus list_strays(Joiner *joiner, uint32_t seed_count)
{
    const MesoDomainVertices *vertices = &joiner->nearest->vertices;
    uint32_t *first = MESO_NEW(joiner->arena, uint32_t, seed_count, joiner->error);
    MesoStatus status = first ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < seed_count && first; s++)
        first[s] = MESO_NO_INDEX;
    for (uint32_t v = meso_domain_vertex_from(vertices, 0); v != MESO_NO_INDEX && !status;
         v = meso_domain_vertex_from(vertices, v + 1)) {
        uint32_t seed = meso_seed_slots(joiner->nearest, v)->seed[0], stray = v;
        if (seed == MESO_NO_INDEX || joiner->descends[number_of(joiner, v)])
            continue;
        if (first[seed] == MESO_NO_INDEX || is_nearer(joiner, v, first[seed])) {
            stray = first[seed];
            first[seed] = v;
        }
        if (stray != MESO_NO_INDEX)
            status = add_stray(joiner, stray);
    }
    for (uint32_t s = 0; s < seed_count && !status; s++)
        if (first[s] != MESO_NO_INDEX)
            meso_bits_set(joiner->joined, number_of(joiner, first[s]));
    return status;
}

/* Notes a vertex of the walk's cell, unless it is known; says whether it is joined. */
static MesoStatus meet(Joiner *joiner, uint32_t vertex, uint32_t seed, bool *joined)
{
    uint32_t number = number_of(joiner, vertex);
    if (meso_seed_slots(joiner->nearest, vertex)->seed[0] != seed || meso_bits_test(joiner->met, number))
        return MESO_OK;
    joiner->met_list = MESO_GROW(joiner->arena, joiner->met_list, joiner->met_count, joiner->met_room, 64,
                                 joiner->error);
    if (!joiner->met_list)
        return MESO_ERR_MEMORY;
    meso_bits_set(joiner->met, number);
    joiner->met_list[joiner->met_count++] = vertex;
    *joined = *joined || meso_bits_test(joiner->joined, number);
    return MESO_OK;
}

static MesoStatus meet_around(Joiner *joiner, uint32_t vertex, uint32_t seed, bool *joined)
{
    const uint32_t *corners = joiner->mesh->corners;
    MesoFan fan = meso_fan_first(joiner->mesh, vertex);
    uint32_t first = fan.corner;
    MesoStatus status = MESO_OK;
    do {
        if (!meso_domain_holds(joiner->domain, joiner->mesh, fan.corner / 3))
            continue;
        status = meet(joiner, corners[meso_next_corner(fan.corner)], seed, joined);
        if (!status)
            status = meet(joiner, corners[meso_previous_corner(fan.corner)], seed, joined);
    } while (!status && meso_fan_next(joiner->mesh, &fan) && fan.corner != first);
    return status;
}

/* The vertex forgets its nearest seed, if it knows another. */
static MesoStatus forget_nearest(Joiner *joiner, uint32_t vertex)
{
    MesoSeedSlots *slots = meso_seed_slots(joiner->nearest, vertex);
    if (slots->seed[1] == MESO_NO_INDEX)
        return MESO_OK;
    for (uint32_t k = 0; k + 1 < SLOTS; k++) {
        slots->distance[k] = slots->distance[k + 1];
        slots->seed[k] = slots->seed[k + 1];
    }
    slots->distance[SLOTS - 1] = INFINITY;
    slots->seed[SLOTS - 1] = MESO_NO_INDEX;
    return add_stray(joiner, vertex);
}

/* Walks over the part of its cell that a vertex is in, until that is known to be joined; all that is met is alike. */
static MesoStatus settle_part(Joiner *joiner, uint32_t vertex)
{
    uint32_t seed = meso_seed_slots(joiner->nearest, vertex)->seed[0];
    bool joined = false;
    joiner->met_count = 0;
    MesoStatus status = meet(joiner, vertex, seed, &joined);
    for (uint32_t i = 0; i < joiner->met_count && !status && !joined; i++)
        status = meet_around(joiner, joiner->met_list[i], seed, &joined);
    for (uint32_t i = 0; i < joiner->met_count && !status; i++) {
        uint32_t number = number_of(joiner, joiner->met_list[i]);
        meso_bits_clear(joiner->met, number);
        if (joined)
            meso_bits_set(joiner->joined, number);
        else
            status = forget_nearest(joiner, joiner->met_list[i]);
    }
    return status;
}

static MesoStatus join_cells(Joiner *joiner, uint32_t seed_count)
{
    uint32_t words = meso_bits_words(joiner->nearest->vertices.count);
    joiner->joined = MESO_NEW(joiner->arena, uint64_t, words, joiner->error);
    joiner->met = MESO_NEW(joiner->arena, uint64_t, words, joiner->error);
    joiner->descends = MESO_NEW(joiner->arena, atomic_uchar, joiner->nearest->vertices.count, joiner->error);
    if (!joiner->joined || !joiner->met || !joiner->descends)
        return MESO_ERR_MEMORY;
    meso_parallel_for(joiner->nearest->threads, meso_domain_size(joiner->domain, joiner->mesh), GRAIN, note_descents,
                      joiner);
    MesoStatus status = list_strays(joiner, seed_count);
    for (uint32_t i = 0; i < joiner->stray_count && !status; i++)
        status = settle_part(joiner, joiner->strays[i]);
    return status;
}

/* ---- borders through vertices ---- */

static void level_slots(void *context, uint64_t begin, uint64_t end)
{
    const MesoNearestSeeds *nearest = context;
    for (uint32_t v = meso_domain_vertex_from(&nearest->vertices, (uint32_t)begin); v < end;
         v = meso_domain_vertex_from(&nearest->vertices, v + 1)) {
        MesoSeedSlots *slots = meso_seed_slots(nearest, v);
        float least = slots->distance[0];
        for (uint32_t k = 1; k < SLOTS; k++)
            if (slots->distance[k] - least <= nearest->snap[v])
                slots->distance[k] = least;
    }
}

MesoStatus meso_nearest_seeds_settle(MesoNearestSeeds *nearest, MesoArena *arena, const MesoTriangulation *mesh,
                                     MesoError *error)
{
    Joiner joiner = {.mesh = mesh, .domain = nearest->domain, .nearest = nearest, .arena = arena, .error = error};
    MesoStatus status = join_cells(&joiner, nearest->seed_count);
    meso_parallel_for(nearest->threads, mesh->vertex_count, GRAIN, level_slots, nearest);
    return status;
}
