/* A frame as a scene: details as placed bodies, over the surface. */
#ifndef MESO_REPLICATE_SCENE_H
#define MESO_REPLICATE_SCENE_H

#include "cmd/replicate/replicate_kinds.h"
#include "cmd/replicate/replicate_modes.h"

/*
 * Parts are told apart by "detail", their ids in the whole clip, and "kind".
 *
 * placed    [run->count]
 * surface   of the frame; NULL: it is not shown
 * material  what it is made of
 *
 * MESO_ERR_LIMIT, MESO_ERR_MEMORY; arrays are in the tool's arena.
 */
MesoStatus meso_replicate_scene(MesoScene *scene, const MesoReplicateRun *run, const MesoReplicateKinds *kinds,
                                const MesoPlacedDetail *placed, const MesoPolygonMesh *surface,
                                const char *material);

#endif
