/* Ranges of parts through Draco: what .drc and .glb share. */
#ifndef MESO_DRACO_MESH_H
#define MESO_DRACO_MESH_H

#include "formats/scene/draco_adapter.h"
#include "formats/scene/mesh_window.h"

/*
 * Options for all meshes of a scene: one grid for all of them, so that
 * what meets before the rounding meets after it. MESO_ERR_LIMIT where an id is
 * too large for Draco; MESO_ERR_INPUT as meso_scene_parts_box().
 */
MesoStatus meso_draco_options_make(MesoDracoOptions *draco, const MesoSceneParts *parts,
                                   const MesoMeshWriteOptions *options, MesoError *error);

/* Tessellates and encodes the parts of `ranges`, which have faces, as one mesh. Threads may call
 * this at once. */
MesoStatus meso_draco_encode_parts(const MesoSceneParts *parts, uint32_t range_count,
                                   const MesoPartRange *ranges, const MesoDracoOptions *draco,
                                   MesoDracoResult *result, MesoError *error);

#endif
