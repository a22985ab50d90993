/* Draco's bitstream as a mesh. */
#include "formats/mesh/mesh_kinds.h"

#include <exception>
#include <new>

#include <nlohmann/json.hpp>

#include "formats/mesh/gltf/draco_mesh_decoder.hpp"
#include "formats/mesh/gltf/mesh_gatherer.hpp"

namespace {

/* What an attribute of a .drc is called; empty where that is not known. */
std::string draco_name(const draco::Mesh &mesh, const draco::PointAttribute &attribute, int id)
{
    switch (attribute.attribute_type()) {
    case draco::GeometryAttribute::NORMAL:
        return "normal";
    case draco::GeometryAttribute::TEX_COORD:
        return "uv";
    case draco::GeometryAttribute::COLOR:
        return "color";
    default:
        std::string name;
        const draco::AttributeMetadata *metadata = mesh.GetAttributeMetadataByAttributeId(id);
        if (metadata)
            metadata->GetEntryString("name", &name);
        return name;
    }
}

/* "tiles" in the metadata of the mesh, as we write them: a list of JSON, that names the numbers of "tile". */
void gather_names(meso::MeshGatherer &gatherer, const draco::Mesh &mesh)
{
    if (!mesh.GetMetadata())
        return;
    for (const auto &column : gatherer.columns) {
        std::string text;
        if (!column.second.whole || !mesh.GetMetadata()->GetEntryString(column.first + "s", &text))
            continue;
        auto json = nlohmann::json::parse(text, nullptr, false);
        std::vector<std::string> names;
        for (std::size_t i = 0; json.is_array() && i < json.size() && json[i].is_string(); i++)
            names.push_back(json[i]);
        if (!names.empty() && names.size() == json.size())
            gatherer.names[column.first] = names;
    }
}

void gather_draco(meso::MeshGatherer &gatherer, const draco::Mesh &mesh)
{
    const draco::PointAttribute *place = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (!place || place->num_components() != 3)
        throw std::runtime_error("it has no positions");
    for (int id = 0; id < mesh.num_attributes(); id++) {
        const draco::PointAttribute &attribute = *mesh.attribute(id);
        std::string name = draco_name(mesh, attribute, id);
        auto width = static_cast<uint32_t>(attribute.num_components());
        if (name.empty() || attribute.attribute_type() == draco::GeometryAttribute::POSITION || width < 1 || width > 4)
            continue;
        if (meso::draco_is_whole(attribute) && width == 1 && name != "color")
            gatherer.add_wholes(name, meso::draco_wholes(mesh, attribute));
        else
            gatherer.add_floats(name, width, meso::draco_floats(mesh, attribute));
    }
    std::vector<float> positions = meso::draco_floats(mesh, *place);
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
        gatherer.positions.push_back(MesoVec3{positions[i], positions[i + 1], positions[i + 2]});
    gatherer.end_vertices();
    gather_names(gatherer, mesh);
    gatherer.corners = meso::draco_corners(mesh);
}

}

extern "C" MesoStatus meso_draco_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t,
                                      MesoError *error)
try {
    meso::MeshGatherer gatherer;
    std::unique_ptr<draco::Mesh> decoded = meso::decode_draco(input->data, input->size, meso::most_corners(input->size));
    gather_draco(gatherer, *decoded);
    return gatherer.finish(mesh, arena, error);
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "%s: out of memory in Draco", input->path);
} catch (const std::exception &exception) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken .drc: %s", input->path, exception.what());
} catch (...) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken .drc", input->path);
}
