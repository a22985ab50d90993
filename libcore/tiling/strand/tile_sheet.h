/* A sheet of a tile set: each tile as it is in a unit cell, with its name, in rows. */
#ifndef MESO_TILE_SHEET_H
#define MESO_TILE_SHEET_H

#include "libcore/tiling/strand/model.h"

/*
 * Makes a model of cells that do not touch, one for each tile in its own place, and expands it: the scene's channels
 * are those of expansion.h. It lies in the plane of x and y, rows from the top, and shows to +z. Around each cell are
 * the edges of the shell, those at its foot in the colours of the sides' interfaces, and its tile's name is below it.
 *
 * model    has the tile set and its inner meshes; gets the rest
 * columns  cells in a row; 0: as many as make a sheet that is wider than high
 *
 * MESO_ERR_INPUT as meso_model_expand(), and for a set without tiles; MESO_ERR_MEMORY.
 */
MesoStatus meso_tile_sheet(MesoScene *scene, MesoArena *arena, MesoModel *model, uint32_t columns,
                           uint32_t thread_count, MesoError *error);

#endif
