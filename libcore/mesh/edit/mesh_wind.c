#include "libcore/mesh/edit/mesh_wind.h"

#include <string.h>

#include "libcore/mesh/edit/face_area.h"
#include "libcore/mesh/edit/mesh_pieces.h"

/* ---- which faces ---- */

/* Corners of the piece whose normals look along their faces as they are turned now, less those that look against. */
static int64_t count_normals(const MesoMeshPieces *pieces, const MesoAttribute *normals)
{
    const MesoPolygonMesh *mesh = pieces->mesh;
    int64_t count = 0;
    for (uint32_t i = pieces->head; i < pieces->tail; i++) {
        uint32_t face = pieces->queue[i], begin = meso_polygon_begin(mesh, face);
        MesoAreaVector area = meso_face_area(mesh, face);
        int sign = meso_bits_test(pieces->turned, face) ? -1 : 1;
        for (uint32_t c = begin; c < begin + meso_polygon_sides(mesh, face); c++) {
            uint32_t entry = meso_attribute_entry(normals, normals->domain == MESO_ON_CORNERS ? c : mesh->corners[c]);
            if (entry == MESO_NO_INDEX)
                continue;
            MesoVec3 n = meso_attribute_vec3(normals, entry);
            double along = meso_area_dot((MesoAreaVector){(double)n.x, (double)n.y, (double)n.z}, area);
            count += along > 0 ? sign : along < 0 ? -sign : 0;
        }
    }
    return count;
}

static void choose_side(const MesoMeshPieces *pieces, const MesoAttribute *normals)
{
    MesoMeshPiece piece = meso_mesh_pieces_measure(pieces);
    uint32_t count = pieces->tail - pieces->head;
    if (piece.turned == 0 && piece.doubled == 0)
        return;
    int64_t along = normals ? count_normals(pieces, normals) : 0;
    bool encloses = piece.closed && piece.doubled == 0 && piece.volume != 0;
    if (along != 0 ? along < 0 : encloses ? piece.volume < 0 : piece.turned > count - piece.turned)
        meso_mesh_pieces_turn(pieces);
}

MesoStatus meso_mesh_find_windings(uint8_t *over, const MesoPolygonMesh *mesh, const MesoHalfEdges *edges,
                                   MesoError *error)
{
    MesoArena scratch;
    MesoMeshPieces pieces = {.mesh = mesh, .edges = edges};
    meso_arena_init(&scratch);
    MesoStatus status = meso_mesh_pieces_init(&pieces, &scratch, error);
    for (uint32_t f = 0; f < mesh->face_count && !status; f++) {
        if (meso_bits_test(pieces.met, f))
            continue;
        meso_mesh_pieces_find(&pieces, f);
        choose_side(&pieces, meso_polygon_normals(mesh));
    }
    for (uint32_t f = 0; f < mesh->face_count && !status; f++)
        over[f] = meso_bits_test(pieces.turned, f);
    meso_arena_release(&scratch);
    return status;
}

/* ---- the cut ---- */

typedef struct Winding {
    MesoMeshPieces pieces;      /* turned as the caller says */
    uint64_t *disagreed;        /* bits of faces of pieces in which neighbours disagreed */
    uint32_t *parent;           /* [corner_count] corners that stay on one vertex */
    uint32_t *corners;          /* [corner_count] vertices of the new mesh */
    uint64_t *on_cut;           /* bits of vertices */
} Winding;

static void count_turned(const Winding *w, uint32_t face, MesoWindCounts *counts)
{
    if (!meso_bits_test(w->pieces.turned, face))
        return;
    counts->turned_face = counts->faces_turned++ && counts->turned_face < face ? counts->turned_face : face;
}

/* The pieces are found once more, and turned to agree, to see which of them did not. */
static MesoStatus find_disagreed(Winding *w, MesoArena *scratch, MesoWindCounts *counts, MesoError *error)
{
    MesoMeshPieces probe = {.mesh = w->pieces.mesh, .edges = w->pieces.edges};
    w->disagreed = MESO_NEW(scratch, uint64_t, meso_bits_words(probe.mesh->face_count), error);
    MesoStatus status = w->disagreed ? meso_mesh_pieces_init(&probe, scratch, error) : MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < probe.mesh->face_count && !status; f++) {
        if (meso_bits_test(probe.met, f))
            continue;
        meso_mesh_pieces_find(&probe, f);
        MesoMeshPiece piece = meso_mesh_pieces_measure(&probe);
        for (uint32_t i = probe.head; i < probe.tail && (piece.turned || piece.doubled); i++) {
            meso_bits_set(w->disagreed, probe.queue[i]);
            if (!piece.doubled)
                count_turned(w, probe.queue[i], counts);
        }
    }
    return status;
}

static uint32_t next_corner(const MesoMeshPieces *pieces, uint32_t c)
{
    uint32_t begin = meso_polygon_begin(pieces->mesh, pieces->face_of[c]);
    uint32_t sides = meso_polygon_sides(pieces->mesh, pieces->face_of[c]);
    return begin + (c + 1 - begin) % sides;
}

static bool is_cut(const Winding *w, uint32_t h)
{
    return w->pieces.edges->twin[h] != MESO_NO_INDEX && meso_mesh_pieces_disagree(&w->pieces, h);
}

