#include "libcore/mesh/quad_mesh.h"

#include <math.h>
#include <string.h>

typedef struct Vec3Double {
    double x, y, z;
} Vec3Double;

static Vec3Double difference(MesoVec3 a, MesoVec3 b)
{
    return (Vec3Double){(double)a.x - b.x, (double)a.y - b.y, (double)a.z - b.z};
}

static double length(Vec3Double a)
{
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

/* Makes `out` unit length; false where `a` has no direction. Double, so that no float under- or overflows. */
static bool unit(Vec3Double a, MesoVec3 *out)
{
    double size = length(a);
    if (!(size > 0))
        return false;
    *out = (MesoVec3){(float)(a.x / size), (float)(a.y / size), (float)(a.z / size)};
    return true;
}

static MesoStatus check_positions(uint32_t count, const MesoVec3 *positions, MesoError *error)
{
    for (uint32_t v = 0; v < count; v++) {
        MesoVec3 p = positions[v];
        if (!meso_vec3_finite(p))
            return meso_fail(error, MESO_ERR_INPUT, "vertex %u is not finite", v + 1);
        if (fabsf(p.x) > MESO_COORDINATE_LIMIT || fabsf(p.y) > MESO_COORDINATE_LIMIT ||
            fabsf(p.z) > MESO_COORDINATE_LIMIT)
            return meso_fail(error, MESO_ERR_INPUT, "vertex %u lies beyond the largest coordinate, %g",
                             v + 1, (double)MESO_COORDINATE_LIMIT);
    }
    return MESO_OK;
}

static MesoStatus check_normals(uint32_t count, const MesoVec3 *normals, MesoError *error)
{
    for (uint32_t n = 0; n < count; n++)
        if (!meso_vec3_finite(normals[n]))
            return meso_fail(error, MESO_ERR_INPUT, "normal %u is not finite", n + 1);
    return MESO_OK;
}

static MesoStatus check_face(uint32_t face, const uint32_t *vertices, uint32_t vertex_count,
                             MesoError *error)
{
    for (uint32_t i = 0; i < 4; i++)
        if (vertices[i] >= vertex_count)
            return meso_fail(error, MESO_ERR_INPUT, "face %u uses vertex %llu of %u", face + 1,
                             (unsigned long long)vertices[i] + 1, vertex_count);
    for (uint32_t i = 0; i < 3; i++)
        for (uint32_t j = i + 1; j < 4; j++)
            if (vertices[i] == vertices[j])
                return meso_fail(error, MESO_ERR_INPUT, "face %u uses vertex %u twice", face + 1,
                                 vertices[i] + 1);
    return MESO_OK;
}

static MesoStatus check_faces(uint32_t face_count, const uint32_t *face_vertices,
                              uint32_t vertex_count, const uint32_t *face_normals,
                              uint32_t normal_count, MesoError *error)
{
    if (face_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "mesh has no faces");
    if (face_count > (MESO_NO_INDEX - 2) / 4)
        return meso_fail(error, MESO_ERR_INPUT, "mesh has more than %u faces", (MESO_NO_INDEX - 2) / 4);
    for (uint32_t f = 0; f < face_count; f++) {
        MesoStatus status = check_face(f, face_vertices + 4 * (size_t)f, vertex_count, error);
        if (status)
            return status;
        for (size_t h = 4 * (size_t)f; face_normals && h < 4 * (size_t)f + 4; h++)
            if (face_normals[h] >= normal_count && face_normals[h] != MESO_NO_INDEX)
                return meso_fail(error, MESO_ERR_INPUT, "face %u uses normal %llu of %u", f + 1,
                                 (unsigned long long)face_normals[h] + 1, normal_count);
    }
    return MESO_OK;
}

/*
 * Copies the given normals at unit length and points the corners at them; a
 * corner without a usable one gets MESO_NO_INDEX, and its vertex a mark in
 * `lacking`. Returns the number of marked vertices.
 */
static uint32_t take_normals(MesoQuadMesh *mesh, uint32_t normal_count, const MesoVec3 *normals,
                             const uint32_t *face_normals, uint32_t *lacking)
{
    uint32_t lacking_count = 0;
    for (size_t h = 0; h < 4 * (size_t)mesh->face_count; h++) {
        uint32_t n = face_normals ? face_normals[h] : MESO_NO_INDEX;
        MesoVec3 ignored;
        bool usable = n < normal_count && unit(difference(normals[n], (MesoVec3){0}), &ignored);
        uint32_t v = mesh->face_vertices[h];
        mesh->face_normals[h] = usable ? n : MESO_NO_INDEX;
        if (!usable && !lacking[v]) {
            lacking[v] = 1;
            lacking_count++;
        }
    }
    return lacking_count;
}

/* Adds the cross product of each face's diagonals, twice its area, to its corners. */
static void sum_face_normals(const MesoQuadMesh *mesh, Vec3Double *sums)
{
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *v = mesh->face_vertices + 4 * (size_t)f;
        Vec3Double a = difference(mesh->positions[v[2]], mesh->positions[v[0]]);
        Vec3Double b = difference(mesh->positions[v[3]], mesh->positions[v[1]]);
        Vec3Double n = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
        for (uint32_t i = 0; i < 4; i++) {
            sums[v[i]].x += n.x;
            sums[v[i]].y += n.y;
            sums[v[i]].z += n.z;
        }
    }
}

