/* Vertices, triangles and attributes of several pieces, gathered into one polygon mesh. For the two adapters beside. */
#ifndef MESO_MESH_GATHERER_HPP
#define MESO_MESH_GATHERER_HPP

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "libcore/mesh/polygon_mesh.h"

namespace meso {

/* Numbers of vertices under one name: floats, or whole numbers of 32 bits. */
struct Column {
    bool whole = false;
    uint32_t width = 0;
    std::vector<float> floats;
    std::vector<uint32_t> wholes;
    std::vector<uint32_t> entry_of;     /* by vertex; MESO_NO_INDEX where a piece has none */
};

/* Names of faces: entries, and which a face has. */
struct NameColumn {
    std::vector<std::string> names;
    std::map<std::string, uint32_t> numbers;
    std::vector<uint32_t> of_face;

    void add_faces(const std::string &name, std::size_t face_count);
};

/* What glTF says of a material, but for its textures. */
struct Material {
    std::string name;
    float albedo[3], roughness, metallic;
};

/* The most vertices, and corners, of a mesh from so many bytes: MESO_GLTF_CORNERS_A_BYTE. */
std::size_t most_corners(std::size_t bytes);

class MeshGatherer {
public:
    std::vector<MesoVec3> positions;
    std::vector<uint32_t> corners;
    std::map<std::string, Column> columns;
    NameColumn objects;
    std::vector<Material> materials;
    std::vector<uint32_t> material_of;      /* by face; or MESO_NO_INDEX; empty where no face can have one */
    std::map<std::string, std::vector<std::string>> names;     /* of the whole numbers of a column, from 0 */

    /* The values of the next `count` vertices, whose positions are added behind: `width` numbers each. Under a name that
     * has other numbers already they are left out. */
    void add_floats(const std::string &name, uint32_t width, const std::vector<float> &values);
    void add_wholes(const std::string &name, const std::vector<uint32_t> &values);

    /* Ends the vertices of a piece: columns without a value for them have none. */
    void end_vertices();

    /* Copies all to the arena. */
    MesoStatus finish(MesoPolygonMesh *mesh, MesoArena *arena, MesoError *error);

private:
    Column *column(const std::string &name, bool whole, uint32_t width, std::size_t count);
};

}

#endif
