#include "libcore/tiling/problem/assignment.h"

#include <stdio.h>

/* "'name'", or "'name' flipped" for a negative label. */
static void describe_label(const MesoTileSet *set, int32_t label, char out[96])
{
    if (label == 0)
        snprintf(out, 96, "nothing");
    else
        snprintf(out, 96, "'%.60s'%s", set->interfaces[meso_label_interface(label)].name,
                 label < 0 ? " flipped" : "");
}

static int32_t label_at(const MesoAssignment *assignment, const MesoTileSet *set, uint32_t half_edge)
{
    uint32_t slot = half_edge / 4;
    return meso_tile_label(&set->tiles[assignment->tile[slot]], assignment->transform[slot],
                           half_edge % 4);
}

static MesoStatus check_tile(const MesoAssignment *assignment, const MesoTileSet *set,
                             uint32_t slot, MesoError *error)
{
    uint32_t tile = assignment->tile[slot];
    uint32_t transform = assignment->transform[slot];
    if (tile >= set->tile_count)
        return meso_fail(error, MESO_ERR_INPUT, "slot %u: no tile %u; the set has %u", slot, tile,
                         set->tile_count);
    if (set->tiles[tile].ignored)
        return meso_fail(error, MESO_ERR_INPUT, "slot %u: tile '%s' is marked as ignored", slot,
                         set->tiles[tile].name);
    if (transform >= MESO_TRANSFORM_COUNT ||
        !meso_tile_allows(&set->tiles[tile], (MesoTransform)transform))
        return meso_fail(error, MESO_ERR_INPUT, "slot %u: tile '%s' does not allow transform %u",
                         slot, set->tiles[tile].name, transform);
    return MESO_OK;
}

static MesoStatus check_border_side(const MesoTileSet *set, int32_t label, uint32_t half_edge,
                                    MesoError *error)
{
    if (label == 0 || !set->interfaces[meso_label_interface(label)].border_exempt)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_INPUT,
                     "slot %u, side %u: interface '%s' must not lie on a border", half_edge / 4,
                     half_edge % 4, set->interfaces[meso_label_interface(label)].name);
}

static MesoStatus check_inner_side(const MesoTileSet *set, int32_t label, int32_t other,
                                   uint32_t half_edge, uint32_t twin, MesoError *error)
{
    if (label != 0 && set->interfaces[meso_label_interface(label)].border_only)
        return meso_fail(error, MESO_ERR_INPUT,
                         "slot %u, side %u: interface '%s' may lie on a border only",
                         half_edge / 4, half_edge % 4,
                         set->interfaces[meso_label_interface(label)].name);
    if (label == -other)
        return MESO_OK;
    char own[96], across[96];
    describe_label(set, label, own);
    describe_label(set, other, across);
    return meso_fail(error, MESO_ERR_INPUT,
                     "slot %u, side %u: shows %s, but slot %u, side %u shows %s", half_edge / 4,
                     half_edge % 4, own, twin / 4, twin % 4, across);
}

MesoStatus meso_assignment_check(const MesoAssignment *assignment, const MesoTileSet *set,
                                 const MesoSlotGraph *graph, MesoError *error)
{
    if (assignment->slot_count != graph->slot_count)
        return meso_fail(error, MESO_ERR_INPUT,
                         "the assignment has %u slots, but the surface has %u faces",
                         assignment->slot_count, graph->slot_count);

    MesoStatus status = MESO_OK;
    for (uint32_t slot = 0; slot < graph->slot_count && !status; slot++)
        status = check_tile(assignment, set, slot, error);

    for (uint32_t h = 0; h < 4 * graph->slot_count && !status; h++) {
        int32_t label = label_at(assignment, set, h);
        uint32_t twin = graph->twin[h];
        if (twin == MESO_NO_INDEX)
            status = check_border_side(set, label, h, error);
        else
            status = check_inner_side(set, label, label_at(assignment, set, twin), h, twin, error);
    }
    return status;
}
