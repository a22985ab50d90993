#include "libcore/mesh/edit/triangle_pairs.h"

#include "libcore/mesh/edit/face_area.h"
#include "libcore/mesh/edit/origins.h"

static MesoStatus refuse(uint32_t *face, uint32_t number, const char *why, MesoError *error)
{
    *face = number;
    return meso_fail(error, MESO_ERR_INPUT, "face %u %s", number + 1, why);
}

/*
 * Corners of the quad, counter-clockwise from the first of triangle `t`:
 *
 *     d---c      t has the corners a b c, its neighbour a c d: their edge is opposite
 *     | / |      to b and to d
 *     a---b
 */
static MesoStatus join_corners(uint32_t quad[4], const MesoPolygonMesh *mesh, uint32_t t, uint32_t *face,
                               MesoError *error)
{
    const uint32_t *a = mesh->corners + 3 * (size_t)t, *b = a + 3;
    uint32_t shared = 0, edge_a = 0, edge_b = 0;
    for (uint32_t i = 0; i < 3; i++)
        for (uint32_t j = 0; j < 3; j++) {
            uint32_t from = a[i], to = a[(i + 1) % 3], other_from = b[j], other_to = b[(j + 1) % 3];
            if (from == other_from && to == other_to)
                return refuse(face, t + 1, "runs along an edge the same way as the face before it, with which it would "
                              "be a quad", error);
            if (from == other_to && to == other_from) {
                shared++;
                edge_a = i;
                edge_b = j;
            }
        }
    if (shared != 1)
        return refuse(face, t + 1, shared ? "is the face before it from behind" : "has no edge in common with the face "
                      "before it, with which it would be a quad", error);
    uint32_t corners[4] = {edge_a + 1, edge_a + 2, edge_a + 3, 0}, begin = 3 * t, first = 0;
    for (uint32_t k = 0; k < 3; k++)
        corners[k] = begin + corners[k] % 3;
    corners[3] = begin + 3 + (edge_b + 2) % 3;
    while (corners[first] != begin)
        first++;
    for (uint32_t k = 0; k < 4; k++)
        quad[k] = corners[(first + k) % 4];
    return MESO_OK;
}

static bool bends_too_far(const MesoPolygonMesh *mesh, uint32_t t)
{
    MesoAreaVector a = meso_face_area(mesh, t), b = meso_face_area(mesh, t + 1);
    double aa = meso_area_dot(a, a), bb = meso_area_dot(b, b), ab = meso_area_dot(a, b);
    return !(ab > 0 && ab * ab >= (1 - MESO_PAIR_BEND * MESO_PAIR_BEND) * aa * bb);
}

static bool is_convex(const MesoPolygonMesh *mesh, const uint32_t quad[4])
{
    MesoVec3 p[4];
    for (uint32_t k = 0; k < 4; k++)
        p[k] = mesh->positions[mesh->corners[quad[k]]];
    MesoAreaVector a = meso_area_between(p[0], p[1], p[2]), b = meso_area_between(p[0], p[2], p[3]);
    MesoAreaVector area = {a.x + b.x, a.y + b.y, a.z + b.z};
    for (uint32_t k = 0; k < 4; k++)
        if (!(meso_area_dot(meso_area_between(p[k], p[(k + 1) % 4], p[(k + 2) % 4]), area) > 0))
            return false;
    return true;
}

static MesoStatus add_pair(MesoMeshCopies *copies, const MesoPolygonMesh *mesh, uint32_t t, uint32_t *face,
                           MesoError *error)
{
    uint32_t quad[4] = {0};
    MesoStatus status = join_corners(quad, mesh, t, face, error);
    if (status)
        return status;
    if (bends_too_far(mesh, t))
        return refuse(face, t, "and the next would be a quad with a fold of more than 30 degrees", error);
    if (!is_convex(mesh, quad))
        return refuse(face, t, "and the next would be a quad that is not convex", error);
    for (uint32_t k = 0; k < 4; k++)
        meso_mesh_copies_corner(copies, quad[k], mesh->corners[quad[k]]);
    meso_mesh_copies_face(copies, t);
    return MESO_OK;
}

static MesoStatus check_triangles(const MesoPolygonMesh *mesh, uint32_t *face, MesoError *error)
{
    for (uint32_t f = 0; mesh->side_count != 3 && f < mesh->face_count; f++)
        if (meso_polygon_sides(mesh, f) != 3)
            return refuse(face, f, "is no triangle, and triangles alone become pairs", error);
    if (mesh->face_count % 2)
        return refuse(face, mesh->face_count - 1, "is left over: the number of triangles is odd", error);
    return MESO_OK;
}

MesoStatus meso_mesh_pair_triangles(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                                    uint32_t *face, MesoError *error)
{
    MesoArena scratch;
    MesoMeshCopies copies;
    uint32_t ignored;
    face = face ? face : &ignored;
    *face = MESO_NO_INDEX;
    meso_arena_init(&scratch);
    MesoStatus status = check_triangles(from, face, error);
    if (!status)
        status = meso_mesh_copies_init(&copies, &scratch, from->face_count / 2, 2 * (uint64_t)from->face_count, error);
    for (uint32_t t = 0; t < from->face_count && !status; t += 2)
        status = add_pair(&copies, from, t, face, error);
    if (!status)
        status = meso_mesh_copies_build(mesh, arena, from, &copies, error);
    meso_arena_release(&scratch);
    return status;
}
