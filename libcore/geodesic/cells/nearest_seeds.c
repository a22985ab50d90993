#include "libcore/geodesic/cells/nearest_seeds.h"

#include <stdatomic.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/geodesic/geodesic_solver.h"
#include "libcore/mesh/cut/cut_keys.h"
#include "libcore/mesh/cut/cut_lines.h"

enum { SLOTS = MESO_NEAREST_SEEDS };

/* Vertices of the mesh that one thread goes through at a time; how often a thread comes back for more seeds. */
enum { VERTEX_GRAIN = 1 << 15, SEED_RANGES = 16 };

/* Vertices a seed from which on few are near a border: close bounds take longer to find there than they save. */
enum { LARGE_CELL = 32 };

/* Of the longest side at a vertex: along it distances of two seeds come nearer by twice its length at most. */
static const float FAR = 2.1f;

typedef struct Finder {
    const MesoTriangulation *mesh;
    MesoNearestSeeds *nearest;
    bool small;                 /* cells are */
    uint32_t worker_count, team_count;
    MesoGeodesicSolver *team[MESO_TEAM_MOST];       /* of small cells, two for each worker */
    MesoStatus status[MESO_TEAM_MOST];
    MesoError errors[MESO_TEAM_MOST];
    uint64_t *order;            /* [seed_count] by triangles: what one seed has touched, the next finds in the caches */
    MesoGeodesicSeed *planted;  /* [3 * seed_count] in that order */
    uint32_t *planted_begin;    /* [seed_count + 1] */
    float *together;            /* [vertex_count] distances from the nearest of all seeds */
    float *longest;             /* [vertex_count] squares of the longest sides */
    float *wanted;              /* [vertex_count] up to which distance one from a seed is wanted; then `snap` */
    float *bound;               /* [vertex_count] what distances from a seed have to be below to matter */
    atomic_uchar *locks;        /* [vertices.count] of slots, with more threads than one */
    MesoArena *arena;
    MesoError *error;
} Finder;

/* ---- distances ---- */

static MesoStatus make_room(Finder *finder)
{
    MesoStatus status = meso_domain_vertices_init(&finder->nearest->vertices, finder->arena, finder->mesh,
                                                  finder->nearest->domain, finder->error);
    if (status)
        return status;
    uint32_t count = finder->nearest->vertices.count;
    finder->nearest->slots = MESO_NEW(finder->arena, MesoSeedSlots, count, finder->error);
    float **of_vertices[] = {&finder->together, &finder->longest, &finder->wanted, &finder->bound};
    for (uint32_t i = 0; i < sizeof of_vertices / sizeof *of_vertices; i++) {
        *of_vertices[i] = MESO_NEW(finder->arena, float, finder->mesh->vertex_count, finder->error);
        if (!*of_vertices[i])
            return MESO_ERR_MEMORY;
    }
    if (finder->worker_count > 1)
        finder->locks = MESO_NEW(finder->arena, atomic_uchar, count, finder->error);
    return finder->nearest->slots && (finder->locks || finder->worker_count == 1) ? MESO_OK : MESO_ERR_MEMORY;
}

/* A seed at a vertex is that vertex; the corners of its triangle know one that is inside. Returns how many. */
static uint32_t plant(const MesoTriangulation *mesh, const MesoMeshPoint *point, MesoGeodesicSeed planted[3])
{
    const uint32_t *corners = mesh->corners + 3 * (size_t)point->triangle;
    MesoVec3 place = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++) {
        if (point->weight[k] >= 1) {
            planted[0] = (MesoGeodesicSeed){corners[k], 0, false};
            return 1;
        }
        place = meso_vec3_mad(place, point->weight[k], mesh->positions[corners[k]]);
    }
    for (uint32_t k = 0; k < 3; k++) {
        float distance = meso_vec3_length(meso_vec3_sub(mesh->positions[corners[k]], place));
        planted[k] = (MesoGeodesicSeed){corners[k], distance, false};
    }
    return 3;
}

