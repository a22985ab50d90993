/* The vertices, corners and attributes of one primitive, wherever they are stored. */
#ifndef MESO_GLTF_PRIMITIVE_HPP
#define MESO_GLTF_PRIMITIVE_HPP

#include <memory>

#include "formats/mesh/gltf/draco_mesh_decoder.hpp"
#include "formats/mesh/gltf/gltf_accessor.hpp"

namespace meso {

class Primitive {
public:
    /* At most so many vertices, and corners, whatever accessors claim. All may throw BrokenGltf. */
    Primitive(const tinygltf::Model &model, const tinygltf::Primitive &primitive, std::size_t most_corners);

    bool has(const std::string &name) const { return from.attributes.count(name) != 0; }
    const tinygltf::Accessor &accessor(const std::string &name) const
    {
        return at(model.accessors, from.attributes.at(name), "accessor");
    }
    std::size_t vertex_count() const { return compressed ? compressed->num_points() : accessor("POSITION").count; }
    uint32_t width(const std::string &name) const { return component_count(accessor(name)); }

    /* All elements of an attribute: see gltf_accessor.hpp. */
    std::vector<float> floats(const std::string &name) const;
    std::vector<uint32_t> wholes(const std::string &name) const;

    /* Three corners a triangle. */
    std::vector<uint32_t> corners() const;

private:
    const draco::PointAttribute *stored(const std::string &name) const;

    const tinygltf::Model &model;
    const tinygltf::Primitive &from;
    std::size_t most;
    tinygltf::Value ids;
    std::unique_ptr<draco::Mesh> compressed;
};

}

#endif
