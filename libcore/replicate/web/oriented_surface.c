#include "libcore/replicate/web/oriented_surface.h"

/* The half-edge that a surface's becomes. */
static uint32_t side_of(const uint8_t *turned, uint32_t h)
{
    return turned[h / 3] ? h / 3 * 3 + 2 - h % 3 : h;
}

/* Whether the triangles at a side are wound against each other, if one of them is turned and the other not. */
static bool is_cut(const MesoTriangulation *mesh, const uint8_t *turned, uint32_t h)
{
    uint32_t across = mesh->twins[h];
    bool against = mesh->corners[across] == mesh->corners[h];
    return (turned[h / 3] != turned[across / 3]) != against;
}

/* Winds all triangles of a part as the first of it, as they are reached. */
static void wind(uint8_t *turned, uint8_t *seen, uint32_t *queue, const MesoTriangulation *mesh)
{
    for (uint32_t root = 0; root < mesh->triangle_count; root++) {
        uint32_t begin = 0, end = 0;
        if (!seen[root])
            queue[end++] = root;
        seen[root] = 1;
        while (begin < end) {
            uint32_t t = queue[begin++];
            for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
                uint32_t across = mesh->twins[h];
                if (across == MESO_NO_INDEX || seen[across / 3])
                    continue;
                seen[across / 3] = 1;
                turned[across / 3] = turned[t] ^ (mesh->corners[across] == mesh->corners[h]);
                queue[end++] = across / 3;
            }
        }
    }
}

/* Half-edges of one fan begin at one node: its first at the vertex is that, others are new. */
static void assign_fan(MesoOrientedSurface *out, bool *assigned, uint32_t h, uint32_t node)
{
    uint32_t first = h;
    for (; h != MESO_NO_INDEX && !assigned[h]; h = out->twins[meso_previous_corner(h)]) {
        assigned[h] = true;
        out->corners[h] = node;
    }
    for (h = out->twins[first]; h != MESO_NO_INDEX; h = out->twins[h]) {
        h = meso_next_corner(h);
        if (assigned[h])
            break;
        assigned[h] = true;
        out->corners[h] = node;
    }
}

static MesoStatus assign_nodes(MesoOrientedSurface *out, MesoArena *arena, const MesoTriangulation *mesh, uint32_t cuts,
                               MesoError *error)
{
    uint32_t count = 3 * mesh->triangle_count, room = mesh->vertex_count + 2 * cuts;
    bool *assigned = MESO_NEW(arena, bool, count, error), *used = MESO_NEW(arena, bool, mesh->vertex_count, error);
    out->vertices = MESO_NEW(arena, uint32_t, room, error);
    if (!assigned || !used || !out->vertices)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        out->vertices[v] = v;
    out->node_count = mesh->vertex_count;
    for (uint32_t h = 0; h < count; h++) {
        uint32_t vertex = out->corners[h];
        if (assigned[h])
            continue;
        uint32_t node = used[vertex] ? out->node_count++ : vertex;
        used[vertex] = true;
        out->vertices[node] = vertex;
        assign_fan(out, assigned, h, node);
    }
    return MESO_OK;
}

MesoStatus meso_orient_surface(MesoOrientedSurface *out, MesoArena *arena, const MesoTriangulation *mesh,
                               MesoError *error)
{
    uint32_t count = 3 * mesh->triangle_count, cuts = 0;
    uint8_t *turned = MESO_NEW(arena, uint8_t, mesh->triangle_count, error);
    uint8_t *seen = MESO_NEW(arena, uint8_t, mesh->triangle_count, error);
    uint32_t *queue = MESO_NEW(arena, uint32_t, mesh->triangle_count, error);
    *out = (MesoOrientedSurface){.corners = MESO_NEW(arena, uint32_t, count, error),
                                 .twins = MESO_NEW(arena, uint32_t, count, error)};
    if (!turned || !seen || !queue || !out->corners || !out->twins)
        return MESO_ERR_MEMORY;
    wind(turned, seen, queue, mesh);
    for (uint32_t h = 0; h < count; h++) {
        bool cut = mesh->twins[h] != MESO_NO_INDEX && is_cut(mesh, turned, h);
        uint32_t side = side_of(turned, h);
        out->corners[side] = mesh->corners[turned[h / 3] ? meso_next_corner(h) : h];
        out->twins[side] = cut || mesh->twins[h] == MESO_NO_INDEX ? MESO_NO_INDEX : side_of(turned, mesh->twins[h]);
        cuts += cut;
    }
    return assign_nodes(out, arena, mesh, cuts, error);
}
