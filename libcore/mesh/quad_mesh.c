#include "libcore/mesh/quad_mesh.h"

#include <assert.h>
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

static MesoStatus check_normals(uint32_t count, const MesoVec3 *normals, MesoError *error)
{
    for (uint32_t n = 0; n < count; n++)
        if (!meso_vec3_finite(normals[n]))
            return meso_fail(error, MESO_ERR_INPUT, "normal %u is not finite", n + 1);
    return MESO_OK;
}

/* Normals of a mesh on their way from the file's to one for every corner. */
typedef struct Completion {
    const MesoAttribute *given;     /* or NULL */
    uint32_t *lacking;              /* [vertex_count] vertices with a corner that has no usable normal: 1, then the normal's number */
    uint32_t lacking_count;
} Completion;

static uint32_t given_count(const Completion *completion)
{
    return completion->given ? completion->given->entry_count : 0;
}

/* Number of the corner's normal, or MESO_NO_INDEX where it has none of any length. */
static uint32_t usable_normal(const Completion *completion, const MesoQuadMesh *mesh, size_t corner)
{
    const MesoAttribute *given = completion->given;
    if (!given)
        return MESO_NO_INDEX;
    bool of_corners = given->domain == MESO_ON_CORNERS;
    uint32_t n = meso_attribute_entry(given, of_corners ? (uint32_t)corner : mesh->face_vertices[corner]);
    if (n == MESO_NO_INDEX)
        return n;
    MesoVec3 normal = meso_attribute_vec3(given, n);
    return normal.x != 0 || normal.y != 0 || normal.z != 0 ? n : MESO_NO_INDEX;
}

static void mark_lacking(Completion *completion, const MesoQuadMesh *mesh)
{
    for (size_t h = 0; h < 4 * (size_t)mesh->face_count; h++) {
        uint32_t *lacking = &completion->lacking[mesh->face_vertices[h]];
        if (*lacking || usable_normal(completion, mesh, h) != MESO_NO_INDEX)
            continue;
        *lacking = 1;
        completion->lacking_count++;
    }
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

/* Appends the normal of each vertex marked in `lacking`. */
static void append_vertex_normals(const Completion *completion, MesoQuadMesh *mesh, const Vec3Double *sums)
{
    uint32_t next = given_count(completion);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (!completion->lacking[v])
            continue;
        mesh->normals[next] = (MesoVec3){0, 0, 1};
        mesh->lost_normals += !unit(sums[v], &mesh->normals[next]);
        completion->lacking[v] = next++;
    }
}

