/*
 * Decimation of triangle meshes on OpenMesh's half-edges, with its collapse, its quadrics and its heap. Which edge goes
 * is ours: its error forgets borders, and its decimater asks of every edge whether it may go before it asks whether it
 * would be the one.
 */
#include "libcore/mesh/refine/openmesh_decimate_adapter.h"

#include <algorithm>
#include <cfloat>
#include <exception>
#include <new>
#include <vector>

/* GCC 12 loses sight of the default arguments of add_property(). */
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Geometry/QuadricT.hh>      /* needs what the mesh includes */
#include <OpenMesh/Tools/Utils/HeapT.hh>

namespace {

using Vec = OpenMesh::Vec3d;

/* Positions are with the vertices below, next to what they are used with. */
struct Traits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
};

using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Half = OpenMesh::HalfedgeHandle;
using Quadric = OpenMesh::Geometry::QuadricT<double>;

/* How much more a plane on a border weighs than one of a face: its shape is seen against what is behind. */
constexpr double BORDER_WEIGHT = 10;

struct Vertex {
    Vec point;
    Quadric quadric;
    Half target;            /* the cheapest collapse of this vertex that may be; invalid for none */
    float cost;             /* of that */
    int place;              /* in the heap; -1 for none */
    std::uint32_t mark;
};

/* Vertices by their cheapest collapse. */
struct ByCost {
    std::vector<Vertex> *vertices;

    Vertex &at(int v) { return (*vertices)[static_cast<std::size_t>(v)]; }
    bool less(int a, int b) { return at(a).cost < at(b).cost; }
    bool greater(int a, int b) { return at(a).cost > at(b).cost; }
    int get_heap_position(int v) { return at(v).place; }
    void set_heap_position(int v, int place) { at(v).place = place; }
};

/* Mesh and vertices, and their walks. */
struct Shape {
    Mesh mesh;
    std::vector<Vertex> vertices;

    Vertex &at(int v) { return vertices[static_cast<std::size_t>(v)]; }
    Half next(Half half) const { return mesh.next_halfedge_handle(half); }
    Half opposite(Half half) const { return mesh.opposite_halfedge_handle(half); }
    /* The next half-edge out of the same vertex, clockwise. */
    Half rotated(Half half) const { return next(opposite(half)); }
    Half first_out(int v) const { return mesh.halfedge_handle(OpenMesh::VertexHandle(v)); }
    int end(Half half) const { return mesh.to_vertex_handle(half).idx(); }
    int begin(Half half) const { return end(opposite(half)); }
    bool is_border(Half half) const { return mesh.is_boundary(half); }
    /* OpenMesh keeps a border's half-edge first. */
    bool is_border_vertex(int v) const { return is_border(first_out(v)); }

    /* Once for each half-edge out of `v`; of vertices alone there is none. */
    template <class Visit> void around(int v, Visit visit) const
    {
        Half first = first_out(v), half = first;
        if (!first.is_valid())
            return;
        do {
            visit(half);
            half = rotated(half);
        } while (half != first);
    }
};

/* ---- errors ---- */

void add_plane(Shape &shape, int v, const Vec &normal, const Vec &point, double weight)
{
    shape.at(v).quadric += Quadric(normal[0], normal[1], normal[2], -(normal | point)) * weight;
}

/* Weights are areas: twice that of the triangle, and the square over a border edge. */
void add_face_planes(Shape &shape, OpenMesh::FaceHandle face)
{
    Half half = shape.mesh.halfedge_handle(face);
    const Vec &q = shape.at(shape.end(shape.next(half))).point;
    Vec normal = (shape.at(shape.begin(half)).point - q) % (shape.at(shape.end(half)).point - q);
    double size = normal.norm();
    normal *= size > 0 ? 1 / size : 0;
    for (int k = 0; k < 3; k++, half = shape.next(half)) {
        int from = shape.begin(half), to = shape.end(half);
        Vec p = shape.at(from).point, along = shape.at(to).point - p;
        double area = (along % (shape.at(shape.end(shape.next(half))).point - p)).norm();
        add_plane(shape, from, normal, p, area);
        Vec upright = along % normal;
        if (!shape.is_border(shape.opposite(half)) || upright.norm() == 0)
            continue;
        upright.normalize();
        add_plane(shape, from, upright, p, BORDER_WEIGHT * along.sqrnorm());
        add_plane(shape, to, upright, p, BORDER_WEIGHT * along.sqrnorm());
    }
}

