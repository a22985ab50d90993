#include "libcore/mesh/triangle_mesh.h"

#include <math.h>
#include <string.h>

typedef struct Sum {
    double x, y, z;
} Sum;

/* Working arrays of one triangulation. */
typedef struct Split {
    const MesoPolygonMesh *mesh;
    const MesoAttribute *normals;   /* of corners or vertices, or NULL */
    MesoArena *scratch;
    uint32_t count;
    uint32_t *of_corner;    /* [corner_count] vertex after the split */
    uint32_t *source;       /* [corner_count] vertex of the file, of each vertex after the split */
    uint32_t *normal;       /* [corner_count] its normal, or MESO_NO_INDEX */
} Split;

static bool unit(double x, double y, double z, MesoVec3 *out)
{
    double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0))
        return false;
    *out = (MesoVec3){(float)(x / length), (float)(y / length), (float)(z / length)};
    return true;
}

static uint32_t usable_normal(const Split *split, uint32_t corner)
{
    const MesoAttribute *normals = split->normals;
    if (!normals)
        return MESO_NO_INDEX;
    uint32_t n = meso_attribute_entry(normals,
                                      normals->domain == MESO_ON_CORNERS ? corner : split->mesh->corners[corner]);
    if (n == MESO_NO_INDEX)
        return n;
    MesoVec3 given = meso_attribute_vec3(normals, n);
    return given.x != 0 || given.y != 0 || given.z != 0 ? n : MESO_NO_INDEX;
}

/*
 * Numbers the vertices after the split. met[n] is the last of them with normal
 * n, perhaps at another vertex; the last entry stands for "none".
 */
static void number_vertices(Split *split, const uint32_t *list, const uint32_t *next, uint32_t *met)
{
    uint32_t none = split->normals ? split->normals->entry_count : 0;
    for (uint32_t v = 0; v < split->mesh->vertex_count; v++)
        for (uint32_t c = list[v]; c != MESO_NO_INDEX; c = next[c]) {
            uint32_t normal = usable_normal(split, c);
            uint32_t *same = &met[normal == MESO_NO_INDEX ? none : normal];
            if (*same == MESO_NO_INDEX || split->source[*same] != v) {
                split->source[split->count] = v;
                split->normal[split->count] = normal;
                *same = split->count++;
            }
            split->of_corner[c] = *same;
        }
}

static MesoStatus split_vertices(Split *split, MesoError *error)
{
    const MesoPolygonMesh *mesh = split->mesh;
    MesoArena *arena = split->scratch;
    size_t normal_count = split->normals ? split->normals->entry_count : 0;
    split->of_corner = MESO_NEW(arena, uint32_t, mesh->corner_count, error);
    split->source = MESO_NEW(arena, uint32_t, mesh->corner_count, error);
    split->normal = MESO_NEW(arena, uint32_t, mesh->corner_count, error);
    uint32_t *next = MESO_NEW(arena, uint32_t, mesh->corner_count, error);
    uint32_t *list = MESO_NEW(arena, uint32_t, mesh->vertex_count, error);
    uint32_t *met = MESO_NEW(arena, uint32_t, normal_count + 1, error);
    if (!split->of_corner || !split->source || !split->normal || !next || !list || !met)
        return MESO_ERR_MEMORY;
    memset(list, 0xff, mesh->vertex_count * sizeof *list);
    memset(met, 0xff, (normal_count + 1) * sizeof *met);
    for (uint32_t c = mesh->corner_count; c-- > 0;) {
        uint32_t v = mesh->corners[c];
        next[c] = list[v];
        list[v] = c;
    }
    number_vertices(split, list, next, met);
    return MESO_OK;
}

/* Twice the area vector of a polygon: the cross products of its fan. */
static Sum area_vector(const MesoPolygonMesh *mesh, uint32_t begin, uint32_t end)
{
    Sum sum = {0, 0, 0};
    MesoVec3 o = mesh->positions[mesh->corners[begin]];
    for (uint32_t c = begin + 1; c + 1 < end; c++) {
        MesoVec3 p = mesh->positions[mesh->corners[c]];
        MesoVec3 q = mesh->positions[mesh->corners[c + 1]];
        Sum a = {(double)p.x - o.x, (double)p.y - o.y, (double)p.z - o.z};
        Sum b = {(double)q.x - o.x, (double)q.y - o.y, (double)q.z - o.z};
        sum.x += a.y * b.z - a.z * b.y;
        sum.y += a.z * b.x - a.x * b.z;
        sum.z += a.x * b.y - a.y * b.x;
    }
    return sum;
}

static Sum *sum_face_normals(const Split *split, MesoError *error)
{
    const MesoPolygonMesh *mesh = split->mesh;
    Sum *sums = MESO_NEW(split->scratch, Sum, mesh->vertex_count, error);
    for (uint32_t f = 0; sums && f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        Sum area = area_vector(mesh, begin, end);
        for (uint32_t c = begin; c < end; c++) {
            Sum *sum = &sums[mesh->corners[c]];
            sum->x += area.x;
            sum->y += area.y;
            sum->z += area.z;
        }
    }
    return sums;
}

static MesoStatus fill_vertices(MesoTriangleMesh *mesh, MesoArena *arena, const Split *split, MesoError *error)
{
    const Sum *sums = sum_face_normals(split, error);
    mesh->vertex_count = split->count;
    mesh->positions = MESO_NEW(arena, MesoVec3, split->count, error);
    mesh->normals = MESO_NEW(arena, MesoVec3, split->count, error);
    if (!sums || !mesh->positions || !mesh->normals)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < split->count; v++) {
        uint32_t source = split->source[v];
        mesh->positions[v] = split->mesh->positions[source];
        Sum n = sums[source];
        if (split->normal[v] != MESO_NO_INDEX) {
            MesoVec3 given = meso_attribute_vec3(split->normals, split->normal[v]);
            n = (Sum){(double)given.x, (double)given.y, (double)given.z};
        }
        mesh->normals[v] = (MesoVec3){0, 0, 1};
        unit(n.x, n.y, n.z, &mesh->normals[v]);
    }
    return MESO_OK;
}

static MesoStatus fill_triangles(MesoTriangleMesh *mesh, MesoArena *arena, const Split *split, MesoError *error)
{
    const MesoPolygonMesh *polygons = split->mesh;
    mesh->triangle_count = polygons->corner_count - 2 * polygons->face_count;
    mesh->triangles = MESO_NEW(arena, uint32_t, (size_t)mesh->triangle_count * 3, error);
    if (!mesh->triangles)
        return MESO_ERR_MEMORY;
    uint32_t *out = mesh->triangles;
    for (uint32_t f = 0; f < polygons->face_count; f++) {
        uint32_t begin = meso_polygon_begin(polygons, f), end = begin + meso_polygon_sides(polygons, f);
        for (uint32_t c = begin + 1; c + 1 < end; c++) {
            *out++ = split->of_corner[begin];
            *out++ = split->of_corner[c];
            *out++ = split->of_corner[c + 1];
        }
    }
    return MESO_OK;
}

MesoStatus meso_polygon_triangulate(MesoTriangleMesh *mesh, MesoArena *arena, const MesoPolygonMesh *polygons,
                                    MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    *mesh = (MesoTriangleMesh){0};
    Split split = {.mesh = polygons, .normals = meso_polygon_normals(polygons), .scratch = &scratch};
    MesoStatus status = split_vertices(&split, error);
    if (!status)
        status = fill_vertices(mesh, arena, &split, error);
    if (!status)
        status = fill_triangles(mesh, arena, &split, error);
    meso_arena_release(&scratch);
    return status;
}
