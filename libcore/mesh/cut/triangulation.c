#include "libcore/mesh/cut/triangulation.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/mesh/cut/locality.h"

/* ---- room ---- */

/* Half-edges are numbers of 32 bits, and MESO_NO_INDEX is none of them. */
enum { TRIANGLE_LIMIT = (UINT32_MAX - 1) / 3 };

static bool enlarge(void **array, size_t room, size_t size)
{
    if (size == 0)
        return true;
    void *larger = realloc(*array, room * size);
    if (larger)
        *array = larger;
    return larger != NULL;
}

static MesoStatus out_of_memory(uint64_t count, const char *what, MesoError *error)
{
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %llu %s", (unsigned long long)count, what);
}

static MesoStatus reserve_vertices(MesoTriangulation *mesh, uint64_t count, MesoError *error)
{
    if (count > UINT32_MAX - 1)
        return meso_fail(error, MESO_ERR_LIMIT, "a mesh of %llu vertices is beyond what can be cut",
                         (unsigned long long)count);
    if (count <= mesh->vertex_room)
        return MESO_OK;
    uint64_t room = mesh->vertex_room + mesh->vertex_room / 2;
    room = room < count ? count : room > UINT32_MAX - 1 ? UINT32_MAX - 1 : room;
    if (!enlarge((void **)&mesh->positions, room, sizeof *mesh->positions) ||
        !enlarge((void **)&mesh->vertex_corner, room, sizeof *mesh->vertex_corner) ||
        !enlarge((void **)&mesh->origins, room, sizeof *mesh->origins) ||
        !enlarge((void **)&mesh->vertex_values, room, mesh->vertex_width * sizeof *mesh->vertex_values))
        return out_of_memory(count, "vertices", error);
    memset(mesh->origins + mesh->vertex_room, 0xff, (room - mesh->vertex_room) * sizeof *mesh->origins);
    mesh->vertex_room = (uint32_t)room;
    return MESO_OK;
}

static MesoStatus reserve_triangles(MesoTriangulation *mesh, uint64_t count, MesoError *error)
{
    if (count > TRIANGLE_LIMIT)
        return meso_fail(error, MESO_ERR_LIMIT, "a mesh of %llu triangles is beyond what can be cut",
                         (unsigned long long)count);
    if (count <= mesh->triangle_room)
        return MESO_OK;
    uint64_t room = mesh->triangle_room + mesh->triangle_room / 2;
    room = room < count ? count : room > TRIANGLE_LIMIT ? TRIANGLE_LIMIT : room;
    if (!enlarge((void **)&mesh->corners, room, 3 * sizeof *mesh->corners) ||
        !enlarge((void **)&mesh->twins, room, 3 * sizeof *mesh->twins) ||
        !enlarge((void **)&mesh->labels, room, sizeof *mesh->labels) ||
        !enlarge((void **)&mesh->faces, room, sizeof *mesh->faces) ||
        !enlarge((void **)&mesh->walls, room, sizeof *mesh->walls) ||
        !enlarge((void **)&mesh->corner_values, room, 3 * mesh->corner_width * sizeof *mesh->corner_values))
        return out_of_memory(count, "triangles", error);
    mesh->triangle_room = (uint32_t)room;
    return MESO_OK;
}

MesoStatus meso_triangulation_reserve(MesoTriangulation *mesh, uint64_t vertex_count, uint64_t triangle_count,
                                      MesoError *error)
{
    MesoStatus status = reserve_vertices(mesh, vertex_count, error);
    return status ? status : reserve_triangles(mesh, triangle_count, error);
}

void meso_triangulation_release(MesoTriangulation *mesh)
{
    free(mesh->positions);
    free(mesh->vertex_corner);
    free(mesh->origins);
    free(mesh->vertex_values);
    free(mesh->corners);
    free(mesh->twins);
    free(mesh->labels);
    free(mesh->faces);
    free(mesh->walls);
    free(mesh->corner_values);
    *mesh = (MesoTriangulation){0};
}

