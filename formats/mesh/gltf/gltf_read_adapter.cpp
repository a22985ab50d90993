/* glTF, read through tinygltf, and Draco's bitstream. */
#include "formats/mesh/mesh_kinds.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>

#include <nlohmann/json.hpp>

#include "formats/mesh/gltf/draco_mesh_decoder.hpp"
#include "formats/mesh/gltf/gltf_accessor.hpp"
#include "formats/mesh/gltf/mesh_gatherer.hpp"

namespace {

/* Buffers lie beside the file, or below its folder: a file is not to make us read any other. */
struct Folder {
    std::string path;           /* with a slash at its end, or empty */
    std::size_t bytes_read;
};

bool file_exists(const std::string &, void *) { return true; }
std::string expand_path(const std::string &path, void *) { return path; }

bool read_beside(std::vector<unsigned char> *bytes, std::string *error, const std::string &name, void *user)
{
    auto *folder = static_cast<Folder *>(user);
    std::string file = name.compare(0, 2, "./") == 0 ? name.substr(2) : name;
    if (file.empty() || file[0] == '/' || file.find("..") != std::string::npos || file.find('\\') != std::string::npos ||
        file.find(':') != std::string::npos) {
        *error += "the buffer '" + file + "' does not lie beside the file";
        return false;
    }
    MesoInput input;
    MesoError failure;
    std::string path = folder->path + file;
    if (meso_input_open(&input, path.c_str(), &failure)) {
        *error += failure.message;
        return false;
    }
    bytes->assign(input.data, input.data + input.size);
    folder->bytes_read += input.size;
    meso_input_close(&input);
    return true;
}

bool write_no_file(std::string *, const std::string &, const std::vector<unsigned char> &, void *) { return false; }

bool skip_image(tinygltf::Image *, const int, std::string *, std::string *, int, int, const unsigned char *, int, void *)
{
    return true;
}

struct Bytes {
    const unsigned char *begin, *end;
};

/* The JSON of a .gltf, or of a .glb's first chunk, as far as there is one. */
Bytes json_of(const MesoInput *input, bool binary)
{
    Bytes all = {input->data, input->data + input->size};
    const std::size_t header = 20;
    if (!binary)
        return all;
    if (input->size < header)
        return {all.end, all.end};
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; i++)
        length |= static_cast<std::size_t>(input->data[12 + i]) << 8 * i;
    return {all.begin + header, length < input->size - header ? all.begin + header + length : all.end};
}

/* tinygltf copies extras and extensions recursively: without a limit, brackets exhaust the stack. */
bool too_deep(Bytes json)
{
    const int limit = 200;
    int depth = 0;
    bool quoted = false;
    for (const unsigned char *at = json.begin; at < json.end; at++) {
        if (quoted && *at == '\\')
            at++;
        else if (*at == '"')
            quoted = !quoted;
        else if (!quoted && (*at == '[' || *at == '{') && ++depth > limit)
            return true;
        else if (!quoted && (*at == ']' || *at == '}'))
            depth--;
    }
    return false;
}

/* Where indices go that tinygltf would not take: to the attributes, which may lie in no buffer view. */
const char hidden_indices[] = "__indices";

/*
 * tinygltf refuses indices without a buffer view, as compressed ones (it is built without Draco) and wholly sparse ones have
 * none. The file with them hidden; empty where there are none.
 */