static void find_cuts(Winding *w, MesoWindCounts *counts)
{
    const MesoPolygonMesh *mesh = w->pieces.mesh;
    for (uint32_t h = 0; h < mesh->corner_count; h++) {
        uint32_t twin = w->pieces.edges->twin[h];
        if (!is_cut(w, h) || twin < h)
            continue;
        meso_bits_set(w->on_cut, mesh->corners[h]);
        meso_bits_set(w->on_cut, mesh->corners[next_corner(&w->pieces, h)]);
        if (counts->edges_cut++ == 0) {
            counts->cut_faces[0] = w->pieces.face_of[h];
            counts->cut_faces[1] = w->pieces.face_of[twin];
        }
    }
}

static uint32_t root_of(uint32_t *parent, uint32_t c)
{
    while (parent[c] != c)
        c = parent[c] = parent[parent[c]];
    return c;
}

/* The lower corner speaks for both. */
static void join(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = root_of(parent, a);
    b = root_of(parent, b);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

/* Corners at the ends of an edge that is not cut stay together. */
static void join_ends(Winding *w, uint32_t h)
{
    const uint32_t *corners = w->pieces.mesh->corners;
    uint32_t twin = w->pieces.edges->twin[h], other = next_corner(&w->pieces, twin);
    uint32_t ends[2] = {h, next_corner(&w->pieces, h)};
    for (int i = 0; i < 2; i++)
        if (meso_bits_test(w->on_cut, corners[ends[i]]))
            join(w->parent, ends[i], corners[twin] == corners[ends[i]] ? twin : other);
}

/* The first group of corners at a vertex keeps it; each other one gets a copy. */
static MesoStatus split_vertices(Winding *w, MesoMeshTurning *turning, MesoArena *scratch, uint32_t cuts,
                                 MesoError *error)
{
    const MesoPolygonMesh *mesh = w->pieces.mesh;
    uint64_t room = mesh->vertex_count + 4 * (uint64_t)cuts;
    uint64_t *taken = MESO_NEW(scratch, uint64_t, meso_bits_words(mesh->vertex_count), error);
    MesoStatus status = meso_mesh_counts_check("cutting open", room, 0, 0, error);
    turning->vertex_sources = status ? NULL : MESO_NEW(scratch, uint32_t, room, error);
    if (status || !taken || !turning->vertex_sources)
        return status ? status : MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        turning->vertex_sources[v] = v;
    for (uint32_t c = 0; c < mesh->corner_count; c++) {
        uint32_t v = mesh->corners[c], root = root_of(w->parent, c);
        if (root != c || !meso_bits_test(taken, v)) {
            w->corners[c] = root != c ? w->corners[root] : v;
        } else if (meso_bits_test(w->on_cut, v)) {
            turning->vertex_sources[turning->vertex_count] = v;
            w->corners[c] = turning->vertex_count++;
        } else {
            w->corners[c] = v;
        }
        meso_bits_set(taken, v);
    }
    return MESO_OK;
}

static MesoStatus cut_open(Winding *w, MesoMeshTurning *turning, MesoArena *scratch, MesoWindCounts *counts,
                           MesoError *error)
{
    const MesoPolygonMesh *mesh = w->pieces.mesh;
    w->on_cut = MESO_NEW(scratch, uint64_t, meso_bits_words(mesh->vertex_count), error);
    if (!w->on_cut)
        return MESO_ERR_MEMORY;
    find_cuts(w, counts);
    if (counts->edges_cut == 0)
        return MESO_OK;
    w->parent = MESO_NEW(scratch, uint32_t, mesh->corner_count, error);
    w->corners = MESO_NEW(scratch, uint32_t, mesh->corner_count, error);
    if (!w->parent || !w->corners)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < mesh->corner_count; c++)
        w->parent[c] = c;
    for (uint32_t h = 0; h < mesh->corner_count; h++)
        if (w->pieces.edges->twin[h] != MESO_NO_INDEX && !is_cut(w, h))
            join_ends(w, h);
    turning->corners = w->corners;
    return split_vertices(w, turning, scratch, counts->edges_cut, error);
}

static MesoStatus wind(MesoPolygonMesh *mesh, MesoArena *arena, MesoArena *scratch, Winding *w, const uint8_t *over,
                       MesoWindCounts *counts, MesoError *error)
{
    const MesoPolygonMesh *from = w->pieces.mesh;
    MesoStatus status = meso_mesh_pieces_init(&w->pieces, scratch, error);
    for (uint32_t f = 0; f < from->face_count && !status; f++)
        if (over[f])
            meso_bits_set(w->pieces.turned, f);
    MesoMeshTurning turning = {.corners = from->corners, .vertex_count = from->vertex_count};
    if (!status)
        status = find_disagreed(w, scratch, counts, error);
    if (!status)
        status = cut_open(w, &turning, scratch, counts, error);
    turning.turned = w->pieces.turned;
    turning.faces = w->disagreed;
    return status ? status : meso_mesh_turn(mesh, arena, scratch, from, &turning, error);
}

MesoStatus meso_mesh_wind(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                          const MesoHalfEdges *edges, const uint8_t *over, MesoWindCounts *counts, MesoError *error)
{
    MesoArena scratch;
    Winding w = {.pieces = {.mesh = from, .edges = edges}};
    *counts = (MesoWindCounts){0};
    meso_arena_init(&scratch);
    MesoStatus status = wind(mesh, arena, &scratch, &w, over, counts, error);
    meso_arena_release(&scratch);
    return status;
}
