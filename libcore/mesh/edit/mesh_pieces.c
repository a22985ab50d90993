#include "libcore/mesh/edit/mesh_pieces.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/mesh/edit/face_area.h"

MesoStatus meso_mesh_pieces_init(MesoMeshPieces *pieces, MesoArena *scratch, MesoError *error)
{
    const MesoPolygonMesh *mesh = pieces->mesh;
    uint32_t words = meso_bits_words(mesh->face_count);
    pieces->face_of = MESO_NEW(scratch, uint32_t, mesh->corner_count, error);
    pieces->queue = MESO_NEW(scratch, uint32_t, mesh->face_count, error);
    pieces->met = MESO_NEW(scratch, uint64_t, words, error);
    pieces->turned = MESO_NEW(scratch, uint64_t, words, error);
    if (!pieces->face_of || !pieces->queue || !pieces->met || !pieces->turned)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < mesh->face_count; f++)
        for (uint32_t k = 0; k < meso_polygon_sides(mesh, f); k++)
            pieces->face_of[meso_polygon_begin(mesh, f) + k] = f;
    return MESO_OK;
}

static void follow_face(MesoMeshPieces *pieces, uint32_t face)
{
    uint32_t begin = meso_polygon_begin(pieces->mesh, face), end = begin + meso_polygon_sides(pieces->mesh, face);
    for (uint32_t h = begin; h < end; h++) {
        uint32_t twin = pieces->edges->twin[h], other = twin == MESO_NO_INDEX ? face : pieces->face_of[twin];
        if (meso_bits_test(pieces->met, other))
            continue;
        meso_bits_set(pieces->met, other);
        if (meso_mesh_pieces_disagree(pieces, h))
            meso_bits_set(pieces->turned, other);
        pieces->queue[pieces->tail++] = other;
    }
}

void meso_mesh_pieces_find(MesoMeshPieces *pieces, uint32_t first)
{
    uint32_t next = pieces->head = pieces->tail;
    meso_bits_set(pieces->met, first);
    pieces->queue[pieces->tail++] = first;
    while (next < pieces->tail)
        follow_face(pieces, pieces->queue[next++]);
}

MesoMeshPiece meso_mesh_pieces_measure(const MesoMeshPieces *pieces)
{
    const MesoPolygonMesh *mesh = pieces->mesh;
    MesoVec3 o = mesh->positions[mesh->corners[meso_polygon_begin(mesh, pieces->queue[pieces->head])]];
    MesoMeshPiece piece = {.closed = true};
    for (uint32_t i = pieces->head; i < pieces->tail; i++) {
        uint32_t face = pieces->queue[i], begin = meso_polygon_begin(mesh, face);
        bool turned = meso_bits_test(pieces->turned, face);
        piece.turned += turned;
        piece.volume += (turned ? -1 : 1) * meso_face_volume(mesh, face, o);
        for (uint32_t h = begin; h < begin + meso_polygon_sides(mesh, face); h++) {
            bool inner = pieces->edges->twin[h] != MESO_NO_INDEX;
            piece.closed &= inner;
            piece.doubled += inner && meso_mesh_pieces_disagree(pieces, h);
        }
    }
    return piece;
}

void meso_mesh_pieces_turn(const MesoMeshPieces *pieces)
{
    for (uint32_t i = pieces->head; i < pieces->tail; i++)
        pieces->turned[pieces->queue[i] / 64] ^= (uint64_t)1 << (pieces->queue[i] % 64);
}

/* ---- the turned mesh ---- */

static MesoStatus copy_faces(MesoMeshCopies *copies, MesoArena *scratch, const MesoPolygonMesh *mesh,
                             const MesoMeshTurning *turning, MesoError *error)
{
    MesoStatus status = meso_mesh_copies_init(copies, scratch, mesh->face_count, mesh->corner_count, error);
    copies->vertex_sources = turning->vertex_sources;
    copies->vertex_count = turning->vertex_count;
    for (uint32_t f = 0; f < mesh->face_count && !status; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        bool turned = meso_bits_test(turning->turned, f);
        for (uint32_t k = 0; k < sides; k++) {
            uint32_t c = begin + (turned && k > 0 ? sides - k : k);
            meso_mesh_copies_corner(copies, c, turning->corners[c]);
        }
        meso_mesh_copies_face(copies, f);
    }
    return status;
}

static bool looks_in(const MesoAttribute *normals, uint32_t element, MesoAreaVector area)
{
    uint32_t entry = meso_attribute_entry(normals, element);
    MesoVec3 n = entry == MESO_NO_INDEX ? (MesoVec3){0, 0, 0} : meso_attribute_vec3(normals, entry);
    return meso_area_dot((MesoAreaVector){(double)n.x, (double)n.y, (double)n.z}, area) < 0;
}

/* A corner by its vertex and its normal's entry. */
typedef struct SharedNormal {
    uint32_t vertex, entry, corner;
} SharedNormal;

static int compare_shared(const void *left, const void *right)
{
    const SharedNormal *a = left, *b = right;
    if (a->vertex != b->vertex)
        return a->vertex < b->vertex ? -1 : 1;
    if (a->entry != b->entry)
        return a->entry < b->entry ? -1 : 1;
    return (a->corner > b->corner) - (a->corner < b->corner);
}

/*
 * Corners of a vertex that share a normal go on doing so, also over an edge so sharp that it looks along one face and
 * against the other: each gets the sum of all. Those of faces that are left alone have none. Not where a piece has one
 * side only: nowhere on it does a normal look out for all.
 */
