#include "formats/mesh/gltf/gltf_primitive.hpp"

#include "formats/mesh/gltf/gltf_file.hpp"

namespace meso {

Primitive::Primitive(const tinygltf::Model &from_model, const tinygltf::Primitive &primitive, std::size_t most_corners)
    : model(from_model), from(primitive), most(most_corners)
{
    auto extension = from.extensions.find("KHR_draco_mesh_compression");
    if (extension == from.extensions.end())
        return;
    Span bytes = span_of(model, extension->second.Get("bufferView").GetNumberAsInt());
    ids = extension->second.Get("attributes");
    compressed = decode_draco(bytes.data, bytes.size, most);
}

std::vector<float> Primitive::floats(const std::string &name) const
{
    if (const draco::PointAttribute *attribute = stored(name))
        return draco_floats(*compressed, *attribute);
    return floats_of(model, from.attributes.at(name), vertex_count());
}

std::vector<uint32_t> Primitive::wholes(const std::string &name) const
{
    if (const draco::PointAttribute *attribute = stored(name))
        return draco_wholes(*compressed, *attribute);
    return wholes_of(model, from.attributes.at(name), vertex_count());
}

std::vector<uint32_t> Primitive::corners() const
{
    if (compressed)
        return draco_corners(*compressed);
    std::vector<uint32_t> indices;
    int index = has(hidden_indices) ? from.attributes.at(hidden_indices) : from.indices;
    if (index >= 0 && at(model.accessors, index, "accessor").count > most)
        throw BrokenGltf("accessor " + std::to_string(index) + " is absurdly large for its file");
    if (index >= 0)
        indices = wholes_of(model, index, at(model.accessors, index, "accessor").count);
    else
        for (std::size_t i = 0; i < vertex_count(); i++)
            indices.push_back(static_cast<uint32_t>(i));
    if (from.mode == TINYGLTF_MODE_TRIANGLES || from.mode < 0) {
        indices.resize(indices.size() / 3 * 3);
        return indices;
    }
    std::vector<uint32_t> out;
    for (std::size_t i = 0; i + 2 < indices.size(); i++) {
        bool odd = i & 1, fan = from.mode == TINYGLTF_MODE_TRIANGLE_FAN;
        out.push_back(indices[fan ? 0 : i]);
        out.push_back(indices[fan ? i + 1 : odd ? i + 2 : i + 1]);
        out.push_back(indices[fan ? i + 2 : odd ? i + 1 : i + 2]);
    }
    return out;
}

/* The attribute as Draco has it, whose width must be the accessor's; NULL where nothing is compressed. */
const draco::PointAttribute *Primitive::stored(const std::string &name) const
{
    if (!compressed || !ids.Has(name))
        return nullptr;
    const draco::PointAttribute *attribute =
        compressed->GetAttributeByUniqueId(static_cast<uint32_t>(ids.Get(name).GetNumberAsInt()));
    if (!attribute || attribute->num_components() != static_cast<int>(width(name)))
        throw BrokenGltf("what Draco compressed has no such attribute '" + name + "'");
    return attribute;
}

}
