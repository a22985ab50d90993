/* Shapes of a grammar: built in, from mesh files, or swept from cross-sections of a tile set; and their materials. */
#ifndef MESO_GROW_SHAPES_H
#define MESO_GROW_SHAPES_H

#include "cmd/grow/grow_arguments.h"
#include "libcore/growth/scene/growth_scene.h"

/*
 * Makes the shapes of a grammar, in the tool's arena. Files are looked for in the grammar's `folder`, and noted in the
 * provenance. `detail` is that of all shapes that are built in; MESO_NO_INDEX: each its own. MESO_ERR_INPUT names the shape, and what is wrong with its file or material.
 */
MesoStatus meso_grow_shapes(MesoGrowthShapes *shapes, MesoTool *tool, const MesoGrammar *grammar, const char *folder,
                            uint32_t detail);

/* The path of a file that a grammar in `folder` names; NULL when memory is out. */
const char *meso_grow_path(const char *folder, const char *name, MesoArena *arena, MesoError *error);

#endif
