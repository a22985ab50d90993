#include "libcore/tiling/tile/variant.h"

#include <stdlib.h>
#include <string.h>

uint32_t meso_transform_source(MesoTransform transform, uint32_t side)
{
    return meso_transform_side(meso_transform_inverse(transform), side);
}

bool meso_tile_allows(const MesoTile *tile, MesoTransform transform)
{
    /* Bit t: transform t belongs to the subgroup. [rotation][flip x][flip y] */
    static const uint8_t subgroups[2][2][2] = {
        {{0x01, 0x41}, {0x11, 0x55}},
        {{0x0f, 0xff}, {0xff, 0xff}},
    };
    return subgroups[tile->rotation][tile->flip_x][tile->flip_y] >> transform & 1;
}

int32_t meso_tile_label(const MesoTile *tile, MesoTransform transform, uint32_t side)
{
    int32_t label = tile->labels[meso_transform_source(transform, side)];
    return meso_transform_flips(transform) ? -label : label;
}

/* A sweep as it lies in the slot. Plain integers, so that equal ones have equal bytes. */
typedef struct PlacedSweep {
    uint32_t side[2], section[2];
    uint32_t half_turn;
    uint32_t turn_bits;
    int32_t turns;
    uint32_t tangent_bits;
} PlacedSweep;

static int compare_placed(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(PlacedSweep));
}

static PlacedSweep place_sweep(const MesoSweep *sweep, MesoTransform transform)
{
    PlacedSweep placed = {
        .side = {meso_transform_side(transform, sweep->from_side),
                 meso_transform_side(transform, sweep->to_side)},
        .section = {sweep->from_section, sweep->to_section},
        .half_turn = sweep->half_turn,
        .turns = meso_transform_flips(transform) ? -sweep->turns : sweep->turns,
    };
    /* The mirror image of a sweep turns the other way; 0 also stands for -0 here. */
    float turn = sweep->turn == 0 ? 0.0f : sweep->turn;
    if (meso_transform_flips(transform) && turn != 0)
        turn = 1 - turn;
    memcpy(&placed.turn_bits, &turn, sizeof turn);
    memcpy(&placed.tangent_bits, &sweep->tangent_scale, sizeof placed.tangent_bits);

    bool directed = sweep->half_turn || turn != 0;
    bool descends = placed.side[0] > placed.side[1] ||
                    (placed.side[0] == placed.side[1] && placed.section[0] > placed.section[1]);
    if (!directed && descends) {
        placed.side[0] = meso_transform_side(transform, sweep->to_side);
        placed.side[1] = meso_transform_side(transform, sweep->from_side);
        placed.section[0] = sweep->to_section;
        placed.section[1] = sweep->from_section;
    }
    return placed;
}

/* The tile's sweeps as they lie in the slot, sorted: equal lists for equal content. */
static void place_tile(PlacedSweep *placed, const MesoTileSet *set, const MesoTile *tile,
                       MesoTransform transform)
{
    for (uint32_t i = 0; i < tile->sweep_count; i++)
        placed[i] = place_sweep(&set->sweeps[tile->sweep_begin + i], transform);
    if (tile->sweep_count > 1)
        qsort(placed, tile->sweep_count, sizeof *placed, compare_placed);
}

/* Inner meshes, and what top and bottom show, need not have the symmetry of the sides. */
static bool may_merge(const MesoTile *tile)
{
    return tile->inner_count == 0 && tile->labels[MESO_SIDE_TOP] == 0 &&
           tile->labels[MESO_SIDE_BOTTOM] == 0;
}

/*
 * Appends the variants of one tile. `placed` has room for
 * MESO_TRANSFORM_COUNT lists of its sweeps, one for each variant that is kept.
 */
