#include "libcore/mesh/cut/border_loops.h"

#include "libcore/base/grow.h"
#include "libcore/base/index_map.h"
#include "libcore/mesh/cut/mesh_domain.h"
#include "libcore/mesh/cut/triangle_area.h"

typedef struct Finder {
    const MesoTriangulation *mesh;
    const MesoDomain *domain;
    bool slits;
    MesoBorderLoops *loops;
    uint32_t loop_room, half_edge_room, vertex_room, corner_room;
    MesoIndexMap walked;        /* half-edges that are part of a loop */
    MesoArena *arena, *scratch;
    MesoError *error;
} Finder;

/* A side with the part to its left, and whether this is against the winding of its triangle. */
typedef struct Side {
    uint32_t half_edge;
    bool turned;
} Side;

static bool is_border(const Finder *finder, uint32_t half_edge)
{
    const MesoTriangulation *mesh = finder->mesh;
    uint32_t across = meso_domain_across(finder->domain, mesh, half_edge);
    return across == MESO_NO_INDEX || (finder->slits && meso_side_is_wall(mesh, half_edge) &&
                                       mesh->labels[half_edge / 3] == mesh->labels[across / 3]);
}

static bool separates_regions(const Finder *finder, uint32_t half_edge)
{
    const MesoTriangulation *mesh = finder->mesh;
    uint32_t across = mesh->twins[half_edge];
    if (meso_domain_holds(finder->domain, mesh, half_edge / 3))
        return is_border(finder, half_edge);
    return across == MESO_NO_INDEX || mesh->labels[half_edge / 3] != mesh->labels[across / 3];
}

static bool is_corner(const Finder *finder, uint32_t vertex)
{
    MesoFan fan = meso_fan_first(finder->mesh, vertex);
    uint32_t first = fan.corner, count = 0;
    if (finder->mesh->twins[meso_fan_entry(fan)] == MESO_NO_INDEX)
        count += separates_regions(finder, meso_fan_entry(fan));
    do {
        count += separates_regions(finder, meso_fan_exit(fan));
    } while (meso_fan_next(finder->mesh, &fan) && fan.corner != first);
    return count != 2;
}

/* Around the vertex in which a side ends, through the part, to its next side. */
static Side next_side(const Finder *finder, Side side)
{
    MesoFan fan = {side.turned ? side.half_edge : meso_next_corner(side.half_edge), !side.turned};
    while (!is_border(finder, meso_fan_exit(fan)))
        meso_fan_next(finder->mesh, &fan);
    return (Side){meso_fan_exit(fan), !fan.turned};
}

static MesoStatus add_side(Finder *finder, Side side, MesoBorderLoop *loop)
{
    const MesoTriangulation *mesh = finder->mesh;
    MesoBorderLoops *loops = finder->loops;
    uint32_t n = loops->side_count;
    loops->half_edges = MESO_GROW(finder->arena, loops->half_edges, n, finder->half_edge_room, 64, finder->error);
    loops->vertices = MESO_GROW(finder->arena, loops->vertices, n, finder->vertex_room, 64, finder->error);
    loops->corners = MESO_GROW(finder->arena, loops->corners, n, finder->corner_room, 64, finder->error);
    uint32_t *walked = meso_index_map_at(&finder->walked, finder->scratch, side.half_edge, finder->error);
    if (!loops->half_edges || !loops->vertices || !loops->corners || !walked)
        return MESO_ERR_MEMORY;
    uint32_t a = mesh->corners[side.half_edge], b = mesh->corners[meso_next_corner(side.half_edge)];
    *walked = loops->loop_count;
    loops->half_edges[n] = side.half_edge;
    loops->vertices[n] = side.turned ? b : a;
    loops->corners[n] = is_corner(finder, loops->vertices[n]);
    loops->side_count++;
    loop->count++;
    loop->corner_count += loops->corners[n];
    return MESO_OK;
}

static float loop_length(const MesoTriangulation *mesh, const uint32_t *half_edges, uint32_t count)
{
    double length = 0;
    for (uint32_t i = 0; i < count; i++) {
        MesoVec3 a = mesh->positions[mesh->corners[half_edges[i]]];
        MesoVec3 b = mesh->positions[mesh->corners[meso_next_corner(half_edges[i])]];
        length += meso_vec3_length(meso_vec3_sub(a, b));
    }
    return (float)length;
}

static MesoStatus add_loop(Finder *finder, uint32_t half_edge)
{
    MesoBorderLoops *loops = finder->loops;
    MesoBorderLoop loop = {.first = loops->side_count};
    Side side = {half_edge, false};
    MesoStatus status = MESO_OK;
    do {
        status = add_side(finder, side, &loop);
        side = next_side(finder, side);
    } while (!status && side.half_edge != half_edge);
    loops->loops = MESO_GROW(finder->arena, loops->loops, loops->loop_count, finder->loop_room, 8, finder->error);
    if (status || !loops->loops)
        return MESO_ERR_MEMORY;
    loop.length = loop_length(finder->mesh, loops->half_edges + loop.first, loop.count);
    if (loops->longest == MESO_NO_INDEX || loop.length > loops->loops[loops->longest].length)
        loops->longest = loops->loop_count;
    loops->loops[loops->loop_count++] = loop;
    return MESO_OK;
}

MesoStatus meso_border_loops_find(MesoBorderLoops *loops, MesoArena *arena, const MesoTriangulation *mesh,
                                  const MesoDomain *domain, bool slits, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    *loops = (MesoBorderLoops){.longest = MESO_NO_INDEX};
    Finder finder = {.mesh = mesh, .domain = domain, .slits = slits, .loops = loops, .arena = arena,
                     .scratch = &scratch, .error = error};
    uint32_t count = meso_domain_size(domain, mesh);
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++) {
        uint32_t triangle = meso_domain_triangle(domain, i);
        loops->area += meso_triangle_area(mesh, triangle);
        for (uint32_t h = 3 * triangle; h < 3 * triangle + 3 && !status; h++)
            if (is_border(&finder, h) && meso_index_map_find(&finder.walked, h) == MESO_NO_INDEX)
                status = add_loop(&finder, h);
    }
    meso_arena_release(&scratch);
    return status;
}
