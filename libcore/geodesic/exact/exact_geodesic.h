/*
 * Exact geodesic distances of the polyhedron that a triangulation is: "The
 * Discrete Geodesic Problem" (Mitchell, Mount and Papadimitriou 1987), with
 * windows in place of intervals of optimality as in "Fast Exact and
 * Approximate Geodesics on Meshes" (Surazhsky et al. 2005). A window is a part
 * of a side that is seen from one source through a chain of unfolded
 * triangles. Windows of a side cut each other off where one is nearer; what
 * survives crosses the next triangle, together with all of its side that are
 * due at about that time. Vertices where paths may bend, saddles and those of
 * borders, become sources when the front arrives. Lines of seeds are exact
 * too: windows with a linear distance ("Accurate Computation of
 * Geodesic Distance Fields for Polygonal Curves on Triangle Meshes", Bommes
 * and Kobbelt 2007).
 *
 * Slow beside the other engines of geodesic.h, and their oracle.
 */
#ifndef MESO_EXACT_GEODESIC_H
#define MESO_EXACT_GEODESIC_H

#include "libcore/base/arena.h"
#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoExactGeodesicSeed {
    uint32_t vertex;
    double distance;        /* that it starts with, >= 0 */
    bool line;              /* part of a line of seeds: paths begin anywhere on it */
} MesoExactGeodesicSeed;

/* A seed anywhere on the surface. */
typedef struct MesoExactGeodesicPoint {
    MesoMeshPoint at;
    double distance;        /* that it starts with, >= 0 */
} MesoExactGeodesicPoint;

typedef struct MesoExactGeodesicQuery {
    const MesoDomain *domain;           /* paths stay in it; NULL: everywhere */
    const MesoExactGeodesicSeed *seeds;
    uint32_t seed_count;
    const MesoExactGeodesicPoint *points;       /* more seeds, in triangles of the domain */
    uint32_t point_count;
    double limit;                       /* vertices farther away are without distance; 0: no limit */
    uint32_t target;                    /* ends once this vertex is final; MESO_NO_INDEX: none */
    bool keep;                          /* distances in `distance` stand, and are only lowered */
    uint32_t window_limit;              /* windows at a time, some 100 bytes each; 0: 32 million */
} MesoExactGeodesicQuery;

typedef struct MesoExactGeodesicField {
    uint32_t *touched;          /* [touched_count] vertices whose distance was lowered, nearest first */
    uint32_t touched_count;
    uint64_t window_count;      /* windows made, in all */
    uint32_t window_peak;       /* and at a time */
} MesoExactGeodesicField;

/*
 * Distances from the nearest seed, by paths in the domain.
 *
 * A line of seeds is made of the edges between seeds that say so; in a triangle with three of them (a line that turns
 * there) only the sides that are walls count. Distances along an edge of a line run linearly from one end's to the
 * other's. Paths pass walls inside the domain, borders they do not.
 *
 * positions  [vertex_count] that lengths are measured with; NULL: the mesh's
 * distance   [vertex_count] INFINITY where no path leads; only vertices of the domain's triangles are written
 *            (without a domain: all)
 * arena      holds what is in `field`
 *
 * What is written is final, whatever ends the search: to 1e-9 of the distance where triangles are no slivers, and never
 * too short but for rounding. Triangles without area and sides without length are passed; coordinates that are not
 * finite make their triangles impassable. O(n^2 log n) and O(n^2) windows for n triangles at worst, about O(n^1.5) as a
 * rule; windows behind the front are given back. MESO_ERR_LIMIT beyond `window_limit` windows at a time,
 * MESO_ERR_MEMORY; `distance` holds no field then.
 */
MesoStatus meso_exact_geodesic(const MesoTriangulation *mesh, const MesoVec3 *positions,
                               const MesoExactGeodesicQuery *query, MesoArena *arena, double *distance,
                               MesoExactGeodesicField *field, MesoError *error);

#endif
