/* Draco's bitstream to numbers of vertices. */
#ifndef MESO_DRACO_MESH_DECODER_HPP
#define MESO_DRACO_MESH_DECODER_HPP

#include <cstdint>
#include <memory>
#include <vector>

#include <draco/mesh/mesh.h>

namespace meso {

/* Throws std::runtime_error with Draco's words. `most_points` bounds what a small file may grow to. */
std::unique_ptr<draco::Mesh> decode_draco(const unsigned char *data, std::size_t size, std::size_t most_points);

/* Numbers of an attribute at all points: floats, scaled where normalized, or whole numbers that are not negative. */
std::vector<float> draco_floats(const draco::Mesh &mesh, const draco::PointAttribute &attribute);
std::vector<uint32_t> draco_wholes(const draco::Mesh &mesh, const draco::PointAttribute &attribute);
bool draco_is_whole(const draco::PointAttribute &attribute);

/* Corners of all faces, three each. */
std::vector<uint32_t> draco_corners(const draco::Mesh &mesh);

}

#endif
