#include "libcore/decor/pieces.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/cut/triangle_area.h"

MesoStatus meso_pieces_init(MesoPieces *pieces, MesoArena *arena, const MesoTriangulation *mesh, uint32_t largest_leaf,
                            MesoError *error)
{
    *pieces = (MesoPieces){0};
    pieces->piece_of = MESO_NEW(arena, uint32_t, mesh->triangle_count, error);
    pieces->stack = MESO_NEW(arena, uint32_t, largest_leaf, error);
    if (!pieces->piece_of || !pieces->stack)
        return MESO_ERR_MEMORY;
    memset(pieces->piece_of, 0xff, mesh->triangle_count * sizeof *pieces->piece_of);
    return MESO_OK;
}

/* Mean of the field over a triangle after the cut; of a part, its value at its centre. INFINITY where it has none. */
static float field_at(const MesoCornerField *field, uint32_t triangle)
{
    uint32_t before = field->report->first_triangle;
    uint32_t row = triangle < before ? field->row[triangle] : field->row_count + field->part_of[triangle - before];
    if (row == MESO_NO_INDEX)
        return INFINITY;
    if (row < field->row_count) {
        const float *f = &field->values[3 * (size_t)row];
        return (f[0] + f[1] + f[2]) / 3;
    }
    const MesoCutPart *part = &field->report->parts[row - field->row_count];
    if (field->parent_row[row - field->row_count] == MESO_NO_INDEX)
        return INFINITY;
    const float *f = &field->values[3 * (size_t)field->parent_row[row - field->row_count]];
    return part->centre[0] * f[0] + part->centre[1] * f[1] + part->centre[2] * f[2];
}

static void flood(MesoPieces *pieces, const MesoTriangulation *mesh, uint32_t first, const MesoCornerField *field)
{
    uint32_t number = pieces->count - 1, depth = 0;
    MesoPiece *piece = &pieces->pieces[number];
    pieces->stack[depth++] = first;
    pieces->piece_of[first] = number;
    while (depth > 0) {
        uint32_t t = pieces->stack[--depth];
        double area = meso_triangle_area(mesh, t);
        float value = field ? field_at(field, t) : INFINITY;
        piece->triangle_count++;
        piece->area += area;
        if (value < INFINITY)
            piece->level += area * (double)value;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t across = mesh->twins[3 * t + k];
            if (mesh->walls[t] >> k & 1 || pieces->piece_of[across / 3] != MESO_NO_INDEX)
                continue;
            pieces->piece_of[across / 3] = number;
            pieces->stack[depth++] = across / 3;
        }
    }
    piece->level = piece->area > 0 ? piece->level / piece->area : 0;
}

MesoStatus meso_pieces_add(MesoPieces *pieces, MesoArena *arena, const MesoDecorWork *work, uint32_t leaf,
                           const MesoCornerField *field, MesoError *error)
{
    const MesoRegionLists *lists = &work->lists;
    for (uint32_t i = lists->begin[leaf]; i < lists->begin[leaf + 1]; i++) {
        uint32_t t = lists->triangles[i];
        if (pieces->piece_of[t] != MESO_NO_INDEX)
            continue;
        pieces->pieces = MESO_GROW(arena, pieces->pieces, pieces->count, pieces->room, 256, error);
        if (!pieces->pieces)
            return MESO_ERR_MEMORY;
        pieces->pieces[pieces->count++] = (MesoPiece){.leaf = leaf, .first = t};
        flood(pieces, &work->decor->mesh, t, field);
    }
    return MESO_OK;
}

/* ---- small pieces ---- */

/* Of the area of a face as the surface has it. */
static const double SMALL = 1;

/* The triangles of a piece, by another flood, to pieces->stack. */
static uint32_t list_piece(MesoPieces *pieces, const MesoTriangulation *mesh, uint32_t number)
{
    uint32_t count = 0, *list = pieces->stack;
    uint32_t mark = pieces->count;      /* no piece has this number */
    list[count++] = pieces->pieces[number].first;
    pieces->piece_of[list[0]] = mark;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t across = mesh->twins[3 * list[i] + k];
            if (mesh->walls[list[i]] >> k & 1 || pieces->piece_of[across / 3] != number)
                continue;
            pieces->piece_of[across / 3] = mark;
            list[count++] = across / 3;
        }
    for (uint32_t i = 0; i < count; i++)
        pieces->piece_of[list[i]] = number;
    return count;
}