/* Where every corner has its normal, `face_normals` is what the file has. */
static MesoStatus number_corners(const Completion *completion, MesoQuadMesh *mesh, MesoArena *arena, MesoError *error)
{
    const MesoAttribute *given = completion->given;
    if (completion->lacking_count == 0 && given && given->domain == MESO_ON_CORNERS && given->entry_of)
        mesh->face_normals = given->entry_of;
    else if (completion->lacking_count == 0 && given && given->domain == MESO_ON_VERTICES && !given->entry_of)
        mesh->face_normals = mesh->face_vertices;
    if (mesh->face_normals)
        return MESO_OK;
    size_t corner_count = 4 * (size_t)mesh->face_count;
    mesh->face_normals = MESO_NEW(arena, uint32_t, corner_count, error);
    for (size_t h = 0; mesh->face_normals && h < corner_count; h++) {
        uint32_t n = usable_normal(completion, mesh, h);
        mesh->face_normals[h] = n == MESO_NO_INDEX ? completion->lacking[mesh->face_vertices[h]] : n;
    }
    return mesh->face_normals ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus fill_normals(Completion *completion, MesoQuadMesh *mesh, MesoArena *arena, MesoArena *scratch,
                               MesoError *error)
{
    uint32_t count = given_count(completion);
    mesh->given_normals = count;
    mesh->normal_count = count + completion->lacking_count;
    mesh->normals = MESO_NEW(arena, MesoVec3, mesh->normal_count, error);
    if (!mesh->normals)
        return MESO_ERR_MEMORY;
    for (uint32_t n = 0; n < count; n++) {
        mesh->normals[n] = (MesoVec3){0, 0, 1};
        unit(difference(meso_attribute_vec3(completion->given, n), (MesoVec3){0}), &mesh->normals[n]);
    }
    if (completion->lacking_count) {
        Vec3Double *sums = MESO_NEW(scratch, Vec3Double, mesh->vertex_count, error);
        if (!sums)
            return MESO_ERR_MEMORY;
        sum_face_normals(mesh, sums);
        append_vertex_normals(completion, mesh, sums);
    }
    return number_corners(completion, mesh, arena, error);
}

/* Gives `mesh` unit normals: those of `given` (may be NULL), and of vertices where corners lack one. */
static MesoStatus complete_normals(MesoQuadMesh *mesh, MesoArena *arena, const MesoAttribute *given, MesoError *error)
{
    MesoArena scratch;
    Completion completion = {.given = given};
    MesoStatus status = MESO_OK;
    meso_arena_init(&scratch);
    completion.lacking = MESO_NEW(&scratch, uint32_t, mesh->vertex_count, error);
    if (!completion.lacking)
        return MESO_ERR_MEMORY;
    mark_lacking(&completion, mesh);
    if (completion.lacking_count > MESO_NO_INDEX - 1 - given_count(&completion))
        status = meso_fail(error, MESO_ERR_INPUT, "mesh has more than %u normals", MESO_NO_INDEX - 1);
    if (!status)
        status = fill_normals(&completion, mesh, arena, &scratch, error);
    meso_arena_release(&scratch);
    return status;
}

static MesoStatus check_count(uint32_t face_count, MesoError *error)
{
    if (face_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "mesh has no faces");
    if (face_count > (MESO_NO_INDEX - 2) / 4)
        return meso_fail(error, MESO_ERR_INPUT, "mesh has more than %u faces", (MESO_NO_INDEX - 2) / 4);
    return MESO_OK;
}

static MesoStatus check_extent(const MesoQuadMesh *mesh, MesoError *error)
{
    if (!(mesh->mean_edge_length > 0))
        return meso_fail(error, MESO_ERR_INPUT, "mesh has no extent: all edges have length 0");
    if (mesh->mean_edge_length < MESO_SHORTEST_EDGE)
        return meso_fail(error, MESO_ERR_INPUT, "mesh is too small: its mean edge length is %g, at least %g is needed",
                         (double)mesh->mean_edge_length, (double)MESO_SHORTEST_EDGE);
    return MESO_OK;
}

MesoStatus meso_quad_mesh_view(MesoQuadMesh *mesh, MesoArena *arena, const MesoSurface *surface, MesoError *error)
{
    const MesoPolygonMesh *polygons = &surface->mesh;
    assert(polygons->side_count == 4);
    *mesh = (MesoQuadMesh){
        .vertex_count = polygons->vertex_count, .positions = polygons->positions,
        .face_count = polygons->face_count, .face_vertices = polygons->corners,
        .mean_edge_length = surface->mean_edge_length};
    MesoStatus status = check_count(mesh->face_count, error);
    if (!status)
        status = check_extent(mesh, error);
    return status ? status : complete_normals(mesh, arena, meso_polygon_normals(polygons), error);
}

/* ---- from arrays ---- */

static void *copy(MesoArena *arena, const void *from, size_t count, size_t size, MesoError *error)
{
    void *to = meso_arena_alloc(arena, count, size, error);
    if (to && from && count)
        memcpy(to, from, count * size);
    return to;
}

MesoStatus meso_quad_mesh_build(MesoQuadMesh *mesh, MesoArena *arena,
                                uint32_t vertex_count, const MesoVec3 *positions,
                                uint32_t normal_count, const MesoVec3 *normals,
                                uint32_t face_count, const uint32_t *face_vertices,
                                const uint32_t *face_normals, MesoError *error)
{
    *mesh = (MesoQuadMesh){.vertex_count = vertex_count, .face_count = face_count};
    MesoStatus status = check_count(face_count, error);
    if (!status)
        status = check_normals(normal_count, normals, error);
    if (status)
        return status;
    MesoAttribute given = {
        .name = "normal", .domain = MESO_ON_CORNERS, .width = 3, .entry_count = normal_count,
        .values = (void *)normals, .entry_of = (uint32_t *)face_normals};
    MesoPolygonMesh polygons = {
        .vertex_count = vertex_count, .face_count = face_count, .corner_count = 4 * face_count, .side_count = 4,
        .positions = (MesoVec3 *)positions, .corners = (uint32_t *)face_vertices,
        .attribute_count = normals && face_normals, .attributes = &given};
    status = meso_polygon_mesh_check(&polygons, 1, NULL, error);
    if (status)
        return status;
    mesh->mean_edge_length = (float)meso_polygon_mean_edge(&polygons, 1);
    status = check_extent(mesh, error);
    if (status)
        return status;

    mesh->positions = copy(arena, positions, vertex_count, sizeof *positions, error);
    mesh->face_vertices = copy(arena, face_vertices, polygons.corner_count, sizeof *face_vertices, error);
    given.entry_of = copy(arena, face_normals, face_normals ? polygons.corner_count : 0, sizeof *face_normals, error);
    if (!mesh->positions || !mesh->face_vertices || !given.entry_of)
        return MESO_ERR_MEMORY;
    return complete_normals(mesh, arena, polygons.attribute_count ? &given : NULL, error);
}