static MesoStatus share_sums(MesoAreaVector *sums, const MesoPolygonMesh *mesh, const MesoAttribute *normals,
                             MesoArena *scratch, MesoError *error)
{
    uint32_t count = mesh->corner_count;
    SharedNormal *shared = MESO_NEW(scratch, SharedNormal, count, error);
    if (!shared)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < count; c++)
        shared[c] = (SharedNormal){mesh->corners[c], meso_attribute_entry(normals, c), c};
    qsort(shared, count, sizeof *shared, compare_shared);
    for (uint32_t begin = 0, end; begin < count; begin = end) {
        MesoAreaVector sum = {0, 0, 0};
        for (end = begin; end < count && shared[end].vertex == shared[begin].vertex &&
                          shared[end].entry == shared[begin].entry; end++) {
            const MesoAreaVector *own = &sums[shared[end].corner];
            sum = (MesoAreaVector){sum.x + own->x, sum.y + own->y, sum.z + own->z};
        }
        for (uint32_t i = begin; i < end; i++) {
            MesoAreaVector *own = &sums[shared[i].corner];
            *own = own->x != 0 || own->y != 0 || own->z != 0 ? sum : *own;
        }
    }
    return MESO_OK;
}

/* Elements of the domain whose normals look into their faces; of `faces` alone, if there are such. */
static MesoStatus find_wrong_normals(uint64_t **wrong, const MesoPolygonMesh *mesh, const MesoAttribute *normals,
                                     const uint64_t *faces, bool is_cut, MesoArena *scratch, MesoError *error)
{
    bool corners = normals->domain == MESO_ON_CORNERS;
    uint32_t count = meso_polygon_elements(mesh, normals->domain);
    MesoAreaVector *sums = MESO_NEW(scratch, MesoAreaVector, count, error);
    *wrong = MESO_NEW(scratch, uint64_t, meso_bits_words(count), error);
    if (!sums || !*wrong)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        if (faces && !meso_bits_test(faces, f))
            continue;
        MesoAreaVector area = meso_face_area(mesh, f);
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        for (uint32_t c = begin; c < end; c++) {
            MesoAreaVector *sum = &sums[corners ? c : mesh->corners[c]];
            *sum = (MesoAreaVector){sum->x + area.x, sum->y + area.y, sum->z + area.z};
        }
    }
    bool share = corners && normals->entry_of && !is_cut;
    MesoStatus status = share ? share_sums(sums, mesh, normals, scratch, error) : MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++)
        if (looks_in(normals, i, sums[i]))
            meso_bits_set(*wrong, i);
    return status;
}

static void negate(const MesoAttribute *normals, size_t from, size_t to)
{
    float *floats = normals->values;
    double *doubles = normals->values;
    for (size_t k = 0; k < 3; k++)
        if (normals->scalar == MESO_SCALAR_DOUBLE)
            doubles[3 * to + k] = -doubles[3 * from + k];
        else
            floats[3 * to + k] = -floats[3 * from + k];
}

/* An entry may be used from both sides: there is one for either, the turned ones behind the others. */
static MesoStatus double_entries(MesoAttribute *normals, MesoArena *arena, uint32_t count, MesoError *error)
{
    uint32_t old = normals->entry_count;
    size_t size = 3 * (size_t)meso_scalar_size(normals->scalar);
    const void *values = normals->values;
    MesoStatus status = meso_mesh_counts_check("turning normals", 2 * (uint64_t)old, 0, 0, error);
    if (status)
        return status;
    const uint32_t *entry_of = normals->entry_of;
    normals->entry_count = 2 * old;
    normals->values = meso_arena_alloc(arena, 2 * (size_t)old, size, error);
    normals->entry_of = MESO_NEW(arena, uint32_t, count, error);
    if (!normals->values || !normals->entry_of)
        return MESO_ERR_MEMORY;
    memcpy(normals->values, values, old * size);
    memcpy(normals->entry_of, entry_of, count * sizeof *entry_of);
    for (uint32_t e = 0; e < old; e++)
        negate(normals, e, old + e);
    return MESO_OK;
}

static MesoStatus turn_normals(const MesoPolygonMesh *mesh, MesoAttribute *normals, const uint64_t *faces, bool is_cut,
                               MesoArena *arena, MesoArena *scratch, MesoError *error)
{
    uint64_t *wrong = NULL;
    uint32_t count = meso_polygon_elements(mesh, normals->domain), old = normals->entry_count;
    MesoStatus status = find_wrong_normals(&wrong, mesh, normals, faces, is_cut, scratch, error);
    if (status || meso_bits_count(wrong, meso_bits_words(count)) == 0)
        return status;
    if (normals->entry_of)
        status = double_entries(normals, arena, count, error);
    for (uint32_t i = 0; i < count && !status; i++) {
        if (!meso_bits_test(wrong, i))
            continue;
        if (normals->entry_of)
            normals->entry_of[i] += old;
        else
            negate(normals, i, i);
    }
    return status;
}

static bool is_normal(const MesoAttribute *a)
{
    return strcmp(a->name, "normal") == 0 && a->width == 3 && a->domain != MESO_ON_FACES &&
           (a->scalar == MESO_SCALAR_FLOAT || a->scalar == MESO_SCALAR_DOUBLE);
}

MesoStatus meso_mesh_turn(MesoPolygonMesh *mesh, MesoArena *arena, MesoArena *scratch, const MesoPolygonMesh *from,
                          const MesoMeshTurning *turning, MesoError *error)
{
    MesoMeshCopies copies;
    MesoStatus status = copy_faces(&copies, scratch, from, turning, error);
    if (!status)
        status = meso_mesh_copies_build(mesh, arena, from, &copies, error);
    for (uint32_t a = 0; !status && a < mesh->attribute_count; a++)
        if (is_normal(&mesh->attributes[a]))
            status = turn_normals(mesh, &mesh->attributes[a], turning->faces,
                                  turning->vertex_count > from->vertex_count, arena, scratch, error);
    return status;
}