static void append_tile(MesoVariantSet *variants, const MesoTileSet *set, uint32_t tile_index,
                        PlacedSweep *placed)
{
    const MesoTile *tile = &set->tiles[tile_index];
    uint32_t first = variants->count;
    for (MesoTransform transform = 0; transform < MESO_TRANSFORM_COUNT; transform++) {
        if (!meso_tile_allows(tile, transform))
            continue;
        uint32_t next = variants->count;
        int32_t *labels = &variants->labels[4 * (size_t)next];
        for (uint32_t side = 0; side < 4; side++)
            labels[side] = meso_tile_label(tile, transform, side);

        PlacedSweep *list = placed + (size_t)(next - first) * tile->sweep_count;
        place_tile(list, set, tile, transform);
        bool seen = false;
        for (uint32_t v = first; v < next && may_merge(tile) && !seen; v++) {
            const PlacedSweep *other = placed + (size_t)(v - first) * tile->sweep_count;
            seen = memcmp(&variants->labels[4 * (size_t)v], labels, 4 * sizeof *labels) == 0 &&
                   memcmp(other, list, tile->sweep_count * sizeof *list) == 0;
        }
        if (seen)
            continue;
        variants->tile[next] = tile_index;
        variants->transform[next] = transform;
        variants->count++;
    }
}

MesoStatus meso_variant_set_build(MesoVariantSet *variants, MesoArena *arena,
                                  const MesoTileSet *set, MesoError *error)
{
    if (set->tile_count > UINT32_MAX / (4 * MESO_TRANSFORM_COUNT))
        return meso_fail(error, MESO_ERR_LIMIT, "too many tiles: %u, at most %u", set->tile_count,
                         UINT32_MAX / (4 * MESO_TRANSFORM_COUNT));
    size_t most = (size_t)set->tile_count * MESO_TRANSFORM_COUNT;
    uint32_t most_sweeps = 0;
    for (uint32_t t = 0; t < set->tile_count; t++)
        if (set->tiles[t].sweep_count > most_sweeps)
            most_sweeps = set->tiles[t].sweep_count;

    *variants = (MesoVariantSet){
        .tile = MESO_NEW(arena, uint32_t, most, error),
        .transform = MESO_NEW(arena, MesoTransform, most, error),
        .labels = MESO_NEW(arena, int32_t, 4 * (most + 1), error),
    };
    MesoArenaMark mark = meso_arena_mark(arena);
    PlacedSweep *placed = MESO_NEW(arena, PlacedSweep, (size_t)most_sweeps * MESO_TRANSFORM_COUNT, error);
    if (!variants->tile || !variants->transform || !variants->labels || !placed)
        return MESO_ERR_MEMORY;

    for (uint32_t t = 0; t < set->tile_count; t++)
        if (!set->tiles[t].ignored)
            append_tile(variants, set, t, placed);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

/* Equal lists of sweeps in the slot, whatever their order: each is there as often under both. */
static bool same_sweeps(const MesoTileSet *set, const MesoTile *tile, MesoTransform a, MesoTransform b)
{
    for (uint32_t i = 0; i < tile->sweep_count; i++) {
        PlacedSweep placed = place_sweep(&set->sweeps[tile->sweep_begin + i], a);
        uint32_t under_a = 0, under_b = 0;
        for (uint32_t j = 0; j < tile->sweep_count; j++) {
            const MesoSweep *other = &set->sweeps[tile->sweep_begin + j];
            PlacedSweep other_a = place_sweep(other, a), other_b = place_sweep(other, b);
            under_a += compare_placed(&placed, &other_a) == 0;
            under_b += compare_placed(&placed, &other_b) == 0;
        }
        if (under_a != under_b)
            return false;
    }
    return true;
}

uint32_t meso_variant_find(const MesoVariantSet *variants, const MesoTileSet *set, uint32_t tile,
                           MesoTransform transform)
{
    uint32_t low = 0, high = variants->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (variants->tile[middle] < tile)
            low = middle + 1;
        else
            high = middle;
    }
    uint32_t end = low;
    while (end < variants->count && variants->tile[end] == tile)
        if (variants->transform[end++] == transform)
            return end - 1;
    if (low == end || !meso_tile_allows(&set->tiles[tile], transform) || !may_merge(&set->tiles[tile]))
        return MESO_NO_INDEX;
    for (uint32_t v = low; v < end; v++) {
        bool same = true;
        for (uint32_t k = 0; k < 4; k++)
            same &= variants->labels[4 * (size_t)v + k] == meso_tile_label(&set->tiles[tile], transform, k);
        if (same && same_sweeps(set, &set->tiles[tile], transform, variants->transform[v]))
            return v;
    }
    return MESO_NO_INDEX;
}
