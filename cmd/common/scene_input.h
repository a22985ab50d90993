/* Scenes in: models of any method, and meshes. */
#ifndef MESO_SCENE_INPUT_H
#define MESO_SCENE_INPUT_H

#include "cmd/common/tool.h"
#include "formats/model/model_scene.h"

/*
 * Opens the operand MODEL, a model (.meso), a quilt or a mesh (OBJ, PLY, OFF, glTF, Draco), notes it in the provenance, and
 * reads it as a scene to the tool's arena; of a mesh `reading` gets neither tiling nor provenance. `input` must stay
 * open as long as the scene is used, and is closed on failure. Errors as those of the readers.
 */
MesoStatus meso_tool_read_scene(MesoTool *tool, MesoScene *scene, MesoInput *input, const char *path,
                                MesoSceneReading *reading);

#endif
