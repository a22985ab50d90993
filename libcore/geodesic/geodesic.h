/*
 * Geodesic distances over a triangulation, from points and from lines of
 * seeds, in the whole mesh or in some of its regions.
 *
 * MESO_GEODESIC_FRONTS propagates fronts over the rings of triangles around
 * vertices: from the distances at the ends of a side follows the place of
 * the source that they are seen from, unfolded into the plane of the
 * triangle, and from that the distance of the third corner ("Geodesic
 * Distance Computation via Virtual Source Propagation", Trettner, Bommes and
 * Kobbelt 2021, is close). What starts from a line of seeds is a planar front
 * until it ends, and has its source infinitely far away.
 *
 * MESO_GEODESIC_GRAPH finds shortest paths in the graph of "DecoSurf:
 * Recursive Geodesic Patterns on Triangle Meshes" (Nazzaro, Puppo and
 * Pellacini 2020, section 4.2): sides, and the lines across a side between
 * the corners that face it. One to two percent too long, however fine the
 * mesh; never too short.
 *
 * MESO_GEODESIC_EXACT finds the distances of the polyhedron itself; slow.
 */
#ifndef MESO_GEODESIC_H
#define MESO_GEODESIC_H

#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoCutReport MesoCutReport;

typedef enum MesoGeodesicEngine {
    MESO_GEODESIC_FRONTS, MESO_GEODESIC_GRAPH, MESO_GEODESIC_EXACT
} MesoGeodesicEngine;

/* Rings of a mesh, and room for one solve. Several of them may solve at once, in threads of their own. */
typedef struct MesoGeodesicSolver MesoGeodesicSolver;

typedef struct MesoGeodesicSeed {
    uint32_t vertex;
    float distance;         /* that it starts with, >= 0 */
    bool line;              /* part of a line of seeds: its front is planar, and round where the line ends or turns */
} MesoGeodesicSeed;

typedef struct MesoGeodesicQuery {
    const MesoDomain *domain;       /* paths stay in it; NULL: everywhere */
    const MesoGeodesicSeed *seeds;
    uint32_t seed_count;
    float limit;                    /* vertices farther away may stay without distance; 0: no limit */
    uint32_t target;                /* ends once this vertex is final; MESO_NO_INDEX: none */
    bool keep;                      /* distances in `distance` stand, and are only lowered (farthest points) */
} MesoGeodesicQuery;

/*
 * A solver for `mesh`, which must outlive it; lengths are those of the mesh's positions. O(corners).
 * MESO_ERR_MEMORY alone; `*solver` is NULL then.
 */
MesoStatus meso_geodesic_init(MesoGeodesicSolver **solver, const MesoTriangulation *mesh, MesoGeodesicEngine engine,
                              MesoError *error);

/* NULL is left alone. */
void meso_geodesic_release(MesoGeodesicSolver *solver);

/*
 * After meso_mesh_cut(): makes the rings of new vertices and of the corners of the report's parts again; new vertices
 * have the mesh's positions. O(parts). MESO_ERR_MEMORY: the solver is good for nothing but its release then.
 */
MesoStatus meso_geodesic_update(MesoGeodesicSolver *solver, const MesoCutReport *report, MesoError *error);

/*
 * Positions that lengths are measured with from here on: the mesh's after it has moved, or others (perturbed).
 *
 * positions  [vertex_count]; not kept
 *
 * O(vertices). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_geodesic_set_positions(MesoGeodesicSolver *solver, const MesoVec3 *positions, MesoError *error);

/*
 * Distances from the nearest of the seeds, by paths in the domain.
 *
 * distance       [vertex_count] INFINITY where no path leads; only vertices of the domain's triangles are written
 * touched        may be NULL: vertices whose distance this call has lowered, each once, in no order; the solver's,
 *                until its next call
 * touched_count  how many; NULL with `touched`
 *
 * Never NaN. Neighbours differ by no more than their side is long, but for rounding. Fronts are exact in the plane but
 * for rounding, from points and from lines; where a path bends (corners of domains, saddles), where a line is curved,
 * and where fronts of several seeds meet, they are off by a fraction of a side. With a target, what lies beyond the
 * target's neighbours may be too far. Engines and machines differ in rounding at most; runs do not. O(n log n) of
 * the vertices that are reached, and O(domain) more unless `keep`; the exact engine's costs are in exact_geodesic.h, and
 * the graph is made anew at the first solve after a change of the mesh. MESO_ERR_MEMORY; MESO_ERR_LIMIT of the graph
 * and of the exact engine.
 */
MesoStatus meso_geodesic_solve(MesoGeodesicSolver *solver, const MesoGeodesicQuery *query, float *distance,
                               const uint32_t **touched, uint32_t *touched_count, MesoError *error);

/*
 * Two fields, each as meso_geodesic_solve() finds it, one beside the other where there is a second thread and they are
 * large enough to be worth it.
 *
 * queries, distances  [2]; the distances are two arrays
 * thread_count        0: all cores
 *
 * The same for any number of threads. With two the solver keeps 21 bytes a vertex and a queue more until its release,
 * and copies them in the first call after a change of the mesh. Errors as above, the first query's first.
 */
MesoStatus meso_geodesic_solve_pair(MesoGeodesicSolver *solver, const MesoGeodesicQuery *queries,
                                    float *const *distances, uint32_t thread_count, MesoError *error);

#endif
