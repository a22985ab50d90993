#include "formats/mesh/gltf/gltf_meshopt.hpp"

#include <cstdint>
#include <string>

#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include "formats/mesh/gltf/gltf_accessor.hpp"

namespace meso {

namespace {

const char NAME[] = "EXT_meshopt_compression";

/* What a byte of encoded vertices can become at most, and of encoded indices: before there is memory for it. */
constexpr std::uint64_t MOST_GROWTH = 64, MOST_CORNERS_A_BYTE = 3, LARGEST = UINT32_MAX;

[[noreturn]] void refuse(std::size_t view, const char *why)
{
    throw BrokenGltf("bufferView " + std::to_string(view) + ", compressed by meshopt, " + why);
}

/* A whole number of an object, 0 where there is none; more than 32 bits are refused. */
std::uint64_t whole(const nlohmann::json &object, const char *key, std::size_t view)
{
    if (!object.contains(key))
        return 0;
    if (!object[key].is_number_unsigned() || object[key].get<std::uint64_t>() > LARGEST)
        refuse(view, "has a number that is none");
    return object[key].get<std::uint64_t>();
}

std::string word(const nlohmann::json &object, const char *key)
{
    return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : std::string();
}

/* One of the streams in the binary part. */
struct Stream {
    const unsigned char *data;
    std::uint64_t size, count, stride;
    bool indices, sequence;
};

Stream stream_of(const nlohmann::json &coding, std::size_t view, const unsigned char *data, std::size_t size)
{
    if (!coding.is_object() || whole(coding, "buffer", view) != 0)
        refuse(view, "does not lie in the file's binary part");
    std::uint64_t offset = whole(coding, "byteOffset", view);
    std::string mode = word(coding, "mode");
    Stream s = {data + offset, whole(coding, "byteLength", view), whole(coding, "count", view),
                whole(coding, "byteStride", view), mode == "TRIANGLES" || mode == "INDICES", mode == "INDICES"};
    if (offset > size || s.size > size - offset)
        refuse(view, "ends behind the file");
    if (!s.indices && mode != "ATTRIBUTES")
        refuse(view, "has an unknown mode");
    bool fits = s.indices ? (s.stride == 2 || s.stride == 4) && s.count <= MOST_CORNERS_A_BYTE * s.size
                          : s.stride > 0 && s.stride <= 256 && s.stride % 4 == 0 &&
                                s.count * s.stride <= MOST_GROWTH * s.size;
    if (!fits || (mode == "TRIANGLES" && s.count % 3 != 0))
        refuse(view, "is not of the size that it says");
    return s;
}

void filter(const std::string &name, std::size_t view, const Stream &s, unsigned char *out)
{
    if (name == "OCTAHEDRAL" && (s.stride == 4 || s.stride == 8))
        meshopt_decodeFilterOct(out, s.count, s.stride);
    else if (name == "QUATERNION" && s.stride == 8)
        meshopt_decodeFilterQuat(out, s.count, s.stride);
    else if (name == "EXPONENTIAL")
        meshopt_decodeFilterExp(out, s.count, s.stride);
    else if (!name.empty() && name != "NONE")
        refuse(view, "has an unknown filter");
}

void decode(const nlohmann::json &coding, std::size_t view, const Stream &s, unsigned char *out)
{
    int failed = s.sequence ? meshopt_decodeIndexSequence(out, s.count, s.stride, s.data, s.size)
        : s.indices ? meshopt_decodeIndexBuffer(out, s.count, s.stride, s.data, s.size)
                    : meshopt_decodeVertexBuffer(out, s.count, s.stride, s.data, s.size);
    if (failed)
        refuse(view, "cannot be decoded");
    if (!s.indices)
        filter(word(coding, "filter"), view, s, out);
}

/* Room for `size` more bytes, from a multiple of 8 on. */
std::size_t grow(std::vector<unsigned char> *out, std::uint64_t size, std::size_t view)
{
    std::size_t at = (out->size() + 7) / 8 * 8;
    if (at + size > LARGEST)
        refuse(view, "makes the file larger than 4 GiB");
    out->resize(at + size);
    return at;
}

/* A view as it is, which some files have beside the compressed ones. */
void copy_view(const nlohmann::json &view, std::size_t number, const unsigned char *data, std::size_t size,
               std::vector<unsigned char> *out, std::size_t *at, std::uint64_t *length)
{
    std::uint64_t offset = whole(view, "byteOffset", number);
    *length = whole(view, "byteLength", number);
    if (whole(view, "buffer", number) != 0 || offset > size || *length > size - offset)
        refuse(number, "ends behind the file");
    *at = grow(out, *length, number);
    std::copy(data + offset, data + offset + *length, out->begin() + static_cast<std::ptrdiff_t>(*at));
}

void forget(nlohmann::json *json, const char *list)
{
    if (!json->contains(list) || !(*json)[list].is_array())
        return;
    nlohmann::json kept = nlohmann::json::array();
    for (const auto &name : (*json)[list])
        if (name != NAME)
            kept.push_back(name);
    (*json)[list] = kept;
    if (kept.empty())
        json->erase(list);
}

}

std::vector<unsigned char> decode_meshopt_views(nlohmann::json *json, const unsigned char *data, std::size_t size)
{
    std::vector<unsigned char> out;
    if (!json->contains("bufferViews") || !(*json)["bufferViews"].is_array())
        throw BrokenGltf("it uses EXT_meshopt_compression and has no bufferViews");
    std::size_t number = 0;
    for (auto &view : (*json)["bufferViews"]) {
        if (!view.is_object())
            throw BrokenGltf("bufferView " + std::to_string(number) + " is none");
        bool compressed = view.contains("extensions") && view["extensions"].is_object() &&
                          view["extensions"].contains(NAME);
        std::size_t at;
        std::uint64_t length;
        if (compressed) {
            const nlohmann::json coding = view["extensions"][NAME];
            Stream stream = stream_of(coding, number, data, size);
            length = stream.count * stream.stride;
            if (whole(view, "byteLength", number) != length)
                refuse(number, "is not of the size that it says");
            at = grow(&out, length, number);
            if (length > 0)
                decode(coding, number, stream, out.data() + at);
            view["extensions"].erase(NAME);
        } else {
            copy_view(view, number, data, size, &out, &at, &length);
        }
        view["buffer"] = 0;
        view["byteOffset"] = at;
        number++;
    }
    (*json)["buffers"] = nlohmann::json::array({{{"byteLength", out.size()}}});
    forget(json, "extensionsRequired");
    forget(json, "extensionsUsed");
    return out;
}

}
