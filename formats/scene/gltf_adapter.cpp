#include "formats/scene/gltf_adapter.h"

#include <cstdint>
#include <new>
#include <ostream>
#include <streambuf>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace {

const char *const EXTENSION = "KHR_draco_mesh_compression";

/* A view, three or more accessors and a primitive in JSON take less than this. */
constexpr uint64_t PIECE_JSON_BYTES = 4096;

/* Gives what tinygltf writes to a sink, and remembers the sink's first failure. */
class SinkBuffer : public std::streambuf {
public:
    SinkBuffer(MesoGltfSink *sink, void *context, MesoError *error)
        : sink_(sink), context_(context), error_(error)
    {
    }
    MesoStatus status() const { return status_; }

protected:
    std::streamsize xsputn(const char *data, std::streamsize size) override
    {
        if (!status_)
            status_ = sink_(context_, data, static_cast<size_t>(size), error_);
        return status_ ? 0 : size;
    }
    int_type overflow(int_type c) override
    {
        const char byte = traits_type::to_char_type(c);
        return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
    }

private:
    MesoGltfSink *sink_;
    void *context_;
    MesoError *error_;
    MesoStatus status_ = MESO_OK;
};

uint32_t count_pieces(const MesoGltfScene &scene)
{
    return scene.mesh_count ? scene.meshes[scene.mesh_count - 1].piece_end : 0;
}

uint64_t bound_size(const MesoGltfScene &scene)
{
    uint64_t size = PIECE_JSON_BYTES + 6 * std::string(scene.provenance).size();
    for (uint32_t c = 0; c < scene.channel_count; c++)
        for (uint32_t i = 0; scene.channels[c].names && i < scene.channels[c].count; i++)
            size += 6 * std::string(scene.channels[c].names[i]).size() + 16;
    for (uint32_t i = 0; i < scene.mesh_count; i++)
        size += 18 * std::string(scene.meshes[i].name).size() + PIECE_JSON_BYTES;
    for (uint32_t i = 0; i < count_pieces(scene); i++)
        size += scene.pieces[i].size + PIECE_JSON_BYTES;
    return size;
}

tinygltf::Value channel_names(const MesoIdChannel &channel)
{
    tinygltf::Value::Array names;
    for (uint32_t i = 0; i < channel.count; i++)
        names.emplace_back(std::string(channel.names[i]));
    return tinygltf::Value(names);
}

/* "_TILE" for the channel "tile". */
std::string attribute_name(const MesoIdChannel &channel)
{
    std::string name = std::string("_") + channel.name;
    for (char &c : name)
        if (c >= 'a' && c <= 'z')
            c = static_cast<char>(c - 'a' + 'A');
    return name;
}

tinygltf::Asset make_asset(const MesoGltfScene &scene)
{
    tinygltf::Asset asset;
    asset.version = "2.0";
    asset.generator = scene.generator;
    tinygltf::Value::Object extras;
    if (*scene.provenance)
        extras["provenance"] = tinygltf::Value(std::string(scene.provenance));
    for (uint32_t c = 0; c < scene.channel_count; c++)
        if (scene.channels[c].names)
            extras[std::string(scene.channels[c].name) + "s"] = channel_names(scene.channels[c]);
    asset.extras = tinygltf::Value(extras);
    return asset;
}

/* Sweeps that end at a border are open tubes: their insides can be seen. */
tinygltf::Material make_material(const MesoGltfMesh &mesh)
{
    tinygltf::Material material;
    material.name = mesh.name;
    material.doubleSided = true;
    material.pbrMetallicRoughness.baseColorFactor = {mesh.material->albedo[0], mesh.material->albedo[1],
                                                     mesh.material->albedo[2], 1};
    material.pbrMetallicRoughness.roughnessFactor = mesh.material->roughness;
    material.pbrMetallicRoughness.metallicFactor = mesh.material->metallic;
    return material;
}

/* Accessors of compressed attributes say what a decoder will give, and point nowhere. */
int add_accessor(tinygltf::Model *model, int type, int component_type, uint32_t count)
{
    tinygltf::Accessor accessor;
    accessor.type = type;
    accessor.componentType = component_type;
    accessor.count = count;
    model->accessors.push_back(accessor);
    return static_cast<int>(model->accessors.size()) - 1;
}

int add_view(tinygltf::Model *model, MesoDracoResult *piece)
{
    std::vector<unsigned char> &data = model->buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = piece->size;
    data.insert(data.end(), piece->data, piece->data + piece->size);
    data.resize((data.size() + 3) & ~static_cast<size_t>(3));
    model->bufferViews.push_back(view);
    meso_draco_result_release(piece);
    return static_cast<int>(model->bufferViews.size()) - 1;
}

