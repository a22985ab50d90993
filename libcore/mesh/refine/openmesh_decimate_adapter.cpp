/* Decimation of triangle meshes by OpenMesh, which has the heap and the collapses; the error is ours, for its own forgets borders. */
#include "libcore/mesh/refine/openmesh_decimate_adapter.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

/* GCC 12 loses sight of the default arguments of add_property(). */
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Geometry/QuadricT.hh>      /* needs what the mesh includes */
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>

#include "libcore/math/vec.h"

namespace {

struct Traits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
    typedef OpenMesh::Vec3d Point;
    typedef OpenMesh::Vec3d Normal;
};

using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Quadric = OpenMesh::Geometry::QuadricT<double>;

/* How much more a plane on a border weighs than one of a face: its shape is seen against what is behind. */
constexpr double BORDER_WEIGHT = 10;

template <class MeshT>
class ModBorderQuadricT : public OpenMesh::Decimater::ModBaseT<MeshT> {
public:
    DECIMATING_MODULE(ModBorderQuadricT, MeshT, BorderQuadric);

    explicit ModBorderQuadricT(MeshT &mesh) : Base(mesh, false) { mesh.add_property(quadrics_); }
    ~ModBorderQuadricT() override { Base::mesh().remove_property(quadrics_); }

    void initialize() override
    {
        MeshT &mesh = Base::mesh();
        for (auto vertex : mesh.vertices())
            mesh.property(quadrics_, vertex).clear();
        for (auto face : mesh.faces())
            add_face_planes(face);
    }
    float collapse_priority(const CollapseInfo &collapse) override
    {
        Quadric sum = Base::mesh().property(quadrics_, collapse.v0);
        sum += Base::mesh().property(quadrics_, collapse.v1);
        return static_cast<float>(std::max(sum(collapse.p1), 0.0));
    }
    void postprocess_collapse(const CollapseInfo &collapse) override
    {
        Base::mesh().property(quadrics_, collapse.v1) += Base::mesh().property(quadrics_, collapse.v0);
    }

private:
    void add_plane(typename MeshT::VertexHandle vertex, const OpenMesh::Vec3d &normal, const OpenMesh::Vec3d &point,
                   double weight)
    {
        Base::mesh().property(quadrics_, vertex) += Quadric(normal[0], normal[1], normal[2], -(normal | point)) * weight;
    }
    /* Weights are areas: twice that of the triangle, and the square over a border edge. */
    void add_face_planes(typename MeshT::FaceHandle face)
    {
        MeshT &mesh = Base::mesh();
        OpenMesh::Vec3d normal = mesh.normal(face);
        for (auto half = mesh.cfh_begin(face); half != mesh.cfh_end(face); ++half) {
            auto from = mesh.from_vertex_handle(*half), to = mesh.to_vertex_handle(*half);
            OpenMesh::Vec3d p = mesh.point(from), along = mesh.point(to) - p;
            double area = (along % (mesh.point(mesh.opposite_vh(*half)) - p)).norm();
            add_plane(from, normal, p, area);
            OpenMesh::Vec3d upright = along % normal;
            if (!mesh.is_boundary(mesh.edge_handle(*half)) || upright.norm() == 0)
                continue;
            upright.normalize();
            add_plane(from, upright, p, BORDER_WEIGHT * along.sqrnorm());
            add_plane(to, upright, p, BORDER_WEIGHT * along.sqrnorm());
        }
    }

    OpenMesh::VPropHandleT<Quadric> quadrics_;
};

/* Into a box of side 1 around 0: errors have no unit there, and no product of lengths is too large. */
void add_vertices(Mesh &mesh, const MesoDecimation &in)
{
    OpenMesh::Vec3d low(0, 0, 0), high(0, 0, 0);
    for (std::uint32_t v = 0; v < in.vertex_count; v++) {
        OpenMesh::Vec3d p(in.positions[v].x, in.positions[v].y, in.positions[v].z);
        low = v ? low.min(p) : p;
        high = v ? high.max(p) : p;
    }
    double size = (high - low).max(), scale = size > 0 ? 1 / size : 1;
    for (std::uint32_t v = 0; v < in.vertex_count; v++)
        mesh.add_vertex((OpenMesh::Vec3d(in.positions[v].x, in.positions[v].y, in.positions[v].z) - low) * scale);
}

MesoStatus add_faces(Mesh &mesh, const MesoDecimation &in, MesoError *error)
{
    for (std::uint32_t t = 0; t < in.triangle_count; t++) {
        Mesh::VertexHandle v[3];
        for (std::uint32_t k = 0; k < 3; k++)
            v[k] = Mesh::VertexHandle(static_cast<int>(in.triangles[3 * static_cast<std::size_t>(t) + k]));
        if (!mesh.add_face(v[0], v[1], v[2]).is_valid())
            return meso_fail(error, MESO_ERR_INPUT, "face %u is wound against its neighbours, or they are no manifold", t + 1);
    }
    return MESO_OK;
}

void decimate(Mesh &mesh, const MesoDecimation &in)
{
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
    ModBorderQuadricT<Mesh>::Handle quadric;
    OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
    decimater.add(quadric);
    decimater.add(flipping);
    decimater.module(flipping).set_max_normal_deviation(static_cast<float>(std::acos(in.fold) * 180 / MESO_PI));
    if (decimater.initialize())
        decimater.decimate_to_faces(0, in.target);
}

std::uint32_t take(const Mesh &mesh, std::uint32_t *kept, std::uint32_t *corners)
{
    std::uint32_t count = 0;
    for (std::size_t t = 0; t < mesh.n_faces(); t++) {
        Mesh::FaceHandle face(static_cast<int>(t));
        if (mesh.status(face).deleted())
            continue;
        std::uint32_t *out = corners + 3 * static_cast<std::size_t>(count);
        for (auto vertex = mesh.cfv_begin(face); vertex.is_valid(); ++vertex)
            *out++ = static_cast<std::uint32_t>(vertex->idx());
        kept[count++] = static_cast<std::uint32_t>(t);
    }
    return count;
}

}

extern "C" MesoStatus meso_openmesh_decimate(const MesoDecimation *decimation, uint32_t *kept, uint32_t *corners,
                                             uint32_t *kept_count, MesoError *error)
try {
    /* A library of ours prints nothing; a tool's product may be on standard output. */
    omerr().disable();
    omlog().disable();
    omout().disable();
    Mesh mesh;
    mesh.reserve(decimation->vertex_count, 3 * static_cast<std::size_t>(decimation->triangle_count) / 2,
                 decimation->triangle_count);
    add_vertices(mesh, *decimation);
    MesoStatus status = add_faces(mesh, *decimation, error);
    if (status)
        return status;
    mesh.update_face_normals();
    if (decimation->target < decimation->triangle_count)
        decimate(mesh, *decimation);
    *kept_count = take(mesh, kept, corners);
    return MESO_OK;
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory in OpenMesh");
} catch (const std::exception &exception) {
    return meso_fail(error, MESO_ERR_INTERNAL, "OpenMesh failed: %s", exception.what());
} catch (...) {
    return meso_fail(error, MESO_ERR_INTERNAL, "OpenMesh failed");
}
