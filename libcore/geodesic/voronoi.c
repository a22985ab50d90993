#include "libcore/geodesic/voronoi.h"

#include <stdlib.h>

#include "libcore/base/grow.h"
#include "libcore/base/index_map.h"
#include "libcore/mesh/cut/mesh_domain.h"

enum { SLOTS = 3, EDGE_SEEDS = 2 * SLOTS, EDGE_CHANGES = EDGE_SEEDS, OUTLINE_CHANGES = 3 * EDGE_CHANGES };

/* The nearest seeds of a vertex, by distance and then by number; MESO_NO_INDEX where there are fewer. */
typedef struct Slots {
    float distance[SLOTS];
    uint32_t seed[SLOTS];
} Slots;

/* A change from one cell to the next along a side or an outline. */
typedef struct Change {
    uint32_t node;
    uint32_t seed[2];       /* before and behind */
    bool last;              /* of its side */
} Change;

typedef struct Tracer {
    const MesoTriangulation *mesh;
    const MesoVoronoiQuery *query;
    MesoGeodesicSolver *solver;
    MesoDomainVertices vertices;
    Slots *slots;               /* [vertices.count] */
    float *bound;               /* [vertex_count] what distances from a seed have to be below to matter */
    float *front;               /* [vertex_count] those of a solve; as `bound` before and after it */
    MesoIndexMap edges;         /* by the lower half-edge of an edge: its first of `changes` */
    uint32_t change_count, change_room;
    Change *changes;            /* [change_count] along the lower half-edges */
    MesoCutLines *lines;
    MesoArena *arena, *scratch;
    MesoError *error;
} Tracer;

static Slots *slots_of(const Tracer *tracer, uint32_t vertex)
{
    return &tracer->slots[meso_domain_vertex_number(&tracer->vertices, vertex)];
}

/* ---- distances ---- */

static MesoStatus make_room(Tracer *tracer)
{
    MesoStatus status = meso_domain_vertices_init(&tracer->vertices, tracer->scratch, tracer->mesh,
                                                  tracer->query->domain, tracer->error);
    if (status)
        return status;
    tracer->slots = MESO_NEW(tracer->scratch, Slots, tracer->vertices.count, tracer->error);
    tracer->bound = MESO_NEW(tracer->scratch, float, tracer->mesh->vertex_count, tracer->error);
    tracer->front = MESO_NEW(tracer->scratch, float, tracer->mesh->vertex_count, tracer->error);
    if (!tracer->slots || !tracer->bound || !tracer->front)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < tracer->vertices.count; i++)
        for (uint32_t k = 0; k < SLOTS; k++) {
            tracer->slots[i].distance[k] = INFINITY;
            tracer->slots[i].seed[k] = MESO_NO_INDEX;
        }
    return MESO_OK;
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

/* Distances from the nearest of all seeds, in `front`. */
static MesoStatus solve_together(Tracer *tracer)
{
    const MesoVoronoiQuery *query = tracer->query;
    MesoGeodesicSeed *planted = MESO_NEW(tracer->scratch, MesoGeodesicSeed, 3 * (size_t)query->seed_count, tracer->error);
    if (!planted)
        return MESO_ERR_MEMORY;
    MesoGeodesicQuery all = {.domain = query->domain, .seeds = planted, .target = MESO_NO_INDEX};
    for (uint32_t i = 0; i < query->seed_count; i++)
        all.seed_count += plant(tracer->mesh, &query->seeds[i], planted + all.seed_count);
    return meso_geodesic_solve(tracer->solver, &all, tracer->front, NULL, NULL, tracer->error);
}

/* The square of a vertex's longest side, in `bound`. */
static void find_longest_sides(Tracer *tracer)
{
    const MesoTriangulation *mesh = tracer->mesh;
    uint32_t count = meso_domain_size(tracer->query->domain, mesh);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *corners = mesh->corners + 3 * (size_t)meso_domain_triangle(tracer->query->domain, i);
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = corners[k], b = corners[k == 2 ? 0 : k + 1];
            MesoVec3 side = meso_vec3_sub(mesh->positions[a], mesh->positions[b]);
            float square = meso_vec3_dot(side, side);
            tracer->bound[a] = square > tracer->bound[a] ? square : tracer->bound[a];
            tracer->bound[b] = square > tracer->bound[b] ? square : tracer->bound[b];
        }
    }
}

/*
 * A front has to go where its seed is the nearest of a vertex, or of the other end of one of its sides: there each of
 * two seeds is nearer or farther by the side's length at most. A little more, for what rounding and fronts that mix
 * take off the least distance.
 */
