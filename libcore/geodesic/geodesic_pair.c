/*
 * Several fields at once. What a solve writes to is small beside the rings: each thread has rows, states and queues of
 * its own, copied when the solver has changed, and reads the solver's rings.
 */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/geodesic/geodesic_solver.h"

/*
 * Below so many triangles a thread takes longer to start than it saves; and below one for so many of the mesh's
 * vertices, longer to be made alike.
 */
enum { WORTH_A_THREAD = 4096, WORTH_A_COPY = 8 };

/* ---- twins ---- */

void meso_geodesic_twin_release(MesoGeodesicSolver *twin)
{
    if (!twin)
        return;
    meso_geodesic_graph_release(twin->graph);
    meso_buckets_release(&twin->buckets);
    free(twin->rows);
    free(twin->states);
    free(twin->touched);
    free(twin);
}

static bool make_room(MesoGeodesicSolver *twin, uint32_t room)
{
    if (room <= twin->vertex_room)
        return true;
    free(twin->rows);
    free(twin->states);
    free(twin->touched);
    twin->vertex_room = 0;
    twin->rows = malloc(room * sizeof *twin->rows);
    twin->states = malloc(room * sizeof *twin->states);
    twin->touched = malloc(room * sizeof *twin->touched);
    if (!twin->rows || !twin->states || !twin->touched)
        return false;
    twin->vertex_room = room;
    return true;
}

static void copy_state(MesoGeodesicSolver *twin, const MesoGeodesicSolver *solver)
{
    twin->mesh = solver->mesh;
    twin->engine = solver->engine;
    twin->plain = solver->plain;
    twin->vertex_count = solver->vertex_count;
    twin->scale = solver->scale;
    twin->rings = solver->rings;
    twin->buckets.inverse_width = solver->buckets.inverse_width;
    memcpy(twin->rows, solver->rows, solver->vertex_count * sizeof *twin->rows);
    memcpy(twin->states, solver->states, solver->vertex_count * sizeof *twin->states);
    meso_geodesic_graph_release(twin->graph);
    twin->graph = NULL;
}

static MesoStatus bring_up(const MesoGeodesicSolver *solver, MesoGeodesicSolver **twin, MesoError *error)
{
    if (!*twin)
        *twin = calloc(1, sizeof **twin);
    if (!*twin || !make_room(*twin, solver->vertex_room))
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: more distances of %u vertices", solver->vertex_count);
    if (!(*twin)->is_like)
        copy_state(*twin, solver);
    (*twin)->is_like = true;
    return MESO_OK;
}

MesoStatus meso_geodesic_team(MesoGeodesicSolver *solver, uint32_t count, MesoGeodesicSolver **team, MesoError *error)
{
    assert(count > 0 && count <= MESO_TEAM_MOST);
    MesoStatus status = MESO_OK;
    team[0] = solver;
    for (uint32_t i = 1; i < count && !status; i++) {
        status = bring_up(solver, &solver->twins[i - 1], error);
        team[i] = solver->twins[i - 1];
    }
    return status;
}

bool meso_geodesic_team_is_worth(const MesoGeodesicSolver *solver, const MesoDomain *domain)
{
    uint32_t size = domain && domain->triangles ? domain->triangle_count : solver->mesh->triangle_count;
    bool is_like = solver->twins[0] && solver->twins[0]->is_like;
    return size >= WORTH_A_THREAD && (is_like || size >= solver->vertex_count / WORTH_A_COPY);
}

/* ---- both ---- */

typedef struct Pair {
    MesoGeodesicSolver *solvers[2];
    const MesoGeodesicQuery *queries;
    float *const *distances;
    MesoStatus status[2];
    MesoError errors[2];
} Pair;

static void solve_some(void *context, uint64_t begin, uint64_t end)
{
    Pair *pair = context;
    for (uint64_t i = begin; i < end; i++)
        pair->status[i] = meso_geodesic_solve(pair->solvers[i], &pair->queries[i], pair->distances[i], NULL, NULL,
                                              &pair->errors[i]);
}

MesoStatus meso_geodesic_solve_pair(MesoGeodesicSolver *solver, const MesoGeodesicQuery *queries,
                                    float *const *distances, uint32_t thread_count, MesoError *error)
{
    Pair pair = {{solver, solver}, queries, distances, {MESO_OK, MESO_OK}, {{0}}};
    uint32_t threads = thread_count ? thread_count : meso_parallel_cores();
    if (threads > 1 && (!meso_geodesic_team_is_worth(solver, queries[0].domain) ||
                        !meso_geodesic_team_is_worth(solver, queries[1].domain)))
        threads = 1;
    MesoStatus status = threads > 1 ? meso_geodesic_team(solver, 2, pair.solvers, error) : MESO_OK;
    if (status)
        return status;
    meso_parallel_for(threads, 2, 1, solve_some, &pair);
    for (int i = 0; i < 2; i++)
        if (pair.status[i]) {
            if (error)
                *error = pair.errors[i];
            return pair.status[i];
        }
    return MESO_OK;
}
