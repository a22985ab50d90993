#include "libcore/mesh/boundary.h"

#include <assert.h>

typedef struct Tracer {
    const MesoQuadMesh *mesh;
    const MesoSlotGraph *graph;
    MesoBoundary *boundary;
    uint8_t *seen;              /* [4 * face_count] border sides in a loop */
    uint32_t half_edge_count;
} Tracer;

/* The other of the two sides that meet at `vertex` in the face of `half_edge`. */
static uint32_t other_side(const MesoQuadMesh *mesh, uint32_t half_edge, uint32_t vertex)
{
    uint32_t slot = half_edge / 4, side = half_edge % 4;
    bool starts = mesh->face_vertices[half_edge] == vertex;
    return 4 * slot + ((starts ? side + 3 : side + 1) & 3);
}

static uint32_t other_end(const MesoQuadMesh *mesh, uint32_t half_edge, uint32_t vertex)
{
    uint32_t start = mesh->face_vertices[half_edge];
    uint32_t end = mesh->face_vertices[half_edge / 4 * 4 + (half_edge + 1) % 4];
    return start == vertex ? end : start;
}

/* The border side that follows around `vertex`, where `half_edge` ends. */
static uint32_t next_border(const Tracer *tracer, uint32_t half_edge, uint32_t vertex)
{
    uint32_t next = other_side(tracer->mesh, half_edge, vertex);
    while (tracer->graph->twin[next] != MESO_NO_INDEX)
        next = other_side(tracer->mesh, tracer->graph->twin[next], vertex);
    return next;
}

static void trace(Tracer *tracer, uint32_t first)
{
    MesoBoundary *boundary = tracer->boundary;
    uint32_t half_edge = first, vertex = tracer->mesh->face_vertices[first];
    boundary->loop_begin[boundary->loop_count++] = tracer->half_edge_count;
    do {
        assert(!tracer->seen[half_edge]);
        tracer->seen[half_edge] = 1;
        boundary->half_edges[tracer->half_edge_count++] = half_edge;
        vertex = other_end(tracer->mesh, half_edge, vertex);
        half_edge = next_border(tracer, half_edge, vertex);
    } while (half_edge != first);
    boundary->loop_begin[boundary->loop_count] = tracer->half_edge_count;
}

MesoStatus meso_boundary_build(MesoBoundary *boundary, MesoArena *arena, const MesoQuadMesh *mesh,
                               const MesoSlotGraph *graph, MesoError *error)
{
    assert(mesh->face_count == graph->slot_count);
    MesoArena scratch;
    Tracer tracer = {.mesh = mesh, .graph = graph, .boundary = boundary};
    *boundary = (MesoBoundary){0};
    boundary->loop_begin = MESO_NEW(arena, uint32_t, graph->border_count + (size_t)1, error);
    boundary->half_edges = MESO_NEW(arena, uint32_t, graph->border_count, error);
    meso_arena_init(&scratch);
    tracer.seen = MESO_NEW(&scratch, uint8_t, 4 * (size_t)graph->slot_count, error);
    bool ready = boundary->loop_begin && boundary->half_edges && tracer.seen;
    for (uint32_t h = 0; ready && h < 4 * graph->slot_count; h++)
        if (graph->twin[h] == MESO_NO_INDEX && !tracer.seen[h])
            trace(&tracer, h);
    meso_arena_release(&scratch);
    return ready ? MESO_OK : MESO_ERR_MEMORY;
}
