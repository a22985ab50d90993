#include "libcore/geodesic/front_kernel.h"
#include "libcore/geodesic/front_kernel_avx2.h"
#include "libcore/geodesic/front_kernel_four.h"

/*
 * Nothing but rounding can make a vertex lower another and then be lowered by it; should that go on, what comes
 * through a triangle is no longer let below the vertex that tells it, and then it ends as Dijkstra's algorithm does.
 */
enum { PATIENCE = 16, PATIENCE_LEAST = 65536 };

typedef uint32_t (*FrontStep)(const MesoFrontStep *step, float *found);

typedef struct Fronts {
    const MesoGeodesicRun *run;
    MesoGeodesicSolver *solver;
    uint64_t visits;
    uint32_t next;  /* place in the current bucket, of two at once */
    bool hasty;     /* out of patience */
} Fronts;

#define ALWAYS_INLINE static inline __attribute__((always_inline))

ALWAYS_INLINE void lower(const MesoGeodesicRun *run, uint32_t vertex, float distance)
{
    MesoGeodesicSolver *solver = run->solver;
    float before = __builtin_fabsf(solver->rows[vertex].distance), length = __builtin_fabsf(distance);
    if (!meso_geodesic_lowers(run, vertex, distance))
        return;
    solver->rows[vertex].distance = distance;
    int32_t place = meso_bucket_place(&solver->buckets, length);
    bool queued = solver->states[vertex] & MESO_VERTEX_QUEUED;
    if (queued && meso_bucket_place(&solver->buckets, before) == place)
        return;
    solver->states[vertex] |= MESO_VERTEX_QUEUED;
    meso_buckets_put(&solver->buckets, place, vertex, length);
}

ALWAYS_INLINE void tell_window(Fronts *fronts, uint32_t vertex, const uint32_t *spokes, uint32_t count, bool closed,
                               FrontStep step)
{
    MesoGeodesicSolver *solver = fronts->solver;
    float found[8];
    float least = fronts->hasty ? __builtin_fabsf(solver->rows[vertex].distance) : 0;
    uint32_t lowered = step(&(MesoFrontStep){solver->rows, vertex, spokes, count, closed, least}, found);
    for (; lowered; lowered &= lowered - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(lowered);
        lower(fronts->run, spokes[i], found[i]);
    }
}

/* Eight spokes at a time; the last of them is the first of the next, so that no triangle is left out. */
ALWAYS_INLINE void tell_long_ring(Fronts *fronts, uint32_t vertex, MesoOneRing ring, FrontStep step)
{
    for (uint32_t begin = 0; begin + 1 < ring.count; begin += 7) {
        uint32_t rest = ring.count - begin;
        tell_window(fronts, vertex, ring.spokes + begin, rest < 8 ? rest : 8, false, step);
    }
    if (ring.closed) {
        uint32_t seam[MESO_RING_SLACK] = {ring.spokes[ring.count - 1], ring.spokes[0]};
        tell_window(fronts, vertex, seam, 2, false, step);
    }
}

/* Spokes of a walk around a vertex, told whenever eight have come together. */
typedef struct Window {
    uint32_t count, spokes[MESO_RING_SLACK];
} Window;

ALWAYS_INLINE void end_window(Fronts *fronts, uint32_t vertex, Window *window, FrontStep step)
{
    if (window->count >= 2)
        tell_window(fronts, vertex, window->spokes, window->count, false, step);
    window->count = 0;
}

ALWAYS_INLINE void add_triangle(Fronts *fronts, uint32_t vertex, Window *window, uint32_t entry, uint32_t leaving,
                                FrontStep step)
{
    if (window->count == MESO_RING_SLACK)
        end_window(fronts, vertex, window, step);
    if (window->count == 0)
        window->spokes[window->count++] = entry;
    window->spokes[window->count++] = leaving;
}