/* ---- fans ---- */

/* Back to the border by which the walk would have come, or once around. */
static MesoFan rewound(const MesoTriangulation *mesh, uint32_t corner)
{
    MesoFan back = {corner, true};
    do {
        if (!meso_fan_next(mesh, &back))
            return (MesoFan){back.corner, !back.turned};
    } while (back.corner != corner);
    return (MesoFan){corner, false};
}

MesoFan meso_fan_first(const MesoTriangulation *mesh, uint32_t vertex)
{
    return rewound(mesh, mesh->vertex_corner[vertex]);
}

/* Marks a fan from one place on until it closes or ends; whether it has closed. */
static bool claim_from(const MesoTriangulation *mesh, uint8_t *claimed, MesoFan fan)
{
    uint32_t first = fan.corner;
    do {
        claimed[fan.corner] = 1;
        if (!meso_fan_next(mesh, &fan))
            return false;
    } while (fan.corner != first);
    return true;
}

/* Most fans close, and are walked once. */
static void claim_fan(const MesoTriangulation *mesh, uint8_t *claimed, uint32_t corner)
{
    if (!claim_from(mesh, claimed, (MesoFan){corner, false}))
        claim_from(mesh, claimed, (MesoFan){corner, true});
}

/* Gives a fan to a vertex. A walk looks at the vertex that it goes around: each corner is left before it changes. */
static void move_fan(MesoTriangulation *mesh, uint32_t corner, uint32_t vertex)
{
    MesoFan fan = rewound(mesh, corner), end = fan;
    uint32_t count = 1;
    while (meso_fan_next(mesh, &end) && end.corner != fan.corner)
        count++;
    for (; count > 0; count--) {
        uint32_t left = fan.corner;
        if (count > 1)
            meso_fan_next(mesh, &fan);
        mesh->corners[left] = vertex;
    }
}

/* The first fan keeps the vertex of the file, each other has one of its own. */
static MesoStatus give_fans_vertices(MesoTriangulation *mesh, MesoError *error)
{
    size_t corner_count = 3 * (size_t)mesh->triangle_count;
    uint8_t *claimed = calloc(corner_count + 1, 1);
    if (!claimed)
        return out_of_memory(corner_count, "corners", error);
    MesoStatus status = MESO_OK;
    memset(mesh->vertex_corner, 0xff, mesh->vertex_count * sizeof *mesh->vertex_corner);
    for (uint32_t c = 0; c < corner_count && !status; c++) {
        if (claimed[c])
            continue;
        uint32_t vertex = mesh->corners[c];
        if (mesh->vertex_corner[vertex] != MESO_NO_INDEX) {
            status = meso_triangulation_reserve(mesh, (uint64_t)mesh->vertex_count + 1, mesh->triangle_count, error);
            if (status)
                break;
            mesh->positions[mesh->vertex_count] = mesh->positions[vertex];
            mesh->origins[mesh->vertex_count] = mesh->origins[vertex];
            vertex = mesh->vertex_count++;
            move_fan(mesh, c, vertex);
        }
        mesh->vertex_corner[vertex] = c;
        claim_fan(mesh, claimed, c);
    }
    free(claimed);
    return status;
}

/* Corners of the fan that has a corner, by one walk where it closes. */
static uint32_t fan_corners(const MesoTriangulation *mesh, uint32_t corner)
{
    MesoFan fan = {corner, false};
    uint32_t count = 1;
    while (meso_fan_next(mesh, &fan)) {
        if (fan.corner == corner)
            return count;
        count++;
    }
    for (fan = (MesoFan){corner, true}; meso_fan_next(mesh, &fan);)
        count++;
    return count;
}

