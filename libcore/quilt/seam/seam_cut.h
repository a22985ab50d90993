/*
 * The seam between what is there and what is laid over it, as a function on a grid of the plane.
 *
 * The cells that both sides could have go to one or the other by a minimum cut, as in "Graphcut Textures" (Kwatra et
 * al. 2003): the line between the two runs where it costs least. The staircase of cells is then drawn smooth, without
 * a cell's centre changing sides, and the function is the distance from the smooth line.
 */
#ifndef MESO_SEAM_CUT_H
#define MESO_SEAM_CUT_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef enum MesoSeamState {
    MESO_SEAM_OLD,      /* fixed on the old side */
    MESO_SEAM_NEW,      /* fixed on the new side */
    MESO_SEAM_FREE,     /* on either */
    MESO_SEAM_VOID      /* neither side has anything there: on the side of a cell nearby, and seams through it cost nothing */
} MesoSeamState;

/* Cell (i, j), stored at j * columns + i, has its centre at low + ((i, j) + (0.5, 0.5)) * cell. */
typedef struct MesoSeamGrid {
    uint32_t columns, rows;
    MesoVec2 low;
    float cell;         /* side of a cell, in the plane's units */
    float *values;      /* [columns * rows] at centres: distance from the seam in the plane's units, positive on the
                           new side */
} MesoSeamGrid;

/*
 * Finds the seam of least cost and fills `grid->values`; the other members of `grid` say its extent.
 *
 * arena    gets the values
 * states   [columns * rows] MesoSeamState
 * costs    [columns * rows] what a seam through a cell costs for each unit of its length, 0 to 65535. A half is added
 *          everywhere, so that of seams without cost the shortest is taken
 *
 * A line's length is measured by the eight directions to a cell's neighbours ("Computing Geodesics and Minimal Surfaces
 * via Graph Cuts", Boykov and Kolmogorov 2003), true to 8 %. Free cells that no old and no new cell is joined to stay
 * old, and so do cells that could be on either side. Centres of old cells have negative values, those of new ones
 * positive ones. Where no cell is old, all values are columns + rows cells; else where none is new, minus that.
 * MESO_ERR_INTERNAL for more than 2^24 cells or none, MESO_ERR_MEMORY.
 */
MesoStatus meso_seam_cut(MesoSeamGrid *grid, MesoArena *arena, const uint8_t *states, const uint16_t *costs,
                         MesoError *error);

/* The function at a point of the plane: bilinear between centres; beyond the outermost centres that of the nearest
 * point between them. O(1). */
float meso_seam_at(const MesoSeamGrid *grid, MesoVec2 point);

#endif