float cost_of(Shape &shape, Half half)
{
    const Vertex &kept = shape.at(shape.end(half));
    Quadric sum = shape.at(shape.begin(half)).quadric;
    sum += kept.quadric;
    return static_cast<float>(std::max(sum(kept.point), 0.0));
}

/* ---- what may go ---- */

bool has_three(const Shape &shape, int v)
{
    Half first = shape.first_out(v);
    return shape.rotated(shape.rotated(shape.rotated(first))) == first;
}

bool are_joined(const Shape &shape, int a, int b)
{
    bool joined = false;
    shape.around(a, [&](Half half) { joined = joined || shape.end(half) == b; });
    return joined;
}

/* The vertex across the face of `half`, or -1. */
int across(const Shape &shape, Half half)
{
    return shape.is_border(half) ? -1 : shape.end(shape.next(half));
}

/* Whether the face of `half` hangs on it alone. */
bool is_flap(const Shape &shape, Half half)
{
    Half second = shape.next(half), third = shape.next(second);
    return !shape.is_border(half) && shape.is_border(shape.opposite(second)) && shape.is_border(shape.opposite(third));
}

/* Whether both ends have a neighbour in common that is not across a face of the edge: it would be pinched there. */
bool pinches(Shape &shape, int v0, int v1, int left, int right, std::uint32_t mark)
{
    bool pinched = false;
    shape.around(v1, [&](Half half) { shape.at(shape.end(half)).mark = mark; });
    shape.around(v0, [&](Half half) {
        int v = shape.end(half);
        pinched = pinched || (shape.at(v).mark == mark && v != left && v != right);
    });
    return pinched;
}

/* Whether the surface is one of the same kind after the vertex at the beginning of `half` went to its end. */
bool keeps_topology(Shape &shape, Half half, std::uint32_t mark)
{
    Half back = shape.opposite(half);
    int v0 = shape.begin(half), v1 = shape.end(half), left = across(shape, half), right = across(shape, back);
    if (shape.mesh.status(shape.mesh.edge_handle(half)).deleted() || is_flap(shape, half) || is_flap(shape, back) ||
        left == right)
        return false;
    if (shape.is_border_vertex(v0) && (!shape.is_border_vertex(v1) || (left >= 0 && right >= 0)))
        return false;       /* borders stay where they are, and apart */
    if (shape.rotated(shape.rotated(half)) == half)
        return false;
    if (left >= 0 && right >= 0 && has_three(shape, left) && has_three(shape, right) && are_joined(shape, left, right))
        return false;
    return !pinches(shape, v0, v1, left, right, mark);
}

/* Whether no face around turns by more than the angle of cosine `fold`, nor becomes flat. */
bool keeps_facing(Shape &shape, Half half, double fold)
{
    bool faces = true;
    int v0 = shape.begin(half);
    Vec from = shape.at(v0).point, to = shape.at(shape.end(half)).point;
    shape.around(v0, [&](Half out) {
        if (!faces || out == half || shape.is_border(out) || shape.opposite(shape.next(shape.next(out))) == half)
            return;
        const Vec &a = shape.at(shape.end(out)).point, &b = shape.at(shape.end(shape.next(out))).point;
        Vec before = (a - from) % (b - from), after = (a - to) % (b - to);
        double dot = before | after;
        faces = dot > 0 && dot * dot >= fold * fold * before.sqrnorm() * after.sqrnorm();
    });
    return faces;
}

/* ---- collapses ---- */

class Decimater {
public:
    Decimater(Shape &shape, double fold) : shape_(shape), fold_(fold), heap_(ByCost{&shape.vertices}) {}

    void run(std::size_t face_count, std::size_t target)
    {
        for (auto face : shape_.mesh.faces())
            add_face_planes(shape_, face);
        heap_.reserve(shape_.vertices.size());
        for (std::size_t v = 0; v < shape_.vertices.size(); v++)
            find_target(static_cast<int>(v));
        while (!heap_.empty() && face_count > target) {
            Half half = shape_.at(heap_.front()).target;
            heap_.pop_front();
            if (keeps_topology(shape_, half, ++mark_))
                face_count -= collapse(half);
        }
    }

private:
    struct Candidate {
        Half half;
        float cost;
    };