static void find_bounds(Tracer *tracer)
{
    const float reach = 2.1f;
    find_longest_sides(tracer);
    for (uint32_t v = meso_domain_vertex_from(&tracer->vertices, 0); v != MESO_NO_INDEX;
         v = meso_domain_vertex_from(&tracer->vertices, v + 1))
        tracer->front[v] = tracer->bound[v] = tracer->front[v] + reach * sqrtf(tracer->bound[v]);
}

static void put_slot(Slots *slots, uint32_t seed, float distance)
{
    uint32_t k = SLOTS;
    while (k > 0 && (distance < slots->distance[k - 1] || (distance == slots->distance[k - 1] && seed < slots->seed[k - 1]))) {
        k--;
        if (k + 1 < SLOTS) {
            slots->distance[k + 1] = slots->distance[k];
            slots->seed[k + 1] = slots->seed[k];
        }
    }
    if (k < SLOTS) {
        slots->distance[k] = distance;
        slots->seed[k] = seed;
    }
}

/* Distances from one seed, where it matters. */
static MesoStatus solve_alone(Tracer *tracer, uint32_t seed)
{
    MesoGeodesicSeed planted[3];
    const uint32_t *touched;
    uint32_t touched_count;
    MesoGeodesicQuery one = {.domain = tracer->query->domain, .seeds = planted, .target = MESO_NO_INDEX, .keep = true};
    one.seed_count = plant(tracer->mesh, &tracer->query->seeds[seed], planted);
    MesoStatus status = meso_geodesic_solve(tracer->solver, &one, tracer->front, &touched, &touched_count, tracer->error);
    for (uint32_t i = 0; i < touched_count && !status; i++) {
        put_slot(slots_of(tracer, touched[i]), seed, tracer->front[touched[i]]);
        tracer->front[touched[i]] = tracer->bound[touched[i]];
    }
    return status;
}

/* A seed and its triangle. */
typedef struct SeedPlace {
    uint32_t triangle, seed;
} SeedPlace;

static int by_triangle(const void *a, const void *b)
{
    const SeedPlace *p = a, *q = b;
    return p->triangle != q->triangle ? (p->triangle < q->triangle ? -1 : 1) : (p->seed > q->seed) - (p->seed < q->seed);
}

/* One after another in the order of their triangles: what one has touched, the next finds in the caches. */
static MesoStatus solve_each(Tracer *tracer)
{
    uint32_t count = tracer->query->seed_count;
    SeedPlace *places = MESO_NEW(tracer->scratch, SeedPlace, count, tracer->error);
    if (!places)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        places[i] = (SeedPlace){tracer->query->seeds[i].triangle, i};
    qsort(places, count, sizeof *places, by_triangle);
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++)
        status = solve_alone(tracer, places[i].seed);
    return status;
}

static MesoStatus solve(Tracer *tracer)
{
    MesoStatus status = make_room(tracer);
    if (!status)
        status = solve_together(tracer);
    if (status)
        return status;
    find_bounds(tracer);
    return solve_each(tracer);
}

/* ---- sides ---- */

static double slot_distance(const Slots *slots, uint32_t seed)
{
    for (uint32_t k = 0; k < SLOTS; k++)
        if (slots->seed[k] == seed)
            return slots->distance[k];
    return INFINITY;
}

/* A seed's distances at the two ends of a side. */
typedef struct EndDistances {
    uint32_t seed;
    double at[2];
} EndDistances;

/* The seeds that both ends know, and each end's nearest, which is at most the side's length farther at the other. */
static uint32_t seeds_of_side(const Slots *ends[2], double length, EndDistances found[EDGE_SEEDS])
{
    uint32_t count = 0;
    for (uint32_t end = 0; end < 2; end++)
        for (uint32_t k = 0; k < SLOTS; k++) {
            uint32_t seed = ends[end]->seed[k];
            double own = ends[end]->distance[k], other = slot_distance(ends[1 - end], seed);
            if (seed == MESO_NO_INDEX || (other == INFINITY && k > 0) || (end == 1 && other < INFINITY))
                continue;
            other = fmin(other, own + length);
            found[count++] = (EndDistances){seed, {end == 0 ? own : other, end == 0 ? other : own}};
        }
    return count;
}

/* Where along the side a seed becomes nearer than `now`; INFINITY where it does not. */
static double overtakes(const EndDistances *now, const EndDistances *other)
{
    double begin = other->at[0] - now->at[0], end = other->at[1] - now->at[1];
    if (!(end < 0 || (end == 0 && other->seed < now->seed && begin > 0)))
        return INFINITY;
    return begin > 0 ? begin / (begin - end) : 0;
}

