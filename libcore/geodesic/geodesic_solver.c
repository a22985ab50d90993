#include "libcore/geodesic/geodesic_solver.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/geodesic/exact/exact_geodesic.h"
#include "libcore/mesh/cut/mesh_cut.h"

/* ---- room ---- */

static bool enlarge(void **array, size_t count, size_t size)
{
    void *larger = realloc(*array, count * size);
    if (larger)
        *array = larger;
    return larger != NULL;
}

static MesoStatus reserve(MesoGeodesicSolver *solver, uint32_t vertex_count, MesoError *error)
{
    if (vertex_count <= solver->vertex_room)
        return MESO_OK;
    uint64_t room = solver->vertex_room + solver->vertex_room / 4;
    room = room < vertex_count ? vertex_count : room > UINT32_MAX - 1 ? UINT32_MAX - 1 : room;
    if (!enlarge((void **)&solver->rows, room, sizeof *solver->rows) ||
        !enlarge((void **)&solver->states, room, sizeof *solver->states) ||
        !enlarge((void **)&solver->touched, room, sizeof *solver->touched))
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: distances of %u vertices", vertex_count);
    MesoStatus status = meso_one_rings_reserve(&solver->rings, (uint32_t)room, error);
    if (!status)
        solver->vertex_room = (uint32_t)room;
    return status;
}

/* ---- lengths ---- */

static MesoGeodesicRow scaled_row(MesoVec3 position, float scale)
{
    return (MesoGeodesicRow){position.x * scale, position.y * scale, position.z * scale, INFINITY};
}

/* The power of two that brings the largest coordinate to between 1/2 and 1. */
static float fitting_scale(const MesoVec3 *positions, uint32_t count)
{
    float largest = 0;
    for (uint32_t v = 0; v < count; v++) {
        float x = fabsf(positions[v].x), y = fabsf(positions[v].y), z = fabsf(positions[v].z);
        x = x > y ? x : y;
        x = x > z ? x : z;
        largest = x > largest ? x : largest;
    }
    int exponent = 0;
    frexpf(largest, &exponent);
    exponent = exponent > 100 ? 100 : exponent < -100 ? -100 : exponent;
    return largest > 0 && largest < INFINITY ? ldexpf(1, -exponent) : 1;
}

/* Of the rings of some 65536 vertices, evenly spread. */
static float mean_spoke(const MesoGeodesicSolver *solver)
{
    double sum = 0;
    uint64_t count = 0;
    uint32_t step = solver->vertex_count / 65536 + 1;
    for (uint64_t v = 0; v < solver->vertex_count; v += step) {
        MesoOneRing ring = meso_one_ring(&solver->rings, (uint32_t)v);
        const MesoGeodesicRow *from = &solver->rows[v];
        for (uint32_t k = 0; k < ring.count; k++, count++) {
            const MesoGeodesicRow *to = &solver->rows[ring.spokes[k]];
            sum += meso_vec3_length((MesoVec3){to->x - from->x, to->y - from->y, to->z - from->z});
        }
    }
    return count ? (float)(sum / (double)count) : 0;
}

/* Buckets of half a side keep the number of visits near one a vertex. */
static void take_positions(MesoGeodesicSolver *solver, const MesoVec3 *positions)
{
    solver->scale = fitting_scale(positions, solver->vertex_count);
    for (uint32_t v = 0; v < solver->vertex_count; v++)
        solver->rows[v] = scaled_row(positions[v], solver->scale);
    float side = mean_spoke(solver);
    solver->buckets.inverse_width = side > 1e-30f && side < INFINITY ? 2 / side : 1;
}

static void note_walls(MesoGeodesicSolver *solver, uint32_t triangle)
{
    const MesoTriangulation *mesh = solver->mesh;
    for (uint32_t k = 0; k < 3 && mesh->walls[triangle]; k++) {
        uint32_t side = 3 * triangle + k;
        uint8_t *begin = &solver->states[mesh->corners[side]];
        *begin |= MESO_VERTEX_NEAR_WALL;
        if (meso_side_is_wall(mesh, side)) {
            *begin |= MESO_VERTEX_WALLED;
            solver->states[mesh->corners[meso_next_corner(side)]] |= MESO_VERTEX_WALLED;
        }
    }
}

/* What follows from mesh and positions is made again when it is wanted. */
static void note_change(MesoGeodesicSolver *solver)
{
    meso_geodesic_graph_release(solver->graph);
    solver->graph = NULL;
    for (uint32_t i = 0; i < MESO_TEAM_MOST - 1; i++)
        if (solver->twins[i])
            solver->twins[i]->is_like = false;
}