static bool is_small(const MesoPieces *pieces, const MesoDecorWork *work, uint32_t number, uint32_t count)
{
    float largest = 0;
    for (uint32_t i = 0; i < count; i++)
        largest = fmaxf(largest, work->face_areas[work->decor->mesh.faces[pieces->stack[i]]]);
    return pieces->pieces[number].area < SMALL * (double)largest;
}

/* The piece across a wall of the same leaf; MESO_NO_INDEX where there is none, or the same. */
static uint32_t piece_across(const MesoPieces *pieces, const MesoTriangulation *mesh, uint32_t half_edge)
{
    uint32_t across = mesh->twins[half_edge], t = half_edge / 3;
    if (across == MESO_NO_INDEX || mesh->labels[across / 3] != mesh->labels[t] ||
        pieces->piece_of[across / 3] == pieces->piece_of[t])
        return MESO_NO_INDEX;
    return pieces->piece_of[across / 3];
}

/* The neighbour with the longest wall in common; of few triangles, all against all. */
static uint32_t best_neighbour(const MesoPieces *pieces, const MesoTriangulation *mesh, uint32_t count)
{
    uint32_t best = MESO_NO_INDEX;
    double longest = -1;
    for (uint32_t i = 0; i < 3 * count; i++) {
        uint32_t piece = piece_across(pieces, mesh, 3 * pieces->stack[i / 3] + i % 3);
        double length = 0;
        for (uint32_t k = 0; k < 3 * count && piece != MESO_NO_INDEX; k++) {
            uint32_t h = 3 * pieces->stack[k / 3] + k % 3;
            if (piece_across(pieces, mesh, h) == piece)
                length += (double)meso_vec3_length(meso_vec3_sub(mesh->positions[mesh->corners[h]],
                                                                 mesh->positions[mesh->corners[meso_next_corner(h)]]));
        }
        if (piece != MESO_NO_INDEX && length > longest) {
            longest = length;
            best = piece;
        }
    }
    return best;
}

static void take_down(MesoTriangulation *mesh, uint32_t half_edge)
{
    uint32_t across = mesh->twins[half_edge];
    mesh->walls[half_edge / 3] &= (uint8_t)~(1u << half_edge % 3);
    mesh->walls[across / 3] &= (uint8_t)~(1u << across % 3);
}

static void join_piece(MesoPieces *pieces, MesoTriangulation *mesh, uint32_t number, uint32_t to, uint32_t count)
{
    MesoPiece *piece = &pieces->pieces[number], *other = &pieces->pieces[to];
    for (uint32_t i = 0; i < 3 * count; i++) {
        uint32_t h = 3 * pieces->stack[i / 3] + i % 3;
        if (piece_across(pieces, mesh, h) == to)
            take_down(mesh, h);
    }
    for (uint32_t i = 0; i < count; i++)
        pieces->piece_of[pieces->stack[i]] = to;
    other->area += piece->area;
    other->triangle_count += piece->triangle_count;
    other->first = other->first < piece->first ? other->first : piece->first;
    piece->triangle_count = 0;
}

/* Closes the gaps that joined pieces have left in the numbers from `begin` on. */
static MesoStatus close_gaps(MesoPieces *pieces, const MesoDecorWork *work, uint32_t begin, MesoError *error)
{
    uint32_t kept = begin;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint32_t *number = MESO_NEW(work->scratch, uint32_t, pieces->count, error);
    if (!number)
        return MESO_ERR_MEMORY;
    for (uint32_t i = begin, leaf = MESO_NO_INDEX; i < pieces->count; i++) {
        number[i] = kept;
        if (pieces->pieces[i].triangle_count > 0)
            pieces->pieces[kept++] = pieces->pieces[i];
        leaf = pieces->pieces[i].leaf;
        if (i + 1 < pieces->count && pieces->pieces[i + 1].leaf == leaf)
            continue;
        for (uint32_t k = work->lists.begin[leaf]; k < work->lists.begin[leaf + 1]; k++)
            pieces->piece_of[work->lists.triangles[k]] = number[pieces->piece_of[work->lists.triangles[k]]];
    }
    pieces->count = kept;
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}

/* More triangles than these are not small, whatever their area. */
enum { SMALL_TRIANGLES = 64 };

