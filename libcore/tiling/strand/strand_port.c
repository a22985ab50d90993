#include "libcore/tiling/strand/strand_port.h"

float meso_slot_size(const MesoQuadMesh *mesh, uint32_t slot)
{
    const uint32_t *corners = mesh->face_vertices + 4 * (size_t)slot;
    float sum = 0;
    for (uint32_t i = 0; i < 4; i++)
        sum += meso_vec3_length(meso_vec3_sub(mesh->positions[corners[(i + 1) % 4]], mesh->positions[corners[i]]));
    return sum / 4;
}

static MesoStatus measure_slots(MesoPortFinder *finder, MesoArena *arena, MesoError *error)
{
    uint32_t count = finder->model->surface.face_count;
    if (finder->model->options.section_size == MESO_SECTION_SCENE)
        return MESO_OK;
    finder->slot_sizes = MESO_NEW(arena, float, count, error);
    for (uint32_t slot = 0; finder->slot_sizes && slot < count; slot++)
        finder->slot_sizes[slot] = meso_slot_size(&finder->model->surface, slot);
    return finder->slot_sizes ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_port_finder_make(MesoPortFinder *finder, MesoArena *arena, const MesoModel *model,
                                 const MesoShell *shell, const MesoVec2 *centers, MesoError *error)
{
    *finder = (MesoPortFinder){.model = model, .shell = shell, .centers = centers};
    MesoStatus status = measure_slots(finder, arena, error);
    if (!status && model->joints)
        status = meso_strand_joints_number(&finder->joints, arena, &model->assignment, &model->tile_set, &model->graph,
                                           error);
    return status;
}

float meso_port_size(const MesoPortFinder *finder, uint32_t slot, uint32_t tile_side)
{
    const MesoModel *model = finder->model;
    float mean = model->surface.mean_edge_length;
    if (!finder->slot_sizes || !(mean > 0))
        return 1;
    uint32_t side = meso_transform_side(model->assignment.transform[slot], tile_side);
    uint32_t other = side < 4 ? model->graph.twin[4 * (size_t)slot + side] : MESO_NO_INDEX;
    return 0.5f * (finder->slot_sizes[slot] + finder->slot_sizes[other == MESO_NO_INDEX ? slot : other / 4]) / mean;
}

bool meso_port_flipped(const MesoModel *model, uint32_t slot, uint32_t tile_side)
{
    int32_t label = model->tile_set.tiles[model->assignment.tile[slot]].labels[tile_side];
    return (label < 0) != meso_transform_flips(model->assignment.transform[slot]);
}

static MesoWallMove move_of(const MesoJointMove *joint)
{
    return (MesoWallMove){(float)joint->along / MESO_JOINT_PLACES, (float)joint->rise / MESO_JOINT_PLACES,
                          (float)joint->lean_along / MESO_JOINT_LEANS, (float)joint->lean_rise / MESO_JOINT_LEANS};
}

MesoStatus meso_port_find_by(const MesoPortFinder *finder, MesoSlotWalls *walls, uint32_t slot, uint32_t tile_side,
                             uint32_t section, MesoPort *port, MesoError *error)
{
    const MesoModel *model = finder->model;
    const MesoAssignment *a = &model->assignment;
    MesoTransform transform = a->transform[slot];
    MesoVec2 center = finder->centers[section];
    if (tile_side >= MESO_SIDE_TOP) {
        bool flipped = model->tile_set.tiles[a->tile[slot]].labels[tile_side] < 0;
        return meso_shell_lid_port(finder->shell, slot, tile_side == MESO_SIDE_BOTTOM, transform, center, flipped, port,
                                   error);
    }
    uint32_t side = meso_transform_side(transform, tile_side);
    bool flipped = meso_port_flipped(model, slot, tile_side);
    if (!walls->made[side])
        walls->walls[side] = meso_shell_wall(finder->shell, slot, side);
    walls->made[side] = true;
    if (!model->joints)
        return meso_wall_port(&walls->walls[side], slot, side, center, flipped, NULL, port, error);
    uint32_t joint = meso_strand_joint(&finder->joints, a, &model->tile_set, slot, tile_side, section);
    MesoWallMove move = move_of(&model->joints[joint]);
    return meso_wall_port(&walls->walls[side], slot, side, center, flipped, &move, port, error);
}

MesoStatus meso_port_find(const MesoPortFinder *finder, uint32_t slot, uint32_t tile_side, uint32_t section,
                          MesoPort *port, MesoError *error)
{
    MesoSlotWalls walls = {.made = {false}};
    return meso_port_find_by(finder, &walls, slot, tile_side, section, port, error);
}
