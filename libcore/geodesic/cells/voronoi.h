/*
 * Geodesic Voronoi cells: each point of a domain belongs to the nearest of the seeds, by paths in the domain.
 * Distances from each seed are found at vertices, as far as they matter, and taken as linear between them; so are the
 * borders between cells.
 *
 * A side between vertices of two cells changes from one to the other where their distances are equal, and that depends
 * on the side alone: both of its triangles agree. A vertex that is nearly as far from two seeds is on their border,
 * which goes through it then: no change comes nearer to the end of a side than MESO_CUT_SNAP of its length. A triangle
 * whose outline changes twice is crossed by a segment. Where it changes more often, all changes are joined to a node
 * inside: for three cells the point that is as far from all three, and where that is outside, or for more, the middle
 * of the changes. What a cell has between vertices of others is left to them, and so are vertices of it beyond: those
 * that sides do not join to the nearest are drawn in the cell of another seed that is near.
 */
#ifndef MESO_VORONOI_H
#define MESO_VORONOI_H

#include "libcore/geodesic/geodesic.h"
#include "libcore/mesh/cut/cut_lines.h"

typedef struct MesoVoronoiQuery {
    const MesoDomain *domain;       /* NULL: everywhere */
    uint32_t seed_count;
    const MesoMeshPoint *seeds;     /* [seed_count] in triangles of the domain */
    uint32_t threads;               /* 0: all cores; what is found is the same for any number */
} MesoVoronoiQuery;

/*
 * Adds the borders between cells; a segment's `line` is the lower of the two seeds that it is between.
 *
 * solver    of the mesh
 * cell      [vertex_count] nearest seed of each vertex, the lower of two; MESO_NO_INDEX where no path leads from any.
 *           Only those of the domain's triangles are written. May be NULL
 * distance  [vertex_count] from that seed, likewise; INFINITY where there is none
 *
 * A solve for all seeds, and one for each that goes little beyond its cell: cells are those of separate solves but for
 * rounding. Measured against one propagation that carries three seeds a vertex: faster from a thousand seeds on, since
 * the fronts of a cell stay in the nearest caches; solves run side by side, and two in turn on each thread where cells
 * are small. Lines are the same bytes for any number of threads. 41 bytes of scratch a vertex of the domain, 60 a seed
 * and twice the lines that are added; and 21 a vertex of the mesh for each solver more, of 8 at most, that `solver`
 * keeps. Errors as of meso_geodesic_solve().
 */
MesoStatus meso_voronoi_trace(MesoCutLines *lines, uint32_t *cell, float *distance, MesoArena *arena,
                              const MesoTriangulation *mesh, MesoGeodesicSolver *solver, const MesoVoronoiQuery *query,
                              MesoError *error);

#endif
