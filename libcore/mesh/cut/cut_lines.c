#include "libcore/mesh/cut/cut_lines.h"

#include "libcore/base/grow.h"

MesoStatus meso_cut_add_node(MesoCutLines *lines, MesoArena *arena, MesoCutNode added, uint32_t *node, MesoError *error)
{
    lines->nodes = MESO_GROW(arena, lines->nodes, lines->node_count, lines->node_room, 1024, error);
    if (!lines->nodes)
        return MESO_ERR_MEMORY;
    if (node)
        *node = lines->node_count;
    lines->nodes[lines->node_count++] = added;
    return MESO_OK;
}

MesoStatus meso_cut_add_segment(MesoCutLines *lines, MesoArena *arena, MesoCutSegment added, MesoError *error)
{
    lines->segments = MESO_GROW(arena, lines->segments, lines->segment_count, lines->segment_room, 1024, error);
    if (!lines->segments)
        return MESO_ERR_MEMORY;
    lines->segments[lines->segment_count++] = added;
    return MESO_OK;
}

/* Twice as many as now at least, so that many small additions do not copy all of it each time. */
static bool reserve(void **array, MesoArena *arena, uint32_t count, uint32_t *room, uint64_t wanted, size_t size,
                    MesoError *error)
{
    if (wanted <= *room)
        return true;
    uint64_t larger = wanted < 2 * (uint64_t)*room ? 2 * (uint64_t)*room : wanted;
    larger = larger > UINT32_MAX ? UINT32_MAX : larger;
    if (wanted > larger) {
        meso_fail(error, MESO_ERR_MEMORY, "out of memory: lines of more than %u nodes or segments", UINT32_MAX);
        return false;
    }
    *array = meso_arena_enlarge(arena, *array, count, larger, size, error);
    *room = (uint32_t)larger;
    return *array != NULL;
}

MesoStatus meso_cut_lines_reserve(MesoCutLines *lines, MesoArena *arena, uint64_t node_count, uint64_t segment_count,
                                  MesoError *error)
{
    return reserve((void **)&lines->nodes, arena, lines->node_count, &lines->node_room, node_count,
                   sizeof *lines->nodes, error) &&
                   reserve((void **)&lines->segments, arena, lines->segment_count, &lines->segment_room, segment_count,
                           sizeof *lines->segments, error)
               ? MESO_OK : MESO_ERR_MEMORY;
}

MesoVec3 meso_cut_node_position(const MesoTriangulation *mesh, const MesoCutNode *node)
{
    if (node->kind == MESO_AT_VERTEX)
        return mesh->positions[node->element];
    uint32_t begin = node->kind == MESO_ON_EDGE ? node->element : 3 * node->element;
    MesoVec3 a = mesh->positions[mesh->corners[begin]];
    MesoVec3 b = mesh->positions[mesh->corners[meso_next_corner(begin)]];
    MesoVec3 p = meso_vec3_add(a, meso_vec3_scale(meso_vec3_sub(b, a), node->share[0]));
    if (node->kind == MESO_ON_EDGE)
        return p;
    MesoVec3 c = mesh->positions[mesh->corners[meso_previous_corner(begin)]];
    return meso_vec3_add(p, meso_vec3_scale(meso_vec3_sub(c, a), node->share[1]));
}