tinygltf::Value draco_extension(int view, const MesoGltfScene &scene, const MesoDracoResult &piece)
{
    auto number = [](uint32_t id) { return tinygltf::Value(static_cast<int>(id)); };
    tinygltf::Value::Object attributes;
    attributes["POSITION"] = number(piece.position_id);
    attributes["NORMAL"] = number(piece.normal_id);
    attributes["TEXCOORD_0"] = number(piece.uv_id);
    if (scene.colored)
        attributes["COLOR_0"] = number(piece.color_id);
    for (uint32_t c = 0; c < scene.channel_count; c++)
        attributes[attribute_name(scene.channels[c])] = number(piece.channel_id[c]);
    tinygltf::Value::Object extension;
    extension["bufferView"] = tinygltf::Value(view);
    extension["attributes"] = tinygltf::Value(attributes);
    return tinygltf::Value(extension);
}

tinygltf::Primitive make_primitive(tinygltf::Model *model, const MesoGltfScene &scene, MesoDracoResult *piece,
                                   int material)
{
    const uint32_t vertices = piece->vertex_count;
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = material;
    primitive.indices = add_accessor(model, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                     3 * piece->triangle_count);
    const int position = add_accessor(model, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT, vertices);
    model->accessors.back().minValues = {piece->decoded_low.x, piece->decoded_low.y, piece->decoded_low.z};
    model->accessors.back().maxValues = {piece->decoded_high.x, piece->decoded_high.y, piece->decoded_high.z};
    primitive.attributes["POSITION"] = position;
    primitive.attributes["NORMAL"] =
        add_accessor(model, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT, vertices);
    primitive.attributes["TEXCOORD_0"] =
        add_accessor(model, TINYGLTF_TYPE_VEC2, TINYGLTF_COMPONENT_TYPE_FLOAT, vertices);
    if (scene.colored) {
        primitive.attributes["COLOR_0"] =
            add_accessor(model, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, vertices);
        model->accessors.back().normalized = true;
    }
    for (uint32_t c = 0; c < scene.channel_count; c++)
        primitive.attributes[attribute_name(scene.channels[c])] =
            add_accessor(model, scene.channels[c].names ? TINYGLTF_TYPE_SCALAR : TINYGLTF_TYPE_VEC2,
                         TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, vertices);
    primitive.extensions[EXTENSION] = draco_extension(add_view(model, piece), scene, *piece);
    return primitive;
}

tinygltf::Model make_model(const MesoGltfScene &scene, uint64_t data_bound)
{
    tinygltf::Model model;
    model.asset = make_asset(scene);
    model.extensionsUsed = model.extensionsRequired = {EXTENSION};
    model.buffers.resize(1);
    model.buffers[0].data.reserve(data_bound);
    model.scenes.resize(1);
    model.defaultScene = 0;
    for (uint32_t i = 0; i < scene.mesh_count; i++) {
        const int number = static_cast<int>(i);
        tinygltf::Mesh mesh;
        mesh.name = scene.meshes[i].name;
        for (uint32_t k = scene.meshes[i].piece_begin; k < scene.meshes[i].piece_end; k++)
            mesh.primitives.push_back(make_primitive(&model, scene, &scene.pieces[k], number));
        tinygltf::Node node;
        node.name = scene.meshes[i].name;
        node.mesh = number;
        model.materials.push_back(make_material(scene.meshes[i]));
        model.meshes.push_back(mesh);
        model.nodes.push_back(node);
        model.scenes[0].nodes.push_back(number);
    }
    return model;
}

MesoStatus write(const MesoGltfScene &scene, MesoGltfSink *sink, void *context, MesoError *error)
{
    const uint64_t size = bound_size(scene);
    if (size > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "too large for a GLB file: over 4 GiB%s%s",
                         scene.smaller ? ": " : "", scene.smaller ? scene.smaller : "");
    const tinygltf::Model model = make_model(scene, size);
    SinkBuffer buffer(sink, context, error);
    std::ostream stream(&buffer);
    const bool written = tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
    if (buffer.status())
        return buffer.status();
    if (!written || !stream)
        return meso_fail(error, MESO_ERR_INTERNAL, "tinygltf cannot write the scene");
    return MESO_OK;
}

}  // namespace

extern "C" MesoStatus meso_gltf_write(const MesoGltfScene *scene, MesoGltfSink *sink, void *context,
                                      MesoError *error)
{
    MesoStatus status;
    try {
        status = write(*scene, sink, context, error);
    } catch (const std::bad_alloc &) {
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory for the GLB file");
    } catch (...) {
        status = meso_fail(error, MESO_ERR_INTERNAL, "tinygltf failed on the scene");
    }
    for (uint32_t i = 0; i < count_pieces(*scene); i++)
        meso_draco_result_release(&scene->pieces[i]);
    return status;
}
