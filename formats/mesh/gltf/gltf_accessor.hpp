/* Numbers of glTF's accessors, checked against the buffers that they lie in. */
#ifndef MESO_GLTF_ACCESSOR_HPP
#define MESO_GLTF_ACCESSOR_HPP

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace meso {

struct BrokenGltf : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <typename T>
const T &at(const std::vector<T> &items, int index, const char *what)
{
    if (index < 0 || static_cast<std::size_t>(index) >= items.size())
        throw BrokenGltf(std::string(what) + " " + std::to_string(index) + " is not there");
    return items[static_cast<std::size_t>(index)];
}

/* Bytes of a buffer view. */
struct Span {
    const unsigned char *data;
    std::size_t size;
};
Span span_of(const tinygltf::Model &model, int view);

/* Numbers an element, 1 to 16. */
uint32_t component_count(const tinygltf::Accessor &accessor);
bool is_whole(const tinygltf::Accessor &accessor);

/*
 * All elements of an accessor with `count` of them, sparse ones put in: as floats, scaled where the accessor is
 * normalized, or, without scaling, as whole numbers, which its must be and not negative. Throws BrokenGltf.
 */
std::vector<float> floats_of(const tinygltf::Model &model, int accessor, std::size_t count);
std::vector<uint32_t> wholes_of(const tinygltf::Model &model, int accessor, std::size_t count);

}

#endif