static const EndDistances *find_seed(const EndDistances *seeds, uint32_t count, uint32_t seed)
{
    for (uint32_t i = 0; i < count; i++)
        if (seeds[i].seed == seed)
            return &seeds[i];
    return NULL;
}

/* The one that overtakes first, and goes on lowest of several. */
static const EndDistances *next_seed(const EndDistances *seeds, uint32_t count, const EndDistances *now, double *share)
{
    const EndDistances *next = NULL;
    double soonest = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        double at = overtakes(now, &seeds[i]);
        if (at < soonest || (next && at == soonest && seeds[i].at[1] < next->at[1])) {
            soonest = at;
            next = &seeds[i];
        }
    }
    *share = soonest;
    return next;
}

static MesoStatus add_change(Tracer *tracer, uint32_t half_edge, double share, Change change)
{
    tracer->changes = MESO_GROW(tracer->scratch, tracer->changes, tracer->change_count, tracer->change_room, 256,
                                tracer->error);
    if (!tracer->changes)
        return MESO_ERR_MEMORY;
    MesoCutNode node = {MESO_ON_EDGE, half_edge, {(float)share}};
    MesoStatus status = meso_cut_add_node(tracer->lines, tracer->arena, node, &change.node, tracer->error);
    tracer->changes[tracer->change_count++] = change;
    return status;
}

/* The lower envelope of the distances along a side between two cells. */
static MesoStatus change_along(Tracer *tracer, uint32_t half_edge)
{
    const MesoTriangulation *mesh = tracer->mesh;
    uint32_t a = mesh->corners[half_edge], b = mesh->corners[meso_next_corner(half_edge)];
    const Slots *ends[2] = {slots_of(tracer, a), slots_of(tracer, b)};
    double length = meso_vec3_length(meso_vec3_sub(mesh->positions[a], mesh->positions[b])), share, along = 0;
    EndDistances seeds[EDGE_SEEDS];
    uint32_t count = seeds_of_side(ends, length, seeds), last = ends[1]->seed[0];
    const EndDistances *now = find_seed(seeds, count, ends[0]->seed[0]);
    MesoStatus status = MESO_OK;
    for (uint32_t i = 1; !status && now->seed != last; i++) {
        const EndDistances *next = next_seed(seeds, count, now, &share);
        if (!next || i == EDGE_CHANGES) {   /* of equal distances the lower number counts at the end */
            next = find_seed(seeds, count, last);
            share = fmin(share, 1);
        }
        along = fmax(along, share);
        status = add_change(tracer, half_edge, along, (Change){.seed = {now->seed, next->seed}, .last = next->seed == last});
        now = next;
    }
    return status;
}

/* ---- triangles ---- */

/* Appends the changes of a side between two cells to those of the outline. */
static MesoStatus add_side(Tracer *tracer, uint32_t half_edge, Change *outline, uint32_t *count)
{
    uint32_t twin = tracer->mesh->twins[half_edge], edge = twin < half_edge ? twin : half_edge;
    uint32_t *first = meso_index_map_at(&tracer->edges, tracer->scratch, edge, tracer->error);
    if (!first)
        return MESO_ERR_MEMORY;
    if (*first == MESO_NO_INDEX) {
        *first = tracer->change_count;
        MesoStatus status = change_along(tracer, edge);
        if (status)
            return status;
    }
    bool same = tracer->mesh->corners[edge] == tracer->mesh->corners[half_edge];
    uint32_t begin = *first, end = begin;
    while (!tracer->changes[end++].last)
        continue;
    for (uint32_t i = 0; i < end - begin; i++) {
        Change change = tracer->changes[same ? begin + i : end - 1 - i];
        if (!same)
            change = (Change){change.node, {change.seed[1], change.seed[0]}, false};
        outline[(*count)++] = change;
    }
    return MESO_OK;
}

/* Weights of the point at which three seeds are equally far; false where it is not inside. */
static bool meeting_point(const Tracer *tracer, uint32_t triangle, const Change *outline, double weight[3])
{
    double d[3][2];     /* by corner: how much farther the second and the third seed are than the first */
    for (uint32_t k = 0; k < 3; k++) {
        const Slots *slots = slots_of(tracer, tracer->mesh->corners[3 * (size_t)triangle + k]);
        double first = slot_distance(slots, outline[0].seed[0]);
        d[k][0] = slot_distance(slots, outline[1].seed[0]) - first;
        d[k][1] = slot_distance(slots, outline[2].seed[0]) - first;
    }
    double sum = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t a = (k + 1) % 3, b = (k + 2) % 3;
        weight[k] = d[a][0] * d[b][1] - d[a][1] * d[b][0];
        sum += weight[k];
    }
    for (uint32_t k = 0; k < 3; k++) {
        weight[k] /= sum;
        if (!(weight[k] > 0 && weight[k] < 1))
            return false;
    }
    return true;
}

