#include "formats/mesh/gltf/mesh_gatherer.hpp"

#include <cstring>

#include "formats/mesh/mesh_kinds.h"

namespace meso {

std::size_t most_corners(std::size_t bytes)
{
    std::size_t most = bytes * MESO_GLTF_CORNERS_A_BYTE;
    return most < UINT32_MAX / 2 ? most : UINT32_MAX / 2;
}

void NameColumn::add_faces(const std::string &name, std::size_t face_count)
{
    auto place = numbers.emplace(name, static_cast<uint32_t>(names.size()));
    if (place.second)
        names.push_back(name);
    of_face.insert(of_face.end(), face_count, place.first->second);
}

/* The column with `count` more entries, or NULL where the name has other numbers. Vertices before have none. */
Column *MeshGatherer::column(const std::string &name, bool whole, uint32_t width, std::size_t count)
{
    Column &column = columns[name];
    if (column.width == 0) {
        column.whole = whole;
        column.width = width;
    }
    if (column.whole != whole || column.width != width || column.entry_of.size() > positions.size())
        return nullptr;
    column.entry_of.resize(positions.size(), MESO_NO_INDEX);
    auto entry = static_cast<uint32_t>((whole ? column.wholes.size() : column.floats.size()) / width);
    for (std::size_t i = 0; i < count; i++)
        column.entry_of.push_back(entry++);
    return &column;
}

void MeshGatherer::add_floats(const std::string &name, uint32_t width, const std::vector<float> &values)
{
    if (Column *to = column(name, false, width, values.size() / width))
        to->floats.insert(to->floats.end(), values.begin(), values.end());
}

void MeshGatherer::add_wholes(const std::string &name, const std::vector<uint32_t> &values)
{
    if (Column *to = column(name, true, 1, values.size()))
        to->wholes.insert(to->wholes.end(), values.begin(), values.end());
}

void MeshGatherer::end_vertices()
{
    for (auto &named : columns)
        named.second.entry_of.resize(positions.size(), MESO_NO_INDEX);
}

/* Whether all corners of each face have the same number; then of_face gets the entry of each. */
static bool agree_on_faces(const Column &column, const std::vector<uint32_t> &corners, std::vector<uint32_t> &of_face)
{
    of_face.resize(corners.size() / 3);
    for (std::size_t f = 0; f < of_face.size(); f++) {
        uint32_t first = column.entry_of[corners[3 * f]];
        for (int k = 1; k < 3; k++) {
            uint32_t other = column.entry_of[corners[3 * f + static_cast<std::size_t>(k)]];
            if ((first == MESO_NO_INDEX) != (other == MESO_NO_INDEX) ||
                (first != MESO_NO_INDEX && column.wholes[first] != column.wholes[other]))
                return false;
        }
        of_face[f] = first;
    }
    return true;
}

template <typename T>
static T *copy(MesoArena *arena, const std::vector<T> &values, MesoError *error)
{
    T *out = static_cast<T *>(meso_arena_alloc(arena, values.size(), sizeof(T), error));
    if (out && !values.empty())
        std::memcpy(out, values.data(), values.size() * sizeof(T));
    return out;
}

static MesoStatus finish_numbers(MesoAttribute *out, MesoArena *arena, const std::string &name, const Column &column,
                                 const std::vector<uint32_t> &corners, MesoError *error)
{
    std::vector<uint32_t> of_face;
    bool faces = column.whole && agree_on_faces(column, corners, of_face);
    out->name = meso_arena_copy_text(arena, name.c_str(), error);
    out->domain = faces ? MESO_ON_FACES : MESO_ON_VERTICES;
    out->scalar = column.whole ? MESO_SCALAR_UINT32 : MESO_SCALAR_FLOAT;
    out->width = column.width;
    out->entry_count = static_cast<uint32_t>((column.whole ? column.wholes.size() : column.floats.size()) / column.width);
    out->values = column.whole ? static_cast<void *>(copy(arena, column.wholes, error))
                               : static_cast<void *>(copy(arena, column.floats, error));
    bool direct = !faces;
    for (std::size_t i = 0; i < column.entry_of.size() && direct; i++)
        direct = column.entry_of[i] == i;
    out->entry_of = direct ? nullptr : copy(arena, faces ? of_face : column.entry_of, error);
    return out->name && out->values && (direct || out->entry_of) ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus finish_names(MesoAttribute *out, MesoArena *arena, const char *name, const NameColumn &column,
                               MesoError *error)
{
    out->name = name;
    out->domain = MESO_ON_FACES;
    out->entry_count = static_cast<uint32_t>(column.names.size());
    out->names = static_cast<const char **>(meso_arena_alloc(arena, column.names.size(), sizeof *out->names, error));
    out->entry_of = copy(arena, column.of_face, error);
    if (!out->names || !out->entry_of)
        return MESO_ERR_MEMORY;
    for (std::size_t i = 0; i < column.names.size(); i++)
        if (!(out->names[i] = meso_arena_copy_text(arena, column.names[i].c_str(), error)))
            return MESO_ERR_MEMORY;
    return MESO_OK;
}

MesoStatus MeshGatherer::finish(MesoPolygonMesh *mesh, MesoArena *arena, MesoError *error)
{
    std::size_t face_count = corners.size() / 3, attribute_count = 0;
    *mesh = MesoPolygonMesh{};
    mesh->vertex_count = static_cast<uint32_t>(positions.size());
    mesh->face_count = static_cast<uint32_t>(face_count);
    mesh->corner_count = static_cast<uint32_t>(corners.size());
    mesh->side_count = 3;
    mesh->positions = copy(arena, positions, error);
    mesh->corners = copy(arena, corners, error);
    mesh->attributes = static_cast<MesoAttribute *>(
        meso_arena_alloc(arena, columns.size() + 2, sizeof *mesh->attributes, error));
    if (!mesh->positions || !mesh->corners || !mesh->attributes)
        return MESO_ERR_MEMORY;
    for (const auto &named : columns)
        if (named.second.width && finish_numbers(&mesh->attributes[attribute_count++], arena, named.first, named.second,
                                                 corners, error))
            return MESO_ERR_MEMORY;
    const NameColumn *names[2] = {&objects, &materials};
    const char *const keys[2] = {"object", "material"};
    for (int i = 0; i < 2; i++)
        if (names[i]->of_face.size() == face_count && face_count &&
            finish_names(&mesh->attributes[attribute_count++], arena, keys[i], *names[i], error))
            return MESO_ERR_MEMORY;
    mesh->attribute_count = static_cast<uint32_t>(attribute_count);
    return MESO_OK;
}

}
