#include "libcore/shell/hexahedra.h"

#include <assert.h>

MesoShell meso_shell_make(const MesoQuadMesh *mesh, const MesoSlotGraph *graph,
                          float offset, float thickness)
{
    return (MesoShell){.mesh = mesh, .graph = graph, .normals = mesh->normals, .face_normals = mesh->face_normals,
                       .bottom = offset, .top = offset + 0.5f * thickness};
}

void meso_shell_cell_init(MesoShellCell *cell)
{
    *cell = (MesoShellCell){.corners = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, .up = {0, 0, 1},
                            .vertices = {0, 1, 2, 3},
                            .twins = {MESO_NO_INDEX, MESO_NO_INDEX, MESO_NO_INDEX, MESO_NO_INDEX}};
    cell->mesh = (MesoQuadMesh){.vertex_count = 4, .normal_count = 1, .face_count = 1, .positions = cell->corners,
                                .normals = &cell->up, .face_vertices = cell->vertices, .face_normals = cell->normals,
                                .mean_edge_length = 1};
    cell->graph = (MesoSlotGraph){.slot_count = 1, .edge_count = 4, .border_count = 4, .twin = cell->twins};
    cell->shell = meso_shell_make(&cell->mesh, &cell->graph, 0, 1);
}

static uint32_t corner_vertex(const MesoShell *shell, uint32_t slot, uint32_t corner)
{
    return shell->mesh->face_vertices[4 * (size_t)slot + (corner & 3)];
}

static MesoVec3 corner_position(const MesoShell *shell, uint32_t slot, uint32_t corner)
{
    return shell->mesh->positions[corner_vertex(shell, slot, corner)];
}

static MesoVec3 corner_normal(const MesoShell *shell, uint32_t slot, uint32_t corner)
{
    return shell->normals[shell->face_normals[4 * (size_t)slot + (corner & 3)]];
}

static float level_of(const MesoShell *shell, uint32_t vertex, bool top)
{
    return shell->levels ? shell->levels[2 * (size_t)vertex + top] : top ? shell->top : shell->bottom;
}

MesoVec3 meso_shell_corner(const MesoShell *shell, uint32_t slot, uint32_t corner, bool top)
{
    return meso_vec3_mad(corner_position(shell, slot, corner),
                         level_of(shell, corner_vertex(shell, slot, corner), top),
                         corner_normal(shell, slot, corner));
}

/* Equal normals stay the very same floats; opposite ones have no mean, and a face keeps its own. */
static MesoVec3 mean_normal(MesoVec3 a, MesoVec3 b)
{
    if (a.x == b.x && a.y == b.y && a.z == b.z)
        return a;
    return meso_vec3_unit(meso_vec3_add(a, b), a);
}

/* A side with its two ends, as the half-edge that speaks for the edge runs. */
typedef struct Edge {
    MesoVec3 a, b;      /* positions */
    MesoVec3 na, nb;    /* normals, of both faces */
    uint32_t va, vb;    /* vertices */
    bool reversed;      /* the asking side runs from b to a */
} Edge;

static Edge find_edge(const MesoShell *shell, uint32_t slot, uint32_t side)
{
    uint32_t half = 4 * slot + side, twin = shell->graph->twin[half];
    Edge e = {corner_position(shell, slot, side), corner_position(shell, slot, side + 1),
              corner_normal(shell, slot, side), corner_normal(shell, slot, side + 1),
              corner_vertex(shell, slot, side), corner_vertex(shell, slot, side + 1), false};
    if (twin == MESO_NO_INDEX)
        return e;

    uint32_t other = twin / 4, other_side = twin % 4;
    const uint32_t *corners = shell->mesh->face_vertices;
    bool opposed = corners[4 * (size_t)other + other_side] == corners[4 * (size_t)slot + ((side + 1) & 3)];
    if (!opposed)   /* inconsistent winding: what they draw there is not one shape */
        return e;
    e.na = mean_normal(e.na, corner_normal(shell, other, other_side + 1));
    e.nb = mean_normal(e.nb, corner_normal(shell, other, other_side));
    if (twin < half)
        e = (Edge){e.b, e.a, e.nb, e.na, e.vb, e.va, true};
    return e;
}

