#include "formats/mesh/gltf_read_adapter.h"

#include <climits>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace {

/* An input file is not to make us read other ones: every outside buffer is found, and empty of meaning. */
bool file_exists(const std::string &, void *) { return true; }
std::string expand_path(const std::string &path, void *) { return path; }
bool read_no_file(std::vector<unsigned char> *, std::string *error, const std::string &name, void *)
{
    *error += "buffer in the other file '" + name + "' is not read";
    return false;
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

/* tinygltf ends each of its lines with a line end; one line is enough. */
std::string first_line(const std::string &text)
{
    return text.empty() ? "no reason given" : text.substr(0, text.find('\n'));
}

}

extern "C" MesoStatus meso_gltf_parse(const MesoInput *input, uint32_t *mesh_count, MesoError *error)
try {
    if (input->size > INT_MAX)
        return meso_fail(error, MESO_ERR_INPUT, "%s: glTF of more than 2 GiB is not read", input->path);
    tinygltf::TinyGLTF reader;
    tinygltf::Model model;
    std::string failure, warning;
    reader.SetFsCallbacks({file_exists, expand_path, read_no_file, write_no_file, nullptr});
    reader.SetImageLoader(skip_image, nullptr);

    auto size = static_cast<unsigned int>(input->size);
    bool binary = input->size >= 4 && std::memcmp(input->data, "glTF", 4) == 0;
    if (too_deep(json_of(input, binary)))
        return meso_fail(error, MESO_ERR_INPUT, "%s: broken glTF: nested more than 200 deep", input->path);
    bool read = binary
        ? reader.LoadBinaryFromMemory(&model, &failure, &warning, input->data, size, "", 0)
        : reader.LoadASCIIFromString(&model, &failure, &warning, reinterpret_cast<const char *>(input->data), size, "", 0);
    if (!read)
        return meso_fail(error, MESO_ERR_INPUT, "%s: broken glTF: %s", input->path, first_line(failure).c_str());
    *mesh_count = static_cast<uint32_t>(model.meshes.size());
    return MESO_OK;
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "%s: out of memory in tinygltf", input->path);
} catch (const std::exception &exception) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken glTF: %s", input->path, exception.what());
} catch (...) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken glTF", input->path);
}
