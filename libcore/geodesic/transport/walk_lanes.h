/* Walks under way, and their first triangles in lanes: the same as one by one, float by float. */
#ifndef MESO_WALK_LANES_H
#define MESO_WALK_LANES_H

#include "libcore/geodesic/transport/walk.h"

/* A walk under way. */
typedef struct MesoWalkLane {
    MesoComplex left;       /* end of the side it has come in by; the walk goes along x from 0 to `length` */
    MesoComplex side;       /* from there to its right end */
    double length;
    double share;           /* of the side, where the walk crosses it; for pieces */
    uint32_t half_edge;     /* that side, in the triangle where the walk is */
    uint32_t crossings, walk;
    bool begun, turned;     /* turned: the triangle is wound against the first */
} MesoWalkLane;

/* Walks that are taken together. */
enum { MESO_WALK_GROUP = 4 };

/*
 * Takes walks[first] and those behind it through a few triangles, and tells their pieces. Bit i of the result: walk
 * first + i has not ended, and goes on as lanes[i] has it, or has not begun. `options` with pieces and a
 * limit of crossings.
 */
uint32_t meso_walk_group(const MesoWalkGround *ground, MesoWalk *walks, uint32_t first, const MesoWalkOptions *options,
                         MesoWalkLane lanes[MESO_WALK_GROUP]);

#endif