/* One fan a vertex. Nearly always that is so from the first: then the fans of the vertices' corners have all corners. */
static MesoStatus separate_fans(MesoTriangulation *mesh, MesoError *error)
{
    uint64_t in_fans = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (mesh->vertex_corner[v] != MESO_NO_INDEX)
            in_fans += fan_corners(mesh, mesh->vertex_corner[v]);
    return in_fans == 3 * (uint64_t)mesh->triangle_count ? MESO_OK : give_fans_vertices(mesh, error);
}

/* ---- building ---- */

/* Places of the surface's elements in the triangulation. */
typedef struct Places {
    uint32_t *of_vertex, *of_triangle;
} Places;

/* Orders vertices and triangles into `origins` and `faces`, and says where each has gone. */
static MesoStatus find_places(MesoTriangulation *mesh, const MesoPolygonMesh *from, Places *places, MesoError *error)
{
    places->of_vertex = malloc(((size_t)from->vertex_count + 1) * sizeof(uint32_t));
    places->of_triangle = malloc(((size_t)from->face_count + 1) * sizeof(uint32_t));
    if (!places->of_vertex || !places->of_triangle)
        return out_of_memory(from->vertex_count, "vertices", error);
    if (from->vertex_count >= MESO_LOCALITY_LEAST) {
        const MesoLocality order = {mesh->origins, places->of_vertex, mesh->faces, places->of_triangle};
        return meso_locality_order(from->positions, from->vertex_count, from->corners, from->face_count, &order, error);
    }
    for (uint32_t v = 0; v < from->vertex_count; v++)
        mesh->origins[v] = places->of_vertex[v] = v;
    for (uint32_t t = 0; t < from->face_count; t++)
        mesh->faces[t] = places->of_triangle[t] = t;
    return MESO_OK;
}

static void copy_triangle(MesoTriangulation *mesh, const MesoSurface *surface, const Places *places, uint32_t t)
{
    size_t from = 3 * (size_t)mesh->faces[t], to = 3 * (size_t)t;
    mesh->labels[t] = 0;
    mesh->walls[t] = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t twin = surface->edges.twin[from + k];
        uint32_t vertex = places->of_vertex[surface->mesh.corners[from + k]];
        mesh->corners[to + k] = vertex;
        if (mesh->vertex_corner[vertex] > (uint32_t)to + k)     /* MESO_NO_INDEX is above all */
            mesh->vertex_corner[vertex] = (uint32_t)to + k;
        mesh->twins[to + k] = twin == MESO_NO_INDEX ? twin : 3 * places->of_triangle[twin / 3] + twin % 3;
        if (twin == MESO_NO_INDEX)
            mesh->walls[t] |= (uint8_t)(1u << k);
    }
}

static MesoStatus copy_surface(MesoTriangulation *mesh, const MesoSurface *surface, MesoError *error)
{
    const MesoPolygonMesh *from = &surface->mesh;
    Places places = {0};
    mesh->vertex_count = from->vertex_count;
    mesh->triangle_count = from->face_count;
    MesoStatus status = find_places(mesh, from, &places, error);
    if (!status) {
        for (uint32_t v = 0; v < from->vertex_count; v++)
            mesh->positions[v] = from->positions[mesh->origins[v]];
        memset(mesh->vertex_corner, 0xff, from->vertex_count * sizeof *mesh->vertex_corner);
        for (uint32_t t = 0; t < from->face_count; t++)
            copy_triangle(mesh, surface, &places, t);
    }
    free(places.of_vertex);
    free(places.of_triangle);
    return status;
}

