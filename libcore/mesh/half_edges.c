#include "libcore/mesh/half_edges.h"

#include <string.h>

#include "libcore/base/bits.h"
#include "libcore/base/parallel.h"

/* Half-edges of a list that are compared each with each; longer lists are sorted. */
enum { SHORT_LIST = 24, VERTEX_GRAIN = 1 << 14 };

typedef struct Counts {
    uint32_t edges, borders, reversed, crowded;
    uint32_t crowded_vertex, crowded_halves[3];     /* of the first of the crowded ones */
    uint32_t longest;           /* half-edges of the longest list that was left for later, or 0 */
} Counts;

typedef struct Join {
    const MesoPolygonMesh *mesh;
    uint32_t *twin;             /* next of the list, then the twin */
    uint32_t *list;             /* [vertex_count] first half-edge by lower vertex; MESO_NO_INDEX once it is done */
    uint64_t *last;             /* bits of the corners that end a face, where sides differ in number */
    Counts *counts;             /* [ranges of VERTEX_GRAIN vertices] */
} Join;

static uint32_t next_corner(const Join *join, uint32_t h)
{
    uint32_t sides = join->mesh->side_count;
    if (sides == 4)
        return (h & ~3u) | ((h + 1) & 3u);
    if (sides == 3)
        return h % 3 == 2 ? h - 2 : h + 1;
    if (sides)
        return h % sides == sides - 1 ? h - (sides - 1) : h + 1;
    if (!meso_bits_test(join->last, h))
        return h + 1;
    while (h > 0 && !meso_bits_test(join->last, h - 1))
        h--;
    return h;
}

/* ---- lists ---- */

static MesoStatus mark_last_corners(Join *join, MesoArena *arena, MesoError *error)
{
    const MesoPolygonMesh *mesh = join->mesh;
    if (mesh->side_count)
        return MESO_OK;
    join->last = MESO_NEW(arena, uint64_t, (size_t)mesh->corner_count / 64 + 1, error);
    if (!join->last)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < mesh->face_count; f++)
        meso_bits_set(join->last, mesh->face_begin[f + 1] - 1);
    return MESO_OK;
}

/* From the last face to the first, so that lists are ascending. */
static void list_half_edges(const Join *join)
{
    const MesoPolygonMesh *mesh = join->mesh;
    for (uint32_t f = mesh->face_count; f-- > 0;) {
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        uint32_t to = mesh->corners[begin];
        for (uint32_t h = end; h-- > begin;) {
            uint32_t from = mesh->corners[h], lower = from < to ? from : to;
            join->twin[h] = join->list[lower];
            join->list[lower] = h;
            to = from;
        }
    }
}

/* The end of a half-edge of the list of `lower` that is not `lower`. */
static uint32_t upper_of(const Join *join, uint32_t lower, uint32_t h)
{
    uint32_t from = join->mesh->corners[h];
    return from != lower ? from : join->mesh->corners[next_corner(join, h)];
}

/* ---- edges ---- */

/* Vertices come in ascending order; among the edges of one, the first is the one whose third half-edge is. */
static void note_crowded(Counts *counts, uint32_t vertex, const uint32_t three[3])
{
    bool first = counts->crowded++ == 0;
    if (!first && (vertex != counts->crowded_vertex || three[2] > counts->crowded_halves[2]))
        return;
    counts->crowded_vertex = vertex;
    memcpy(counts->crowded_halves, three, sizeof counts->crowded_halves);
}

/* Joins the `count` half-edges between `vertex` and another, of which `halves` has the first three, ascending. */
static void join_edge(const Join *join, Counts *counts, uint32_t vertex, const uint32_t *halves, uint32_t count)
{
    counts->edges++;
    if (count > 2) {
        note_crowded(counts, vertex, halves);
        return;
    }
    join->twin[halves[0]] = count == 2 ? halves[1] : MESO_NO_INDEX;
    counts->borders += count == 1;
    if (count == 2) {
        join->twin[halves[1]] = halves[0];
        counts->reversed += join->mesh->corners[halves[0]] == join->mesh->corners[halves[1]];
    }
}

/* `uppers` of half-edges that are joined become MESO_NO_INDEX. */
static void join_short_list(const Join *join, Counts *counts, uint32_t vertex, const uint32_t *halves, uint32_t *uppers,
                            uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t upper = uppers[i], same[3] = {halves[i]}, found = 1;
        if (upper == MESO_NO_INDEX)
            continue;
        join->twin[halves[i]] = MESO_NO_INDEX;
        for (uint32_t j = i + 1; j < count; j++) {
            if (uppers[j] != upper)
                continue;
            uppers[j] = MESO_NO_INDEX;
            join->twin[halves[j]] = MESO_NO_INDEX;
            if (found < 3)
                same[found] = halves[j];
            found++;
        }
        join_edge(join, counts, vertex, same, found);
    }
}

static void join_range(void *context, uint64_t begin, uint64_t end)
{
    const Join *join = context;
    Counts *counts = &join->counts[begin / VERTEX_GRAIN];
    uint32_t halves[SHORT_LIST], uppers[SHORT_LIST];
    for (uint32_t v = (uint32_t)begin; v < end; v++) {
        uint32_t count = 0;
        for (uint32_t h = join->list[v]; h != MESO_NO_INDEX; h = join->twin[h], count++)
            if (count < SHORT_LIST) {
                halves[count] = h;
                uppers[count] = upper_of(join, v, h);
            }
        if (count > SHORT_LIST) {
            counts->longest = count > counts->longest ? count : counts->longest;
            continue;
        }
        join_short_list(join, counts, v, halves, uppers, count);
        join->list[v] = MESO_NO_INDEX;
    }
}

