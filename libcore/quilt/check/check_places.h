/* Random places of a surface, all of them as likely. */
#ifndef MESO_CHECK_PLACES_H
#define MESO_CHECK_PLACES_H

#include "libcore/base/arena.h"
#include "libcore/base/random.h"
#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoPlaces {
    const MesoTriangulation *base;
    double *sums;       /* [triangle_count + 1] twice the area of the triangles before */
} MesoPlaces;

MesoStatus meso_places_init(MesoPlaces *places, MesoArena *arena, const MesoTriangulation *base, MesoError *error);

double meso_places_area(const MesoPlaces *places);

/* From 0 to 1. */
double meso_random_share(MesoRandom *random);

/* The next place, and the triangle that it is in. */
MesoVec3 meso_places_next(const MesoPlaces *places, MesoRandom *random, uint32_t *triangle);

#endif
