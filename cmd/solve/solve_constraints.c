#include "cmd/solve/solve_constraints.h"

#include <string.h>

#include "cmd/common/input_kind.h"
#include "formats/tiling/constraints/constraints_file.h"
#include "formats/tiling/result/slots_file.h"

static MesoStatus read_file(MesoTool *tool, const char *path, const MesoConstraintScope *scope,
                            MesoConstraints *constraints)
{
    MesoInput input;
    MesoStatus status = meso_tool_open_place(tool, &input, path, &MESO_PLACE_CONSTRAINTS);
    if (status)
        return status;
    status = meso_constraints_read(constraints, &tool->arena, &input, scope, &tool->error);
    meso_input_close(&input);
    return status;
}

/* Tile of `set` that has the name of each tile of the file, or MESO_NO_INDEX; NULL: out of memory. */
static uint32_t *match_tiles(MesoTool *tool, const MesoSlotsFile *slots, const MesoTileSet *set)
{
    uint32_t *tiles = MESO_NEW(&tool->arena, uint32_t, slots->tile_count, &tool->error);
    json_t *numbers = json_object();
    bool failed = !tiles || !numbers;
    for (uint32_t t = 0; t < set->tile_count && !failed; t++)
        failed = json_object_set_new_nocheck(numbers, set->tiles[t].name, json_integer(t)) != 0;
    for (uint32_t t = 0; t < slots->tile_count && !failed; t++) {
        const json_t *number = json_object_get(numbers, slots->tile_names[t]);
        tiles[t] = number ? (uint32_t)json_integer_value(number) : MESO_NO_INDEX;
    }
    json_decref(numbers);
    if (failed)
        meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the slots to keep");
    return failed ? NULL : tiles;
}

/* Whether the face was seen from the side that it is seen from now: a tile has no other side. */
static bool is_seen_alike(const MesoSlotsFile *slots, const MesoSolveSurface *surface, uint32_t slot)
{
    return (slots->over && slots->over[slot]) == (surface->over && surface->over[slot]);
}

/* What slot `slot` of the file holds, seen from the side that is direction 0 now. */
static MesoTransform turn_to(const MesoSlotsFile *slots, const MesoSolveSurface *surface, uint32_t slot)
{
    uint32_t then = slots->quarters ? slots->quarters[slot] : 0, now = surface->quarters ? surface->quarters[slot] : 0;
    return meso_transform_compose((MesoTransform)((then - now) & 3u), slots->assignment.transform[slot]);
}

/* Slots go by number and tiles by name: what is gone, or was not there, is free. */
static MesoStatus read_keep(MesoTool *tool, const char *path, const MesoTileSet *set,
                            const MesoVariantSet *variants, const MesoSolveSurface *surface,
                            MesoConstraints *constraints)
{
    MesoInput input;
    MesoSlotsFile slots;
    MesoStatus status = meso_tool_open_place(tool, &input, path, &MESO_PLACE_KEEP);
    if (status)
        return status;
    status = meso_slots_read(&slots, &tool->arena, &input, &tool->error);
    meso_input_close(&input);
    if (status)
        return status;
    uint32_t *keep = MESO_NEW(&tool->arena, uint32_t, surface->graph.slot_count, &tool->error);
    const uint32_t *tiles = match_tiles(tool, &slots, set);
    if (!keep || !tiles)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < surface->graph.slot_count; s++) {
        bool kept = s < slots.assignment.slot_count && is_seen_alike(&slots, surface, s);
        uint32_t tile = kept ? tiles[slots.assignment.tile[s]] : MESO_NO_INDEX;
        keep[s] = tile == MESO_NO_INDEX
                      ? MESO_NO_INDEX
                      : meso_variant_find(variants, set, tile, turn_to(&slots, surface, s));
    }
    constraints->keep = keep;
    return MESO_OK;
}

MesoStatus meso_tool_read_control(MesoTool *tool, const MesoControlArguments *arguments, const MesoTileSet *set,
                                  const MesoVariantSet *variants, const MesoSolveSurface *surface,
                                  const MesoConstraints **constraints)
{
    MesoStatus status = MESO_OK;
    *constraints = NULL;
    if (!arguments->constraints && !arguments->strands && !arguments->keep)
        return MESO_OK;
    MesoConstraints *read = MESO_NEW(&tool->arena, MesoConstraints, 1, &tool->error);
    if (!read)
        return MESO_ERR_MEMORY;
    if (arguments->constraints) {
        MesoBoundary boundary;
        status = meso_boundary_build(&boundary, &tool->arena, &surface->mesh, &surface->graph, &tool->error);
        const MesoConstraintScope scope = {set, variants, &surface->graph, &boundary, &surface->file.mesh};
        if (!status)
            status = read_file(tool, arguments->constraints, &scope, read);
    }
    if (!status && arguments->strands)
        status = meso_strand_rule_parse(&read->strands, arguments->strands, &tool->error);
    if (!status && arguments->keep)
        status = read_keep(tool, arguments->keep, set, variants, surface, read);
    *constraints = read;
    return status;
}
