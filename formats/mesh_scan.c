#include "formats/mesh_scan.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { FIRST_ROOM = 256 };

/*
 * Makes `*array` twice as large. What it outgrows stays in the arena: together
 * less than the array itself.
 */
static MesoStatus enlarge(MesoArena *arena, void **array, uint32_t used, uint32_t room, size_t size,
                          MesoError *error)
{
    void *larger = meso_arena_alloc(arena, room, size, error);
    if (!larger)
        return MESO_ERR_MEMORY;
    if (used)
        memcpy(larger, *array, used * size);
    *array = larger;
    return MESO_OK;
}

static MesoStatus next_room(uint32_t room, uint32_t *wanted, MesoError *error)
{
    if (room == UINT32_MAX - 1)
        return meso_fail(error, MESO_ERR_LIMIT, "mesh has more than %u elements of a kind", room);
    *wanted = room > (UINT32_MAX - 1) / 2 ? UINT32_MAX - 1 : room ? 2 * room : FIRST_ROOM;
    return MESO_OK;
}

/* Room for one more of `size` bytes. */
static MesoStatus reserve(MesoArena *arena, void **array, uint32_t count, uint32_t *room, size_t size,
                          MesoError *error)
{
    uint32_t wanted = 0;
    if (count < *room)
        return MESO_OK;
    MesoStatus status = next_room(*room, &wanted, error);
    if (!status)
        status = enlarge(arena, array, count, wanted, size, error);
    if (!status)
        *room = wanted;
    return status;
}

static MesoStatus append_point(MesoArena *arena, MesoVec3 **points, uint32_t *count, uint32_t *room,
                               MesoVec3 point, MesoError *error)
{
    void *array = *points;
    MesoStatus status = reserve(arena, &array, *count, room, sizeof point, error);
    if (status)
        return status;
    *points = array;
    (*points)[(*count)++] = point;
    return MESO_OK;
}

MesoStatus meso_mesh_scan_vertex(MesoMeshScan *scan, MesoVec3 position, MesoError *error)
{
    return append_point(scan->arena, &scan->positions, &scan->vertex_count, &scan->vertex_room,
                        position, error);
}

MesoStatus meso_mesh_scan_normal(MesoMeshScan *scan, MesoVec3 normal, MesoError *error)
{
    return append_point(scan->arena, &scan->normals, &scan->normal_count, &scan->normal_room, normal,
                        error);
}

/* Room for one more in two arrays of indices that grow together. */
static MesoStatus reserve_pair(MesoArena *arena, uint32_t **a, uint32_t **b, uint32_t count,
                               uint32_t *room, MesoError *error)
{
    if (count < *room)
        return MESO_OK;
    void *first = *a, *second = *b;
    uint32_t wanted = 0;
    MesoStatus status = next_room(*room, &wanted, error);
    if (!status)
        status = enlarge(arena, &first, count, wanted, sizeof **a, error);
    if (!status)
        status = enlarge(arena, &second, count, wanted, sizeof **b, error);
    if (status)
        return status;
    *a = first;
    *b = second;
    *room = wanted;
    return MESO_OK;
}

MesoStatus meso_mesh_scan_corner(MesoMeshScan *scan, uint32_t vertex, uint32_t normal, MesoError *error)
{
    MesoStatus status = reserve_pair(scan->arena, &scan->corner_vertices, &scan->corner_normals,
                                     scan->corner_count, &scan->corner_room, error);
    if (status)
        return status;
    scan->corner_vertices[scan->corner_count] = vertex;
    scan->corner_normals[scan->corner_count++] = normal;
    return MESO_OK;
}

MesoStatus meso_mesh_scan_face(MesoMeshScan *scan, uint32_t line, MesoError *error)
{
    MesoStatus status = reserve_pair(scan->arena, &scan->face_ends, &scan->face_lines,
                                     scan->face_count, &scan->face_room, error);
    if (status)
        return status;
    scan->face_ends[scan->face_count] = scan->corner_count;
    scan->face_lines[scan->face_count++] = line;
    return MESO_OK;
}

MesoStatus meso_mesh_scan_fail(const MesoMeshScan *scan, const char *path, uint32_t face,
                               MesoError *error, const char *format, ...)
{
    char message[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    uint32_t line = scan->face_lines[face];
    if (line)
        return meso_fail(error, MESO_ERR_INPUT, "%s:%u: face %u %s", path, line, face + 1, message);
    return meso_fail(error, MESO_ERR_INPUT, "%s: face %u %s", path, face + 1, message);
}

/*
 * Checks one face. seen[v] is the last face, plus 1, that used vertex v: faces
 * of any size are checked in linear time.
 */
static MesoStatus check_face(const MesoMeshScan *scan, const char *path, uint32_t face,
                             uint32_t *seen, MesoError *error)
{
    uint32_t begin = meso_mesh_scan_begin(scan, face), end = scan->face_ends[face];
    if (end - begin < 3)
        return meso_mesh_scan_fail(scan, path, face, error, "has %u sides; a face has at least 3",
                                   end - begin);
    for (uint32_t c = begin; c < end; c++) {
        uint32_t vertex = scan->corner_vertices[c], normal = scan->corner_normals[c];
        if (vertex >= scan->vertex_count)
            return meso_mesh_scan_fail(scan, path, face, error, "uses vertex %llu of %u",
                                       vertex + 1ull, scan->vertex_count);
        if (normal >= scan->normal_count && normal != MESO_NO_INDEX)
            return meso_mesh_scan_fail(scan, path, face, error, "uses normal %llu of %u",
                                       normal + 1ull, scan->normal_count);
        if (seen[vertex] == face + 1)
            return meso_mesh_scan_fail(scan, path, face, error, "uses vertex %u twice", vertex + 1);
        seen[vertex] = face + 1;
    }
    return MESO_OK;
}

MesoStatus meso_mesh_scan_check(const MesoMeshScan *scan, const char *path, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scan->arena);
    uint32_t *seen = MESO_NEW(scan->arena, uint32_t, scan->vertex_count, error);
    MesoStatus status = seen ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < scan->face_count && !status; f++)
        status = check_face(scan, path, f, seen, error);
    meso_arena_rewind(scan->arena, mark);
    return status;
}
