/* EXT_meshopt_compression of .glb files, undone before they are read. */
#ifndef MESO_GLTF_MESHOPT_HPP
#define MESO_GLTF_MESHOPT_HPP

#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace meso {

/*
 * Decodes the views of `json` that are compressed, from `data` of `size` bytes, the file's binary part, and makes it a
 * file without the extension over one buffer, which comes back. Throws BrokenGltf where a view is not what it says, or
 * lies in another buffer.
 */
std::vector<unsigned char> decode_meshopt_views(nlohmann::json *json, const unsigned char *data, std::size_t size);

}

#endif