/* ---- long lists ---- */

typedef struct LongLists {
    uint32_t *halves;           /* [longest] */
    uint32_t *chain;            /* [vertex_count] half-edges of the list by upper vertex, which `twin` links */
} LongLists;

static void join_long_list(const Join *join, Counts *counts, uint32_t vertex, const LongLists *scratch)
{
    uint32_t count = 0;
    for (uint32_t h = join->list[vertex]; h != MESO_NO_INDEX; h = join->twin[h])
        scratch->halves[count++] = h;
    for (uint32_t i = count; i-- > 0;) {
        uint32_t h = scratch->halves[i], *chain = &scratch->chain[upper_of(join, vertex, h)];
        join->twin[h] = *chain;
        *chain = h;
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *chain = &scratch->chain[upper_of(join, vertex, scratch->halves[i])], same[3] = {0}, found = 0;
        for (uint32_t h = *chain, next; h != MESO_NO_INDEX; h = next, found++) {
            next = join->twin[h];
            join->twin[h] = MESO_NO_INDEX;
            if (found < 3)
                same[found] = h;
        }
        *chain = MESO_NO_INDEX;
        if (found)
            join_edge(join, counts, vertex, same, found);
    }
}

/* What ranges have left: vertices whose lists are not empty. */
static MesoStatus join_long_lists(const Join *join, Counts *counts, uint32_t longest, MesoArena *arena,
                                  MesoError *error)
{
    uint32_t vertex_count = join->mesh->vertex_count;
    LongLists scratch = {MESO_NEW(arena, uint32_t, longest, error), MESO_NEW(arena, uint32_t, vertex_count, error)};
    if (!scratch.halves || !scratch.chain)
        return MESO_ERR_MEMORY;
    memset(scratch.chain, 0xff, vertex_count * sizeof *scratch.chain);
    for (uint32_t v = 0; v < vertex_count; v++)
        if (join->list[v] != MESO_NO_INDEX)
            join_long_list(join, counts, v, &scratch);
    return MESO_OK;
}

/* ---- all together ---- */

static void add_counts(MesoHalfEdges *joined, uint32_t *crowded_vertex, const Counts *counts)
{
    if (counts->crowded && (joined->crowded_count == 0 || counts->crowded_vertex < *crowded_vertex)) {
        *crowded_vertex = counts->crowded_vertex;
        memcpy(joined->crowded, counts->crowded_halves, sizeof joined->crowded);
    }
    joined->edge_count += counts->edges;
    joined->border_count += counts->borders;
    joined->reversed_count += counts->reversed;
    joined->crowded_count += counts->crowded;
}

static MesoStatus join_lists(MesoHalfEdges *joined, const Join *join, uint32_t range_count, MesoArena *arena,
                             uint32_t thread_count, MesoError *error)
{
    uint32_t longest = 0, crowded_vertex = 0;
    meso_parallel_for(thread_count, join->mesh->vertex_count, VERTEX_GRAIN, join_range, (void *)join);
    for (uint32_t r = 0; r < range_count; r++) {
        add_counts(joined, &crowded_vertex, &join->counts[r]);
        longest = join->counts[r].longest > longest ? join->counts[r].longest : longest;
    }
    if (longest == 0)
        return MESO_OK;
    Counts of_long = {0};
    MesoStatus status = join_long_lists(join, &of_long, longest, arena, error);
    add_counts(joined, &crowded_vertex, &of_long);
    return status;
}

MesoStatus meso_half_edges_join(MesoHalfEdges *joined, MesoArena *arena, const MesoPolygonMesh *mesh,
                                uint32_t thread_count, MesoError *error)
{
    uint32_t range_count = mesh->vertex_count / VERTEX_GRAIN + 1;
    *joined = (MesoHalfEdges){.twin = MESO_NEW(arena, uint32_t, mesh->corner_count, error)};
    if (!joined->twin)
        return MESO_ERR_MEMORY;
    MesoArenaMark mark = meso_arena_mark(arena);
    Join join = {.mesh = mesh, .twin = joined->twin};
    join.list = MESO_NEW(arena, uint32_t, mesh->vertex_count, error);
    join.counts = MESO_NEW(arena, Counts, range_count, error);
    MesoStatus status = join.list && join.counts ? mark_last_corners(&join, arena, error) : MESO_ERR_MEMORY;
    if (!status) {
        memset(join.list, 0xff, mesh->vertex_count * sizeof *join.list);
        list_half_edges(&join);
        status = join_lists(joined, &join, range_count, arena, thread_count, error);
    }
    meso_arena_rewind(arena, mark);
    return status;
}

MesoStatus meso_half_edges_require_manifold(const MesoHalfEdges *joined, const MesoPolygonMesh *mesh, MesoError *error)
{
    if (joined->crowded_count == 0)
        return MESO_OK;
    uint32_t faces[3], h = joined->crowded[0];
    for (uint32_t i = 0; i < 3; i++)
        faces[i] = meso_polygon_face(mesh, joined->crowded[i]);
    uint32_t begin = meso_polygon_begin(mesh, faces[0]), sides = meso_polygon_sides(mesh, faces[0]);
    uint32_t from = mesh->corners[h], to = mesh->corners[h + 1 < begin + sides ? h + 1 : begin];
    return meso_fail(error, MESO_ERR_INPUT, "edge between vertices %u and %u joins more than two faces (%u, %u, %u)",
                     (from < to ? from : to) + 1, (from < to ? to : from) + 1, faces[0] + 1, faces[1] + 1,
                     faces[2] + 1);
}