static MesoStatus plant_all(Finder *finder)
{
    uint32_t count = finder->nearest->seed_count;
    finder->order = MESO_NEW(finder->arena, uint64_t, count, finder->error);
    finder->planted_begin = MESO_NEW(finder->arena, uint32_t, (size_t)count + 1, finder->error);
    finder->planted = MESO_NEW(finder->arena, MesoGeodesicSeed, 3 * (size_t)count, finder->error);
    uint64_t *spare = MESO_NEW(finder->arena, uint64_t, count, finder->error);
    if (!finder->order || !finder->planted_begin || !finder->planted || !spare)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        finder->order[i] = meso_cut_key(finder->nearest->seeds[i].triangle, i);
    meso_cut_sort(finder->order, spare, count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t begin = finder->planted_begin[i];
        finder->planted_begin[i + 1] =
            begin + plant(finder->mesh, &finder->nearest->seeds[(uint32_t)finder->order[i]], finder->planted + begin);
    }
    return MESO_OK;
}

/* Of small cells each worker has two solvers, as far as there are so many. */
static MesoStatus make_team(Finder *finder, MesoGeodesicSolver *solver)
{
    const MesoNearestSeeds *nearest = finder->nearest;
    finder->small = nearest->vertices.count / LARGE_CELL < nearest->seed_count;
    finder->team_count = finder->worker_count;
    if (finder->small && 2 * finder->worker_count <= MESO_TEAM_MOST &&
        meso_geodesic_team_is_worth(solver, nearest->domain))
        finder->team_count = 2 * finder->worker_count;
    return meso_geodesic_team(solver, finder->team_count, finder->team, finder->error);
}

static MesoStatus solve_together(Finder *finder, MesoError *error)
{
    const MesoNearestSeeds *nearest = finder->nearest;
    MesoGeodesicQuery all = {.domain = nearest->domain, .seed_count = finder->planted_begin[nearest->seed_count],
                             .seeds = finder->planted, .target = MESO_NO_INDEX};
    return meso_geodesic_solve(finder->team[0], &all, finder->together, NULL, NULL, error);
}

static void clear_slots(const MesoNearestSeeds *nearest)
{
    for (uint32_t i = 0; i < nearest->vertices.count; i++)
        for (uint32_t k = 0; k < SLOTS; k++) {
            nearest->slots[i].distance[k] = INFINITY;
            nearest->slots[i].seed[k] = MESO_NO_INDEX;
        }
}

static void find_longest_sides(Finder *finder)
{
    const MesoTriangulation *mesh = finder->mesh;
    uint32_t count = meso_domain_size(finder->nearest->domain, mesh);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *corners = mesh->corners + 3 * (size_t)meso_domain_triangle(finder->nearest->domain, i);
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = corners[k], b = corners[k == 2 ? 0 : k + 1];
            MesoVec3 side = meso_vec3_sub(mesh->positions[a], mesh->positions[b]);
            float square = meso_vec3_dot(side, side);
            finder->longest[a] = square > finder->longest[a] ? square : finder->longest[a];
            finder->longest[b] = square > finder->longest[b] ? square : finder->longest[b];
        }
    }
}

/* What bounds follow from: the one solve that cannot be divided, and beside it all that does not need it. */
static void prepare_some(void *context, uint64_t begin, uint64_t end)
{
    Finder *finder = context;
    for (uint64_t i = begin; i < end; i++) {
        if (i == 0) {
            finder->status[0] = solve_together(finder, &finder->errors[0]);
            continue;
        }
        clear_slots(finder->nearest);
        find_longest_sides(finder);
    }
}

/*
 * A front has to go where its seed is the nearest of a vertex, or of the other end of one of its sides: there each of
 * two seeds is nearer or farther by the side's length at most. A little more, for what rounding and fronts that mix
 * take off the least distance.
 */
static void find_simple_bounds(void *context, uint64_t begin, uint64_t end)
{
    const Finder *finder = context;
    const MesoDomainVertices *vertices = &finder->nearest->vertices;
    for (uint32_t v = meso_domain_vertex_from(vertices, (uint32_t)begin); v < end;
         v = meso_domain_vertex_from(vertices, v + 1))
        finder->bound[v] = finder->together[v] + FAR * sqrtf(finder->longest[v]);
}

/*
 * A seed's distance is wanted where it is the nearest of a vertex, or of the other end of one of its sides: there it is
 * farther by the side's length at most. A little more, for what rounding and fronts that mix take off the least
 * distance.
 */
