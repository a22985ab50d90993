/* glTF as a mesh: the nodes of a scene, primitive by primitive. */
#include "formats/mesh/mesh_kinds.h"

#include <cmath>
#include <exception>
#include <new>

#include "formats/mesh/gltf/gltf_file.hpp"
#include "formats/mesh/gltf/gltf_nodes.hpp"
#include "formats/mesh/gltf/gltf_primitive.hpp"
#include "formats/mesh/gltf/mesh_gatherer.hpp"

namespace {

using meso::BrokenGltf;
using meso::Matrix;
using meso::Primitive;
using meso::Turn;

/* The file at hand, and what is gathered from it. */
struct Reading {
    const tinygltf::Model &model;
    std::size_t most_corners;
    meso::MeshGatherer gatherer;
};

/* `name` without its first `skip` bytes, in lower case. */
std::string plain_name(const std::string &name, std::size_t skip)
{
    std::string out = name.substr(skip);
    for (char &c : out)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return out;
}

void add_colors(Reading &reading, const Primitive &primitive)
{
    if (primitive.has("COLOR_0") && (primitive.width("COLOR_0") == 3 || primitive.width("COLOR_0") == 4))
        reading.gatherer.add_floats("color", primitive.width("COLOR_0"), primitive.floats("COLOR_0"));
}

/* A factor as it should be: a broken one is 0. */
float share(double x)
{
    return x > 0 ? static_cast<float>(std::fmin(x, 1)) : 0;
}

void add_materials(Reading &reading)
{
    for (const tinygltf::Material &from : reading.model.materials) {
        const tinygltf::PbrMetallicRoughness &look = from.pbrMetallicRoughness;
        meso::Material material = {from.name, {1, 1, 1}, share(look.roughnessFactor), share(look.metallicFactor)};
        if (material.name.empty())
            material.name = "material " + std::to_string(reading.gatherer.materials.size());
        for (std::size_t i = 0; i < 3 && look.baseColorFactor.size() >= 3; i++)
            material.albedo[i] = share(look.baseColorFactor[i]);
        reading.gatherer.materials.push_back(material);
    }
}

/* "tiles" in the asset's extras, as we write them, names the numbers of _TILE. */
void add_names(Reading &reading)
{
    const tinygltf::Value &extras = reading.model.asset.extras;
    if (!extras.IsObject())
        return;
    for (const std::string &key : extras.Keys()) {
        const tinygltf::Value &values = extras.Get(key);
        std::vector<std::string> names;
        for (std::size_t i = 0; values.IsArray() && i < values.ArrayLen(); i++)
            if (values.Get(static_cast<int>(i)).IsString())
                names.push_back(values.Get(static_cast<int>(i)).Get<std::string>());
        if (!key.empty() && key.back() == 's' && !names.empty() && names.size() == values.ArrayLen())
            reading.gatherer.names[key.substr(0, key.size() - 1)] = names;
    }
}

void add_named(Reading &reading, const Primitive &primitive, const std::string &name)
{
    const tinygltf::Accessor &accessor = primitive.accessor(name);
    uint32_t width = primitive.width(name);
    if (!meso::is_whole(accessor)) {
        reading.gatherer.add_floats(plain_name(name, 1), width, primitive.floats(name));
        return;
    }
    bool halves = width == 2 && accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    if (width != 1 && !halves)
        return;
    std::vector<uint32_t> values = primitive.wholes(name);
    for (std::size_t i = 0; halves && i < values.size() / 2; i++)
        values[i] = values[2 * i] | values[2 * i + 1] << 16;
    values.resize(values.size() / width);
    reading.gatherer.add_wholes(plain_name(name, 1), values);
}

void add_normals(Reading &reading, const Primitive &primitive, const Turn &turn)
{
    if (!primitive.has("NORMAL") || primitive.width("NORMAL") != 3)
        return;
    std::vector<float> normals = primitive.floats("NORMAL");
    for (std::size_t i = 0; i + 2 < normals.size(); i += 3) {
        double n[3], length = 0;
        for (int row = 0; row < 3; row++) {
            n[row] = 0;
            for (int column = 0; column < 3; column++)
                n[row] += turn.m[3 * column + row] * static_cast<double>(normals[i + static_cast<std::size_t>(column)]);
            length += n[row] * n[row];
        }
        double scale = length > 0 && std::isfinite(length) ? (turn.mirrors ? -1 : 1) / std::sqrt(length) : 0;
        for (std::size_t row = 0; row < 3; row++)
            normals[i + row] = static_cast<float>(scale * n[row]);
    }
    reading.gatherer.add_floats("normal", 3, normals);
}

void add_primitive(Reading &reading, const tinygltf::Primitive &from, const Matrix &world, const std::string &object)
{
    Primitive primitive(reading.model, from, reading.most_corners);
    meso::MeshGatherer &gatherer = reading.gatherer;
    std::size_t count = primitive.vertex_count(), first = gatherer.positions.size();
    if (count >= reading.most_corners)
        throw BrokenGltf("its positions are absurdly many for the file");
    std::vector<uint32_t> corners = primitive.corners();
    if (primitive.width("POSITION") != 3)
        throw BrokenGltf("positions are not of three numbers");
    if (first + count >= reading.most_corners || gatherer.corners.size() + corners.size() >= reading.most_corners)
        throw std::length_error("its nodes make too many triangles of it");
    std::vector<float> positions = primitive.floats("POSITION");
    Turn turn = meso::turn_of(world);

    add_normals(reading, primitive, turn);
    add_colors(reading, primitive);
    for (const auto &attribute : from.attributes) {
        const std::string &name = attribute.first;
        if (name.compare(0, 9, "TEXCOORD_") == 0 && primitive.width(name) == 2)
            gatherer.add_floats(name == "TEXCOORD_0" ? "uv" : "uv" + name.substr(9), 2, primitive.floats(name));
        else if (name.size() > 1 && name[0] == '_' && name[1] != '_')
            add_named(reading, primitive, name);
    }
    for (std::size_t i = 0; i < count; i++) {
        float p[3];
        for (int row = 0; row < 3; row++)
            p[row] = static_cast<float>(world.m[row] * static_cast<double>(positions[3 * i]) +
                                        world.m[4 + row] * static_cast<double>(positions[3 * i + 1]) +
                                        world.m[8 + row] * static_cast<double>(positions[3 * i + 2]) + world.m[12 + row]);
        gatherer.positions.push_back(MesoVec3{p[0], p[1], p[2]});
    }
    gatherer.end_vertices();
    for (std::size_t i = 0; i < corners.size(); i += 3)
        for (std::size_t k = 0; k < 3; k++) {
            uint32_t corner = corners[i + (turn.mirrors && k ? 3 - k : k)];
            if (corner >= count)
                throw BrokenGltf("an index names vertex " + std::to_string(corner) + " of " + std::to_string(count));
            gatherer.corners.push_back(static_cast<uint32_t>(first) + corner);
        }
    if (from.material >= 0)
        meso::at(reading.model.materials, from.material, "material");
    gatherer.objects.add_faces(object, corners.size() / 3);
    gatherer.material_of.insert(gatherer.material_of.end(), corners.size() / 3,
                                from.material < 0 ? MESO_NO_INDEX : static_cast<uint32_t>(from.material));
}

void add_nodes(Reading &reading)
{
    const tinygltf::Model &model = reading.model;
    for (const meso::PlacedNode &placed : meso::nodes_of_scene(model, meso::locals_of(model))) {
        const tinygltf::Node &node = meso::at(model.nodes, placed.node, "node");
        if (node.mesh < 0)
            continue;
        const tinygltf::Mesh &mesh = meso::at(model.meshes, node.mesh, "mesh");
        std::string name = !node.name.empty() ? node.name : !mesh.name.empty() ? mesh.name
                                                          : "node " + std::to_string(placed.node);
        for (const tinygltf::Primitive &primitive : mesh.primitives)
            if (meso::is_shown(primitive))
                add_primitive(reading, primitive, placed.world, name);
    }
}

}

extern "C" MesoStatus meso_gltf_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t,
                                     MesoError *error)
try {
    tinygltf::Model model;
    std::size_t size = 0;
    meso::load_gltf(&model, &size, input);
    Reading reading = {model, meso::most_corners(size), {}};
    add_materials(reading);
    add_names(reading);
    add_nodes(reading);
    return reading.gatherer.finish(mesh, arena, error);
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "%s: out of memory for glTF", input->path);
} catch (const std::length_error &exception) {
    return meso_fail(error, MESO_ERR_LIMIT, "%s: %s", input->path, exception.what());
} catch (const std::exception &exception) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken glTF: %s", input->path, exception.what());
} catch (...) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken glTF", input->path);
}
