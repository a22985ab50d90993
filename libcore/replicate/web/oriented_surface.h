/*
 * A surface whose triangles are all wound alike, part by part. One that has one side only, as a Moebius band, is cut
 * open for that: along the sides where two ways around it meet, and vertices there are two nodes or more.
 */
#ifndef MESO_ORIENTED_SURFACE_H
#define MESO_ORIENTED_SURFACE_H

#include "libcore/base/arena.h"
#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoOrientedSurface {
    uint32_t node_count;    /* first the vertices, each one node of it; behind them others of those that are cut */
    uint32_t *vertices;     /* [node_count] */
    uint32_t *corners;      /* [3 * triangle_count] nodes; half-edges as in triangulation.h */
    uint32_t *twins;        /* [3 * triangle_count] or MESO_NO_INDEX */
} MesoOrientedSurface;

/* Half-edges of a triangle that is turned run the other way. Arrays are in the arena. MESO_ERR_MEMORY alone. O(n). */
MesoStatus meso_orient_surface(MesoOrientedSurface *out, MesoArena *arena, const MesoTriangulation *mesh,
                               MesoError *error);

#endif
