/* meso-map --join: parts of a mesh, put together. */
#ifndef MESO_MAP_JOIN_H
#define MESO_MAP_JOIN_H

#include "cmd/common/scene_output.h"

/*
 * Writes what the operands, files of --slots or --shard, are parts of to tool->output: the same bytes as written
 * at once. Called after meso_tool_choose_scene_kind(). MESO_ERR_USAGE for kinds that cannot be put together.
 */
MesoStatus meso_map_join(MesoTool *tool, const MesoSceneOutput *output);

#endif
