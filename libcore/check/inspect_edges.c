/* Half-edges joined across edges; pieces, parts and things; fans around places. */
#include <stdlib.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/index_map.h"
#include "libcore/base/parallel.h"
#include "libcore/check/inspect_work.h"

enum { GRAIN = 1 << 14, FEW = 24 };

/* ---- sets, parts ---- */

/* Each element's number among the sets, in the order of their first elements; how many sets there are. */
static uint32_t number_sets(uint32_t *sets, uint32_t count)
{
    uint32_t met = 0;
    for (uint32_t i = 0; i < count; i++)
        sets[i] = meso_sets_root(sets, i);
    for (uint32_t i = 0; i < count; i++)    /* roots are the first of their sets */
        sets[i] = sets[i] == i ? met++ : sets[sets[i]];
    return met;
}

/* By the vertices that triangles share as the mesh has them. */
static MesoStatus find_parts(MesoInspectWork *work, MesoError *error)
{
    const MesoInspectedMesh *mesh = work->mesh;
    work->parts = MESO_NEW(work->scratch, uint32_t, mesh->triangle_count, error);
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint32_t *vertices = work->parts ? MESO_NEW(work->scratch, uint32_t, mesh->vertex_count, error) : NULL;
    if (!vertices)
        return MESO_ERR_MEMORY;
    meso_sets_init(vertices, mesh->vertex_count);
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        meso_sets_join(vertices, mesh->corners[h], mesh->corners[meso_half_next(h)]);
    work->part_count = number_sets(vertices, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        work->parts[t] = vertices[mesh->corners[3 * t]];
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}

/* ---- edges ---- */

/* Of one of the lower place of an edge. */
typedef struct EdgeEntry {
    uint32_t higher, half;
} EdgeEntry;

typedef struct Edges {
    MesoInspectWork *work;
    uint32_t *last_edge;    /* [part_count] number of the last crowded edge that a part was met at */
    uint32_t crowded;       /* edges so far */
    uint64_t *begin;        /* [place_count + 1] */
    EdgeEntry *entries;
} Edges;

static int compare_entries(const void *a, const void *b)
{
    const EdgeEntry *x = a, *y = b;
    if (x->higher != y->higher)
        return x->higher < y->higher ? -1 : 1;
    return x->half < y->half ? -1 : x->half > y->half;
}

static void sort_entries(EdgeEntry *entries, uint64_t count)
{
    if (count > FEW) {
        qsort(entries, count, sizeof *entries, compare_entries);
        return;
    }
    for (uint64_t i = 1; i < count; i++) {
        EdgeEntry entry = entries[i];
        uint64_t k = i;
        for (; k > 0 && compare_entries(&entries[k - 1], &entry) > 0; k--)
            entries[k] = entries[k - 1];
        entries[k] = entry;
    }
}

/* The triangles of one edge. */
static void join_run(MesoInspectWork *work, const EdgeEntry *run, uint64_t count)
{
    if (count == 2) {
        work->mates[run[0].half] = run[1].half;
        work->mates[run[1].half] = run[0].half;
        return;
    }
    for (uint64_t i = 0; i < count; i++)
        work->mates[run[i].half] = count == 1 ? MESO_MATE_NONE : MESO_MATE_MANY;
}

static void join_range(void *context, uint64_t begin, uint64_t end)
{
    const Edges *edges = context;
    for (uint64_t p = begin; p < end; p++) {
        EdgeEntry *entries = &edges->entries[edges->begin[p]];
        uint64_t count = edges->begin[p + 1] - edges->begin[p];
        sort_entries(entries, count);
        for (uint64_t first = 0, next; first < count; first = next) {
            for (next = first + 1; next < count && entries[next].higher == entries[first].higher;)
                next++;
            join_run(edges->work, &entries[first], next - first);
        }
    }
}

static void lower_and_higher(const MesoInspectWork *work, uint32_t half, uint32_t *lower, uint32_t *higher)
{
    uint32_t a = work->places[half], b = work->places[meso_half_next(half)];
    *lower = a < b ? a : b;
    *higher = a < b ? b : a;
}

/* By their lower places: counted, then filled in. */
static void fill_edges(Edges *edges)
{
    const MesoInspectWork *work = edges->work;
    uint32_t half_count = 3 * work->mesh->triangle_count, lower, higher;
    for (uint32_t h = 0; h < half_count; h++) {
        lower_and_higher(work, h, &lower, &higher);
        if (work->mates[h] != MESO_MATE_OUT)
            edges->begin[lower]++;
    }
    uint64_t sum = 0;
    for (uint32_t p = 0; p <= work->place_count; p++) {
        sum += edges->begin[p];
        edges->begin[p] = sum;
    }
    for (uint32_t h = half_count; h-- > 0;) {
        lower_and_higher(work, h, &lower, &higher);
        if (work->mates[h] != MESO_MATE_OUT)
            edges->entries[--edges->begin[lower]] = (EdgeEntry){higher, h};
    }
}

/* Whether both run the same way along their edge. */
static bool is_wound_against(const MesoInspectWork *work, uint32_t half, uint32_t mate)
{
    return work->places[half] == work->places[mate];
}

static void note_edges(MesoInspectWork *work)
{
    for (uint32_t h = 0; h < 3 * work->mesh->triangle_count; h++) {
        uint32_t mate = work->mates[h];
        work->result->open_edges += mate == MESO_MATE_NONE;
        if (mate < MESO_MATE_OUT && h < mate && is_wound_against(work, h, mate)) {
            meso_inspect_note(work, MESO_FAULT_WINDING, h / 3, 0);
            work->result->marks[mate / 3] |= 1u << MESO_FAULT_WINDING;
        }
    }
}

/* Whether the triangles of an edge are ends of as many parts of one slot or two: where sweeps share a cross-section. */
static bool is_branch(Edges *edges, const EdgeEntry *run, uint64_t count)
{
    const MesoInspectWork *work = edges->work;
    const uint32_t *slots = work->mesh->slots;
    uint32_t others = MESO_NO_INDEX, edge = ++edges->crowded;
    for (uint64_t i = 0; slots && i < count; i++) {
        uint32_t t = run[i].half / 3;
        if (slots[t] != slots[run[0].half / 3] && others == MESO_NO_INDEX)
            others = slots[t];
        if (slots[t] != slots[run[0].half / 3] && slots[t] != others)
            return false;
        if (edges->last_edge[work->parts[t]] == edge)
            return false;
        edges->last_edge[work->parts[t]] = edge;
    }
    return slots != NULL;
}

/* An edge counts once, with all of its triangles marked. */
static void note_run(Edges *edges, const EdgeEntry *run, uint64_t count)
{
    MesoInspectWork *work = edges->work;
    MesoFault fault = is_branch(edges, run, count) ? MESO_FAULT_BRANCH : MESO_FAULT_EDGE;
    meso_inspect_note(work, fault, run[0].half / 3, 0);
    for (uint64_t i = 1; i < count; i++) {
        work->result->marks[run[i].half / 3] |= 1u << fault;
        if (fault == MESO_FAULT_BRANCH)
            meso_inspect_joint(work, run[0].half, run[i].half);
    }
}

/* Entries stand edge by edge. */
static void note_crowded(Edges *edges)
{
    for (uint32_t p = 0; p < edges->work->place_count; p++) {
        const EdgeEntry *entries = &edges->entries[edges->begin[p]];
        uint64_t count = edges->begin[p + 1] - edges->begin[p];
        for (uint64_t first = 0, next; first < count; first = next) {
            for (next = first + 1; next < count && entries[next].higher == entries[first].higher;)
                next++;
            if (next - first > 2)
                note_run(edges, &entries[first], next - first);
        }
    }
}

/* ---- fans and pieces: what is joined over edges ---- */

/* The half-edge's corner at `place`, one of its ends. */
static uint32_t corner_at(const MesoInspectWork *work, uint32_t half, uint32_t place)
{
    return work->places[half] == place ? half : meso_half_next(half);
}

/* Joins the triangles of each edge, and their corners at its ends. */
static void join_over_edges(const MesoInspectWork *work, const Edges *edges, uint32_t *corners)
{
    for (uint32_t p = 0; p < work->place_count; p++)
        for (uint64_t i = edges->begin[p] + 1; i < edges->begin[p + 1]; i++) {
            EdgeEntry a = edges->entries[i - 1], b = edges->entries[i];
            if (a.higher != b.higher)
                continue;
            meso_sets_join(work->pieces, a.half / 3, b.half / 3);
            meso_sets_join(corners, corner_at(work, a.half, p), corner_at(work, b.half, p));
            meso_sets_join(corners, corner_at(work, a.half, a.higher), corner_at(work, b.half, a.higher));
        }
}

static MesoStatus note_fans(MesoInspectWork *work, uint32_t *corners, MesoError *error)
{
    uint8_t *fans = MESO_NEW(work->scratch, uint8_t, work->place_count, error);
    if (!fans)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < 3 * work->mesh->triangle_count; c++) {
        if (work->mates[c] == MESO_MATE_OUT || meso_sets_root(corners, c) != c)
            continue;
        uint8_t *met = &fans[work->places[c]];
        if (*met == 1)
            meso_inspect_note(work, MESO_FAULT_VERTEX, c / 3, 0);
        *met = *met < 2 ? (uint8_t)(*met + 1) : 2;
    }
    return MESO_OK;
}

