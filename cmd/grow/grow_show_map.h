/* --show-map: what a map of the grammar is on the surface, as a picture over its texture coordinates. */
#ifndef MESO_GROW_SHOW_MAP_H
#define MESO_GROW_SHOW_MAP_H

#include "cmd/common/tool.h"
#include "libcore/growth/ground/growth_contexts.h"
#include "libcore/mesh/polygon_mesh.h"

/*
 * Writes the map of "NAME=FILE", of 1024 x 1024 pixels: its numbers where the file ends in .exr, or else a PNG; then it
 * says what black and white are where that is not 0 and 1.
 * MESO_ERR_USAGE where the grammar has no such map, or the words are others; MESO_ERR_INPUT where the surface has no
 * texture coordinates; as the writer has it.
 */
MesoStatus meso_grow_show_map(MesoTool *tool, const char *name_and_file, const MesoGrammar *grammar,
                              const MesoGrowthContexts *contexts, const MesoPolygonMesh *polygons);

#endif
