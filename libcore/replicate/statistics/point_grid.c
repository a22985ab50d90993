#include "libcore/replicate/statistics/point_grid.h"

enum { AXIS_BITS = 21, AXIS_LIMIT = 1 << AXIS_BITS };

static uint32_t axis_cell(float x, float least, float cell)
{
    double at = floor(((double)x - least) / cell) + 1;
    return at > 1 ? at < AXIS_LIMIT - 2 ? (uint32_t)at : AXIS_LIMIT - 2 : 1;
}

static uint64_t key_of(uint32_t x, uint32_t y, uint32_t z)
{
    return (uint64_t)x << 2 * AXIS_BITS | (uint64_t)y << AXIS_BITS | z;
}

static uint32_t slot_of(const MesoPointGrid *grid, uint64_t key)
{
    uint64_t h = key * 0x9e3779b97f4a7c15u;
    return (uint32_t)(h >> 32) & grid->mask;
}

static uint64_t cell_of(const MesoPointGrid *grid, MesoVec3 p)
{
    return key_of(axis_cell(p.x, grid->corner.x, grid->cell), axis_cell(p.y, grid->corner.y, grid->cell),
                  axis_cell(p.z, grid->corner.z, grid->cell));
}

static MesoVec3 least_corner(const MesoVec3 *positions, uint32_t count)
{
    MesoVec3 least = count ? positions[0] : (MesoVec3){0, 0, 0};
    for (uint32_t i = 1; i < count; i++)
        least = (MesoVec3){fminf(least.x, positions[i].x), fminf(least.y, positions[i].y),
                           fminf(least.z, positions[i].z)};
    return least;
}

MesoStatus meso_point_grid_build(MesoPointGrid *grid, MesoArena *arena, const MesoVec3 *positions, uint32_t count,
                                 float cell, MesoError *error)
{
    *grid = (MesoPointGrid){.cell = cell > 0 ? cell : 1, .corner = least_corner(positions, count), .count = count,
                            .mask = 1};
    while (grid->mask < count)
        grid->mask = 2 * grid->mask + 1;
    grid->begin = MESO_NEW(arena, uint32_t, (size_t)grid->mask + 2, error);
    grid->order = MESO_NEW(arena, uint32_t, count, error);
    grid->keys = MESO_NEW(arena, uint64_t, count, error);
    grid->places = MESO_NEW(arena, MesoVec3, count, error);
    if (!grid->begin || !grid->order || !grid->keys || !grid->places)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        grid->begin[slot_of(grid, cell_of(grid, positions[i])) + 1]++;
    for (uint32_t s = 0; s <= grid->mask; s++)
        grid->begin[s + 1] += grid->begin[s];
    for (uint32_t i = count; i-- > 0;) {
        uint64_t key = cell_of(grid, positions[i]);
        uint32_t at = --grid->begin[slot_of(grid, key) + 1];
        grid->order[at] = i;
        grid->keys[at] = key;
        grid->places[at] = positions[i];
    }
    /* each slot has been counted down to its beginning, one place too far on */
    for (uint32_t s = 0; s <= grid->mask; s++)
        grid->begin[s] = grid->begin[s + 1];
    grid->begin[grid->mask + 1] = count;
    return MESO_OK;
}

MesoPointRange meso_point_grid_range(const MesoPointGrid *grid, MesoVec3 place, uint32_t cell)
{
    uint64_t middle = cell_of(grid, place);
    uint64_t key = middle + key_of(cell % 3, cell / 3 % 3, cell / 9) - key_of(1, 1, 1);
    uint32_t slot = slot_of(grid, key);
    return (MesoPointRange){grid->begin[slot], grid->begin[slot + 1], key};
}
