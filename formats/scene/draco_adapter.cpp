#include "formats/scene/draco_adapter.h"

#include <cassert>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

#include <draco/compression/expert_encode.h>
#include <draco/core/quantization_utils.h>
#include <draco/mesh/mesh.h>

namespace {

using draco::GeometryAttribute;

/*
 * Draco's explicit quantization goes through decimal text with six digits
 * behind the point, too coarse for small scenes. Its automatic one takes the
 * box of the attribute's values, whether faces use them or not: two corners
 * that no face uses set the box, and Edgebreaker does not encode them.
 */
constexpr uint32_t CORNERS = 2;

/* Entries of metadata have names of at most 255 bytes. */
constexpr size_t MATERIAL_NAME = 200;

/* Adds an attribute whose value i belongs to vertex i; gives back where the values go, zeroes now. */
template <typename T>
T *add_attribute(draco::Mesh *mesh, GeometryAttribute::Type type, draco::DataType data_type,
                 int8_t components, const char *name, uint32_t count, int *id)
{
    GeometryAttribute attribute;
    attribute.Init(type, nullptr, static_cast<uint8_t>(components), data_type, false,
                   static_cast<int64_t>(sizeof(T)) * components, 0);
    *id = mesh->AddAttribute(attribute, true, count + CORNERS);
    if (*id < 0)
        throw std::bad_alloc();
    if (name) {
        auto metadata = std::make_unique<draco::AttributeMetadata>();
        metadata->AddEntryString("name", name);
        mesh->AddAttributeMetadata(*id, std::move(metadata));
    }
    uint8_t *values = mesh->attribute(*id)->GetAddress(draco::AttributeValueIndex(0));
    std::memset(values, 0, sizeof(T) * static_cast<size_t>(components) * (static_cast<size_t>(count) + CORNERS));
    return reinterpret_cast<T *>(values);
}

/* Attribute numbers within a mesh. */
struct Ids {
    int position = -1, normal = -1, uv = -1, color = -1, material = -1;
    int channel[MESO_ID_CHANNELS] = {-1, -1, -1, -1};
};
static_assert(MESO_ID_CHANNELS == 4, "as many attributes");

void add_vertices(draco::Mesh *mesh, const MesoDracoMesh &from, const MesoDracoOptions &options, Ids *ids)
{
    const size_t n = from.vertex_count;
    float *position = add_attribute<float>(mesh, GeometryAttribute::POSITION, draco::DT_FLOAT32, 3,
                                           nullptr, from.vertex_count, &ids->position);
    float *normal = add_attribute<float>(mesh, GeometryAttribute::NORMAL, draco::DT_FLOAT32, 3,
                                         nullptr, from.vertex_count, &ids->normal);
    float *uv = add_attribute<float>(mesh, GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, 2,
                                     nullptr, from.vertex_count, &ids->uv);
    for (size_t i = 0; i < n; i++) {
        std::memcpy(position + 3 * i, &from.vertices[i].position, 12);
        std::memcpy(normal + 3 * i, &from.vertices[i].normal, 12);
        std::memcpy(uv + 2 * i, &from.vertices[i].uv, 8);
    }
    const MesoMeshVertex corners[CORNERS] = {{options.box.low, {0, 0, 1}, {0, 0}},
                                             {options.box.high, {0, 0, 1}, {1, 1}}};
    for (size_t i = 0; i < CORNERS; i++) {
        std::memcpy(position + 3 * (n + i), &corners[i].position, 12);
        std::memcpy(normal + 3 * (n + i), &corners[i].normal, 12);
        std::memcpy(uv + 2 * (n + i), &corners[i].uv, 8);
    }
}

/* Calls `set(vertex, part)` for every vertex. */
template <typename Set>
void for_parts(const MesoDracoMesh &from, Set set)
{
    size_t vertex = 0;
    for (uint32_t part = 0; part < from.part_count; part++)
        for (; vertex < from.part_end[part]; vertex++)
            set(vertex, from.parts[part]);
}

void add_colors(draco::Mesh *mesh, const MesoDracoMesh &from, Ids *ids)
{
    if (!from.colors)
        return;
    uint8_t *color = add_attribute<uint8_t>(mesh, GeometryAttribute::COLOR, draco::DT_UINT8, 3, nullptr,
                                            from.vertex_count, &ids->color);
    std::memcpy(color, from.colors, 3 * static_cast<size_t>(from.vertex_count));
    mesh->attribute(ids->color)->set_normalized(true);
}

void add_channel(draco::Mesh *mesh, const MesoDracoMesh &from, uint32_t channel, bool for_gltf, Ids *ids)
{
    const GeometryAttribute::Type type = GeometryAttribute::GENERIC;
    const MesoIdChannel &what = from.scene->channels[channel];
    int *id = &ids->channel[channel];
    auto id_of = [&from, channel](const MesoPart &part) { return meso_scene_id(from.scene, part.ids, channel); };
    if (what.names) {
        uint16_t *out = add_attribute<uint16_t>(mesh, type, draco::DT_UINT16, 1, what.name, from.vertex_count, id);
        for_parts(from, [out, id_of](size_t i, const MesoPart &part) { out[i] = static_cast<uint16_t>(id_of(part)); });
    } else if (for_gltf) {
        uint16_t *out = add_attribute<uint16_t>(mesh, type, draco::DT_UINT16, 2, what.name, from.vertex_count, id);
        for_parts(from, [out, id_of](size_t i, const MesoPart &part) {
            out[2 * i] = static_cast<uint16_t>(id_of(part));
            out[2 * i + 1] = static_cast<uint16_t>(id_of(part) >> 16);
        });
    } else {
        uint32_t *out = add_attribute<uint32_t>(mesh, type, draco::DT_UINT32, 1, what.name, from.vertex_count, id);
        for_parts(from, [out, id_of](size_t i, const MesoPart &part) { out[i] = id_of(part); });
    }
}

/* A name as OBJ files have it, which ends at white space; none twice, and none of the entries that have a meaning. */
std::string material_entry(const MesoScene &scene, uint32_t material, const draco::Metadata &metadata)
{
    std::string name(scene.material_names[material], strnlen(scene.material_names[material], MATERIAL_NAME));
    for (char &c : name)
        if (static_cast<unsigned char>(c) <= 0x20)
            c = '_';
    while (name.empty() || metadata.entries().count(name))
        name += "+";
    return name;
}

/* Draco's own writer of OBJ takes the names of materials from here, and refuses a mesh without a name of their file. */
void name_materials(draco::Mesh *mesh, const MesoScene &scene, int attribute)
{
    auto metadata = std::make_unique<draco::AttributeMetadata>();
    metadata->AddEntryString("name", "material");
    metadata->AddEntryString("file_name", "materials.mtl");
    for (uint32_t m = 0; m < scene.material_count; m++)
        metadata->AddEntryInt(material_entry(scene, m, *metadata), static_cast<int32_t>(m));
    mesh->AddAttributeMetadata(attribute, std::move(metadata));
}

void add_numbers(draco::Mesh *mesh, const MesoDracoMesh &from, bool for_gltf, Ids *ids)
{
    for (uint32_t c = 0; c < from.scene->channel_count; c++)
        add_channel(mesh, from, c, for_gltf, ids);
    if (for_gltf)
        return;
    uint16_t *material = add_attribute<uint16_t>(mesh, GeometryAttribute::GENERIC, draco::DT_UINT16, 1, nullptr,
                                                 from.vertex_count, &ids->material);
    name_materials(mesh, *from.scene, ids->material);
    for_parts(from, [material](size_t i, const MesoPart &part) {
        material[i] = static_cast<uint16_t>(part.material);
    });
}

size_t count_triangles(const MesoDracoMesh &from)
{
    size_t count = from.face_count;
    for (size_t i = 0; i < from.face_count; i++)
        count += from.faces[i].v[3] != MESO_NO_INDEX;
    return count;
}

void add_faces(draco::Mesh *mesh, const MesoDracoMesh &from)
{
    using Point = draco::PointIndex;
    mesh->SetNumFaces(count_triangles(from));
    uint32_t next = 0;
    for (size_t i = 0; i < from.face_count; i++) {
        const uint32_t *v = from.faces[i].v;
        mesh->SetFace(draco::FaceIndex(next++), {Point(v[0]), Point(v[1]), Point(v[2])});
        if (v[3] != MESO_NO_INDEX)
            mesh->SetFace(draco::FaceIndex(next++), {Point(v[0]), Point(v[2]), Point(v[3])});
    }
}

void add_texts(draco::Mesh *mesh, const MesoDracoOptions &options)
{
    if (options.text_count == 0)
        return;
    if (!mesh->metadata())
        mesh->AddMetadata(std::make_unique<draco::GeometryMetadata>());
    for (uint32_t i = 0; i < options.text_count; i++)
        mesh->metadata()->AddEntryString(options.texts[i].key, options.texts[i].value);
}

void set_options(draco::ExpertEncoder *encoder, const MesoDracoOptions &options, const Ids &ids)
{
    encoder->SetSpeedOptions(static_cast<int>(options.speed), static_cast<int>(options.speed));
    encoder->SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder->SetAttributeQuantization(ids.position, static_cast<int>(options.position_bits));
    encoder->SetAttributeQuantization(ids.normal, static_cast<int>(options.normal_bits));
    encoder->SetAttributeQuantization(ids.uv, static_cast<int>(options.uv_bits));
    encoder->SetTrackEncodedProperties(options.for_gltf);
}

/* What Draco's own quantizer and dequantizer make of a coordinate; its range is the box's largest extent. */
float decoded(float value, float low, const MesoDracoOptions &options)
{
    const int32_t steps = static_cast<int32_t>((1u << options.position_bits) - 1);
    const float range = std::fmax(options.box.high.x - options.box.low.x,
                                  std::fmax(options.box.high.y - options.box.low.y,
                                            options.box.high.z - options.box.low.z));
    draco::Quantizer quantizer;
    draco::Dequantizer dequantizer;
    quantizer.Init(range > 0 ? range : 1, steps);
    dequantizer.Init(range > 0 ? range : 1, steps);
    return dequantizer.DequantizeFloat(quantizer.QuantizeFloat(value - low)) + low;
}

MesoVec3 decoded_point(MesoVec3 point, const MesoDracoOptions &options)
{
    return MesoVec3{decoded(point.x, options.box.low.x, options), decoded(point.y, options.box.low.y, options),
                    decoded(point.z, options.box.low.z, options)};
}

/* Rounding to the grid keeps the order of coordinates, so the corners of the box suffice. */
void bound(const MesoDracoMesh &from, const MesoDracoOptions &options, MesoDracoResult *result)
{
    MesoBox box = meso_box_empty();
    for (size_t i = 0; i < from.vertex_count; i++)
        meso_box_add(&box, from.vertices[i].position);
    result->decoded_low = decoded_point(box.low, options);
    result->decoded_high = decoded_point(box.high, options);
}

uint32_t unique_id(const draco::Mesh &mesh, int id)
{
    return id < 0 ? MESO_NO_INDEX : mesh.attribute(id)->unique_id();
}

void describe(const draco::Mesh &mesh, const draco::ExpertEncoder &encoder, const Ids &ids,
              MesoDracoResult *result)
{
    result->vertex_count = static_cast<uint32_t>(encoder.num_encoded_points());
    result->triangle_count = static_cast<uint32_t>(encoder.num_encoded_faces());
    result->position_id = unique_id(mesh, ids.position);
    result->normal_id = unique_id(mesh, ids.normal);
    result->uv_id = unique_id(mesh, ids.uv);
    result->color_id = unique_id(mesh, ids.color);
    for (uint32_t c = 0; c < MESO_ID_CHANNELS; c++)
        result->channel_id[c] = unique_id(mesh, ids.channel[c]);
    result->material_id = unique_id(mesh, ids.material);
}

MesoStatus encode(const MesoDracoMesh &from, const MesoDracoOptions &options,
                  MesoDracoResult *result, MesoError *error)
{
    draco::Mesh mesh;
    Ids ids;
    mesh.set_num_points(from.vertex_count + CORNERS);
    add_vertices(&mesh, from, options, &ids);
    add_colors(&mesh, from, &ids);
    add_numbers(&mesh, from, options.for_gltf, &ids);
    add_faces(&mesh, from);
    add_texts(&mesh, options);
    if (options.for_gltf)
        bound(from, options, result);

    draco::ExpertEncoder encoder(mesh);
    draco::EncoderBuffer buffer;
    set_options(&encoder, options, ids);
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (!status.ok())
        return meso_fail(error, MESO_ERR_INTERNAL, "Draco cannot encode the mesh: %s",
                         status.error_msg());
    describe(mesh, encoder, ids, result);

    result->data = static_cast<uint8_t *>(std::malloc(buffer.size()));
    if (!result->data)
        throw std::bad_alloc();
    result->size = buffer.size();
    std::memcpy(result->data, buffer.data(), buffer.size());
    return MESO_OK;
}

}  // namespace

extern "C" MesoStatus meso_draco_encode(const MesoDracoMesh *mesh, const MesoDracoOptions *options,
                                        MesoDracoResult *result, MesoError *error)
{
    assert(mesh->vertex_count > 0 && mesh->face_count > 0);
    *result = MesoDracoResult{};
    try {
        return encode(*mesh, *options, result, error);
    } catch (const std::bad_alloc &) {
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %u faces to Draco", mesh->face_count);
    } catch (...) {
        return meso_fail(error, MESO_ERR_INTERNAL, "Draco failed on %u faces", mesh->face_count);
    }
}

extern "C" void meso_draco_result_release(MesoDracoResult *result)
{
    std::free(result->data);
    result->data = nullptr;
    result->size = 0;
}