static void middle_of_changes(const Tracer *tracer, uint32_t triangle, const Change *outline, uint32_t count,
                              double weight[3])
{
    const uint32_t *corners = tracer->mesh->corners;
    weight[0] = weight[1] = weight[2] = 0;
    for (uint32_t i = 0; i < count; i++) {
        const MesoCutNode *node = &tracer->lines->nodes[outline[i].node];
        uint32_t ends[2] = {corners[node->element], corners[meso_next_corner(node->element)]};
        for (uint32_t k = 0; k < 3; k++)
            for (uint32_t end = 0; end < 2; end++)
                if (corners[3 * triangle + k] == ends[end])
                    weight[k] += (end ? node->share[0] : 1.0 - node->share[0]) / count;
    }
}

static MesoStatus add_segment(Tracer *tracer, uint32_t triangle, const Change *from, uint32_t to)
{
    uint32_t line = from->seed[0] < from->seed[1] ? from->seed[0] : from->seed[1];
    MesoCutSegment segment = {{from->node, to}, triangle, line};
    return meso_cut_add_segment(tracer->lines, tracer->arena, segment, tracer->error);
}

/* Joins all changes of a triangle's outline to one node inside. */
static MesoStatus add_star(Tracer *tracer, uint32_t triangle, const Change *outline, uint32_t count)
{
    double weight[3];
    uint32_t middle;
    bool three = count == 3 && outline[0].seed[0] != outline[1].seed[0] && outline[1].seed[0] != outline[2].seed[0] &&
                 outline[2].seed[0] != outline[0].seed[0];
    if (!three || !meeting_point(tracer, triangle, outline, weight))
        middle_of_changes(tracer, triangle, outline, count, weight);
    MesoCutNode node = {MESO_IN_TRIANGLE, triangle, {(float)weight[1], (float)weight[2]}};
    MesoStatus status = meso_cut_add_node(tracer->lines, tracer->arena, node, &middle, tracer->error);
    for (uint32_t i = 0; i < count && !status; i++)
        status = add_segment(tracer, triangle, &outline[i], middle);
    return status;
}

static MesoStatus trace_triangle(Tracer *tracer, uint32_t triangle)
{
    const uint32_t *corners = tracer->mesh->corners + 3 * (size_t)triangle;
    uint32_t seeds[3], count = 0;
    for (uint32_t k = 0; k < 3; k++)
        seeds[k] = slots_of(tracer, corners[k])->seed[0];
    if ((seeds[0] == seeds[1] && seeds[1] == seeds[2]) || seeds[0] == MESO_NO_INDEX || seeds[1] == MESO_NO_INDEX ||
        seeds[2] == MESO_NO_INDEX)
        return MESO_OK;
    Change outline[OUTLINE_CHANGES];
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 3 && !status; k++)
        if (seeds[k] != seeds[k == 2 ? 0 : k + 1])
            status = add_side(tracer, 3 * triangle + k, outline, &count);
    if (status)
        return status;
    return count == 2 ? add_segment(tracer, triangle, &outline[0], outline[1].node)
                      : add_star(tracer, triangle, outline, count);
}

/* ---- results ---- */

static void hand_out(const Tracer *tracer, uint32_t *cell, float *distance)
{
    const MesoDomainVertices *vertices = &tracer->vertices;
    for (uint32_t v = meso_domain_vertex_from(vertices, 0); v != MESO_NO_INDEX;
         v = meso_domain_vertex_from(vertices, v + 1)) {
        const Slots *slots = slots_of(tracer, v);
        if (cell)
            cell[v] = slots->seed[0];
        if (distance)
            distance[v] = slots->distance[0];
    }
}

MesoStatus meso_voronoi_trace(MesoCutLines *lines, uint32_t *cell, float *distance, MesoArena *arena,
                              const MesoTriangulation *mesh, MesoGeodesicSolver *solver, const MesoVoronoiQuery *query,
                              MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    Tracer tracer = {.mesh = mesh, .query = query, .solver = solver, .lines = lines, .arena = arena,
                     .scratch = &scratch, .error = error};
    MesoStatus status = solve(&tracer);
    uint32_t count = meso_domain_size(query->domain, mesh);
    for (uint32_t i = 0; i < count && !status; i++)
        status = trace_triangle(&tracer, meso_domain_triangle(query->domain, i));
    if (!status)
        hand_out(&tracer, cell, distance);
    meso_arena_release(&scratch);
    return status;
}
