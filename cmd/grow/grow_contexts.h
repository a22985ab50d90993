/* What a grammar's maps, fields and places of seeds are on a surface: images, attributes, regions, distances, files. */
#ifndef MESO_GROW_CONTEXTS_H
#define MESO_GROW_CONTEXTS_H

#include "cmd/common/tool.h"
#include "libcore/growth/ground/growth_seeds.h"
#include "libcore/mesh/polygon_mesh.h"

/*
 * Opens what the grammar names, beside the grammar where a path is not absolute, and notes it in the provenance.
 *
 * polygons        triangles, of which `ground`'s mesh was made: attributes are looked for there
 * grammar_folder  "" or NULL: the current one
 *
 * All is in the tool's arena. MESO_ERR_INPUT with the line of the grammar for what is not there, is no number, or does
 * not fit the surface, with the nearest name that is there; and as readers have it.
 */
MesoStatus meso_grow_contexts(MesoGrowthContexts *out, MesoGrowthPlaces *places, MesoTool *tool,
                              const MesoGrammar *grammar, const MesoPolygonMesh *polygons,
                              const MesoGrowthGround *ground, const char *grammar_folder);

#endif