MesoStatus meso_pieces_join_small(MesoPieces *pieces, MesoDecorWork *work, uint32_t begin, MesoError *error)
{
    MesoTriangulation *mesh = &work->decor->mesh;
    bool joined = false;
    for (uint32_t i = begin; i < pieces->count; i++) {
        if (pieces->pieces[i].triangle_count > SMALL_TRIANGLES)
            continue;
        uint32_t count = list_piece(pieces, mesh, i);
        uint32_t to = is_small(pieces, work, i, count) ? best_neighbour(pieces, mesh, count) : MESO_NO_INDEX;
        if (to == MESO_NO_INDEX)
            continue;
        join_piece(pieces, mesh, i, to, count);
        joined = true;
    }
    return joined ? close_gaps(pieces, work, begin, error) : MESO_OK;
}

MesoStatus meso_corner_field_cut(MesoCornerField *field, MesoArena *arena, const MesoTriangulation *mesh,
                                 const MesoCutReport *report, MesoError *error)
{
    field->report = report;
    field->parent_row = MESO_NEW(arena, uint32_t, report->part_count, error);
    field->part_of = MESO_NEW(arena, uint32_t, mesh->triangle_count - report->first_triangle, error);
    if (!field->parent_row || !field->part_of)
        return MESO_ERR_MEMORY;
    /* all parents first: one part stands in the parent's place, and its row becomes the part's */
    for (uint32_t i = 0; i < report->part_count; i++)
        field->parent_row[i] = field->row[report->parts[i].parent];
    for (uint32_t i = 0; i < report->part_count; i++) {
        uint32_t t = report->parts[i].triangle;
        *(t < report->first_triangle ? &field->row[t] : &field->part_of[t - report->first_triangle]) =
            t < report->first_triangle ? field->row_count + i : i;
    }
    return MESO_OK;
}

/* ---- becoming regions ---- */

typedef struct Rank {
    uint32_t piece, kind;
    double area;
} Rank;

static int by_kind(const void *a, const void *b)
{
    const Rank *x = a, *y = b;
    if (x->kind != y->kind)
        return x->kind < y->kind ? -1 : 1;
    if (x->area != y->area)
        return x->area > y->area ? -1 : 1;
    return x->piece < y->piece ? -1 : x->piece > y->piece;
}

static void sort_pieces(Rank *ranks, const MesoPieces *pieces, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin; i < end; i++)
        ranks[i - begin] = (Rank){i, pieces->pieces[i].kind, pieces->pieces[i].area};
    qsort(ranks, end - begin, sizeof *ranks, by_kind);
}

MesoStatus meso_pieces_become_regions(MesoPieces *pieces, MesoDecorWork *work, uint32_t begin, uint32_t end,
                                      MesoPieceLook (*look)(void *context, const MesoPiece *piece), void *context,
                                      MesoError *error)
{
    MesoRegionTree *tree = &work->decor->tree;
    uint32_t leaf = pieces->pieces[begin].leaf, first, count = end - begin;
    const MesoRegion like = {.step = work->decor->operation_count + 1, .material = {MESO_NO_INDEX}};
    Rank *ranks = MESO_NEW(work->scratch, Rank, count, error);
    uint32_t *region_of = MESO_NEW(work->scratch, uint32_t, count, error);
    if (!ranks || !region_of)
        return MESO_ERR_MEMORY;
    sort_pieces(ranks, pieces, begin, end);
    MesoStatus status = meso_region_tree_split(tree, leaf, count, &like, &first, error);
    if (status)
        return status;
    for (uint32_t i = 0; i < count; i++) {
        const MesoPiece *piece = &pieces->pieces[ranks[i].piece];
        MesoPieceLook looks = look(context, piece);
        MesoRegion *region = &tree->regions[first + i];
        region->tag = looks.tag;
        region->name = looks.name;
        region->level = looks.level;
        region->triangle_count = piece->triangle_count;
        region->area = piece->area;
        region_of[ranks[i].piece - begin] = first + i;
    }
    const MesoRegionLists *lists = &work->lists;
    for (uint32_t i = lists->begin[leaf]; i < lists->begin[leaf + 1]; i++)
        work->decor->mesh.labels[lists->triangles[i]] = region_of[pieces->piece_of[lists->triangles[i]] - begin];
    return MESO_OK;
}
