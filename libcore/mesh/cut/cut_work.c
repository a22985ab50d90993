#include "libcore/mesh/cut/cut_work.h"

static bool same_place(const MesoCutPlace *a, const MesoCutPlace *b)
{
    return a->kind == b->kind && a->kind != MESO_IN_TRIANGLE && a->element == b->element;
}

static MesoStatus sort_queue(MesoCutQueue *queue, MesoArena *arena, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(arena);
    uint64_t *spare = MESO_NEW(arena, uint64_t, queue->count, error);
    if (!spare)
        return MESO_ERR_MEMORY;
    meso_cut_sort(queue->keys, spare, queue->count);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

static MesoStatus list_sides(MesoCutQueue *sides, const MesoTriangulation *mesh, const MesoCutNodes *nodes,
                             MesoArena *arena, MesoError *error)
{
    sides->keys = MESO_NEW(arena, uint64_t, 2 * (size_t)nodes->edge_count, error);
    if (!sides->keys)
        return MESO_ERR_MEMORY;
    for (uint32_t e = 0; e < nodes->edge_count; e++) {
        uint32_t h = nodes->edges[e].half_edge;
        sides->keys[sides->count++] = meso_cut_key(h, e);
        if (mesh->twins[h] != MESO_NO_INDEX)
            sides->keys[sides->count++] = meso_cut_key(mesh->twins[h], e);
    }
    return sort_queue(sides, arena, error);
}

/* The triangle on the other side of the segment, where that is a side of its triangle; MESO_NO_INDEX otherwise. */
static uint32_t triangle_across(const MesoTriangulation *mesh, const MesoCutNodes *nodes, const MesoCutSegment *segment)
{
    const MesoCutPlace *a = &nodes->places[segment->node[0]], *b = &nodes->places[segment->node[1]];
    if (a->kind != MESO_AT_VERTEX || b->kind != MESO_AT_VERTEX)
        return MESO_NO_INDEX;
    for (uint32_t h = 3 * segment->triangle; h < 3 * segment->triangle + 3; h++) {
        uint32_t begin = mesh->corners[h], end = mesh->corners[meso_next_corner(h)];
        if ((begin == a->element && end == b->element) || (begin == b->element && end == a->element))
            return mesh->twins[h] == MESO_NO_INDEX ? MESO_NO_INDEX : mesh->twins[h] / 3;
    }
    return MESO_NO_INDEX;
}

static MesoStatus list_segments(MesoCutWork *work, const MesoTriangulation *mesh, const MesoCutLines *lines,
                                const MesoCutNodes *nodes, MesoError *error)
{
    for (uint32_t s = 0; s < lines->segment_count; s++) {
        const MesoCutSegment *segment = &lines->segments[s];
        if (segment->triangle >= mesh->triangle_count || segment->node[0] >= lines->node_count ||
            segment->node[1] >= lines->node_count)
            return meso_fail(error, MESO_ERR_INTERNAL, "segment %u of the lines has no triangle or no ends", s);
        if (same_place(&nodes->places[segment->node[0]], &nodes->places[segment->node[1]]))
            continue;
        work->segments.keys[work->segments.count++] = meso_cut_key(segment->triangle, s);
        uint32_t across = triangle_across(mesh, nodes, segment);
        if (across != MESO_NO_INDEX)
            work->inner.keys[work->inner.count++] = meso_cut_key(across, MESO_NO_INDEX);
    }
    return MESO_OK;
}

MesoStatus meso_cut_work_list(MesoCutWork *work, const MesoTriangulation *mesh, const MesoCutLines *lines,
                              const MesoCutNodes *nodes, MesoArena *arena, MesoError *error)
{
    *work = (MesoCutWork){0};
    work->segments.keys = MESO_NEW(arena, uint64_t, lines->segment_count, error);
    work->inner.keys = MESO_NEW(arena, uint64_t, (size_t)lines->node_count + lines->segment_count, error);
    if (!work->segments.keys || !work->inner.keys)
        return MESO_ERR_MEMORY;
    for (uint32_t n = 0; n < lines->node_count; n++)
        if (nodes->places[n].kind == MESO_IN_TRIANGLE)
            work->inner.keys[work->inner.count++] = meso_cut_key(nodes->places[n].element, n);
    MesoStatus status = list_segments(work, mesh, lines, nodes, error);
    if (!status)
        status = list_sides(&work->sides, mesh, nodes, arena, error);
    if (!status)
        status = sort_queue(&work->segments, arena, error);
    return status ? status : sort_queue(&work->inner, arena, error);
}

/* ---- going through it ---- */

bool meso_cut_work_next(const MesoCutWork *work, uint32_t *triangle)
{
    uint32_t side = meso_cut_next(&work->sides), segment = meso_cut_next(&work->segments);
    uint32_t inner = meso_cut_next(&work->inner);
    uint32_t first = side == MESO_NO_INDEX ? side : side / 3;
    first = segment < first ? segment : first;
    *triangle = inner < first ? inner : first;
    return *triangle != MESO_NO_INDEX;
}

uint32_t meso_cut_work_count(const MesoCutWork *work)
{
    MesoCutWork rest = *work;
    uint32_t count = 0, triangle, value;
    for (; meso_cut_work_next(&rest, &triangle); count++) {
        for (uint32_t k = 0; k < 3; k++)
            meso_cut_take(&rest.sides, 3 * triangle + k, &value);
        while (meso_cut_take(&rest.segments, triangle, &value))
            continue;
        while (meso_cut_take(&rest.inner, triangle, &value))
            continue;
    }
    return count;
}
