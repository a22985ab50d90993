#include "libcore/mesh/edit/mesh_weld.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/mesh/edit/face_loops.h"

/* ---- places ---- */

typedef struct Key {
    double x, y, z;
} Key;

/* Lists of vertices by what their keys hash to. */
typedef struct Table {
    uint32_t mask;
    uint32_t *head;             /* [mask + 1] newest vertex, or MESO_NO_INDEX */
    uint32_t *next;             /* [vertex_count] */
} Table;

static MesoStatus init_table(Table *table, MesoArena *scratch, uint32_t count, MesoError *error)
{
    table->mask = 63;
    while (table->mask < count && table->mask < UINT32_MAX / 2)
        table->mask = 2 * table->mask + 1;
    table->head = MESO_NEW(scratch, uint32_t, (size_t)table->mask + 1, error);
    table->next = MESO_NEW(scratch, uint32_t, count, error);
    if (!table->head || !table->next)
        return MESO_ERR_MEMORY;
    memset(table->head, 0xff, ((size_t)table->mask + 1) * sizeof *table->head);
    return MESO_OK;
}

/* The finalizer of MurmurHash3 over each coordinate; adding 0 makes one zero of both. */
static uint64_t mix(uint64_t hash, double x)
{
    uint64_t bits;
    x += 0.0;
    memcpy(&bits, &x, sizeof bits);
    hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
    hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53u;
    return hash ^ (hash >> 33);
}

static uint32_t *list_of(const Table *table, Key key)
{
    return &table->head[mix(mix(mix(1, key.x), key.y), key.z) & table->mask];
}

static void add_to_list(const Table *table, uint32_t *head, uint32_t v)
{
    table->next[v] = *head;
    *head = v;
}

static Key key_of(MesoVec3 p)
{
    return (Key){(double)p.x, (double)p.y, (double)p.z};
}

/* ---- equal positions ---- */

static bool same_place(MesoVec3 a, MesoVec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static void join_equal(uint32_t *first, const Table *table, const MesoPolygonMesh *mesh)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 p = mesh->positions[v];
        uint32_t *head = list_of(table, key_of(p)), u = *head;
        while (u != MESO_NO_INDEX && !same_place(mesh->positions[u], p))
            u = table->next[u];
        if (u == MESO_NO_INDEX)
            add_to_list(table, head, v);
        first[v] = u == MESO_NO_INDEX ? v : u;
    }
}

/* ---- near positions ---- */

static bool within(MesoVec3 a, MesoVec3 b, double distance)
{
    double x = (double)a.x - b.x, y = (double)a.y - b.y, z = (double)a.z - b.z;
    return x * x + y * y + z * z <= distance * distance;
}

static void join_list(uint32_t *first, const Table *table, const MesoPolygonMesh *mesh, uint32_t head, uint32_t v,
                      double distance)
{
    for (uint32_t u = head; u != MESO_NO_INDEX; u = table->next[u])
        if (meso_sets_root(first, u) != meso_sets_root(first, v) &&
            within(mesh->positions[u], mesh->positions[v], distance))
            meso_sets_join(first, u, v);
}

/*
 * Into cells as wide as the distance, so that what is within it lies in the 27 cells around. Cells are whole numbers in
 * double precision: where these are too coarse to count cells one by one, so are the coordinates.
 */
static void join_near(uint32_t *first, const Table *table, const MesoPolygonMesh *mesh, double distance)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (first[v] != v && same_place(mesh->positions[first[v]], mesh->positions[v]))
            continue;
        Key p = key_of(mesh->positions[v]);
        Key cell = {floor(p.x / distance), floor(p.y / distance), floor(p.z / distance)};
        for (int i = 0; i < 27; i++) {
            Key near = {cell.x + i % 3 - 1, cell.y + i / 3 % 3 - 1, cell.z + i / 9 - 1};
            join_list(first, table, mesh, *list_of(table, near), v, distance);
        }
        add_to_list(table, list_of(table, cell), v);
    }
}

MesoStatus meso_mesh_weld_map(uint32_t *first, const MesoPolygonMesh *mesh, double distance, MesoError *error)
{
    assert(distance >= 0 && isfinite(distance));
    MesoArena scratch;
    Table table;
    meso_arena_init(&scratch);
    MesoStatus status = init_table(&table, &scratch, mesh->vertex_count, error);
    if (!status)
        join_equal(first, &table, mesh);
    if (!status && distance > 0) {
        memset(table.head, 0xff, ((size_t)table.mask + 1) * sizeof *table.head);
        join_near(first, &table, mesh, distance);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            first[v] = meso_sets_root(first, v);
    }
    meso_arena_release(&scratch);
    return status;
}