MesoStatus meso_geodesic_set_positions(MesoGeodesicSolver *solver, const MesoVec3 *positions, MesoError *error)
{
    (void)error;
    note_change(solver);
    take_positions(solver, positions);
    return MESO_OK;
}

/* ---- making ---- */

MesoStatus meso_geodesic_init(MesoGeodesicSolver **made, const MesoTriangulation *mesh, MesoGeodesicEngine engine,
                              MesoError *error)
{
    *made = NULL;
    MesoGeodesicSolver *solver = calloc(1, sizeof *solver);
    if (!solver)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: a solver of distances");
    solver->mesh = mesh;
    solver->engine = engine;
    MesoStatus status = meso_one_rings_init(&solver->rings, mesh, error);
    if (!status)
        status = reserve(solver, mesh->vertex_count + 1, error);
    if (status) {
        meso_geodesic_release(solver);
        return status;
    }
    solver->vertex_count = mesh->vertex_count;
    memset(solver->states, 0, solver->vertex_room);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        note_walls(solver, t);
    take_positions(solver, mesh->positions);
    *made = solver;
    return MESO_OK;
}

void meso_geodesic_release(MesoGeodesicSolver *solver)
{
    if (!solver)
        return;
    meso_geodesic_graph_release(solver->graph);
    for (uint32_t i = 0; i < MESO_TEAM_MOST - 1; i++)
        meso_geodesic_twin_release(solver->twins[i]);
    meso_buckets_release(&solver->buckets);
    meso_one_rings_release(&solver->rings);
    free(solver->rows);
    free(solver->states);
    free(solver->touched);
    free(solver);
}

/* ---- after a cut ---- */

static MesoStatus remake_ring(MesoGeodesicSolver *solver, uint32_t vertex, MesoError *error)
{
    if (!(solver->states[vertex] & MESO_VERTEX_MARKED))
        return MESO_OK;
    solver->states[vertex] &= (uint8_t)~MESO_VERTEX_MARKED;
    return meso_one_rings_remake(&solver->rings, solver->mesh, vertex, error);
}

static MesoStatus remake_rings(MesoGeodesicSolver *solver, const MesoCutReport *report, MesoError *error)
{
    const uint32_t *corners = solver->mesh->corners;
    for (uint32_t p = 0; p < report->part_count; p++) {
        note_walls(solver, report->parts[p].triangle);
        for (uint32_t k = 0; k < 3; k++)
            solver->states[corners[3 * report->parts[p].triangle + k]] |= MESO_VERTEX_MARKED;
    }
    MesoStatus status = MESO_OK;
    for (uint32_t p = 0; p < report->part_count; p++)
        for (uint32_t k = 0; k < 3 && !status; k++)
            status = remake_ring(solver, corners[3 * report->parts[p].triangle + k], error);
    return status;
}

MesoStatus meso_geodesic_update(MesoGeodesicSolver *solver, const MesoCutReport *report, MesoError *error)
{
    const MesoTriangulation *mesh = solver->mesh;
    MesoStatus status = reserve(solver, mesh->vertex_count, error);
    if (status)
        return status;
    for (uint32_t v = solver->vertex_count; v < mesh->vertex_count; v++) {
        solver->rows[v] = scaled_row(mesh->positions[v], solver->scale);
        solver->states[v] = 0;
    }
    solver->vertex_count = mesh->vertex_count;
    note_change(solver);
    return remake_rings(solver, report, error);
}

/* ---- solving ---- */

static void clear_distances(const MesoTriangulation *mesh, const MesoDomain *domain, float *distance)
{
    uint32_t count = domain->triangles ? domain->triangle_count : mesh->triangle_count;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t = domain->triangles ? domain->triangles[i] : i;
        if (meso_domain_has(domain, mesh, t))
            for (uint32_t k = 0; k < 3; k++)
                distance[mesh->corners[3 * t + k]] = INFINITY;
    }
}

/* Hands the distances out, and leaves the rows as they were. `all`: of vertices without distance, too. */
static void take_distances(MesoGeodesicSolver *solver, bool all, float *distance)
{
    float unit = 1 / solver->scale;
    uint32_t count = all ? solver->vertex_count : solver->touched_count;
    if (all)
        for (uint32_t v = 0; v < count; v++)
            distance[v] = meso_geodesic_take(solver, v, unit);
    else
        for (uint32_t i = 0; i < count; i++)
            distance[solver->touched[i]] = meso_geodesic_take(solver, solver->touched[i], unit);
}

