/* Cameras of glTF scenes, .glb and .gltf. */
#ifndef MESO_GLTF_CAMERA_H
#define MESO_GLTF_CAMERA_H

#include "formats/file/input.h"
#include "libcore/base/arena.h"
#include "libcore/render/projection.h"

/*
 * The camera that a node has, by the name of the node or of the camera itself, or without one (NULL) the first node's:
 * perspective, with its vertical field of view, or orthographic, twice as high as its ymag. Its place and direction are
 * those of the node in the world, whose sizes do not count; its target lies ahead. Nothing else of the scene is looked
 * at, nor any buffer. `arena` is scratch. MESO_ERR_INPUT for a file that is broken, has no camera, or none of that
 * name, with the names that it has. O(nodes * depth).
 */
MesoStatus meso_gltf_camera_read(MesoCamera *camera, MesoArena *arena, const MesoInput *input, const char *name,
                                 MesoError *error);

#endif