MesoWall meso_shell_wall(const MesoShell *shell, uint32_t slot, uint32_t side)
{
    assert(side < 4);
    Edge e = find_edge(shell, slot, side);
    MesoWall wall = {.up = meso_vec3_add(e.na, e.nb), .reversed = e.reversed};
    wall.low[0] = meso_vec3_mad(e.a, level_of(shell, e.va, false), e.na);
    wall.low[1] = meso_vec3_mad(e.b, level_of(shell, e.vb, false), e.nb);
    wall.high[0] = meso_vec3_mad(e.a, level_of(shell, e.va, true), e.na);
    wall.high[1] = meso_vec3_mad(e.b, level_of(shell, e.vb, true), e.nb);
    MesoVec3 normal = meso_vec3_cross(meso_vec3_sub(wall.high[0], wall.low[1]),
                                      meso_vec3_sub(wall.high[1], wall.low[0]));
    wall.normal = meso_vec3_direction(normal, (MesoVec3){0, 0, 0});
    return wall;
}

MesoVec3 meso_wall_point(const MesoWall *wall, float x, float y)
{
    return meso_vec3_lerp(meso_vec3_lerp(wall->low[0], wall->low[1], x),
                          meso_vec3_lerp(wall->high[0], wall->high[1], x), y);
}

void meso_wall_axes(const MesoWall *wall, MesoVec3 axes[2])
{
    MesoVec3 along = meso_vec3_add(meso_vec3_sub(wall->low[1], wall->low[0]),
                                   meso_vec3_sub(wall->high[1], wall->high[0]));
    along = meso_vec3_mad(along, -meso_vec3_dot(along, wall->normal), wall->normal);
    axes[1] = meso_vec3_direction(meso_vec3_cross(along, wall->normal), (MesoVec3){0, 0, 0});
    if (meso_vec3_dot(axes[1], wall->up) < 0)
        axes[1] = meso_vec3_scale(axes[1], -1);
    axes[0] = meso_vec3_direction(along, (MesoVec3){0, 0, 0});
}

static MesoVec3 leant(const MesoWall *wall, const MesoWallMove *move)
{
    MesoVec3 axes[2];
    if (!move || (move->lean_along == 0 && move->lean_rise == 0))
        return wall->normal;
    meso_wall_axes(wall, axes);
    MesoVec3 lean = meso_vec3_mad(meso_vec3_scale(axes[0], move->lean_along), move->lean_rise, axes[1]);
    return meso_vec3_unit(meso_vec3_add(wall->normal, lean), wall->normal);
}

MesoStatus meso_wall_port(const MesoWall *wall, uint32_t slot, uint32_t side, MesoVec2 center, bool flipped,
                          const MesoWallMove *move, MesoPort *port, MesoError *error)
{
    MesoVec2 at = meso_wall_place(wall, center, flipped);
    port->point = move ? meso_wall_point(wall, at.x + move->along, at.y + move->rise)
                       : meso_wall_point(wall, at.x, at.y);
    port->up = wall->up;
    port->inward = leant(wall, move);
    if (wall->reversed)
        port->inward = meso_vec3_scale(port->inward, -1);
    if (meso_vec3_dot(wall->normal, wall->normal) == 0 || meso_vec3_dot(port->up, port->up) == 0)
        return meso_fail(error, MESO_ERR_INPUT,
                         "slot %u: the shell has no wall on side %u (coinciding corners or opposite normals)",
                         slot, side);
    return MESO_OK;
}