/* The rows' positions without their scale, which as a power of two leaves no trace. */
static MesoVec3 *row_positions(const MesoGeodesicSolver *solver, MesoArena *arena, MesoError *error)
{
    MesoVec3 *positions = MESO_NEW(arena, MesoVec3, solver->vertex_count, error);
    float unit = 1 / solver->scale;
    for (uint32_t v = 0; positions && v < solver->vertex_count; v++)
        positions[v] = (MesoVec3){solver->rows[v].x * unit, solver->rows[v].y * unit, solver->rows[v].z * unit};
    return positions;
}

/* Fills the rows with what the exact solver finds. */
static MesoStatus run_exact(const MesoGeodesicRun *run, MesoArena *arena, MesoError *error)
{
    const MesoGeodesicQuery *query = run->query;
    MesoGeodesicSolver *solver = run->solver;
    MesoExactGeodesicField field;
    MesoVec3 *positions = row_positions(solver, arena, error);
    double *distance = MESO_NEW(arena, double, solver->vertex_count, error);
    if (!positions || !distance)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < solver->vertex_count; v++)
        distance[v] = run->kept ? (double)run->kept[v] : INFINITY;
    MesoExactGeodesicSeed *seeds = MESO_NEW(arena, MesoExactGeodesicSeed, query->seed_count, error);
    if (!seeds)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < query->seed_count; i++)
        seeds[i] = (MesoExactGeodesicSeed){query->seeds[i].vertex, (double)query->seeds[i].distance,
                                           query->seeds[i].line};
    const MesoExactGeodesicQuery exact = {
        .domain = query->domain, .seeds = seeds, .seed_count = query->seed_count, .limit = (double)query->limit,
        .target = query->target, .keep = query->keep,
    };
    MesoStatus status = meso_exact_geodesic(solver->mesh, positions, &exact, arena, distance, &field, error);
    for (uint32_t i = 0; i < field.touched_count && !status; i++) {
        uint32_t v = field.touched[i];
        float length = (float)(distance[v] * (double)solver->scale);
        if (meso_geodesic_lowers(run, v, length))
            solver->rows[v].distance = length;
    }
    return status;
}

MesoStatus meso_geodesic_run(const MesoGeodesicRun *run, MesoError *error)
{
    MesoArena arena;
    MesoGeodesicSolver *solver = run->solver;
    solver->touched_count = 0;
    MesoStatus status = MESO_OK;
    switch (solver->engine) {
    case MESO_GEODESIC_FRONTS:
        if (!meso_fronts_run(run, 1))
            status = meso_fail(error, MESO_ERR_MEMORY, "out of memory: a front of %u vertices", solver->touched_count);
        break;
    case MESO_GEODESIC_GRAPH:
        if (!solver->graph)
            status = meso_geodesic_graph_make(solver, error);
        if (!status)
            meso_geodesic_graph_run(run);
        break;
    case MESO_GEODESIC_EXACT:
        meso_arena_init(&arena);
        status = run_exact(run, &arena, error);
        meso_arena_release(&arena);
        break;
    }
    return status;
}

MesoStatus meso_geodesic_run_two(const MesoGeodesicRun runs[2], MesoError *error)
{
    if (runs[0].solver->engine != MESO_GEODESIC_FRONTS) {
        MesoStatus status = meso_geodesic_run(&runs[0], error), other = meso_geodesic_run(&runs[1], error);
        return status ? status : other;
    }
    runs[0].solver->touched_count = runs[1].solver->touched_count = 0;
    if (!meso_fronts_run(runs, 2))
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: fronts of %u vertices",
                         runs[0].solver->touched_count + runs[1].solver->touched_count);
    return MESO_OK;
}

MesoStatus meso_geodesic_solve(MesoGeodesicSolver *solver, const MesoGeodesicQuery *query, float *distance,
                               const uint32_t **touched, uint32_t *touched_count, MesoError *error)
{
    MesoGeodesicRun run = {solver, query, INFINITY, query->keep ? distance : NULL};
    if (query->limit > 0)
        run.limit = query->limit * solver->scale;
    bool all = !query->keep && (!query->domain || !query->domain->member);
    if (!query->keep && !all)
        clear_distances(solver->mesh, query->domain, distance);
    MesoStatus status = meso_geodesic_run(&run, error);
    take_distances(solver, all, distance);
    if (touched) {
        *touched = solver->touched;
        *touched_count = solver->touched_count;
    }
    return status;
}