/* ---- attributes ---- */

static bool same_entry(const MesoAttribute *a, uint32_t i, uint32_t j)
{
    if (i == j || i == MESO_NO_INDEX || j == MESO_NO_INDEX)
        return i == j;
    if (a->width == 0)
        return strcmp(a->names[i], a->names[j]) == 0;
    size_t size = (size_t)a->width * meso_scalar_size(a->scalar);
    return memcmp((const char *)a->values + size * i, (const char *)a->values + size * j, size) == 0;
}

static bool differs(const MesoAttribute *a, const uint32_t *first, uint32_t vertex_count)
{
    for (uint32_t v = 0; v < vertex_count; v++)
        if (first[v] != v && !same_entry(a, meso_attribute_entry(a, v), meso_attribute_entry(a, first[v])))
            return true;
    return false;
}

static MesoStatus move_to_corners(MesoAttribute *a, MesoArena *arena, const MesoPolygonMesh *mesh, MesoError *error)
{
    uint32_t *entry_of = MESO_NEW(arena, uint32_t, mesh->corner_count, error);
    if (!entry_of)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < mesh->corner_count; c++)
        entry_of[c] = meso_attribute_entry(a, mesh->corners[c]);
    a->domain = MESO_ON_CORNERS;
    a->entry_of = entry_of;
    return MESO_OK;
}

/* The same mesh, with what would be lost on vertices on corners. */
static MesoStatus move_attributes(MesoPolygonMesh *moved, MesoArena *arena, const MesoPolygonMesh *from,
                                  const uint32_t *first, uint32_t *count, MesoError *error)
{
    *moved = *from;
    moved->attributes = MESO_NEW(arena, MesoAttribute, from->attribute_count, error);
    MesoStatus status = moved->attributes ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < from->attribute_count && !status; i++) {
        MesoAttribute *a = &moved->attributes[i];
        *a = from->attributes[i];
        if (a->domain != MESO_ON_VERTICES || !differs(a, first, from->vertex_count) ||
            meso_polygon_attribute_on(from, a->name, MESO_ON_CORNERS))
            continue;
        status = move_to_corners(a, arena, from, error);
        (*count)++;
    }
    return status;
}

/* ---- meshes ---- */

/* Numbers the vertices that stay; vertex_of[v] takes the place of first[v]. */
static void number_vertices(MesoMeshCopies *copies, uint32_t *first, uint32_t vertex_count)
{
    for (uint32_t v = 0; v < vertex_count; v++) {
        if (first[v] == v)
            copies->vertex_sources[copies->vertex_count++] = v;
        first[v] = first[v] == v ? copies->vertex_count - 1 : first[first[v]];
    }
}

static MesoStatus weld(MesoPolygonMesh *mesh, MesoArena *arena, MesoArena *scratch, const MesoPolygonMesh *from,
                       double distance, MesoWeldCounts *counts, MesoError *error)
{
    MesoMeshCopies copies;
    MesoFaceLoops loops;
    MesoPolygonMesh moved = {0};
    uint32_t *first = MESO_NEW(scratch, uint32_t, from->vertex_count, error);
    MesoStatus status = first ? meso_mesh_weld_map(first, from, distance, error) : MESO_ERR_MEMORY;
    if (!status)
        status = move_attributes(&moved, scratch, from, first, &counts->attributes_moved, error);
    if (!status)    /* every face is more than one only with three corners for each */
        status = meso_mesh_copies_init(&copies, scratch, (uint64_t)from->face_count + from->corner_count / 3,
                                       from->corner_count, error);
    if (!status && !(copies.vertex_sources = MESO_NEW(scratch, uint32_t, from->vertex_count, error)))
        status = MESO_ERR_MEMORY;
    if (status)
        return status;
    number_vertices(&copies, first, from->vertex_count);
    counts->vertices_gone = from->vertex_count - copies.vertex_count;
    status = meso_face_loops_init(&loops, scratch, from, copies.vertex_count, error);
    for (uint32_t f = 0; f < from->face_count && !status; f++)
        counts->faces_gone += meso_face_loops_add(&loops, &copies, first, f) == 0;
    return status ? status : meso_mesh_copies_build(mesh, arena, &moved, &copies, error);
}

MesoStatus meso_mesh_weld(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, double distance,
                          MesoWeldCounts *counts, MesoError *error)
{
    MesoArena scratch;
    MesoWeldCounts ignored;
    counts = counts ? counts : &ignored;
    *counts = (MesoWeldCounts){0};
    meso_arena_init(&scratch);
    MesoStatus status = weld(mesh, arena, &scratch, from, distance, counts, error);
    meso_arena_release(&scratch);
    return status;
}
