#include "libcore/mesh/edit/mesh_orient.h"

#include <string.h>

#include "libcore/base/bits.h"
#include "libcore/mesh/edit/face_area.h"
#include "libcore/mesh/edit/origins.h"

typedef struct Orient {
    const MesoPolygonMesh *mesh;
    const MesoHalfEdges *edges;
    uint32_t *face_of;          /* [corner_count] */
    uint32_t *queue;            /* [face_count] faces of the piece, in the order in which they were found */
    uint64_t *met, *turned;     /* bits of faces */
    uint32_t head, tail;        /* of the piece within the queue */
} Orient;

static MesoStatus init(Orient *orient, MesoArena *scratch, MesoError *error)
{
    const MesoPolygonMesh *mesh = orient->mesh;
    uint32_t words = meso_bits_words(mesh->face_count);
    orient->face_of = MESO_NEW(scratch, uint32_t, mesh->corner_count, error);
    orient->queue = MESO_NEW(scratch, uint32_t, mesh->face_count, error);
    orient->met = MESO_NEW(scratch, uint64_t, words, error);
    orient->turned = MESO_NEW(scratch, uint64_t, words, error);
    if (!orient->face_of || !orient->queue || !orient->met || !orient->turned)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < mesh->face_count; f++)
        for (uint32_t k = 0; k < meso_polygon_sides(mesh, f); k++)
            orient->face_of[meso_polygon_begin(mesh, f) + k] = f;
    return MESO_OK;
}

/* Whether the two faces of an edge run along it the same way, as they are turned now. */
static bool disagrees(const Orient *orient, uint32_t h)
{
    uint32_t twin = orient->edges->twin[h];
    bool alike = orient->mesh->corners[h] == orient->mesh->corners[twin];
    return alike ^ meso_bits_test(orient->turned, orient->face_of[h]) ^
           meso_bits_test(orient->turned, orient->face_of[twin]);
}

static void follow_face(Orient *orient, uint32_t face)
{
    uint32_t begin = meso_polygon_begin(orient->mesh, face), end = begin + meso_polygon_sides(orient->mesh, face);
    for (uint32_t h = begin; h < end; h++) {
        uint32_t twin = orient->edges->twin[h], other = twin == MESO_NO_INDEX ? face : orient->face_of[twin];
        if (meso_bits_test(orient->met, other))
            continue;
        meso_bits_set(orient->met, other);
        if (disagrees(orient, h))
            meso_bits_set(orient->turned, other);
        orient->queue[orient->tail++] = other;
    }
}

/* The faces from `first` on that hang together, as a part of the queue. */
static void find_piece(Orient *orient, uint32_t first)
{
    uint32_t next = orient->head = orient->tail;
    meso_bits_set(orient->met, first);
    orient->queue[orient->tail++] = first;
    while (next < orient->tail)
        follow_face(orient, orient->queue[next++]);
}

typedef struct Piece {
    bool closed;
    uint32_t turned, doubled;   /* faces; edges that disagree, each counted from both sides */
    double volume;
} Piece;

static Piece measure_piece(const Orient *orient)
{
    const MesoPolygonMesh *mesh = orient->mesh;
    MesoVec3 o = mesh->positions[mesh->corners[meso_polygon_begin(mesh, orient->queue[orient->head])]];
    Piece piece = {.closed = true};
    for (uint32_t i = orient->head; i < orient->tail; i++) {
        uint32_t face = orient->queue[i], begin = meso_polygon_begin(mesh, face);
        bool turned = meso_bits_test(orient->turned, face);
        piece.turned += turned;
        piece.volume += (turned ? -1 : 1) * meso_face_volume(mesh, face, o);
        for (uint32_t h = begin; h < begin + meso_polygon_sides(mesh, face); h++) {
            bool inner = orient->edges->twin[h] != MESO_NO_INDEX;
            piece.closed &= inner;
            piece.doubled += inner && disagrees(orient, h);
        }
    }
    return piece;
}

static void turn_piece(const Orient *orient)
{
    for (uint32_t i = orient->head; i < orient->tail; i++)
        orient->turned[orient->queue[i] / 64] ^= (uint64_t)1 << (orient->queue[i] % 64);
}

