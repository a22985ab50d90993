#include "libcore/mesh/refine/openmesh_subdivide_adapter.h"

#include <exception>
#include <new>
#include <vector>

/* GCC 12 loses sight of the default arguments of add_property(). */
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/CatmullClarkT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/LoopT.hh>

namespace {

struct Traits : OpenMesh::DefaultTraits {
    typedef OpenMesh::Vec3d Point;
    typedef OpenMesh::Vec3d Normal;
};

template <class Mesh> MesoStatus fill(Mesh &mesh, const MesoOpenMeshPolygons &polygons, MesoError *error)
{
    std::vector<typename Mesh::VertexHandle> handles;
    for (std::uint32_t v = 0; v < polygons.vertex_count; v++) {
        MesoVec3 p = polygons.positions[v];
        mesh.add_vertex(OpenMesh::Vec3d(p.x, p.y, p.z));
    }
    for (std::uint32_t f = 0; f < polygons.face_count; f++) {
        handles.clear();
        for (std::uint32_t c = polygons.face_begin[f]; c < polygons.face_begin[f + 1]; c++)
            handles.push_back(typename Mesh::VertexHandle(static_cast<int>(polygons.corners[c])));
        if (!mesh.add_face(handles).is_valid())
            return meso_fail(error, MESO_ERR_INPUT, "OpenMesh does not take face %u", f + 1);
    }
    return MESO_OK;
}

template <class Mesh, class Subdivider>
MesoStatus subdivide(MesoVec3 *positions, std::uint32_t room, std::uint32_t *count,
                     const MesoOpenMeshPolygons &polygons, std::uint32_t level_count, MesoError *error)
{
    Mesh mesh;
    Subdivider subdivider;
    MesoStatus status = fill(mesh, polygons, error);
    if (status)
        return status;
    subdivider.attach(mesh);
    subdivider(level_count);
    subdivider.detach();
    if (mesh.n_vertices() > room)
        return meso_fail(error, MESO_ERR_LIMIT, "%zu vertices, and room for %u", mesh.n_vertices(), room);
    *count = 0;
    for (auto vertex : mesh.vertices()) {
        auto p = mesh.point(vertex);
        positions[(*count)++] = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    }
    return MESO_OK;
}

using Triangles = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Polygons = OpenMesh::PolyMesh_ArrayKernelT<Traits>;

}

extern "C" MesoStatus meso_openmesh_subdivide(MesoVec3 *positions, uint32_t room, uint32_t *count,
                                              const MesoOpenMeshPolygons *polygons, int loop, uint32_t level_count,
                                              MesoError *error)
try {
    omerr().disable();
    if (loop)
        return subdivide<Triangles, OpenMesh::Subdivider::Uniform::LoopT<Triangles, double>>(positions, room, count, *polygons,
                                                                                           level_count, error);
    return subdivide<Polygons, OpenMesh::Subdivider::Uniform::CatmullClarkT<Polygons, double>>(positions, room, count, *polygons,
                                                                                             level_count, error);
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory in OpenMesh");
} catch (const std::exception &exception) {
    return meso_fail(error, MESO_ERR_INTERNAL, "OpenMesh failed: %s", exception.what());
} catch (...) {
    return meso_fail(error, MESO_ERR_INTERNAL, "OpenMesh failed");
}
