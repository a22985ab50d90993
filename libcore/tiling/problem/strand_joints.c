#include "libcore/tiling/problem/strand_joints.h"

uint32_t meso_strand_section_count(const MesoAssignment *assignment, const MesoTileSet *set, uint32_t slot,
                                   uint32_t side)
{
    const MesoTile *tile = &set->tiles[assignment->tile[slot]];
    int32_t label = side < 4 ? meso_tile_label(tile, assignment->transform[slot], side) : tile->labels[side];
    return label ? set->interfaces[meso_label_interface(label)].section_count : 0;
}

MesoStatus meso_strand_joints_number(MesoStrandJoints *joints, MesoArena *arena, const MesoAssignment *assignment,
                                     const MesoTileSet *set, const MesoSlotGraph *graph, MesoError *error)
{
    uint64_t count = 0;
    joints->base = MESO_NEW(arena, uint32_t, 6 * (size_t)graph->slot_count, error);
    if (!joints->base)
        return MESO_ERR_MEMORY;
    for (uint32_t slot = 0; slot < graph->slot_count; slot++)
        for (uint32_t side = 0; side < 6; side++) {
            uint32_t half_edge = 4 * slot + side;
            uint32_t twin = side < 4 ? graph->twin[half_edge] : MESO_NO_INDEX;
            size_t at = 6 * (size_t)slot + side;
            if (twin != MESO_NO_INDEX && twin < half_edge) {
                joints->base[at] = joints->base[6 * (size_t)(twin / 4) + twin % 4];
                continue;
            }
            joints->base[at] = (uint32_t)count;
            count += meso_strand_section_count(assignment, set, slot, side);
            if (count >= MESO_NO_INDEX)
                return meso_fail(error, MESO_ERR_LIMIT, "too many cross-sections for strands: over %u",
                                 MESO_NO_INDEX - 1);
        }
    joints->count = (uint32_t)count;
    return MESO_OK;
}

uint32_t meso_strand_joint(const MesoStrandJoints *joints, const MesoAssignment *assignment, const MesoTileSet *set,
                           uint32_t slot, uint32_t tile_side, uint32_t section)
{
    uint32_t place = meso_transform_side(assignment->transform[slot], tile_side);
    uint32_t first = set->interfaces[set->sections[section].interface].section_begin;
    return joints->base[6 * (size_t)slot + place] + section - first;
}