MesoStatus meso_shell_wall_port(const MesoShell *shell, uint32_t slot, uint32_t side, MesoVec2 center, bool flipped,
                                const MesoWallMove *move, MesoPort *port, MesoError *error)
{
    MesoWall wall = meso_shell_wall(shell, slot, side);
    return meso_wall_port(&wall, slot, side, center, flipped, move, port, error);
}

/* Neither the point nor the flip has a say in whether there is a wall. */
static bool has_walls(const MesoShell *shell, uint32_t slot)
{
    MesoPort port;
    bool all = true;
    for (uint32_t side = 0; side < 4 && all; side++)
        all = meso_shell_wall_port(shell, slot, side, (MesoVec2){0, 0}, false, NULL, &port, NULL) == MESO_OK;
    return all;
}

uint32_t meso_shell_without_walls(const MesoShell *shell, uint32_t *slots, uint32_t room)
{
    uint32_t count = 0;
    for (uint32_t slot = 0; slot < shell->mesh->face_count; slot++) {
        if (has_walls(shell, slot))
            continue;
        if (count < room)
            slots[count] = slot;
        count++;
    }
    return count;
}

MesoCage meso_shell_cage(const MesoShell *shell, uint32_t slot)
{
    MesoCage cage = {.low = shell->bottom, .high = shell->top};
    for (uint32_t i = 0; i < 4; i++) {
        cage.base[i] = corner_position(shell, slot, i);
        cage.rise[i] = corner_normal(shell, slot, i);
    }
    if (!shell->levels)
        return cage;
    for (uint32_t i = 0; i < 4; i++) {
        cage.base[i] = meso_shell_corner(shell, slot, i, false);
        cage.rise[i] = meso_vec3_sub(meso_shell_corner(shell, slot, i, true), cage.base[i]);
    }
    cage.low = 0;
    cage.high = 1;
    return cage;
}

/* Derivative of the shell's map along the direction `along` of the unit square at `at`. */
static MesoVec3 lid_direction(const MesoCage *cage, MesoVec2 at, MesoVec2 along, float h)
{
    MesoVec3 dx = meso_vec3_sub(meso_cage_point(cage, 1, at.y, h), meso_cage_point(cage, 0, at.y, h));
    MesoVec3 dy = meso_vec3_sub(meso_cage_point(cage, at.x, 1, h), meso_cage_point(cage, at.x, 0, h));
    return meso_vec3_add(meso_vec3_scale(dx, along.x), meso_vec3_scale(dy, along.y));
}

MesoStatus meso_shell_lid_port(const MesoShell *shell, uint32_t slot, bool bottom,
                               MesoTransform transform, MesoVec2 center, bool flipped,
                               MesoPort *port, MesoError *error)
{
    float h = bottom ? 0 : 1;
    MesoVec2 in_tile = {flipped != bottom ? 1 - center.x : center.x, center.y};
    MesoVec2 at = meso_transform_point(transform, in_tile);
    MesoVec2 y_end = meso_transform_point(transform, (MesoVec2){in_tile.x, in_tile.y + 1});

    MesoCage cage = meso_shell_cage(shell, slot);
    port->point = meso_cage_point(&cage, at.x, at.y, h);
    port->up = lid_direction(&cage, at, meso_vec2_sub(y_end, at), h);
    MesoVec3 outward = meso_vec3_cross(lid_direction(&cage, at, (MesoVec2){1, 0}, h),
                                       lid_direction(&cage, at, (MesoVec2){0, 1}, h));
    MesoVec3 none = {0, 0, 0};
    port->inward = meso_vec3_direction(meso_vec3_scale(outward, bottom ? 1 : -1), none);
    if (meso_vec3_dot(port->inward, port->inward) == 0 || meso_vec3_dot(port->up, port->up) == 0)
        return meso_fail(error, MESO_ERR_INPUT, "slot %u: the shell has no %s (coinciding corners)", slot,
                         bottom ? "bottom" : "top");
    return MESO_OK;
}
