/* The line between the cells of two sides of a grid, drawn smooth, and distances from it. */
#ifndef MESO_SEAM_LINE_H
#define MESO_SEAM_LINE_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

/* In units of cells; the centre of cell (i, j) is at (i, j). */
typedef struct MesoSeamLine {
    uint32_t count;
    MesoVec2 *points;   /* [count] each on the segment between two centres of different sides */
    uint32_t *next;     /* [count] the point after it, with side 1 to the left; MESO_NO_INDEX at an end on the border */
    uint32_t *previous; /* [count] */
} MesoSeamLine;

/*
 * Draws the line between `sides` [columns * rows] of 0 and 1. It bends as little as it can while each of its points
 * stays between the two centres that it parts: it leaves no cell's centre on the other side, and its shape is that of
 * the staircase to half a cell. Where two cells of side 1 meet in a corner alone, they are parted.
 * O(columns * rows). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_seam_line_trace(MesoSeamLine *line, MesoArena *arena, const uint8_t *sides, uint32_t columns,
                                uint32_t rows, MesoError *error);

/*
 * Distances from the line to all centres in cells, negative on side 0: exact, but for rounding, to 2 cells from it, and
 * beyond too large by a tenth of a cell at most. At least one cell of each side. O(columns * rows). MESO_ERR_MEMORY
 * alone.
 */
MesoStatus meso_seam_line_distances(float *values, MesoArena *scratch, const MesoSeamLine *line, const uint8_t *sides,
                                    uint32_t columns, uint32_t rows, MesoError *error);

#endif
