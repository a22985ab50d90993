#include "libcore/mesh/slot_graph.h"

#include <assert.h>
#include <string.h>

static MesoStatus take_edges(MesoSlotGraph *graph, const MesoHalfEdges *edges, const MesoPolygonMesh *mesh,
                             MesoError *error)
{
    *graph = (MesoSlotGraph){
        .slot_count = mesh->face_count, .edge_count = edges->edge_count, .border_count = edges->border_count,
        .reversed_count = edges->reversed_count, .twin = edges->twin};
    return meso_half_edges_require_manifold(edges, mesh, error);
}

MesoStatus meso_slot_graph_view(MesoSlotGraph *graph, const MesoSurface *surface, MesoError *error)
{
    assert(surface->mesh.side_count == 4);
    return take_edges(graph, &surface->edges, &surface->mesh, error);
}

MesoStatus meso_slot_graph_build(MesoSlotGraph *graph, MesoArena *arena,
                                 const MesoQuadMesh *mesh, MesoError *error)
{
    MesoHalfEdges edges;
    MesoPolygonMesh polygons = {
        .vertex_count = mesh->vertex_count, .positions = mesh->positions, .side_count = 4,
        .face_count = mesh->face_count, .corner_count = 4 * mesh->face_count, .corners = mesh->face_vertices};
    *graph = (MesoSlotGraph){0};
    MesoStatus status = meso_half_edges_join(&edges, arena, &polygons, 1, error);
    return status ? status : take_edges(graph, &edges, &polygons, error);
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
