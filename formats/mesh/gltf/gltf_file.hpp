/* glTF files, with the buffers that lie beside them, by the tinygltf library. */
#ifndef MESO_GLTF_FILE_HPP
#define MESO_GLTF_FILE_HPP

#include <tiny_gltf.h>

#include "formats/file/input.h"

namespace meso {

/* Where indices go that tinygltf would not take: to the attributes, which may lie in no buffer view. */
const char hidden_indices[] = "__indices";

/*
 * Loads a .glb, or a .gltf where its bytes do not begin like a .glb. `size` becomes the bytes of all files that were read.
 * Throws BrokenGltf for what is no glTF, and for extensions that are required and not known.
 */
void load_gltf(tinygltf::Model *model, std::size_t *size, const MesoInput *input);

}

#endif
