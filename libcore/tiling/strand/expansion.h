/*
 * Expansion of a model: a scene of tubes and placed meshes. Channels are
 * "slot" and "tile", materials the cross-sections and then the inner meshes of
 * the tile set, rows of ids the slots.
 */
#ifndef MESO_EXPANSION_H
#define MESO_EXPANSION_H

#include "libcore/tiling/strand/model.h"
#include "libcore/tiling/strand/profile.h"

/* Coordinates of inner meshes in their tile, in tiles: those of the shell, which follow the product of
 * three of them, stay finite. */
#define MESO_INNER_LIMIT 1e6f

/* What the scene itself does not know. */
typedef struct MesoExpansion {
    MesoMapOptions options;             /* resolved */
    MesoKindOrigin *origins;            /* [kind_count of the scene] */
} MesoExpansion;

/*
 * Expands a model whose assignment has been checked. `scene` keeps pointers
 * into `model`. Sweeps that meet at an edge, from either slot, end on the same
 * floats: their frames come from the edge alone and their rings from the
 * interface alone. `expansion` may be NULL. O(slots * sweeps a tile).
 * MESO_ERR_INPUT where a face of the shell has no direction (a slot whose
 * corners coincide), naming the slot, and where a tile's inner mesh reaches
 * beyond MESO_INNER_LIMIT, naming tile and mesh.
 */
MesoStatus meso_model_expand(MesoScene *scene, MesoExpansion *expansion, MesoArena *arena,
                             const MesoModel *model, uint32_t thread_count, MesoError *error);

/*
 * The same over contours that the caller made: `contours` of the model's tile
 * set, sampled in any way.
 */
MesoStatus meso_model_expand_over(MesoScene *scene, MesoExpansion *expansion, MesoArena *arena,
                                  const MesoModel *model, const MesoContourSet *contours,
                                  uint32_t thread_count, MesoError *error);

/*
 * The same scene to be drawn: one of more than `stored` sweeps has a maker in place of them (sweep_maker.h), where
 * sections keep their shape and no tolerance chooses the steps. It points into `model` too; 0 stores all.
 */
MesoStatus meso_model_expand_to_draw(MesoScene *scene, MesoArena *arena, const MesoModel *model, uint32_t stored,
                                     uint32_t thread_count, MesoError *error);

#endif
