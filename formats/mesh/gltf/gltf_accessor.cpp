#include "formats/mesh/gltf/gltf_accessor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace meso {

static std::size_t component_size(int type)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        throw BrokenGltf("an accessor has numbers of the unknown type " + std::to_string(type));
    }
}

template <typename T>
static double load(const unsigned char *at)
{
    T value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
}

/* A number, and what normalized ones of its type are divided by. */
static double number(const unsigned char *at, int type, bool normalized)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
        double value = load<int8_t>(at);
        return normalized ? std::max(value / 127, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return normalized ? load<uint8_t>(at) / 255 : load<uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
        double value = load<int16_t>(at);
        return normalized ? std::max(value / 32767, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return normalized ? load<uint16_t>(at) / 65535 : load<uint16_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return normalized ? load<uint32_t>(at) / 4294967295.0 : load<uint32_t>(at);
    default:
        return load<float>(at);
    }
}

Span span_of(const tinygltf::Model &model, int view_index)
{
    const tinygltf::BufferView &view = at(model.bufferViews, view_index, "bufferView");
    const tinygltf::Buffer &buffer = at(model.buffers, view.buffer, "buffer");
    if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset)
        throw BrokenGltf("bufferView " + std::to_string(view_index) + " ends behind its buffer");
    return {buffer.data.data() + view.byteOffset, view.byteLength};
}

uint32_t component_count(const tinygltf::Accessor &accessor)
{
    int count = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
    if (count < 1 || count > 16)
        throw BrokenGltf("an accessor has elements of an unknown type");
    return static_cast<uint32_t>(count);
}

bool is_whole(const tinygltf::Accessor &accessor)
{
    return accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !accessor.normalized;
}

/* Bytes that `count` elements of `size` bytes, `stride` apart, take from `offset` on; checked. */
static const unsigned char *elements(Span span, std::size_t offset, std::size_t count, std::size_t stride, std::size_t size,
                                     int accessor)
{
    if (count == 0)
        return span.data;
    if (offset > span.size || size > span.size - offset || (count - 1) > (span.size - offset - size) / stride)
        throw BrokenGltf("accessor " + std::to_string(accessor) + " ends behind its bufferView");
    return span.data + offset;
}

/* The numbers of all elements, through `put`. */
template <typename Put>
static void read(const tinygltf::Model &model, int index, std::size_t count, Put put)
{
    const tinygltf::Accessor &accessor = at(model.accessors, index, "accessor");
    std::size_t width = component_count(accessor), one = component_size(accessor.componentType), size = one * width;
    if (accessor.count != count)
        throw BrokenGltf("accessor " + std::to_string(index) + " has " + std::to_string(accessor.count) +
                         " elements, not " + std::to_string(count));
    if (accessor.bufferView >= 0) {
        const tinygltf::BufferView &view = at(model.bufferViews, accessor.bufferView, "bufferView");
        std::size_t stride = view.byteStride ? view.byteStride : size;
        if (stride < size)
            throw BrokenGltf("bufferView " + std::to_string(accessor.bufferView) + " has elements that overlap");
        const unsigned char *from = elements(span_of(model, accessor.bufferView), accessor.byteOffset, count, stride, size,
                                             index);
        for (std::size_t i = 0; i < count; i++)
            for (std::size_t k = 0; k < width; k++)
                put(i * width + k, number(from + i * stride + k * one, accessor.componentType, accessor.normalized));
    }
    if (!accessor.sparse.isSparse)
        return;
    const auto &sparse = accessor.sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        throw BrokenGltf("accessor " + std::to_string(index) + " has a negative count or offset");
    auto changed = static_cast<std::size_t>(sparse.count);
    std::size_t index_size = component_size(sparse.indices.componentType);
    const unsigned char *places = elements(span_of(model, sparse.indices.bufferView),
                                           static_cast<std::size_t>(sparse.indices.byteOffset), changed, index_size,
                                           index_size, index);
    const unsigned char *values = elements(span_of(model, sparse.values.bufferView),
                                           static_cast<std::size_t>(sparse.values.byteOffset), changed, size, size, index);
    for (std::size_t i = 0; i < changed; i++) {
        double place = number(places + i * index_size, sparse.indices.componentType, false);
        if (!(place >= 0 && place < static_cast<double>(count)))
            throw BrokenGltf("accessor " + std::to_string(index) + " changes an element that it does not have");
        for (std::size_t k = 0; k < width; k++)
            put(static_cast<std::size_t>(place) * width + k,
                number(values + i * size + k * one, accessor.componentType, accessor.normalized));
    }
}

std::vector<float> floats_of(const tinygltf::Model &model, int accessor, std::size_t count)
{
    std::vector<float> out(count * component_count(at(model.accessors, accessor, "accessor")));
    read(model, accessor, count, [&](std::size_t i, double value) { out[i] = static_cast<float>(value); });
    return out;
}

std::vector<uint32_t> wholes_of(const tinygltf::Model &model, int accessor, std::size_t count)
{
    std::vector<uint32_t> out(count * component_count(at(model.accessors, accessor, "accessor")));
    read(model, accessor, count, [&](std::size_t i, double value) {
        if (!(value >= 0 && value <= 4294967295.0 && value == std::floor(value)))
            throw BrokenGltf("accessor " + std::to_string(accessor) + " has a number that is not whole, or negative");
        out[i] = static_cast<uint32_t>(value);
    });
    return out;
}

}
