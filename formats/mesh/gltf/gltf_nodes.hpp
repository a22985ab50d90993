/* The nodes that a glTF file shows, and where they are. */
#ifndef MESO_GLTF_NODES_HPP
#define MESO_GLTF_NODES_HPP

#include <string>
#include <vector>

#include "formats/mesh/gltf/gltf_matrix.hpp"

namespace meso {

struct PlacedNode {
    int node;
    Matrix world;
};

/* What the nodes say of themselves. */
std::vector<Matrix> locals_of(const tinygltf::Model &model);

/*
 * All nodes of the default scene, or of the first; of a file without scenes, all. Each once, parents first and children
 * in their order. Throws BrokenGltf for a node that is reached twice.
 *
 * locals     of each node of the model, to its parent
 */
std::vector<PlacedNode> nodes_of_scene(const tinygltf::Model &model, const std::vector<Matrix> &locals);

/* Whether a primitive is read: triangles with positions. */
bool is_shown(const tinygltf::Primitive &primitive);

}

#endif
