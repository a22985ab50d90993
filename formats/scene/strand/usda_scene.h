/* A scene as USD text (.usda). */
#ifndef MESO_USDA_SCENE_H
#define MESO_USDA_SCENE_H

#include "formats/scene/mesh_file.h"

/*
 * Strands as BasisCurves, one prim for each material: cubic Beziers along the trajectories, with widths where
 * sweeps meet (twice the mean distance of the section from its centre), strand and its length by curve, and every
 * channel's ids by sweep. Caps are left out: renderers round ends. Bodies as meshes, one prim for each material,
 * with the ids by face. The materials are UsdPreviewSurface. One part is held at a time, and an item a sweep.
 * Errors as in mesh_file.h.
 */
MesoStatus meso_usda_scene_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                                 MesoError *error);

#endif