/* What is left out joins nothing: it goes with the triangle that it repeats, or stands alone. */
static MesoStatus join_all(MesoInspectWork *work, const Edges *edges, MesoError *error)
{
    uint32_t triangles = work->mesh->triangle_count;
    uint32_t *corners = MESO_NEW(work->scratch, uint32_t, 3 * (size_t)triangles, error);
    if (!corners)
        return MESO_ERR_MEMORY;
    meso_sets_init(corners, 3 * triangles);
    meso_sets_init(work->pieces, triangles);
    join_over_edges(work, edges, corners);
    return note_fans(work, corners, error);
}

MesoStatus meso_inspect_edges(MesoInspectWork *work, MesoError *error)
{
    work->pieces = MESO_NEW(work->scratch, uint32_t, work->mesh->triangle_count, error);
    MesoStatus status = work->pieces ? find_parts(work, error) : MESO_ERR_MEMORY;
    if (status)
        return status;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    Edges edges = {.work = work};
    edges.begin = MESO_NEW(work->scratch, uint64_t, (size_t)work->place_count + 1, error);
    edges.entries = MESO_NEW(work->scratch, EdgeEntry, 3 * (size_t)work->mesh->triangle_count, error);
    edges.last_edge = MESO_NEW(work->scratch, uint32_t, work->part_count, error);
    if (!edges.begin || !edges.entries || !edges.last_edge)
        return MESO_ERR_MEMORY;
    fill_edges(&edges);
    meso_parallel_for(work->options->thread_count, work->place_count, GRAIN, join_range, &edges);
    note_edges(work);
    note_crowded(&edges);
    status = join_all(work, &edges, error);
    meso_arena_rewind(work->scratch, mark);
    return status;
}

