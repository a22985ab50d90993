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

static MesoStatus finish_names(MesoAttribute *out, MesoArena *arena, const char *name, const std::vector<std::string> &names,
                               const std::vector<uint32_t> &of_face, MesoError *error)
{
    *out = MesoAttribute{};
    out->name = name;
    out->domain = MESO_ON_FACES;
    out->entry_count = static_cast<uint32_t>(names.size());
    out->names = static_cast<const char **>(meso_arena_alloc(arena, names.size(), sizeof *out->names, error));
    out->entry_of = copy(arena, of_face, error);
    if (!out->names || !out->entry_of)
        return MESO_ERR_MEMORY;
    for (std::size_t i = 0; i < names.size(); i++)
        if (!(out->names[i] = meso_arena_copy_text(arena, names[i].c_str(), error)))
            return MESO_ERR_MEMORY;
    return MESO_OK;
}

/* Whole numbers of faces that all have names become these; others stay numbers. */
static MesoStatus name_numbers(MesoAttribute *out, MesoArena *arena, const std::vector<std::string> &names,
                               std::size_t face_count, MesoError *error)
{
    if (out->domain != MESO_ON_FACES || out->scalar != MESO_SCALAR_UINT32 || out->width != 1)
        return MESO_OK;
    std::vector<uint32_t> of_face(out->entry_of, out->entry_of + face_count);
    for (uint32_t &entry : of_face) {
        if (entry == MESO_NO_INDEX)
            continue;
        entry = static_cast<const uint32_t *>(out->values)[entry];
        if (entry >= names.size())
            return MESO_OK;
    }
    return finish_names(out, arena, out->name, names, of_face, error);
}

/* One number, or three, of each material, on the faces. */
static MesoStatus finish_look(MesoAttribute *out, MesoArena *arena, const char *name, uint32_t width,
                              const std::vector<float> &values, const std::vector<uint32_t> &of_face, MesoError *error)
{
    out->name = name;
    out->domain = MESO_ON_FACES;
    out->width = width;
    out->entry_count = static_cast<uint32_t>(values.size() / width);
    out->values = copy(arena, values, error);
    out->entry_of = copy(arena, of_face, error);
    return out->values && out->entry_of ? MESO_OK : MESO_ERR_MEMORY;
}

/* Four attributes. */
static MesoStatus finish_materials(MesoAttribute *out, MesoArena *arena, const std::vector<Material> &materials,
                                   const std::vector<uint32_t> &of_face, MesoError *error)
{
    std::vector<std::string> names;
    std::vector<float> albedo, roughness, metallic;
    for (const Material &material : materials) {
        names.push_back(material.name);
        albedo.insert(albedo.end(), material.albedo, material.albedo + 3);
        roughness.push_back(material.roughness);
        metallic.push_back(material.metallic);
    }
    if (finish_names(&out[0], arena, "material", names, of_face, error) ||
        finish_look(&out[1], arena, "albedo", 3, albedo, of_face, error) ||
        finish_look(&out[2], arena, "roughness", 1, roughness, of_face, error) ||
        finish_look(&out[3], arena, "metallic", 1, metallic, of_face, error))
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
        meso_arena_alloc(arena, columns.size() + 5, sizeof *mesh->attributes, error));
    if (!mesh->positions || !mesh->corners || !mesh->attributes)
        return MESO_ERR_MEMORY;
    if (face_count && objects.of_face.size() == face_count &&
        finish_names(&mesh->attributes[attribute_count++], arena, "object", objects.names, objects.of_face, error))
        return MESO_ERR_MEMORY;
    if (face_count && !materials.empty()) {
        if (finish_materials(&mesh->attributes[attribute_count], arena, materials, material_of, error))
            return MESO_ERR_MEMORY;
        attribute_count += 4;
    }
    for (const auto &named : columns) {
        if (!named.second.width)
            continue;
        MesoAttribute *attribute = &mesh->attributes[attribute_count++];
        auto of_numbers = names.find(named.first);
        if (finish_numbers(attribute, arena, named.first, named.second, corners, error) ||
            (of_numbers != names.end() && name_numbers(attribute, arena, of_numbers->second, face_count, error)))
            return MESO_ERR_MEMORY;
    }
    mesh->attribute_count = static_cast<uint32_t>(attribute_count);
    return MESO_OK;
}

}
