/* What the engines of geodesic.h share; for this folder, its tests and its benchmark. */
#ifndef MESO_GEODESIC_SOLVER_H
#define MESO_GEODESIC_SOLVER_H

#include "libcore/geodesic/buckets.h"
#include "libcore/geodesic/geodesic.h"
#include "libcore/geodesic/one_rings.h"

/*
 * A vertex. `distance` is INFINITY where this solve has not been, and with its sign bit set where the front that has
 * come is planar; all are INFINITY between solves.
 */
typedef struct MesoGeodesicRow {
    float x, y, z, distance;
} MesoGeodesicRow;

enum {
    MESO_VERTEX_QUEUED = 1,     /* due */
    MESO_VERTEX_WALLED = 2,     /* has a side that is a wall */
    MESO_VERTEX_NEAR_WALL = 4,  /* corner of a triangle that has a wall */
    MESO_VERTEX_MARKED = 8      /* for a while: its ring is to be made again; its line ends here */
};

/* Solvers that one mesh is solved with at once, at most: each has 21 bytes a vertex. */
enum { MESO_TEAM_MOST = 8 };

typedef struct MesoGeodesicGraph MesoGeodesicGraph;

/* Single precision squares what is between 1e-19 and 1e19 alone: rows are scaled by a power of two to a size near 1. */
struct MesoGeodesicSolver {
    const MesoTriangulation *mesh;
    MesoGeodesicEngine engine;
    bool plain;                 /* without vector instructions: for tests, and to compare */
    uint32_t vertex_count, vertex_room;
    float scale;                /* rows are that times the scene; a power of two */
    MesoGeodesicRow *rows;      /* [vertex_room] */
    uint8_t *states;            /* [vertex_room] MESO_VERTEX_... */
    uint32_t *touched;          /* [vertex_room] those whose row has a distance */
    uint32_t touched_count;
    MesoOneRings rings;
    MesoBuckets buckets;
    MesoGeodesicGraph *graph;   /* of the graph engine; NULL: to be made before the next solve */
    MesoGeodesicSolver *twins[MESO_TEAM_MOST - 1];  /* that solve beside this one, and have its rings; NULL: not wanted
                                                       yet */
    bool is_like;               /* of a twin: nothing has changed since it was made so */
};

/* One solve, in the rows' units. */
typedef struct MesoGeodesicRun {
    MesoGeodesicSolver *solver;
    const MesoGeodesicQuery *query;
    float limit;                /* INFINITY: none */
    const float *kept;          /* [vertex_count] in scene units: what must be lowered; NULL: nothing */
} MesoGeodesicRun;

/*
 * Whether a row may be lowered to `distance`, whose sign bit says that it is planar. NaN is never lower. Lists the
 * vertex when it is met first.
 */
static inline bool meso_geodesic_lowers(const MesoGeodesicRun *run, uint32_t vertex, float distance)
{
    MesoGeodesicSolver *solver = run->solver;
    float length = __builtin_fabsf(distance), before = __builtin_fabsf(solver->rows[vertex].distance);
    if (!(length < before) || !(length <= run->limit))
        return false;
    if (run->kept && !(length < run->kept[vertex] * solver->scale))
        return false;
    if (before == INFINITY)
        solver->touched[solver->touched_count++] = vertex;
    return true;
}

/*
 * Lets the engine find distances, as meso_geodesic_solve() does, and leaves them in the rows of the vertices that are
 * listed as touched; each of them is to be taken from there before the next solve.
 */
MesoStatus meso_geodesic_run(const MesoGeodesicRun *run, MesoError *error);

/*
 * The same for two runs in the same domain, without targets, on two solvers: small ones take less time together, and
 * find what each finds alone.
 */
MesoStatus meso_geodesic_run_two(const MesoGeodesicRun runs[2], MesoError *error);

/* The distance of a row in scene units, which the row has no more then. */
static inline float meso_geodesic_take(MesoGeodesicSolver *solver, uint32_t vertex, float unit)
{
    float distance = __builtin_fabsf(solver->rows[vertex].distance) * unit;
    solver->rows[vertex].distance = INFINITY;
    solver->states[vertex] &= (uint8_t)~MESO_VERTEX_QUEUED;
    return distance;
}

/* Whether a domain is large enough for threads: in smaller ones they cost more than they save. */
bool meso_geodesic_team_is_worth(const MesoGeodesicSolver *solver, const MesoDomain *domain);

/*
 * Solvers for threads, one each: the solver itself, and twins that solve as it does and read its rings.
 *
 * team  [count] of them; count is 1 to MESO_TEAM_MOST
 *
 * O(vertices) for each twin that is new, or that the mesh has changed behind. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_geodesic_team(MesoGeodesicSolver *solver, uint32_t count, MesoGeodesicSolver **team, MesoError *error);

/*
 * Makes points of seeds where a line ends or turns sharply, before anything but seeds has a distance: what starts there
 * is circular on the outer side. O(triangles at the seeds).
 */
void meso_geodesic_round_ends(const MesoGeodesicRun *run);

/* Fills the rows' distances from the seeds in them, of one run or of two. False where memory is out. */
bool meso_fronts_run(const MesoGeodesicRun *runs, uint32_t count);

/* The same by paths in the solver's graph, which has to be there. */
void meso_geodesic_graph_run(const MesoGeodesicRun *run);

/* Makes the solver's graph, for the lengths that its rows have. O(corners). MESO_ERR_LIMIT, MESO_ERR_MEMORY. */
MesoStatus meso_geodesic_graph_make(MesoGeodesicSolver *solver, MesoError *error);

/* NULL is left alone. */
void meso_geodesic_graph_release(MesoGeodesicGraph *graph);

/* The same, of all that is the twin's own. */
void meso_geodesic_twin_release(MesoGeodesicSolver *twin);

#endif