/* ---- pieces, things ---- */

/* Left-out triangles get the piece of a triangle that shares their first corner, so that they are no pieces. */
static MesoStatus adopt_left_out(MesoInspectWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint32_t *at = MESO_NEW(work->scratch, uint32_t, work->place_count, error);
    if (!at)
        return MESO_ERR_MEMORY;
    for (uint32_t h = 3 * work->mesh->triangle_count; h-- > 0;)
        if (work->mates[h] != MESO_MATE_OUT)
            at[work->places[h]] = h / 3 + 1;
    for (uint32_t h = 0; h < 3 * work->mesh->triangle_count; h++)
        if (work->mates[h] == MESO_MATE_OUT && at[work->places[h]])
            meso_sets_join(work->pieces, h / 3, at[work->places[h]] - 1);
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}

/* Ids may be any numbers: they are counted as they are met. */
static MesoStatus number_things(MesoInspectWork *work, MesoError *error)
{
    const MesoInspectedMesh *mesh = work->mesh;
    MesoIndexMap map = {0};
    work->thing_count = work->piece_count;
    work->things = work->pieces;
    if (!mesh->things)
        return MESO_OK;
    work->thing_count = 0;
    work->things = MESO_NEW(work->scratch, uint32_t, mesh->triangle_count, error);
    if (!work->things)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t *number = meso_index_map_at(&map, work->scratch, mesh->things[t], error);
        if (!number)
            return MESO_ERR_MEMORY;
        if (*number == MESO_NO_INDEX)
            *number = work->thing_count++;
        work->things[t] = *number;
    }
    work->thing_ids = MESO_NEW(work->scratch, uint32_t, work->thing_count, error);
    for (uint32_t t = 0; t < mesh->triangle_count && work->thing_ids; t++)
        work->thing_ids[work->things[t]] = mesh->things[t];
    return work->thing_ids ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus note_leaks(MesoInspectWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint8_t *leaks = MESO_NEW(work->scratch, uint8_t, work->thing_count, error);
    if (!leaks)
        return MESO_ERR_MEMORY;
    for (uint32_t h = 0; h < 3 * work->mesh->triangle_count; h++) {
        uint8_t *leak = &leaks[work->things[h / 3]];
        if (work->mates[h] != MESO_MATE_NONE)
            continue;
        if (!*leak)
            meso_inspect_note(work, MESO_FAULT_LEAK, h / 3, 0);
        work->result->marks[h / 3] |= 1u << MESO_FAULT_LEAK;
        *leak = 1;
    }
    work->result->thing_count = work->thing_count;
    work->result->closed_count = work->thing_count - (uint32_t)work->result->findings[MESO_FAULT_LEAK].count;
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}

MesoStatus meso_inspect_pieces(MesoInspectWork *work, MesoError *error)
{
    MesoStatus status = adopt_left_out(work, error);
    if (status)
        return status;
    work->piece_count = number_sets(work->pieces, work->mesh->triangle_count);
    work->result->piece_count = work->piece_count;
    status = number_things(work, error);
    return status ? status : note_leaks(work, error);
}