static float wanted_at(const Finder *finder, uint32_t v, float *shortest)
{
    const float reach = 1.05f;
    const MesoGeodesicSolver *solver = finder->team[0];
    const MesoGeodesicRow *row = &solver->rows[v];
    MesoOneRing ring = meso_one_ring(&solver->rings, v);
    float wanted = finder->together[v], unit = 1 / solver->scale;
    *shortest = INFINITY;
    for (uint32_t k = 0; k < ring.count; k++) {
        const MesoGeodesicRow *end = &solver->rows[ring.spokes[k]];
        float side = unit * meso_vec3_length((MesoVec3){end->x - row->x, end->y - row->y, end->z - row->z});
        float distance = finder->together[ring.spokes[k]] + reach * side;
        wanted = distance > wanted ? distance : wanted;
        *shortest = side < *shortest ? side : *shortest;
    }
    return wanted;
}

/*
 * What is wanted at a vertex comes from vertices around it that are nearer, and so a front has to go on up to what is
 * wanted at any of their neighbours. And for what comes to those from beyond, on by half of the longest side, or by
 * all of it where sides are so unlike that fronts go far around.
 */
static void find_wanted(void *context, uint64_t begin, uint64_t end)
{
    const float near = 1.5f, far = FAR, unlike = 3;
    const Finder *finder = context;
    const MesoDomainVertices *vertices = &finder->nearest->vertices;
    for (uint32_t v = meso_domain_vertex_from(vertices, (uint32_t)begin); v < end;
         v = meso_domain_vertex_from(vertices, v + 1)) {
        float longest = sqrtf(finder->longest[v]), shortest;
        finder->wanted[v] = wanted_at(finder, v, &shortest);
        finder->bound[v] = finder->together[v] + (longest > unlike * shortest ? far : near) * longest;
    }
}

static void find_close_bounds(void *context, uint64_t begin, uint64_t end)
{
    const Finder *finder = context;
    const MesoDomainVertices *vertices = &finder->nearest->vertices;
    for (uint32_t v = meso_domain_vertex_from(vertices, (uint32_t)begin); v < end;
         v = meso_domain_vertex_from(vertices, v + 1)) {
        MesoOneRing ring = meso_one_ring(&finder->team[0]->rings, v);
        float bound = finder->bound[v] > finder->wanted[v] ? finder->bound[v] : finder->wanted[v];
        for (uint32_t k = 0; k < ring.count; k++) {
            float wanted = finder->wanted[ring.spokes[k]];
            bound = wanted > bound ? wanted : bound;
        }
        finder->bound[v] = bound;
    }
}

static void find_bounds(Finder *finder)
{
    uint32_t threads = finder->worker_count, count = finder->mesh->vertex_count;
    if (!finder->small) {
        meso_parallel_for(threads, count, VERTEX_GRAIN, find_simple_bounds, finder);
        return;
    }
    meso_parallel_for(threads, count, VERTEX_GRAIN, find_wanted, finder);
    meso_parallel_for(threads, count, VERTEX_GRAIN, find_close_bounds, finder);
}

/* Greater the farther a seed is, and of equal ones the higher its number: bits of distances are in their order. */
static uint64_t slot_key(float distance, uint32_t seed)
{
    uint32_t bits;
    memcpy(&bits, &distance, sizeof bits);
    return (uint64_t)bits << 32 | seed;
}

/* Without branches, which would go either way as often. */
static void put_slot(MesoSeedSlots *slots, uint32_t seed, float distance)
{
    uint64_t moved = slot_key(distance, seed);
    for (uint32_t k = 0; k < SLOTS; k++) {
        uint64_t held = slot_key(slots->distance[k], slots->seed[k]);
        uint64_t nearer = moved < held ? moved : held;
        uint32_t bits = (uint32_t)(nearer >> 32);
        moved = moved < held ? held : moved;
        memcpy(&slots->distance[k], &bits, sizeof bits);
        slots->seed[k] = (uint32_t)nearer;
    }
}

