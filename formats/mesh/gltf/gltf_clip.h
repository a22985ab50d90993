/*
 * Animated glTF: the positions of the mesh that meso_gltf_read() makes of a file (mesh_kinds.h), at any time of its
 * first animation. Nodes move, morph targets are blended, skins follow their joints, as glTF 2.0 has it.
 */
#ifndef MESO_GLTF_CLIP_H
#define MESO_GLTF_CLIP_H

#include "formats/file/input.h"
#include "libcore/math/vec.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct MesoGltfClip MesoGltfClip;

/*
 * Reads a .glb or .gltf, of which nothing is needed later. MESO_ERR_INPUT for what meso_gltf_read() refuses, files
 * without an animation, and what is broken in it; MESO_ERR_LIMIT for morph targets beyond MESO_GLTF_CORNERS_A_BYTE.
 */
MesoStatus meso_gltf_clip_open(MesoGltfClip **clip, const MesoInput *input, MesoError *error);

/* NULL is allowed. */
void meso_gltf_clip_release(MesoGltfClip *clip);

uint32_t meso_gltf_clip_vertex_count(const MesoGltfClip *clip);

/* Seconds to the last key. */
double meso_gltf_clip_duration(const MesoGltfClip *clip);

/*
 * Positions at a time; what has no key yet, or none any more, stays as at its first or last. May be called from two
 * threads. MESO_ERR_INPUT names the first vertex, from 1, that is not finite, or beyond MESO_COORDINATE_LIMIT.
 *
 * positions  [meso_gltf_clip_vertex_count()]
 */
MesoStatus meso_gltf_clip_positions(const MesoGltfClip *clip, double time, MesoVec3 *positions, MesoError *error);

#ifdef __cplusplus
}
#endif

#endif
