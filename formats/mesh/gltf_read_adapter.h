/* glTF files, read through tinygltf. */
#ifndef MESO_GLTF_READ_ADAPTER_H
#define MESO_GLTF_READ_ADAPTER_H

#include "formats/file/input.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Parses a .glb, or a .gltf if its bytes do not begin like a .glb, without
 * opening the files that it names and without decoding its images. Writes the
 * number of its meshes. MESO_ERR_INPUT with tinygltf's words where it is
 * broken.
 */
MesoStatus meso_gltf_parse(const MesoInput *input, uint32_t *mesh_count, MesoError *error);

#ifdef __cplusplus
}
#endif

#endif
