#include "formats/gltf_read_adapter.h"

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
