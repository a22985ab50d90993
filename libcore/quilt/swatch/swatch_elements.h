/* What hangs together: triangles sorted by elements, their measures and open ends. */
#ifndef MESO_SWATCH_ELEMENTS_H
#define MESO_SWATCH_ELEMENTS_H

#include "libcore/quilt/swatch/swatch.h"

/*
 * Fills `swatch` up to its triangle_begin, and its mates, from `from`, of which only the arrays by vertices and
 * triangles are read, and its mates (NULL: none): elements by their first triangle, in each its vertices and
 * triangles in the order that they had. Vertices without triangles go.
 */
MesoStatus meso_swatch_sort(MesoSwatch *swatch, MesoArena *arena, const MesoSwatch *from, MesoError *error);

/* The open ends: loops and open_edge_count. Each vertex has one fan of triangles. */
MesoStatus meso_swatch_find_loops(MesoSwatch *swatch, MesoArena *arena, MesoError *error);

/* Centres, radii and mean_edge; needs positions. `centres` and `radii` are there. */
void meso_swatch_measure(MesoSwatch *swatch);

/* Element of a vertex. O(log elements). */
uint32_t meso_swatch_element(const MesoSwatch *swatch, uint32_t vertex);

/* Strands are those with open ends, and those that run through most of the tile; needs size. */
void meso_swatch_find_kinds(MesoSwatch *swatch);

#endif
