/*
 * Transforms of tiles (square.h), and variants: tiles under the transforms
 * that they allow.
 */
#ifndef MESO_VARIANT_H
#define MESO_VARIANT_H

#include "libcore/math/square.h"
#include "libcore/tiling/tile/tile_set.h"

/* Where side 0..5 of the tile lies in the slot; top and bottom stay. */
static inline uint32_t meso_transform_side(MesoTransform transform, uint32_t side)
{
    if (side >= 4)
        return side;
    if (meso_transform_flips(transform) && side % 2 == 0)
        side += 2;
    return (side + transform) & 3;
}

/* Which side 0..5 of the tile lies on side `side` of the slot. */
uint32_t meso_transform_source(MesoTransform transform, uint32_t side);

/* True if `tile` allows `transform`: the subgroup that its flags generate. */
bool meso_tile_allows(const MesoTile *tile, MesoTransform transform);

/* Label that side `side` (0..3) of a slot shows under `tile` and `transform`. */
int32_t meso_tile_label(const MesoTile *tile, MesoTransform transform, uint32_t side);

typedef struct MesoVariantSet {
    uint32_t count;
    uint32_t *tile;             /* [count] ascending */
    MesoTransform *transform;   /* [count] */
    int32_t *labels;            /* [4 * count] side k of variant v at 4 v + k */
} MesoVariantSet;

/*
 * Lists the variants of a checked set, by tile, then transform. Variants of
 * one tile that show the same labels and the same content (equal sweeps after
 * the transform, no inner mesh, nothing on top or bottom) appear once, under
 * the smallest transform. Tiles marked `ignored` have none. O(tiles * sweeps).
 */
MesoStatus meso_variant_set_build(MesoVariantSet *variants, MesoArena *arena,
                                  const MesoTileSet *set, MesoError *error);

/*
 * The variant of `tile` under `transform`, or the one that it was merged with;
 * MESO_NO_INDEX where there is none. O(log(variants) + sweeps squared).
 */
uint32_t meso_variant_find(const MesoVariantSet *variants, const MesoTileSet *set, uint32_t tile,
                           MesoTransform transform);

#endif