    /* The cheapest edge out of `v` that may go, the first of equals. The costs come first: few are asked for more. */
    Candidate cheapest(int v)
    {
        candidates_.clear();
        shape_.around(v, [&](Half half) { candidates_.push_back({half, cost_of(shape_, half)}); });
        for (;;) {
            auto best = std::min_element(candidates_.begin(), candidates_.end(),
                                         [](const Candidate &a, const Candidate &b) { return a.cost < b.cost; });
            if (best == candidates_.end() || !(best->cost < FLT_MAX))
                return {Half(), FLT_MAX};
            if (keeps_topology(shape_, best->half, ++mark_) && keeps_facing(shape_, best->half, fold_))
                return *best;
            best->cost = FLT_MAX;
        }
    }

    void find_target(int v)
    {
        Candidate best = cheapest(v);
        Vertex &vertex = shape_.at(v);
        vertex.target = best.half;
        vertex.cost = best.cost;
        if (!best.half.is_valid() && heap_.is_stored(v))
            heap_.remove(v);
        else if (best.half.is_valid() && heap_.is_stored(v))
            heap_.update(v);
        else if (best.half.is_valid())
            heap_.insert(v);
    }

    /* Faces that went. */
    std::size_t collapse(Half half)
    {
        int gone = shape_.begin(half), kept = shape_.end(half);
        std::size_t count = shape_.is_border(half) || shape_.is_border(shape_.opposite(half)) ? 1 : 2;
        ring_.clear();
        shape_.around(gone, [&](Half out) { ring_.push_back(shape_.end(out)); });
        shape_.mesh.collapse(half);
        shape_.at(kept).quadric += shape_.at(gone).quadric;
        for (int v : ring_)
            find_target(v);
        return count;
    }

    Shape &shape_;
    double fold_;
    std::uint32_t mark_ = 0;
    std::vector<Candidate> candidates_;
    std::vector<int> ring_;
    OpenMesh::Utils::HeapT<int, ByCost> heap_;
};

/* ---- in and out ---- */

/* Into a box of side 1 around 0: errors have no unit there, and no product of lengths is too large. */
void add_vertices(Shape &shape, const MesoDecimation &in)
{
    Vec low(0, 0, 0), high(0, 0, 0);
    for (std::uint32_t v = 0; v < in.vertex_count; v++) {
        Vec p(in.positions[v].x, in.positions[v].y, in.positions[v].z);
        low = v ? low.min(p) : p;
        high = v ? high.max(p) : p;
    }
    double size = (high - low).max(), scale = size > 0 ? 1 / size : 1;
    shape.vertices.resize(in.vertex_count);
    for (std::uint32_t v = 0; v < in.vertex_count; v++) {
        Vertex &vertex = shape.vertices[v];
        vertex.point = (Vec(in.positions[v].x, in.positions[v].y, in.positions[v].z) - low) * scale;
        vertex.place = -1;
        vertex.mark = 0;
        shape.mesh.new_vertex();
    }
}

MesoStatus add_faces(Mesh &mesh, const MesoDecimation &in, MesoError *error)
{
    for (std::uint32_t t = 0; t < in.triangle_count; t++) {
        Mesh::VertexHandle v[3];
        for (std::uint32_t k = 0; k < 3; k++)
            v[k] = Mesh::VertexHandle(static_cast<int>(in.triangles[3 * static_cast<std::size_t>(t) + k]));
        if (!mesh.add_face(v[0], v[1], v[2]).is_valid())
            return meso_fail(error, MESO_ERR_INPUT, "face %u is wound against its neighbours, or they are no manifold",
                             t + 1);
    }
    return MESO_OK;
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
    Shape shape;
    shape.mesh.reserve(decimation->vertex_count, 3 * static_cast<std::size_t>(decimation->triangle_count) / 2,
                       decimation->triangle_count);
    add_vertices(shape, *decimation);
    MesoStatus status = add_faces(shape.mesh, *decimation, error);
    if (status)
        return status;
    if (decimation->target < decimation->triangle_count)
        Decimater(shape, decimation->fold).run(decimation->triangle_count, decimation->target);
    *kept_count = take(shape.mesh, kept, corners);
    return MESO_OK;
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory in OpenMesh");
} catch (const std::exception &exception) {
    return meso_fail(error, MESO_ERR_INTERNAL, "OpenMesh failed: %s", exception.what());
} catch (...) {
    return meso_fail(error, MESO_ERR_INTERNAL, "OpenMesh failed");
}