MesoStatus meso_triangulation_init(MesoTriangulation *mesh, const MesoSurface *surface, uint32_t vertex_width,
                                   uint32_t corner_width, MesoError *error)
{
    *mesh = (MesoTriangulation){.vertex_width = vertex_width, .corner_width = corner_width};
    MesoStatus status = meso_surface_require(surface, MESO_NEEDS_TRIANGLES | MESO_NEEDS_MANIFOLD, NULL, error);
    if (!status)
        status = meso_triangulation_reserve(mesh, (uint64_t)surface->mesh.vertex_count + 1,
                                            (uint64_t)surface->mesh.face_count + 1, error);
    if (!status)
        status = copy_surface(mesh, surface, error);
    if (!status)
        status = separate_fans(mesh, error);
    if (status) {
        meso_triangulation_release(mesh);
        return status;
    }
    if (vertex_width)
        memset(mesh->vertex_values, 0, (size_t)vertex_width * mesh->vertex_count * sizeof *mesh->vertex_values);
    if (corner_width)
        memset(mesh->corner_values, 0, 3 * (size_t)corner_width * mesh->triangle_count * sizeof *mesh->corner_values);
    return MESO_OK;
}

/* ---- the check ---- */

static bool joins_same_vertices(const MesoTriangulation *mesh, uint32_t a, uint32_t b)
{
    uint32_t a0 = mesh->corners[a], a1 = mesh->corners[meso_next_corner(a)];
    uint32_t b0 = mesh->corners[b], b1 = mesh->corners[meso_next_corner(b)];
    return (a0 == b0 && a1 == b1) || (a0 == b1 && a1 == b0);
}

static MesoStatus check_half_edge(const MesoTriangulation *mesh, uint32_t h, MesoError *error)
{
    uint32_t corner_count = 3 * mesh->triangle_count, twin = mesh->twins[h];
    uint32_t vertex = mesh->corners[h];
    if (vertex >= mesh->vertex_count || vertex == mesh->corners[meso_next_corner(h)])
        return meso_fail(error, MESO_ERR_INTERNAL, "corner %u: vertex %u does not exist or comes twice", h, vertex);
    if (twin == MESO_NO_INDEX)
        return meso_side_is_wall(mesh, h)
                   ? MESO_OK : meso_fail(error, MESO_ERR_INTERNAL, "half-edge %u: a border that is no wall", h);
    if (twin >= corner_count || twin == h || mesh->twins[twin] != h || !joins_same_vertices(mesh, h, twin))
        return meso_fail(error, MESO_ERR_INTERNAL, "half-edge %u: its twin %u is none", h, twin);
    if (meso_side_is_wall(mesh, h) != meso_side_is_wall(mesh, twin))
        return meso_fail(error, MESO_ERR_INTERNAL, "half-edge %u: a wall on one side", h);
    if (mesh->labels[h / 3] != mesh->labels[twin / 3] && !meso_side_is_wall(mesh, h))
        return meso_fail(error, MESO_ERR_INTERNAL, "half-edge %u: regions %u and %u without a wall between", h,
                         mesh->labels[h / 3], mesh->labels[twin / 3]);
    return MESO_OK;
}

static uint32_t fan_size(const MesoTriangulation *mesh, uint32_t vertex)
{
    MesoFan fan = meso_fan_first(mesh, vertex);
    uint32_t first = fan.corner, size = 1;
    while (meso_fan_next(mesh, &fan) && fan.corner != first)
        size++;
    return size;
}

MesoStatus meso_triangulation_check(const MesoTriangulation *mesh, MesoError *error)
{
    uint32_t corner_count = 3 * mesh->triangle_count;
    MesoStatus status = MESO_OK;
    for (uint32_t h = 0; h < corner_count && !status; h++)
        status = check_half_edge(mesh, h, error);
    if (status)
        return status;
    uint64_t in_fans = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t corner = mesh->vertex_corner[v];
        if (corner == MESO_NO_INDEX)
            continue;
        if (corner >= corner_count || mesh->corners[corner] != v)
            return meso_fail(error, MESO_ERR_INTERNAL, "vertex %u: corner %u is not at it", v, corner);
        in_fans += fan_size(mesh, v);
    }
    return in_fans == corner_count
               ? MESO_OK : meso_fail(error, MESO_ERR_INTERNAL, "vertices with several fans: %llu corners of %u are met",
                                     (unsigned long long)in_fans, corner_count);
}
