/*
 * The seeds that are nearest to each vertex, of as many seeds as there are: what Voronoi cells are drawn from.
 */
#ifndef MESO_NEAREST_SEEDS_H
#define MESO_NEAREST_SEEDS_H

#include "libcore/geodesic/geodesic.h"
#include "libcore/mesh/cut/mesh_domain.h"

enum { MESO_NEAREST_SEEDS = 3 };

/* Of a vertex, by distance and then by number; MESO_NO_INDEX where there are fewer. */
typedef struct MesoSeedSlots {
    float distance[MESO_NEAREST_SEEDS];
    uint32_t seed[MESO_NEAREST_SEEDS];
} MesoSeedSlots;

typedef struct MesoNearestSeeds {
    const MesoDomain *domain;       /* the caller's, as in voronoi.h */
    uint32_t seed_count;
    const MesoMeshPoint *seeds;     /* [seed_count] likewise */
    uint32_t threads;               /* 1 to MESO_TEAM_MOST of geodesic_solver.h */
    MesoDomainVertices vertices;
    MesoSeedSlots *slots;           /* [vertices.count] */
    float *snap;                    /* [vertex_count] of the mesh: a difference of distances that is none */
} MesoNearestSeeds;

static inline MesoSeedSlots *meso_seed_slots(const MesoNearestSeeds *nearest, uint32_t vertex)
{
    return &nearest->slots[meso_domain_vertex_number(&nearest->vertices, vertex)];
}

/*
 * Finds, for the domain and seeds in `nearest`, those that are the nearest of a vertex or of the other end of one of
 * its sides, as a solve for each seed alone finds them but for rounding; the same for any number of threads. Errors as
 * of meso_geodesic_solve().
 */
MesoStatus meso_nearest_seeds_find(MesoNearestSeeds *nearest, MesoArena *arena, const MesoTriangulation *mesh,
                                   MesoGeodesicSolver *solver, MesoError *error);

/*
 * Makes of them what borders are drawn by. The vertices of a cell hang together then: a part of them that sides do not
 * join to the cell's nearest vertex forgets the seed, for the next that its vertices know. And seeds that are nearly
 * as near as the nearest are as near. O(vertices + corners of the domain). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_nearest_seeds_settle(MesoNearestSeeds *nearest, MesoArena *arena, const MesoTriangulation *mesh,
                                     MesoError *error);

#endif
