#include "libcore/mesh/edit/mesh_clean.h"

#include <math.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/names.h"
#include "libcore/mesh/edit/face_area.h"
#include "libcore/mesh/edit/face_loops.h"

/* ---- flat faces ---- */

bool meso_face_is_flat(const MesoPolygonMesh *mesh, uint32_t face)
{
    uint32_t begin = meso_polygon_begin(mesh, face), sides = meso_polygon_sides(mesh, face);
    const uint32_t *v = mesh->corners + begin;
    double area = 0, longest = 0;
    for (uint32_t k = 0; k < sides; k++) {
        MesoVec3 p = mesh->positions[v[k]], q = mesh->positions[v[k + 1 < sides ? k + 1 : 0]];
        double x = (double)q.x - p.x, y = (double)q.y - p.y, z = (double)q.z - p.z;
        MesoAreaVector a = meso_area_between(mesh->positions[v[0]], p, q);
        longest = fmax(longest, x * x + y * y + z * z);
        area += sqrt(meso_area_dot(a, a));
    }
    return area <= MESO_FLAT_FACE * longest;
}

/* ---- double faces ---- */

/* The vertices of a face from the least one on, in the direction of its smaller neighbour. */
static void write_key(uint32_t *key, const uint32_t *v, uint32_t sides)
{
    uint32_t least = 0;
    for (uint32_t k = 1; k < sides; k++)
        least = v[k] < v[least] ? k : least;
    uint32_t before = v[(least + sides - 1) % sides], after = v[(least + 1) % sides];
    for (uint32_t k = 0; k < sides; k++)
        key[k] = v[(least + (after < before ? k : sides - k)) % sides];
}

MesoStatus meso_mesh_find_doubles(uint32_t *doubles, const MesoPolygonMesh *mesh, MesoError *error)
{
    MesoArena scratch;
    MesoNames names = {0};
    meso_arena_init(&scratch);
    uint32_t *keys = MESO_NEW(&scratch, uint32_t, mesh->corner_count, error);
    MesoStatus status = keys ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < mesh->face_count && !status; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        write_key(keys + begin, mesh->corners + begin, sides);
        doubles[f] = meso_names_add(&names, &scratch, (const char *)(keys + begin), sides * sizeof *keys, f, error);
        status = doubles[f] == MESO_NO_INDEX ? MESO_ERR_MEMORY : MESO_OK;
    }
    meso_arena_release(&scratch);
    return status;
}

/* ---- cleaning ---- */

/* vertex_of[v] becomes the new number of v, or MESO_NO_INDEX. */
static uint32_t number_used(uint32_t *vertex_of, uint32_t *sources, uint32_t vertex_count)
{
    uint32_t count = 0;
    for (uint32_t v = 0; v < vertex_count; v++) {
        bool used = vertex_of[v] != 0;
        vertex_of[v] = used ? count : MESO_NO_INDEX;
        if (used)
            sources[count++] = v;
    }
    return count;
}

/* Faces that stay, and the vertices that these use. */
static MesoStatus keep_faces(MesoMeshCopies *copies, MesoArena *scratch, const MesoPolygonMesh *from,
                             MesoCleanCounts *counts, MesoError *error)
{
    uint32_t *doubles = MESO_NEW(scratch, uint32_t, from->face_count, error);
    uint32_t *vertex_of = MESO_NEW(scratch, uint32_t, from->vertex_count, error);
    copies->vertex_sources = MESO_NEW(scratch, uint32_t, from->vertex_count, error);
    if (!doubles || !vertex_of || !copies->vertex_sources)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_mesh_find_doubles(doubles, from, error);
    for (uint32_t f = 0; f < from->face_count && !status; f++) {
        bool flat = meso_face_is_flat(from, f), is_double = !flat && doubles[f] != f;
        counts->faces_flat += flat;
        counts->faces_double += is_double;
        if (flat || is_double)
            continue;
        uint32_t begin = meso_polygon_begin(from, f), end = begin + meso_polygon_sides(from, f);
        for (uint32_t c = begin; c < end; c++) {
            vertex_of[from->corners[c]] = 1;
            meso_mesh_copies_corner(copies, c, from->corners[c]);
        }
        meso_mesh_copies_face(copies, f);
    }
    copies->vertex_count = number_used(vertex_of, copies->vertex_sources, from->vertex_count);
    counts->vertices_unused = from->vertex_count - copies->vertex_count;
    for (uint32_t c = 0; c < copies->corner_count; c++)
        copies->corners[c] = vertex_of[copies->corners[c]];
    return status;
}

