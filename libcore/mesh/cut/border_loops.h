/*
 * Loops of the border of a part of a mesh: what a region is outlined by, its seeds lie on, and its shape is told by.
 */
#ifndef MESO_BORDER_LOOPS_H
#define MESO_BORDER_LOOPS_H

#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoBorderLoop {
    uint32_t first, count;      /* its sides: from `first` on */
    uint32_t corner_count;
    float length;
} MesoBorderLoop;

typedef struct MesoBorderLoops {
    uint32_t loop_count, side_count;
    MesoBorderLoop *loops;      /* [loop_count] by the lowest of their half-edges, with which each begins */
    uint32_t *half_edges;       /* [side_count] sides of the part's triangles; those of a loop one after another */
    uint32_t *vertices;         /* [side_count] at which each begins; it ends where the next of its loop begins */
    uint8_t *corners;           /* [side_count] 1 where that vertex is a corner */
    uint32_t longest;           /* loop, the first of several; MESO_NO_INDEX where there is no border */
    double area;                /* of the part's triangles */
} MesoBorderLoops;

/*
 * The border of `domain` (NULL: all of the mesh): sides of its triangles across which none of its triangles lies; and
 * with `slits` also walls that have one label on both sides, which are walked along twice, once on each. The part lies
 * to the left of its loops, as the triangle of each loop's first side is wound; a half-edge is walked against its own
 * direction where triangles are wound against each other.
 *
 * At a corner not two but one, three or more edges meet that separate regions: those of the border, and outside the
 * part all between triangles of different labels, or where the mesh ends. A slit is such an edge where `slits` says
 * so, and ends in a corner.
 *
 * All arrays are in the arena. O(triangles of the domain + corners at the loops' vertices). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_border_loops_find(MesoBorderLoops *loops, MesoArena *arena, const MesoTriangulation *mesh,
                                  const MesoDomain *domain, bool slits, MesoError *error);

#endif
