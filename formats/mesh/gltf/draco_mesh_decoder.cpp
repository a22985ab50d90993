#include "formats/mesh/gltf/draco_mesh_decoder.hpp"

#include <stdexcept>

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

namespace meso {

/* A count as the bitstream has it: four bytes before `compact`, fewer since. */
static uint32_t read_count(draco::DecoderBuffer *buffer, int compact)
{
    uint32_t count = 0;
    bool read = buffer->bitstream_version() < compact ? buffer->Decode(&count) : draco::DecodeVarint(&count, buffer);
    if (!read)
        throw std::runtime_error("Draco: the bitstream ends where it counts faces");
    return count;
}

/*
 * The larger one of the numbers of faces and vertices in the header, which Draco allocates for before it reads any of
 * them. As MeshEdgebreakerDecoderImpl and MeshSequentialDecoder begin.
 */
static uint32_t claimed_size(draco::DecoderBuffer buffer)
{
    draco::DracoHeader header;
    draco::GeometryMetadata metadata;
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok())
        throw std::runtime_error("Draco: broken header");
    const int version = DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor);
    buffer.set_bitstream_version(static_cast<uint16_t>(version));
    bool described = buffer.bitstream_version() >= DRACO_BITSTREAM_VERSION(1, 3) && (header.flags & METADATA_FLAG_MASK);
    if (described && !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
        throw std::runtime_error("Draco: broken metadata");
    int compact = DRACO_BITSTREAM_VERSION(2, 2);
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        buffer.Advance(1);      /* the kind of traversal */
        if (buffer.bitstream_version() < compact)
            read_count(&buffer, DRACO_BITSTREAM_VERSION(2, 0));     /* vertices that are new */
        compact = DRACO_BITSTREAM_VERSION(2, 0);
    }
    uint32_t first = read_count(&buffer, compact), second = read_count(&buffer, compact);
    return first > second ? first : second;
}

std::unique_ptr<draco::Mesh> decode_draco(const unsigned char *data, std::size_t size, std::size_t most_points)
{
    draco::DecoderBuffer buffer;
    draco::Decoder decoder;
    buffer.Init(reinterpret_cast<const char *>(data), size);
    auto kind = draco::Decoder::GetEncodedGeometryType(&buffer);
    if (!kind.ok() || kind.value() != draco::TRIANGULAR_MESH)
        throw std::runtime_error("what Draco compressed is no mesh of triangles");
    buffer.Init(reinterpret_cast<const char *>(data), size);
    if (claimed_size(buffer) > most_points)
        throw std::runtime_error("a mesh that Draco compressed is absurdly large for its file");
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok())
        throw std::runtime_error("Draco: " + mesh.status().error_msg_string());
    if (mesh.value()->num_points() > most_points || mesh.value()->num_faces() > most_points)
        throw std::runtime_error("a mesh that Draco compressed is absurdly large for its file");
    return std::move(mesh).value();
}

bool draco_is_whole(const draco::PointAttribute &attribute)
{
    return attribute.data_type() != draco::DT_FLOAT32 && attribute.data_type() != draco::DT_FLOAT64 &&
           !attribute.normalized();
}

template <typename T>
static std::vector<T> numbers(const draco::Mesh &mesh, const draco::PointAttribute &attribute)
{
    auto width = static_cast<std::size_t>(attribute.num_components());
    std::vector<T> out(mesh.num_points() * width);
    for (uint32_t i = 0; i < mesh.num_points(); i++) {
        draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute.size() ||
            !attribute.ConvertValue<T>(value, static_cast<int8_t>(width), out.data() + i * width))
            throw std::runtime_error("an attribute that Draco compressed is out of range");
    }
    return out;
}

std::vector<float> draco_floats(const draco::Mesh &mesh, const draco::PointAttribute &attribute)
{
    return numbers<float>(mesh, attribute);
}

std::vector<uint32_t> draco_wholes(const draco::Mesh &mesh, const draco::PointAttribute &attribute)
{
    return numbers<uint32_t>(mesh, attribute);
}

std::vector<uint32_t> draco_corners(const draco::Mesh &mesh)
{
    std::vector<uint32_t> out;
    out.reserve(3 * static_cast<std::size_t>(mesh.num_faces()));
    for (uint32_t f = 0; f < mesh.num_faces(); f++)
        for (int k = 0; k < 3; k++) {
            uint32_t point = mesh.face(draco::FaceIndex(f))[static_cast<std::size_t>(k)].value();
            if (point >= mesh.num_points())
                throw std::runtime_error("a face that Draco compressed names a point that is not there");
            out.push_back(point);
        }
    return out;
}

}