/* The triangles of the domain alone. */
ALWAYS_INLINE void tell_domain(Fronts *fronts, uint32_t vertex, FrontStep step)
{
    const MesoTriangulation *mesh = fronts->solver->mesh;
    MesoFan fan = meso_fan_first(mesh, vertex);
    uint32_t first = fan.corner;
    Window window = {0};
    do {
        uint32_t next = mesh->corners[meso_next_corner(fan.corner)];
        uint32_t previous = mesh->corners[meso_previous_corner(fan.corner)];
        if (!meso_domain_has(fronts->run->query->domain, mesh, fan.corner / 3))
            end_window(fronts, vertex, &window, step);
        else
            add_triangle(fronts, vertex, &window, fan.turned ? previous : next, fan.turned ? next : previous, step);
    } while (meso_fan_next(mesh, &fan) && fan.corner != first);
    end_window(fronts, vertex, &window, step);
}

/* Whether the triangles around a vertex are told of in one step. */
ALWAYS_INLINE bool is_one_step(const Fronts *fronts, uint32_t vertex, MesoOneRing ring, bool everywhere)
{
    return ring.count - 2 <= 6 && (everywhere || !(fronts->solver->states[vertex] & MESO_VERTEX_WALLED));
}

ALWAYS_INLINE void tell(Fronts *fronts, uint32_t vertex, bool everywhere, FrontStep step)
{
    MesoGeodesicSolver *solver = fronts->solver;
    if (!everywhere && solver->states[vertex] & MESO_VERTEX_WALLED) {
        tell_domain(fronts, vertex, step);
        return;
    }
    MesoOneRing ring = meso_one_ring(&solver->rings, vertex);
    if (ring.count < 2)
        return;
    if (ring.count <= 8)
        tell_window(fronts, vertex, ring.spokes, ring.count, ring.closed, step);
    else
        tell_long_ring(fronts, vertex, ring, step);
}

/*
 * Most of the time goes by waiting for memory unless that is asked for early: first a vertex and where its ring lies,
 * then the ring, then what most rings have at the least of the vertices in it.
 */
enum { VERTEX_AHEAD = 12, RING_AHEAD = 6, SPOKES_AHEAD = 3, SPOKES_MOSTLY = 6 };

ALWAYS_INLINE void look_ahead(const MesoGeodesicSolver *solver, const MesoBucket *bucket, uint32_t i)
{
    const MesoOneRings *rings = &solver->rings;
    if (i + VERTEX_AHEAD < bucket->count) {
        uint32_t vertex = bucket->vertices[i + VERTEX_AHEAD];
        __builtin_prefetch(&rings->begins[vertex]);
        __builtin_prefetch(&rings->sizes[vertex]);
        __builtin_prefetch(&solver->rows[vertex]);
        __builtin_prefetch(&solver->states[vertex]);
    }
    if (i + RING_AHEAD < bucket->count)
        __builtin_prefetch(&rings->pool[rings->begins[bucket->vertices[i + RING_AHEAD]]]);
    if (i + SPOKES_AHEAD < bucket->count) {
        const uint32_t *spokes = &rings->pool[rings->begins[bucket->vertices[i + SPOKES_AHEAD]]];
        for (uint32_t k = 0; k < SPOKES_MOSTLY; k++)
            __builtin_prefetch(&solver->rows[spokes[k]]);
    }
}

ALWAYS_INLINE void end_bucket(Fronts *fronts)
{
    MesoBuckets *buckets = &fronts->solver->buckets;
    buckets->open[buckets->current % MESO_BUCKET_COUNT].count = 0;
    meso_bits_clear(buckets->filled, (uint32_t)buckets->current % MESO_BUCKET_COUNT);
    fronts->hasty = fronts->visits > PATIENCE * (uint64_t)fronts->solver->touched_count + PATIENCE_LEAST;
}

/* Vertices that come into the bucket meanwhile are behind the others. */
ALWAYS_INLINE void empty_bucket(Fronts *fronts, bool everywhere, FrontStep step)
{
    MesoGeodesicSolver *solver = fronts->solver;
    MesoBucket *bucket = &solver->buckets.open[solver->buckets.current % MESO_BUCKET_COUNT];
    for (uint32_t i = 0; i < bucket->count; i++) {
        uint32_t vertex = bucket->vertices[i];
        look_ahead(solver, bucket, i);
        if (!(solver->states[vertex] & MESO_VERTEX_QUEUED))
            continue;
        solver->states[vertex] &= (uint8_t)~MESO_VERTEX_QUEUED;
        tell(fronts, vertex, everywhere, step);
        fronts->visits++;
    }
    end_bucket(fronts);
}