/* Whoever comes first: the least of all that are put are the same then. */
static void put_in_turn(const Finder *finder, uint32_t vertex, uint32_t seed, float distance)
{
    uint32_t number = meso_domain_vertex_number(&finder->nearest->vertices, vertex);
    if (!finder->locks) {
        put_slot(&finder->nearest->slots[number], seed, distance);
        return;
    }
    while (atomic_exchange_explicit(&finder->locks[number], 1, memory_order_acquire))
        continue;
    put_slot(&finder->nearest->slots[number], seed, distance);
    atomic_store_explicit(&finder->locks[number], 0, memory_order_release);
}

/* Hands out what a run for the seed that is number `i` of the order has found. */
static void put_touched(const Finder *finder, MesoGeodesicSolver *solver, uint64_t i)
{
    float unit = 1 / solver->scale;
    for (uint32_t k = 0; k < solver->touched_count; k++) {
        uint32_t v = solver->touched[k];
        put_in_turn(finder, v, (uint32_t)finder->order[i], meso_geodesic_take(solver, v, unit));
    }
}

/* Distances from each of one or two seeds, of the order from number `i` on, where they matter. */
static MesoStatus solve_alone(const Finder *finder, MesoGeodesicSolver *const *solvers, uint64_t i, uint32_t count,
                              MesoError *error)
{
    MesoGeodesicQuery queries[2];
    MesoGeodesicRun runs[2];
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t *begin = &finder->planted_begin[i + k];
        queries[k] = (MesoGeodesicQuery){.domain = finder->nearest->domain, .seed_count = begin[1] - begin[0],
                                         .seeds = finder->planted + begin[0], .target = MESO_NO_INDEX, .keep = true};
        runs[k] = (MesoGeodesicRun){solvers[k], &queries[k], INFINITY, finder->bound};
    }
    MesoStatus status = count == 2 ? meso_geodesic_run_two(runs, error) : meso_geodesic_run(&runs[0], error);
    for (uint32_t k = 0; k < count; k++)
        put_touched(finder, solvers[k], i + k);
    return status;
}

static void solve_some(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Finder *finder = context;
    uint32_t step = finder->team_count / finder->worker_count;
    for (uint64_t i = begin; i < end && !finder->status[worker]; i += step)
        finder->status[worker] = solve_alone(finder, &finder->team[step * worker], i, i + step <= end ? step : 1,
                                             &finder->errors[worker]);
}

/* Borders that would cross a side within MESO_CUT_SNAP of its length from the vertex are to go through the vertex. */
static void find_snaps(void *context, uint64_t begin, uint64_t end)
{
    const Finder *finder = context;
    const MesoDomainVertices *vertices = &finder->nearest->vertices;
    for (uint32_t v = meso_domain_vertex_from(vertices, (uint32_t)begin); v < end;
         v = meso_domain_vertex_from(vertices, v + 1)) {
        float far = finder->together[v] + FAR * sqrtf(finder->longest[v]);
        finder->nearest->snap[v] = MESO_CUT_SNAP * (far - meso_seed_slots(finder->nearest, v)->distance[0]);
    }
}

static MesoStatus first_failure(const Finder *finder)
{
    for (uint32_t i = 0; i < finder->worker_count; i++)
        if (finder->status[i]) {
            if (finder->error)
                *finder->error = finder->errors[i];
            return finder->status[i];
        }
    return MESO_OK;
}

MesoStatus meso_nearest_seeds_find(MesoNearestSeeds *nearest, MesoArena *arena, const MesoTriangulation *mesh,
                                   MesoGeodesicSolver *solver, MesoError *error)
{
    Finder finder = {.mesh = mesh, .nearest = nearest, .arena = arena, .error = error,
                     .worker_count = nearest->threads};
    MesoStatus status = make_room(&finder);
    if (!status)
        status = plant_all(&finder);
    if (!status)
        status = make_team(&finder, solver);
    if (status)
        return status;
    uint32_t threads = finder.worker_count, seed_count = nearest->seed_count;
    uint64_t grain = 2 * (seed_count / (2 * SEED_RANGES * (uint64_t)threads) + 1);
    meso_parallel_for(threads, 2, 1, prepare_some, &finder);
    if (!finder.status[0]) {
        find_bounds(&finder);
        meso_parallel_team(threads, seed_count, grain, solve_some, &finder);
        nearest->snap = finder.wanted;
        meso_parallel_for(threads, mesh->vertex_count, VERTEX_GRAIN, find_snaps, &finder);
    }
    return first_failure(&finder);
}