MesoStatus meso_mesh_clean(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                           MesoCleanCounts *counts, MesoError *error)
{
    MesoArena scratch;
    MesoPolygonMesh loops;
    MesoMeshCopies copies;
    MesoCleanCounts ignored;
    counts = counts ? counts : &ignored;
    *counts = (MesoCleanCounts){0};
    meso_arena_init(&scratch);
    MesoStatus status = meso_mesh_cut_loops(&loops, &scratch, from, &counts->faces_looped, error);
    if (!status)
        status = meso_mesh_copies_init(&copies, &scratch, loops.face_count, loops.corner_count, error);
    if (!status)
        status = keep_faces(&copies, &scratch, &loops, counts, error);
    if (!status)
        status = meso_mesh_copies_build(mesh, arena, &loops, &copies, error);
    meso_arena_release(&scratch);
    return status;
}

/* ---- separating ---- */

/* Joins the corners at both ends of an inner edge. */
static void join_fans(uint32_t *fans, const MesoPolygonMesh *mesh, uint32_t h, uint32_t next, uint32_t twin,
                      uint32_t twin_next)
{
    bool alike = mesh->corners[h] == mesh->corners[twin];
    meso_sets_join(fans, h, alike ? twin : twin_next);
    meso_sets_join(fans, next, alike ? twin_next : twin);
}

static uint32_t *next_corners(MesoArena *scratch, const MesoPolygonMesh *mesh, MesoError *error)
{
    uint32_t *next = MESO_NEW(scratch, uint32_t, mesh->corner_count, error);
    for (uint32_t f = 0; f < mesh->face_count && next; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        for (uint32_t c = begin; c < end; c++)
            next[c] = c + 1 < end ? c + 1 : begin;
    }
    return next;
}

MesoStatus meso_mesh_find_fans(uint32_t *fans, const MesoPolygonMesh *mesh, const MesoHalfEdges *edges,
                               MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    const uint32_t *next = next_corners(&scratch, mesh, error);
    meso_sets_init(fans, mesh->corner_count);
    for (uint32_t h = 0; h < mesh->corner_count && next; h++) {
        uint32_t twin = edges->twin[h];
        if (twin != MESO_NO_INDEX && h < twin)
            join_fans(fans, mesh, h, next[h], twin, next[twin]);
    }
    for (uint32_t c = 0; c < mesh->corner_count; c++)
        fans[c] = meso_sets_root(fans, c);
    meso_arena_release(&scratch);
    return next ? MESO_OK : MESO_ERR_MEMORY;
}

/* A fan's first corner comes before its others: `of_fan` knows their vertex by then. */
static MesoStatus give_vertices(MesoMeshCopies *copies, MesoArena *scratch, const MesoPolygonMesh *mesh,
                                const uint32_t *fans, MesoError *error)
{
    uint64_t most = (uint64_t)mesh->vertex_count + mesh->corner_count;
    MesoStatus status = meso_mesh_counts_check("separating", most, 0, 0, error);
    uint32_t *of_fan = status ? NULL : MESO_NEW(scratch, uint32_t, mesh->corner_count, error);
    bool *taken = status ? NULL : MESO_NEW(scratch, bool, mesh->vertex_count, error);
    copies->vertex_sources = status ? NULL : MESO_NEW(scratch, uint32_t, most, error);
    if (!of_fan || !taken || !copies->vertex_sources)
        return status ? status : MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        copies->vertex_sources[v] = v;
    copies->vertex_count = mesh->vertex_count;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        for (uint32_t c = begin; c < end; c++) {
            uint32_t v = mesh->corners[c], root = fans[c];
            if (root == c) {
                of_fan[c] = taken[v] ? copies->vertex_count : v;
                if (taken[v])
                    copies->vertex_sources[copies->vertex_count++] = v;
                taken[v] = true;
            }
            meso_mesh_copies_corner(copies, c, of_fan[root]);
        }
        meso_mesh_copies_face(copies, f);
    }
    return MESO_OK;
}

MesoStatus meso_mesh_separate(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                              const MesoHalfEdges *edges, uint32_t *added, MesoError *error)
{
    MesoArena scratch;
    MesoMeshCopies copies;
    meso_arena_init(&scratch);
    uint32_t *fans = MESO_NEW(&scratch, uint32_t, from->corner_count, error);
    MesoStatus status = fans ? meso_mesh_find_fans(fans, from, edges, error) : MESO_ERR_MEMORY;
    if (!status)
        status = meso_mesh_copies_init(&copies, &scratch, from->face_count, from->corner_count, error);
    if (!status)
        status = give_vertices(&copies, &scratch, from, fans, error);
    if (!status)
        status = meso_mesh_copies_build(mesh, arena, from, &copies, error);
    if (!status && added)
        *added = copies.vertex_count - from->vertex_count;
    meso_arena_release(&scratch);
    return status;
}