/* Opens the window anew from the nearest vertex beyond it. */
static void open_window(MesoGeodesicSolver *solver)
{
    MesoBuckets *buckets = &solver->buckets;
    uint32_t count = buckets->beyond.count;
    if (buckets->nearest_beyond > buckets->current)
        buckets->current = buckets->nearest_beyond;
    buckets->nearest_beyond = MESO_BUCKET_LAST;
    buckets->beyond.count = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t vertex = buckets->beyond.vertices[i];
        float distance = __builtin_fabsf(solver->rows[vertex].distance);
        if (solver->states[vertex] & MESO_VERTEX_QUEUED)
            meso_buckets_put(buckets, meso_bucket_place(buckets, distance), vertex, distance);
    }
}

static bool next_bucket(MesoGeodesicSolver *solver)
{
    MesoBuckets *buckets = &solver->buckets;
    for (;;) {
        int32_t before = buckets->current;
        bool found = meso_buckets_turn(buckets);
        if (!buckets->beyond.count || (found && buckets->current < buckets->nearest_beyond))
            return found;
        buckets->current = before;
        open_window(solver);
    }
}

/* Everything is final that is nearer than the current bucket. */
static bool target_is_final(const MesoGeodesicSolver *solver, uint32_t target)
{
    if (target == MESO_NO_INDEX)
        return false;
    const MesoGeodesicRow *row = &solver->rows[target];
    MesoOneRing ring = meso_one_ring(&solver->rings, target);
    float longest = 0;
    for (uint32_t i = 0; i < ring.count; i++) {
        const MesoGeodesicRow *end = &solver->rows[ring.spokes[i]];
        longest = fmaxf(longest, meso_vec3_length((MesoVec3){end->x - row->x, end->y - row->y, end->z - row->z}));
    }
    float reach = (fabsf(row->distance) + longest) * solver->buckets.inverse_width;
    return reach < (float)solver->buckets.current;
}

ALWAYS_INLINE void propagate(Fronts *fronts, bool everywhere, FrontStep step)
{
    MesoGeodesicSolver *solver = fronts->solver;
    while (!solver->buckets.out_of_memory && next_bucket(solver) &&
           !target_is_final(solver, fronts->run->query->target))
        empty_bucket(fronts, everywhere, step);
}

/* ---- two at once ---- */

/* The next vertex that is due, and is no more; MESO_NO_INDEX at the end. */
ALWAYS_INLINE uint32_t next_due(Fronts *fronts)
{
    MesoGeodesicSolver *solver = fronts->solver;
    do {
        const MesoBucket *bucket = &solver->buckets.open[solver->buckets.current % MESO_BUCKET_COUNT];
        while (fronts->next < bucket->count) {
            uint32_t vertex = bucket->vertices[fronts->next++];
            if (!(solver->states[vertex] & MESO_VERTEX_QUEUED))
                continue;
            solver->states[vertex] &= (uint8_t)~MESO_VERTEX_QUEUED;
            fronts->visits++;
            return vertex;
        }
        end_bucket(fronts);
        fronts->next = 0;
    } while (!solver->buckets.out_of_memory && next_bucket(solver));
    return MESO_NO_INDEX;
}

/*
 * A step of the one and a step of the other, and then what each tells. They do not wait for each other, as steps of one
 * do, of which the next cannot begin before it is known what the last has told.
 */