std::vector<unsigned char> with_hidden_indices(const MesoInput *input, bool binary)
{
    static const char *const signs[] = {"KHR_draco_mesh_compression", "\"sparse\""};
    Bytes text = json_of(input, binary);
    bool any = false;
    for (const char *sign : signs)
        any = any || std::search(text.begin, text.end, sign, sign + std::strlen(sign)) != text.end;
    auto json = any ? nlohmann::json::parse(text.begin, text.end, nullptr, false) : nlohmann::json();
    if (!json.is_object() || !json.contains("meshes") || !json["meshes"].is_array())
        return {};
    const auto accessors = json.value("accessors", nlohmann::json::array());
    for (auto &mesh : json["meshes"])
        for (auto &primitive : mesh.is_object() && mesh.contains("primitives") ? mesh["primitives"] : mesh) {
            if (!primitive.is_object() || !primitive.contains("indices") || !primitive["indices"].is_number_unsigned() ||
                !primitive.contains("attributes") || !primitive["attributes"].is_object())
                continue;
            std::size_t index = primitive["indices"];
            if (index < accessors.size() && accessors[index].is_object() && !accessors[index].contains("bufferView")) {
                primitive["attributes"][hidden_indices] = index;
                primitive.erase("indices");
            }
        }
    std::string plain = json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    if (!binary)
        return std::vector<unsigned char>(plain.begin(), plain.end());
    plain.resize((plain.size() + 3) / 4 * 4, ' ');
    std::vector<unsigned char> out(input->data, text.begin);
    out.insert(out.end(), plain.begin(), plain.end());
    out.insert(out.end(), text.end, static_cast<const unsigned char *>(input->data + input->size));
    for (std::size_t i = 0; i < 4; i++) {
        out[8 + i] = static_cast<unsigned char>(out.size() >> 8 * i);
        out[12 + i] = static_cast<unsigned char>(plain.size() >> 8 * i);
    }
    return out;
}

/* tinygltf ends each of its lines with a line end; one line is enough. */
std::string first_line(const std::string &text)
{
    return text.empty() ? "no reason given" : text.substr(0, text.find('\n'));
}

using meso::BrokenGltf;

/* A column-major 4 x 4 matrix, of which the last row is 0 0 0 1. */
struct Matrix {
    double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

Matrix product(const Matrix &a, const Matrix &b)
{
    Matrix out;
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += a.m[4 * k + row] * b.m[4 * column + k];
            out.m[4 * column + row] = sum;
        }
    return out;
}

Matrix matrix_of(const tinygltf::Node &node)
{
    Matrix out;
    if (node.matrix.size() == 16) {
        std::memcpy(out.m, node.matrix.data(), sizeof out.m);
        return out;
    }
    double q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1}, t[3] = {0, 0, 0};
    for (std::size_t i = 0; i < 4 && node.rotation.size() == 4; i++)
        q[i] = node.rotation[i];
    for (std::size_t i = 0; i < 3; i++) {
        s[i] = node.scale.size() == 3 ? node.scale[i] : s[i];
        t[i] = node.translation.size() == 3 ? node.translation[i] : t[i];
    }
    double x = q[0], y = q[1], z = q[2], w = q[3];
    const double rotation[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),
                                2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
                                2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            out.m[4 * column + row] = rotation[3 * column + row] * s[column];
    for (int row = 0; row < 3; row++)
        out.m[12 + row] = t[row];
    return out;
}

/* The cofactors of the upper 3 x 3, which turn normals as the matrix turns surfaces; the sign tells whether it mirrors. */
struct Turn {
    double m[9];
    bool mirrors;
};

Turn turn_of(const Matrix &a)
{
    Turn out;
    auto e = [&](int row, int column) { return a.m[4 * column + row]; };
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
            out.m[3 * column + row] = e(r1, c1) * e(r2, c2) - e(r1, c2) * e(r2, c1);
        }
    double determinant = 0;
    for (int row = 0; row < 3; row++)
        determinant += e(row, 0) * out.m[row];
    out.mirrors = determinant < 0;
    return out;
}

/* The file at hand, and what is gathered from it. */
struct Reading {
    const tinygltf::Model &model;
    std::size_t most_corners;
    meso::MeshGatherer gatherer;
};

/* The vertices, corners and attributes of one primitive, wherever they are stored. */
class Primitive {
public:
    Primitive(const Reading &reading, const tinygltf::Primitive &primitive)
        : model(reading.model), from(primitive), most(reading.most_corners)
    {
        auto extension = from.extensions.find("KHR_draco_mesh_compression");
        if (extension == from.extensions.end())
            return;
        meso::Span bytes = meso::span_of(model, extension->second.Get("bufferView").GetNumberAsInt());
        ids = extension->second.Get("attributes");
        compressed = meso::decode_draco(bytes.data, bytes.size, reading.most_corners);
    }

    bool has(const std::string &name) const { return from.attributes.count(name) != 0; }
    const tinygltf::Accessor &accessor(const std::string &name) const
    {
        return meso::at(model.accessors, from.attributes.at(name), "accessor");
    }
    std::size_t vertex_count() const { return compressed ? compressed->num_points() : accessor("POSITION").count; }
    uint32_t width(const std::string &name) const { return meso::component_count(accessor(name)); }

