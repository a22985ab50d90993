#include "formats/mesh/gltf/gltf_file.hpp"

#include <algorithm>
#include <climits>
#include <cstring>
#include <set>

#include <nlohmann/json.hpp>

#include "formats/mesh/gltf/gltf_accessor.hpp"
#include "formats/mesh/gltf/gltf_meshopt.hpp"
#include "formats/mesh/mesh_kinds.h"

namespace meso {

namespace {

/* Buffers lie beside the file, or below its folder: a file is not to make us read any other. */
struct Folder {
    std::string path;           /* with a slash at its end, or empty */
    std::set<std::string> read; /* names of files */
    std::size_t bytes;          /* of the file and of those beside it */
};

bool file_exists(const std::string &, void *) { return true; }
std::string expand_path(const std::string &path, void *) { return path; }

std::string without_dot(const std::string &file)
{
    return file.compare(0, 2, "./") == 0 ? file.substr(2) : file;
}

bool lies_beside(const std::string &file)
{
    return !file.empty() && file[0] != '/' && file.find("..") == std::string::npos && file.find('\\') == std::string::npos &&
           file.find(':') == std::string::npos;
}

/* Each once: a small file could name a large one a thousand times. */
bool read_beside(std::vector<unsigned char> *bytes, std::string *error, const std::string &name, void *user)
{
    auto *folder = static_cast<Folder *>(user);
    std::string file = without_dot(name);
    if (!lies_beside(file)) {
        *error += "the buffer '" + file + "' does not lie beside the file";
        return false;
    }
    if (!folder->read.insert(file).second) {
        *error += "the buffer '" + file + "' is named twice";
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
    folder->bytes += input.size;
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

bool is_binary(const MesoInput *input)
{
    return input->size >= 4 && std::memcmp(input->data, "glTF", 4) == 0;
}

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

/* A .glb of a JSON part and a binary one. */
std::vector<unsigned char> binary_file(std::string json, const std::vector<unsigned char> &data)
{
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::size_t padding = (4 - data.size() % 4) % 4, size = 28 + json.size() + data.size() + padding;
    if (size > UINT32_MAX)
        throw BrokenGltf("it is larger than 4 GiB when it is decoded");
    const std::size_t words[] = {0x46546c67, 2, size, json.size(), 0x4e4f534a};
    const std::size_t binary[] = {data.size() + padding, 0x004e4942};
    std::vector<unsigned char> out;
    out.reserve(size);
    auto put = [&out](std::size_t value) {
        for (std::size_t k = 0; k < 4; k++)
            out.push_back(static_cast<unsigned char>(value >> 8 * k));
    };
    for (std::size_t value : words)
        put(value);
    out.insert(out.end(), json.begin(), json.end());
    for (std::size_t value : binary)
        put(value);
    out.insert(out.end(), data.begin(), data.end());
    out.resize(size, 0);
    return out;
}

/* The file with what meshoptimizer compressed decoded; empty where there is nothing of it, or no binary part. */
std::vector<unsigned char> with_decoded_views(const MesoInput *input, bool binary)
{
    static const char sign[] = "EXT_meshopt_compression";
    Bytes text = json_of(input, binary);
    const unsigned char *end = input->data + input->size;
    if (!binary || std::search(text.begin, text.end, sign, sign + sizeof sign - 1) == text.end || end - text.end < 8)
        return {};
    auto json = nlohmann::json::parse(text.begin, text.end, nullptr, false);
    if (!json.is_object())
        return {};
    const unsigned char *data = text.end + 8;
    std::vector<unsigned char> decoded = decode_meshopt_views(&json, data, static_cast<std::size_t>(end - data));
    return binary_file(json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace), decoded);
}

/* tinygltf ends each of its lines with a line end; one line is enough. */
std::string first_line(const std::string &text)
{
    return text.empty() ? "no reason given" : text.substr(0, text.find('\n'));
}

void check_extensions(const tinygltf::Model &model)
{
    for (const std::string &name : model.extensionsRequired)
        if (name != "KHR_draco_mesh_compression" && name != "KHR_mesh_quantization" && name != "KHR_texture_transform" &&
            name != "KHR_texture_basisu" && name.compare(0, 14, "KHR_materials_") != 0)
            throw BrokenGltf("it requires the extension " + name + ", which is not read");
}

std::string folder_of(const char *path)
{
    const char *slash = std::strrchr(path, '/');
    return slash ? std::string(path, slash + 1) : std::string();
}

int digit(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : 0;
}

/* As tinygltf does it, blanks for plus signs too. */
std::string decoded(const std::string &uri)
{
    std::string out;
    for (std::size_t i = 0; i < uri.size(); i++) {
        bool code = uri[i] == '%' && i + 2 < uri.size();
        out += code ? static_cast<char>(digit(uri[i + 1]) << 4 | digit(uri[i + 2])) : uri[i] == '+' ? ' ' : uri[i];
        i += code ? 2 : 0;
    }
    return out;
}

/* Names of the buffers beside a file, each once. */
std::vector<std::string> buffer_names(const MesoInput *input)
{
    static const char sign[] = "\"uri\"";
    Bytes text = json_of(input, is_binary(input));
    std::vector<std::string> out;
    if (std::search(text.begin, text.end, sign, sign + sizeof sign - 1) == text.end)
        return out;
    auto json = nlohmann::json::parse(text.begin, text.end, nullptr, false);
    if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array())
        return out;
    std::set<std::string> known;
    for (const auto &buffer : json["buffers"]) {
        if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string())
            continue;
        std::string file = without_dot(decoded(buffer["uri"]));
        if (lies_beside(file) && known.insert(file).second)
            out.push_back(file);
    }
    return out;
}

void load(tinygltf::Model *model, Folder *folder, const MesoInput *input)
{
    tinygltf::TinyGLTF reader;
    std::string failure, warning;
    reader.SetFsCallbacks({file_exists, expand_path, read_beside, write_no_file, folder});
    reader.SetImageLoader(skip_image, nullptr);
    auto size = static_cast<unsigned int>(input->size);
    bool binary = is_binary(input);
    if (too_deep(json_of(input, binary)))
        throw BrokenGltf("nested more than 200 deep");
    std::vector<unsigned char> plain = with_decoded_views(input, binary);
    if (plain.empty())
        plain = with_hidden_indices(input, binary);
    const unsigned char *bytes = plain.empty() ? input->data : plain.data();
    size = plain.empty() ? size : static_cast<unsigned int>(plain.size());
    bool read = binary
        ? reader.LoadBinaryFromMemory(model, &failure, &warning, bytes, size, "", 0)
        : reader.LoadASCIIFromString(model, &failure, &warning, reinterpret_cast<const char *>(bytes), size, "", 0);
    if (!read)
        throw BrokenGltf(first_line(failure));
}

}

void load_gltf(tinygltf::Model *model, std::size_t *size, const MesoInput *input)
{
    Folder folder = {folder_of(input->path), {}, input->size};
    if (input->size > INT_MAX)
        throw BrokenGltf("over 2 GiB of it are not read");
    load(model, &folder, input);
    check_extensions(*model);
    *size = folder.bytes;
}

}

extern "C" MesoStatus meso_gltf_buffers(const char *const **paths, uint32_t *count, MesoArena *arena, const MesoInput *input,
                                        MesoError *error)
try {
    std::vector<std::string> names = meso::buffer_names(input);
    std::string folder = meso::folder_of(input->path);
    auto **out = static_cast<const char **>(meso_arena_alloc(arena, names.size(), sizeof(char *), error));
    if (!out)
        return MESO_ERR_MEMORY;
    for (std::size_t i = 0; i < names.size(); i++)
        if (!(out[i] = meso_arena_copy_text(arena, (folder + names[i]).c_str(), error)))
            return MESO_ERR_MEMORY;
    *paths = out;
    *count = static_cast<uint32_t>(names.size());
    return MESO_OK;
} catch (...) {
    return meso_fail(error, MESO_ERR_MEMORY, "%s: out of memory for its buffers", input->path);
}