ALWAYS_INLINE void propagate_two(Fronts fronts[2], bool everywhere, FrontStep step)
{
    uint32_t due[2] = {next_due(&fronts[0]), next_due(&fronts[1])};
    while (due[0] != MESO_NO_INDEX && due[1] != MESO_NO_INDEX) {
        MesoOneRing rings[2];
        uint32_t lowered[2] = {0, 0};
        float found[2][8];
        for (uint32_t k = 0; k < 2; k++) {
            const MesoGeodesicSolver *solver = fronts[k].solver;
            float least = fronts[k].hasty ? __builtin_fabsf(solver->rows[due[k]].distance) : 0;
            rings[k] = meso_one_ring(&solver->rings, due[k]);
            if (is_one_step(&fronts[k], due[k], rings[k], everywhere))
                lowered[k] = step(&(MesoFrontStep){solver->rows, due[k], rings[k].spokes, rings[k].count,
                                                   rings[k].closed, least}, found[k]);
            else
                tell(&fronts[k], due[k], everywhere, step);
        }
        for (uint32_t k = 0; k < 2; k++) {
            for (; lowered[k]; lowered[k] &= lowered[k] - 1) {
                uint32_t i = (uint32_t)__builtin_ctz(lowered[k]);
                lower(fronts[k].run, rings[k].spokes[i], found[k][i]);
            }
            due[k] = next_due(&fronts[k]);
        }
    }
    for (uint32_t k = 0; k < 2; k++)
        for (; due[k] != MESO_NO_INDEX; due[k] = next_due(&fronts[k]))
            tell(&fronts[k], due[k], everywhere, step);
}

/* ---- for the machine ---- */

ALWAYS_INLINE void propagate_some(Fronts *fronts, uint32_t count, bool everywhere, FrontStep step)
{
    if (count == 2)
        propagate_two(fronts, everywhere, step);
    else
        propagate(fronts, everywhere, step);
}

static void propagate_plain(Fronts *fronts, uint32_t count, bool everywhere)
{
#ifdef MESO_HAS_FRONT_STEP_FOUR
    propagate_some(fronts, count, everywhere, meso_front_step_four);
#else
    propagate_some(fronts, count, everywhere, meso_front_step_plain);
#endif
}

#ifdef MESO_HAS_FRONT_STEP_AVX2
__attribute__((target("avx2"))) static void propagate_avx2(Fronts *fronts, uint32_t count, bool everywhere)
{
    propagate_some(fronts, count, everywhere, meso_front_step_avx2);
}

static bool machine_has_avx2(void)
{
    return __builtin_cpu_supports("avx2");
}
#else
static void propagate_avx2(Fronts *fronts, uint32_t count, bool everywhere)
{
    propagate_plain(fronts, count, everywhere);
}

static bool machine_has_avx2(void)
{
    return false;
}
#endif

/* Of seeds at one vertex the nearest counts, and a line before a point. */
static void plant_seeds(const MesoGeodesicRun *run)
{
    const MesoGeodesicQuery *query = run->query;
    MesoGeodesicSolver *solver = run->solver;
    for (uint32_t i = 0; i < query->seed_count; i++) {
        const MesoGeodesicSeed *seed = &query->seeds[i];
        float length = seed->distance * solver->scale, distance = seed->line ? -length : length;
        float *row = &solver->rows[seed->vertex].distance;
        if (seed->line && length == fabsf(*row) && length < INFINITY)
            *row = distance;
        else
            lower(run, seed->vertex, distance);
    }
}

bool meso_fronts_run(const MesoGeodesicRun *runs, uint32_t count)
{
    Fronts fronts[2];
    const MesoDomain *domain = runs[0].query->domain;
    bool everywhere = !domain || !domain->member, in_memory = true;
    for (uint32_t k = 0; k < count; k++) {
        fronts[k] = (Fronts){.run = &runs[k], .solver = runs[k].solver};
        meso_buckets_clear(&runs[k].solver->buckets);
        plant_seeds(&runs[k]);
        meso_geodesic_round_ends(&runs[k]);
    }
    if (runs[0].solver->plain || !machine_has_avx2())
        propagate_plain(fronts, count, everywhere);
    else
        propagate_avx2(fronts, count, everywhere);
    for (uint32_t k = 0; k < count; k++)
        in_memory = in_memory && !runs[k].solver->buckets.out_of_memory;
    return in_memory;
}
