/*
 * A frame of details as GLB: the surface, and a mesh for each kind with all its instances
 * (EXT_mesh_gpu_instancing, which is required): TRANSLATION, ROTATION, SCALE, _ID (whole numbers of 32 bits, the same
 * in all frames) and _BIRTH (-1: it was there from the start).
 */
#ifndef MESO_INSTANCE_GLB_H
#define MESO_INSTANCE_GLB_H

#include "formats/file/output.h"
#include "formats/replicate/instance_scene.h"

/* MESO_ERR_LIMIT beyond 4 GiB, MESO_ERR_INPUT for a frame with nothing to show. O(details + vertices). */
MesoStatus meso_instance_glb_write(const MesoInstanceScene *scene, const MesoInstanceFrame *frame, MesoOutput *output,
                                   MesoError *error);

#endif
