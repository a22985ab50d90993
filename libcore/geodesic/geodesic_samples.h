/*
 * Points evenly spread over a domain in the geodesic metric: each the farthest from all before it ("The farthest point
 * strategy for progressive image sampling", Eldar et al. 1997), and so no two nearer to each other than the last is
 * to all.
 */
#ifndef MESO_GEODESIC_SAMPLES_H
#define MESO_GEODESIC_SAMPLES_H

#include "libcore/geodesic/geodesic.h"

typedef struct MesoSampleQuery {
    const MesoDomain *domain;           /* NULL: everywhere */
    uint32_t given_count;
    const MesoGeodesicSeed *given;      /* [given_count] what samples keep away from, too: borders, seeds */
    float slack;                        /* from 0 to 1: they keep only 1 - slack of their distance from it; at 1 only the
                                           first sample knows of it */
    uint32_t start;                     /* vertex of the domain that is the first sample; MESO_NO_INDEX: the farthest
                                           from what is given, or the domain's lowest where nothing is */
    bool border_only;                   /* samples are vertices of the domain's border */
    uint32_t count;                     /* at most so many */
    float radius;                       /* ends when no vertex is as far as this from all; 0: when all are samples */
} MesoSampleQuery;

typedef struct MesoSamples {
    uint32_t count;
    uint32_t *vertices;     /* [count] in the order in which they were taken */
    float *radii;           /* [count] how far each was from what came before it; INFINITY where no path leads from
                               there, and distances from what is given divided by 1 - slack. Descending, but for
                               rounding, from the one behind `start` on */
    float radius;           /* how far any vertex that could be a sample is from all at most */
} MesoSamples;

/*
 * Samples, equally far ones by their number. Parts of the domain that no path joins to what is given or to a sample
 * each get one first.
 *
 * distance  [vertex_count] from the nearest of what is given and all samples; only those of the domain's vertices are
 *           written
 *
 * Arrays are in the arena. Fronts only go where they are nearer than those before: O(n log(samples)) of the vertices in
 * all, and the farthest is found among maxima of 1024 vertices. Errors as of meso_geodesic_solve().
 */
MesoStatus meso_geodesic_sample(MesoSamples *samples, float *distance, MesoArena *arena, const MesoTriangulation *mesh,
                                MesoGeodesicSolver *solver, const MesoSampleQuery *query, MesoError *error);

#endif