    std::vector<float> floats(const std::string &name) const
    {
        if (const draco::PointAttribute *attribute = stored(name))
            return meso::draco_floats(*compressed, *attribute);
        return meso::floats_of(model, from.attributes.at(name), vertex_count());
    }

    std::vector<uint32_t> wholes(const std::string &name) const
    {
        if (const draco::PointAttribute *attribute = stored(name))
            return meso::draco_wholes(*compressed, *attribute);
        return meso::wholes_of(model, from.attributes.at(name), vertex_count());
    }

    /* Three corners a triangle. */
    std::vector<uint32_t> corners() const
    {
        if (compressed)
            return meso::draco_corners(*compressed);
        std::vector<uint32_t> indices;
        int index = has(hidden_indices) ? from.attributes.at(hidden_indices) : from.indices;
        if (index >= 0 && meso::at(model.accessors, index, "accessor").count > most)
            throw BrokenGltf("accessor " + std::to_string(index) + " is absurdly large for its file");
        if (index >= 0)
            indices = meso::wholes_of(model, index, meso::at(model.accessors, index, "accessor").count);
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

private:
    /* The attribute as Draco has it, whose width must be the accessor's; NULL where nothing is compressed. */
    const draco::PointAttribute *stored(const std::string &name) const
    {
        if (!compressed || !ids.Has(name))
            return nullptr;
        const draco::PointAttribute *attribute =
            compressed->GetAttributeByUniqueId(static_cast<uint32_t>(ids.Get(name).GetNumberAsInt()));
        if (!attribute || attribute->num_components() != static_cast<int>(width(name)))
            throw BrokenGltf("what Draco compressed has no such attribute '" + name + "'");
        return attribute;
    }

    const tinygltf::Model &model;
    const tinygltf::Primitive &from;
    std::size_t most;           /* corners, whatever an accessor claims */
    tinygltf::Value ids;
    std::unique_ptr<draco::Mesh> compressed;
};

/* `name` without its first `skip` bytes, in lower case. */
std::string plain_name(const std::string &name, std::size_t skip)
{
    std::string out = name.substr(skip);
    for (char &c : out)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return out;
}

void add_colors(Reading &reading, const Primitive &primitive, int material)
{
    float base[4] = {1, 1, 1, 1};
    if (material >= 0) {
        const auto &factor = meso::at(reading.model.materials, material, "material").pbrMetallicRoughness.baseColorFactor;
        for (std::size_t i = 0; i < 4 && factor.size() == 4; i++)
            base[i] = static_cast<float>(factor[i]);
    }
    bool colored = primitive.has("COLOR_0") && (primitive.width("COLOR_0") == 3 || primitive.width("COLOR_0") == 4);
    if (!colored && base[0] == 1 && base[1] == 1 && base[2] == 1)
        return;
    std::size_t count = primitive.vertex_count(), width = colored ? primitive.width("COLOR_0") : 0;
    std::vector<float> given = colored ? primitive.floats("COLOR_0") : std::vector<float>();
    std::vector<float> out(4 * count);
    for (std::size_t i = 0; i < count; i++)
        for (std::size_t k = 0; k < 4; k++)
            out[4 * i + k] = base[k] * (k < width ? given[width * i + k] : 1);
    reading.gatherer.add_floats("color", 4, out);
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
    if (from.mode >= 0 && from.mode < TINYGLTF_MODE_TRIANGLES)
        return;
    if (!from.attributes.count("POSITION"))
        return;
    Primitive primitive(reading, from);
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
    Turn turn = turn_of(world);

    add_normals(reading, primitive, turn);
    add_colors(reading, primitive, from.material);
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
    std::string material = from.material < 0 ? "none" : meso::at(reading.model.materials, from.material, "material").name;
    gatherer.objects.add_faces(object, corners.size() / 3);
    gatherer.materials.add_faces(material.empty() ? "material " + std::to_string(from.material) : material,
                                 corners.size() / 3);
}

/* All nodes below the roots, each once, parents first and children in their order. */
void add_nodes(Reading &reading, const std::vector<int> &roots)
{
    struct Visit {
        int node;
        Matrix parent;
    };
    const tinygltf::Model &model = reading.model;
    std::vector<bool> seen(model.nodes.size());
    std::vector<Visit> stack;
    for (std::size_t i = roots.size(); i-- > 0;)
        stack.push_back({roots[i], Matrix()});
    while (!stack.empty()) {
        Visit visit = stack.back();
        stack.pop_back();
        const tinygltf::Node &node = meso::at(model.nodes, visit.node, "node");
        if (seen[static_cast<std::size_t>(visit.node)])
            throw BrokenGltf("node " + std::to_string(visit.node) + " is reached twice");
        seen[static_cast<std::size_t>(visit.node)] = true;
        Matrix world = product(visit.parent, matrix_of(node));
        if (node.mesh >= 0) {
            const tinygltf::Mesh &mesh = meso::at(model.meshes, node.mesh, "mesh");
            std::string name = !node.name.empty() ? node.name : !mesh.name.empty() ? mesh.name
                                                              : "node " + std::to_string(visit.node);
            for (const tinygltf::Primitive &primitive : mesh.primitives)
                add_primitive(reading, primitive, world, name);
        }
        for (std::size_t i = node.children.size(); i-- > 0;)
            stack.push_back({node.children[i], world});
    }
}

/* The nodes of the default scene, or of the first; of a file without scenes, those without a parent. */
std::vector<int> roots_of(const tinygltf::Model &model)
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

void check_extensions(const tinygltf::Model &model)
{
    for (const std::string &name : model.extensionsRequired)
        if (name != "KHR_draco_mesh_compression" && name != "KHR_mesh_quantization" && name != "KHR_texture_transform" &&
            name != "KHR_texture_basisu" && name.compare(0, 14, "KHR_materials_") != 0)
            throw BrokenGltf("it requires the extension " + name + ", which is not read");
}

void load(tinygltf::Model *model, Folder *folder, const MesoInput *input)
{
    tinygltf::TinyGLTF reader;
    std::string failure, warning;
    reader.SetFsCallbacks({file_exists, expand_path, read_beside, write_no_file, folder});
    reader.SetImageLoader(skip_image, nullptr);
    auto size = static_cast<unsigned int>(input->size);
    bool binary = input->size >= 4 && std::memcmp(input->data, "glTF", 4) == 0;
    if (too_deep(json_of(input, binary)))
        throw BrokenGltf("nested more than 200 deep");
    std::vector<unsigned char> plain = with_hidden_indices(input, binary);
    const unsigned char *bytes = plain.empty() ? input->data : plain.data();
    size = plain.empty() ? size : static_cast<unsigned int>(plain.size());
    bool read = binary
        ? reader.LoadBinaryFromMemory(model, &failure, &warning, bytes, size, "", 0)
        : reader.LoadASCIIFromString(model, &failure, &warning, reinterpret_cast<const char *>(bytes), size, "", 0);
    if (!read)
        throw BrokenGltf(first_line(failure));
}

std::string folder_of(const char *path)
{
    const char *slash = std::strrchr(path, '/');
    return slash ? std::string(path, slash + 1) : std::string();
}

std::size_t most_corners(std::size_t bytes)
{
    std::size_t most = bytes * MESO_GLTF_CORNERS_A_BYTE;
    return most < UINT32_MAX / 2 ? most : UINT32_MAX / 2;
}

}

extern "C" MesoStatus meso_gltf_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t,
                                     MesoError *error)
try {
    if (input->size > INT_MAX)
        return meso_fail(error, MESO_ERR_INPUT, "%s: glTF of more than 2 GiB is not read", input->path);
    tinygltf::Model model;
    Folder folder = {folder_of(input->path), 0};
    load(&model, &folder, input);
    check_extensions(model);
    Reading reading = {model, most_corners(input->size + folder.bytes_read), {}};
    add_nodes(reading, roots_of(model));
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
    gatherer.corners = meso::draco_corners(mesh);
}

}

extern "C" MesoStatus meso_draco_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t,
                                      MesoError *error)
try {
    meso::MeshGatherer gatherer;
    std::unique_ptr<draco::Mesh> decoded = meso::decode_draco(input->data, input->size, most_corners(input->size));
    gather_draco(gatherer, *decoded);
    return gatherer.finish(mesh, arena, error);
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "%s: out of memory in Draco", input->path);
} catch (const std::exception &exception) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken .drc: %s", input->path, exception.what());
} catch (...) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken .drc", input->path);
}
