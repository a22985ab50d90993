#include "formats/mesh/gltf/gltf_nodes.hpp"

#include "formats/mesh/gltf/gltf_accessor.hpp"

namespace meso {

/* Of a file without scenes, the nodes without a parent. */
static std::vector<int> roots_of(const tinygltf::Model &model)
{
    if (!model.scenes.empty())
        return meso::at(model.scenes, model.defaultScene >= 0 ? model.defaultScene : 0, "scene").nodes;
    std::vector<bool> child(model.nodes.size());
    for (const tinygltf::Node &node : model.nodes)
        for (int index : node.children)
            if (index >= 0 && static_cast<std::size_t>(index) < child.size())
                child[static_cast<std::size_t>(index)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < child.size(); i++)
        if (!child[i])
            roots.push_back(static_cast<int>(i));
    return roots;
}

std::vector<Matrix> locals_of(const tinygltf::Model &model)
{
    std::vector<Matrix> out;
    for (const tinygltf::Node &node : model.nodes)
        out.push_back(matrix_of(node));
    return out;
}

std::vector<PlacedNode> nodes_of_scene(const tinygltf::Model &model, const std::vector<Matrix> &locals)
{
    std::vector<bool> seen(model.nodes.size());
    std::vector<PlacedNode> stack, out;
    std::vector<int> roots = roots_of(model);
    for (std::size_t i = roots.size(); i-- > 0;)
        stack.push_back({roots[i], Matrix()});
    while (!stack.empty()) {
        PlacedNode visit = stack.back();
        stack.pop_back();
        const tinygltf::Node &node = at(model.nodes, visit.node, "node");
        auto number = static_cast<std::size_t>(visit.node);
        if (seen[number])
            throw BrokenGltf("node " + std::to_string(visit.node) + " is reached twice");
        seen[number] = true;
        visit.world = product(visit.world, locals[number]);
        out.push_back(visit);
        for (std::size_t i = node.children.size(); i-- > 0;)
            stack.push_back({node.children[i], visit.world});
    }
    return out;
}

bool is_shown(const tinygltf::Primitive &primitive)
{
    return (primitive.mode < 0 || primitive.mode >= TINYGLTF_MODE_TRIANGLES) && primitive.attributes.count("POSITION");
}

}
