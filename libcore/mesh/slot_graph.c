#include "libcore/mesh/slot_graph.h"

#include <string.h>

typedef struct Ends {
    uint32_t from, to;
} Ends;

static Ends ends_of(const MesoQuadMesh *mesh, uint32_t half_edge)
{
    uint32_t next = (half_edge & ~3u) | ((half_edge + 1) & 3u);
    return (Ends){mesh->face_vertices[half_edge], mesh->face_vertices[next]};
}

static uint32_t lower(Ends ends)
{
    return ends.from < ends.to ? ends.from : ends.to;
}

static uint32_t upper(Ends ends)
{
    return ends.from < ends.to ? ends.to : ends.from;
}

/*
 * Lists the half-edges by their lower vertex: list[v] is the first, and `next`
 * leads to the following ones, in ascending order. `list` arrives filled with
 * MESO_NO_INDEX.
 */
static void list_half_edges(const MesoQuadMesh *mesh, uint32_t *list, uint32_t *next)
{
    for (uint32_t h = 4 * mesh->face_count; h-- > 0;) {
        uint32_t v = lower(ends_of(mesh, h));
        next[h] = list[v];
        list[v] = h;
    }
}

static MesoStatus fail_third_face(const MesoQuadMesh *mesh, uint32_t a, uint32_t b, uint32_t c,
                                  MesoError *error)
{
    Ends ends = ends_of(mesh, a);
    return meso_fail(error, MESO_ERR_INPUT,
                     "edge between vertices %u and %u joins more than two faces (%u, %u, %u)",
                     lower(ends) + 1, upper(ends) + 1, a / 4 + 1, b / 4 + 1, c / 4 + 1);
}

/*
 * Pairs the half-edges of one list. `first[u]` is the half-edge met last at
 * upper vertex u, perhaps in the list of another lower vertex. The lists live
 * in `twin` itself: a half-edge leaves its list before it gets its twin.
 */
static MesoStatus pair_list(MesoSlotGraph *graph, const MesoQuadMesh *mesh, uint32_t begin,
                            uint32_t *first, MesoError *error)
{
    uint32_t next;
    for (uint32_t h = begin; h != MESO_NO_INDEX; h = next) {
        next = graph->twin[h];
        graph->twin[h] = MESO_NO_INDEX;
        Ends ends = ends_of(mesh, h);
        uint32_t *met = &first[upper(ends)];
        if (*met == MESO_NO_INDEX || lower(ends_of(mesh, *met)) != lower(ends)) {
            *met = h;
            graph->edge_count++;
            graph->border_count++;
            continue;
        }
        if (graph->twin[*met] != MESO_NO_INDEX)
            return fail_third_face(mesh, *met, graph->twin[*met], h, error);
        graph->twin[*met] = h;
        graph->twin[h] = *met;
        graph->border_count--;
        graph->reversed_count += ends_of(mesh, *met).from == ends.from;
    }
    return MESO_OK;
}

MesoStatus meso_slot_graph_build(MesoSlotGraph *graph, MesoArena *arena,
                                 const MesoQuadMesh *mesh, MesoError *error)
{
    *graph = (MesoSlotGraph){.slot_count = mesh->face_count};
    graph->twin = MESO_NEW(arena, uint32_t, (size_t)mesh->face_count * 4, error);
    if (!graph->twin)
        return MESO_ERR_MEMORY;

    MesoArenaMark mark = meso_arena_mark(arena);
    uint32_t *scratch = MESO_NEW(arena, uint32_t, (size_t)mesh->vertex_count * 2, error);
    if (!scratch)
        return MESO_ERR_MEMORY;
    memset(scratch, 0xff, (size_t)mesh->vertex_count * 2 * sizeof *scratch);
    uint32_t *list = scratch, *first = scratch + mesh->vertex_count;

    list_half_edges(mesh, list, graph->twin);
    MesoStatus status = MESO_OK;
    for (uint32_t v = 0; v < mesh->vertex_count && !status; v++)
        status = pair_list(graph, mesh, list[v], first, error);
    meso_arena_rewind(arena, mark);
    return status;
}

/*
 * Flood fill whose stack is threaded through `component` itself: a slot that
 * waits holds the one below it, so that nothing but "never seen" has to be
 * told apart.
 */
uint32_t meso_slot_graph_components(const MesoSlotGraph *graph, uint32_t *component)
{
    const uint32_t bottom = MESO_NO_INDEX - 1;
    uint32_t count = 0;
    memset(component, 0xff, (size_t)graph->slot_count * sizeof *component);
    for (uint32_t start = 0; start < graph->slot_count; start++) {
        if (component[start] != MESO_NO_INDEX)
            continue;
        component[start] = bottom;
        for (uint32_t slot = start; slot != bottom;) {
            uint32_t top = component[slot];
            component[slot] = count;
            for (uint32_t k = 0; k < 4; k++) {
                uint32_t twin = graph->twin[4 * (size_t)slot + k];
                if (twin == MESO_NO_INDEX || component[twin / 4] != MESO_NO_INDEX)
                    continue;
                component[twin / 4] = top;
                top = twin / 4;
            }
            slot = top;
        }
        count++;
    }
    return count;
}
