/* Where the meshes lie that tiles name: relative to the folder of their tile set; and what is in them. */
#ifndef MESO_MESH_PATH_H
#define MESO_MESH_PATH_H

#include "cmd/common/tool.h"
#include "libcore/base/arena.h"
#include "libcore/mesh/triangle_mesh.h"
#include "libcore/tiling/tile/tile_set.h"

/* Length of the folder in `path`, with its slash; 0 for the current one. */
int meso_folder_length(const char *path);

/*
 * The path of `file` from the first `length` bytes of `folder` ("": the current
 * one), in `arena`: its very name, or that without the blanks at its end if
 * only this is there. `*found` says whether either is. NULL when memory is out.
 */
const char *meso_mesh_path(const char *folder, int length, const char *file, bool *found, MesoArena *arena,
                           MesoError *error);

/*
 * Renames the set's meshes that are there, seen from the tile set at `from`,
 * so that they are there seen from `to`, which need not exist yet. Where either is standard input or
 * output, or both are in one folder, names stay. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_mesh_paths_move(MesoTileSet *set, const char *from, const char *to, MesoArena *arena,
                                MesoError *error);

/*
 * Reads the meshes to the tool's arena, [inner_count] of a set that was read from the file `tiles`: beside that, or in
 * the folder `mesh_path`, which may be NULL. A file that several tiles name is read once. MESO_ERR_INPUT where one is
 * in neither; MESO_ERR_LIMIT for too many files.
 */
MesoStatus meso_tool_read_tile_meshes(MesoTool *tool, MesoTriangleMesh **meshes, const MesoTileSet *set,
                                      const char *tiles, const char *mesh_path);

#endif