static void orient_piece(const Orient *orient, MesoOrientCounts *counts)
{
    Piece piece = measure_piece(orient);
    uint32_t count = orient->tail - orient->head;
    bool closed = piece.closed && piece.doubled == 0 && piece.volume != 0;
    if (closed ? piece.volume < 0 : piece.turned > count - piece.turned) {
        turn_piece(orient);
        piece.turned = count - piece.turned;
    }
    counts->faces_turned += piece.turned;
    counts->pieces_turned += closed && piece.turned == count;
    counts->disagreeing += piece.doubled / 2;
    if (piece.doubled && counts->one_sided == MESO_NO_INDEX)
        counts->one_sided = orient->queue[orient->head];
}

/* ---- the turned mesh ---- */

static MesoStatus copy_faces(MesoMeshCopies *copies, MesoArena *scratch, const Orient *orient, MesoError *error)
{
    const MesoPolygonMesh *mesh = orient->mesh;
    MesoStatus status = meso_mesh_copies_init(copies, scratch, mesh->face_count, mesh->corner_count, error);
    for (uint32_t f = 0; f < mesh->face_count && !status; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        bool turned = meso_bits_test(orient->turned, f);
        for (uint32_t k = 0; k < sides; k++) {
            uint32_t c = begin + (turned && k > 0 ? sides - k : k);
            meso_mesh_copies_corner(copies, c, mesh->corners[c]);
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

/* Elements of the domain whose normals look into their faces. */
static MesoStatus find_wrong_normals(uint64_t **wrong, const MesoPolygonMesh *mesh, const MesoAttribute *normals,
                                     MesoArena *scratch, MesoError *error)
{
    bool corners = normals->domain == MESO_ON_CORNERS;
    uint32_t count = meso_polygon_elements(mesh, normals->domain);
    MesoAreaVector *sums = MESO_NEW(scratch, MesoAreaVector, count, error);
    *wrong = MESO_NEW(scratch, uint64_t, meso_bits_words(count), error);
    if (!sums || !*wrong)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        MesoAreaVector area = meso_face_area(mesh, f);
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        for (uint32_t c = begin; c < end; c++) {
            MesoAreaVector *sum = &sums[corners ? c : mesh->corners[c]];
            *sum = (MesoAreaVector){sum->x + area.x, sum->y + area.y, sum->z + area.z};
        }
    }
    for (uint32_t i = 0; i < count; i++)
        if (looks_in(normals, i, sums[i]))
            meso_bits_set(*wrong, i);
    return MESO_OK;
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

static MesoStatus turn_normals(const MesoPolygonMesh *mesh, MesoAttribute *normals, MesoArena *arena,
                               MesoArena *scratch, MesoError *error)
{
    uint64_t *wrong = NULL;
    uint32_t count = meso_polygon_elements(mesh, normals->domain), old = normals->entry_count;
    MesoStatus status = find_wrong_normals(&wrong, mesh, normals, scratch, error);
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

static MesoStatus orient(MesoPolygonMesh *mesh, MesoArena *arena, MesoArena *scratch, Orient *orient,
                         MesoOrientCounts *counts, MesoError *error)
{
    MesoMeshCopies copies;
    MesoStatus status = init(orient, scratch, error);
    for (uint32_t f = 0; f < orient->mesh->face_count && !status; f++) {
        if (meso_bits_test(orient->met, f))
            continue;
        find_piece(orient, f);
        orient_piece(orient, counts);
    }
    if (!status)
        status = copy_faces(&copies, scratch, orient, error);
    if (!status)
        status = meso_mesh_copies_build(mesh, arena, orient->mesh, &copies, error);
    for (uint32_t a = 0; !status && a < mesh->attribute_count; a++)
        if (is_normal(&mesh->attributes[a]))
            status = turn_normals(mesh, &mesh->attributes[a], arena, scratch, error);
    return status;
}

MesoStatus meso_mesh_orient(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                            const MesoHalfEdges *edges, MesoOrientCounts *counts, MesoError *error)
{
    MesoArena scratch;
    MesoOrientCounts ignored;
    Orient state = {.mesh = from, .edges = edges};
    counts = counts ? counts : &ignored;
    *counts = (MesoOrientCounts){.one_sided = MESO_NO_INDEX};
    meso_arena_init(&scratch);
    MesoStatus status = orient(mesh, arena, &scratch, &state, counts, error);
    meso_arena_release(&scratch);
    return status;
}
