#include "formats/mesh/openmesh_adapter.h"

#include <exception>
#include <istream>
#include <new>
#include <streambuf>
#include <vector>

#include <OpenMesh/Core/IO/reader/OBJReader.hh>
#include <OpenMesh/Core/IO/reader/OFFReader.hh>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/System/omstream.hh>

namespace {

using namespace OpenMesh;

/* Bytes of the caller as a stream that can be rewound. */
class ByteBuffer : public std::streambuf {
public:
    ByteBuffer(const char *bytes, std::size_t size)
    {
        char *begin = const_cast<char *>(bytes);    /* setg() wants it so; nothing is written */
        setg(begin, begin, begin + size);
    }

protected:
    pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override
    {
        off_type base = from == std::ios_base::beg ? 0 : (from == std::ios_base::cur ? gptr() : egptr()) - eback();
        off_type target = base + offset;
        if (target < 0 || target > egptr() - eback())
            return pos_type(off_type(-1));
        setg(eback(), eback() + target, egptr());
        return pos_type(target);
    }

    pos_type seekpos(pos_type position, std::ios_base::openmode which) override
    {
        return seekoff(off_type(position), std::ios_base::beg, which);
    }
};

/*
 * Stands where OpenMesh's readers expect a mesh. They are asked for positions
 * and faces alone, so the rest of the interface has nothing to do.
 */
class Recorder : public IO::BaseImporter {
public:
    explicit Recorder(const MesoOpenMeshSink &sink) : sink_(sink) {}

    /* Positions may come after their vertices, so they wait here until all is read. */
    void deliver_vertices() const
    {
        for (const Vec3f &p : points_)
            sink_.vertex(sink_.context, p[0], p[1], p[2]);
    }

    VertexHandle add_vertex(const Vec3f &point) override
    {
        points_.push_back(point);
        return VertexHandle(static_cast<int>(points_.size() - 1));
    }
    VertexHandle add_vertex() override { return add_vertex(Vec3f(0, 0, 0)); }
    void set_point(VertexHandle vertex, const Vec3f &point) override
    {
        points_.at(static_cast<std::size_t>(vertex.idx())) = point;
    }
    FaceHandle add_face(const VHandles &handles) override
    {
        indices_.clear();
        for (VertexHandle handle : handles)
            indices_.push_back(static_cast<std::uint32_t>(handle.idx()));
        sink_.face(sink_.context, indices_.data(), static_cast<std::uint32_t>(indices_.size()));
        return FaceHandle(static_cast<int>(face_count_++));
    }
    size_t n_vertices() const override { return points_.size(); }
    size_t n_faces() const override { return face_count_; }
    size_t n_edges() const override { return 0; }

    HalfedgeHandle add_edge(VertexHandle, VertexHandle) override { return HalfedgeHandle(); }
    FaceHandle add_face(HalfedgeHandle) override { return FaceHandle(); }
    void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<Vec2f> &) override {}
    void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<Vec3f> &) override {}
    void set_face_texindex(FaceHandle, int) override {}
    void set_halfedge(VertexHandle, HalfedgeHandle) override {}
    void set_normal(VertexHandle, const Vec3f &) override {}
    void set_normal(VertexHandle, const Vec3d &) override {}
    void set_color(VertexHandle, const Vec3uc &) override {}
    void set_color(VertexHandle, const Vec4uc &) override {}
    void set_color(VertexHandle, const Vec3f &) override {}
    void set_color(VertexHandle, const Vec4f &) override {}
    void set_texcoord(VertexHandle, const Vec2f &) override {}
    void set_status(VertexHandle, const Attributes::StatusInfo &) override {}
    void set_next(HalfedgeHandle, HalfedgeHandle) override {}
    void set_face(HalfedgeHandle, FaceHandle) override {}
    void request_face_texcoords2D() override {}
    void set_texcoord(HalfedgeHandle, const Vec2f &) override {}
    void set_texcoord(VertexHandle, const Vec3f &) override {}
    void set_texcoord(HalfedgeHandle, const Vec3f &) override {}
    void set_status(HalfedgeHandle, const Attributes::StatusInfo &) override {}
    void set_color(EdgeHandle, const Vec3uc &) override {}
    void set_color(EdgeHandle, const Vec4uc &) override {}
    void set_color(EdgeHandle, const Vec3f &) override {}
    void set_color(EdgeHandle, const Vec4f &) override {}
    void set_status(EdgeHandle, const Attributes::StatusInfo &) override {}
    void set_normal(FaceHandle, const Vec3f &) override {}
    void set_normal(FaceHandle, const Vec3d &) override {}
    void set_color(FaceHandle, const Vec3uc &) override {}
    void set_color(FaceHandle, const Vec4uc &) override {}
    void set_color(FaceHandle, const Vec3f &) override {}
    void set_color(FaceHandle, const Vec4f &) override {}
    void set_status(FaceHandle, const Attributes::StatusInfo &) override {}
    void add_texture_information(int, std::string) override {}

private:
    const MesoOpenMeshSink &sink_;
    std::size_t face_count_ = 0;
    std::vector<Vec3f> points_;
    std::vector<std::uint32_t> indices_;
};

/*
 * A library of ours prints nothing; a tool's product may be on standard output.
 * (Taking their targets off, the other way, leaks them.)
 */
void silence()
{
    omerr().disable();
    omlog().disable();
    omout().disable();
}

IO::BaseReader &reader_of(MesoOpenMeshKind kind)
{
    switch (kind) {
    case MESO_OPENMESH_PLY: return IO::PLYReader();
    case MESO_OPENMESH_OFF: return IO::OFFReader();
    default: return IO::OBJReader();
    }
}

}

extern "C" MesoStatus meso_openmesh_read(MesoOpenMeshKind kind, const char *bytes, size_t size,
                                         const MesoOpenMeshSink *sink, MesoError *error)
try {
    silence();
    ByteBuffer buffer(bytes, size);
    std::istream stream(&buffer);
    Recorder recorder(*sink);
    IO::Options options;
    if (!reader_of(kind).read(stream, recorder, options))
        return meso_fail(error, MESO_ERR_INPUT, "OpenMesh cannot read the file");
    recorder.deliver_vertices();
    return MESO_OK;
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory in OpenMesh");
} catch (const std::exception &exception) {
    return meso_fail(error, MESO_ERR_INTERNAL, "OpenMesh failed: %s", exception.what());
} catch (...) {
    return meso_fail(error, MESO_ERR_INTERNAL, "OpenMesh failed");
}
