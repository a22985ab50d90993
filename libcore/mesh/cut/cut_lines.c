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
