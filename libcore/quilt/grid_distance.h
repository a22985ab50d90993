/* Distances on a grid. */
#ifndef MESO_GRID_DISTANCE_H
#define MESO_GRID_DISTANCE_H

#include <stddef.h>
#include <stdint.h>

/* One line of a sweep: what its cells have from the line before, then from the cell before. */
static inline void meso_grid_distance_pass(float *line, const float *other, uint32_t columns, int way)
{
    const float diagonal = 1.3507f, straight = 0.9551f;
    uint32_t last = columns - 1;
    for (uint32_t x = 0; other && x < columns; x++) {
        float best = line[x], up = other[x] + straight;
        float left = x > 0 ? other[x - 1] + diagonal : best, right = x < last ? other[x + 1] + diagonal : best;
        best = up < best ? up : best;
        best = left < best ? left : best;
        line[x] = right < best ? right : best;
    }
    float before = line[way > 0 ? 0 : last];
    for (uint32_t i = 1; i < columns; i++) {
        uint32_t x = way > 0 ? i : last - i;
        before += straight;
        before = line[x] < before ? line[x] : before;
        line[x] = before;
    }
}

/*
 * Lowers `distance` [columns * rows], in cells, to that from the cells where it is least: two sweeps over the 8 neighbours
 * (Borgefors, "Distance transformations in digital images", 1986), within 8 %. O(cells).
 */
static inline void meso_grid_distance(float *distance, uint32_t columns, uint32_t rows)
{
    for (uint32_t y = 0; y < rows; y++)
        meso_grid_distance_pass(distance + (size_t)y * columns, y > 0 ? distance + (size_t)(y - 1) * columns : NULL,
                                columns, 1);
    for (uint32_t y = rows; y-- > 0;)
        meso_grid_distance_pass(distance + (size_t)y * columns,
                                y + 1 < rows ? distance + (size_t)(y + 1) * columns : NULL, columns, -1);
}

#endif