/* Appends the normal of each vertex marked in `lacking` behind the first `begin` normals. */
static void append_vertex_normals(MesoQuadMesh *mesh, uint32_t begin, uint32_t *lacking,
                                  const Vec3Double *sums)
{
    uint32_t next = begin;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (!lacking[v])
            continue;
        mesh->normals[next] = (MesoVec3){0, 0, 1};
        mesh->lost_normals += !unit(sums[v], &mesh->normals[next]);
        lacking[v] = next++;
    }
    for (size_t h = 0; h < 4 * (size_t)mesh->face_count; h++)
        if (mesh->face_normals[h] == MESO_NO_INDEX)
            mesh->face_normals[h] = lacking[mesh->face_vertices[h]];
}

static MesoStatus build_normals(MesoQuadMesh *mesh, MesoArena *arena, uint32_t normal_count,
                                const MesoVec3 *normals, const uint32_t *face_normals,
                                MesoError *error)
{
    uint32_t *lacking = MESO_NEW(arena, uint32_t, mesh->vertex_count, error);
    if (!lacking)
        return MESO_ERR_MEMORY;
    uint32_t lacking_count = take_normals(mesh, normal_count, normals, face_normals, lacking);
    if (lacking_count > MESO_NO_INDEX - 1 - normal_count)
        return meso_fail(error, MESO_ERR_INPUT, "mesh has more than %u normals", MESO_NO_INDEX - 1);

    mesh->normal_count = normal_count + lacking_count;
    mesh->given_normals = normal_count;
    for (uint32_t n = 0; n < normal_count; n++) {
        mesh->normals[n] = (MesoVec3){0, 0, 1};
        unit(difference(normals[n], (MesoVec3){0}), &mesh->normals[n]);
    }
    if (lacking_count == 0)
        return MESO_OK;
    Vec3Double *sums = MESO_NEW(arena, Vec3Double, mesh->vertex_count, error);
    if (!sums)
        return MESO_ERR_MEMORY;
    sum_face_normals(mesh, sums);
    append_vertex_normals(mesh, normal_count, lacking, sums);
    return MESO_OK;
}

static MesoStatus measure_edges(MesoQuadMesh *mesh, MesoError *error)
{
    double sum = 0;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *v = mesh->face_vertices + 4 * (size_t)f;
        for (uint32_t i = 0; i < 4; i++)
            sum += length(difference(mesh->positions[v[(i + 1) & 3]], mesh->positions[v[i]]));
    }
    mesh->mean_edge_length = (float)(sum / (4.0 * mesh->face_count));
    if (!(mesh->mean_edge_length > 0))
        return meso_fail(error, MESO_ERR_INPUT, "mesh has no extent: all edges have length 0");
    if (mesh->mean_edge_length < MESO_SHORTEST_EDGE)
        return meso_fail(error, MESO_ERR_INPUT, "mesh is too small: its mean edge length is %g, at least %g is needed",
                         (double)mesh->mean_edge_length, (double)MESO_SHORTEST_EDGE);
    return MESO_OK;
}

MesoStatus meso_quad_mesh_build(MesoQuadMesh *mesh, MesoArena *arena,
                                uint32_t vertex_count, const MesoVec3 *positions,
                                uint32_t normal_count, const MesoVec3 *normals,
                                uint32_t face_count, const uint32_t *face_vertices,
                                const uint32_t *face_normals, MesoError *error)
{
    *mesh = (MesoQuadMesh){.vertex_count = vertex_count, .face_count = face_count};
    MesoStatus status = check_positions(vertex_count, positions, error);
    if (!status)
        status = check_normals(normal_count, normals, error);
    if (!status)
        status = check_faces(face_count, face_vertices, vertex_count, face_normals, normal_count, error);
    if (status)
        return status;

    size_t corner_count = 4 * (size_t)face_count;
    mesh->positions = MESO_NEW(arena, MesoVec3, vertex_count, error);
    mesh->face_vertices = MESO_NEW(arena, uint32_t, corner_count, error);
    mesh->face_normals = MESO_NEW(arena, uint32_t, corner_count, error);
    mesh->normals = MESO_NEW(arena, MesoVec3, (size_t)normal_count + vertex_count, error);
    if (!mesh->positions || !mesh->face_vertices || !mesh->face_normals || !mesh->normals)
        return MESO_ERR_MEMORY;
    memcpy(mesh->positions, positions, vertex_count * sizeof *positions);
    memcpy(mesh->face_vertices, face_vertices, corner_count * sizeof *face_vertices);

    status = measure_edges(mesh, error);
    if (status)
        return status;
    MesoArenaMark mark = meso_arena_mark(arena);
    status = build_normals(mesh, arena, normal_count, normals, face_normals, error);
    meso_arena_rewind(arena, mark);
    return status;
}
