#include "libcore/tiling/problem/constraints.h"

#include <assert.h>
#include <string.h>

#include "libcore/base/bits.h"
#include "libcore/base/interner.h"

const char *meso_constraint_name(const MesoConstraints *constraints, uint32_t number)
{
    if (number < constraints->restriction_count)
        return constraints->restrictions[number].name;
    number -= constraints->restriction_count;
    return number < constraints->quota_count ? constraints->quotas[number].name : "the rule on strands";
}

/* Masks under construction. The last step is kept: places mostly come in runs of like ones. */
typedef struct MaskBuilder {
    MesoInterner interner;
    MesoArena *arena;
    const MesoVariantSet *variants;
    uint32_t *slot_mask;
    uint64_t *scratch;
    uint32_t last_side, last_from, last_to;
} MaskBuilder;

/* The part of mask `from` that `restriction` allows, seen from side `side` where it is sided. */
static uint32_t restrict_mask(MaskBuilder *builder, const MesoRestriction *restriction,
                              uint32_t side, uint32_t from, MesoError *error)
{
    if (from == builder->last_from && side == builder->last_side)
        return builder->last_to;
    uint32_t words = builder->interner.word_count;
    memcpy(builder->scratch, meso_interner_bits(&builder->interner, from), words * sizeof *builder->scratch);
    if (!restriction->sided)
        for (uint32_t w = 0; w < words; w++)
            builder->scratch[w] &= restriction->allowed[w];
    for (uint32_t v = 0; restriction->sided && v < builder->variants->count; v++)
        if (!meso_bits_test(restriction->allowed,
                            meso_label_code(builder->variants->labels[4 * (size_t)v + side])))
            meso_bits_clear(builder->scratch, v);
    builder->last_side = side;
    builder->last_from = from;
    builder->last_to = meso_interner_add(&builder->interner, builder->arena, builder->scratch, error);
    return builder->last_to;
}

static MesoStatus apply_restriction(MaskBuilder *builder, const MesoRestriction *restriction,
                                    MesoError *error)
{
    builder->last_from = MESO_NO_INDEX;
    for (uint32_t i = 0; i < restriction->place_count; i++) {
        uint32_t place = restriction->places[i];
        uint32_t *mask = &builder->slot_mask[restriction->sided ? place / 4 : place];
        *mask = restrict_mask(builder, restriction, restriction->sided ? place % 4 : 0, *mask, error);
        if (*mask == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

MesoStatus meso_slot_masks_build(MesoSlotMasks *masks, MesoArena *arena,
                                 const MesoConstraints *constraints,
                                 const MesoVariantSet *variants, uint32_t slot_count,
                                 MesoError *error)
{
    uint32_t words = meso_bits_words(variants->count);
    MaskBuilder builder = {.interner = {.word_count = words}, .arena = arena, .variants = variants};
    builder.slot_mask = MESO_NEW(arena, uint32_t, slot_count, error);
    builder.scratch = MESO_NEW(arena, uint64_t, words, error);
    if (!builder.slot_mask || !builder.scratch)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < variants->count; v++)
        meso_bits_set(builder.scratch, v);
    if (meso_interner_add(&builder.interner, arena, builder.scratch, error) == MESO_NO_INDEX)
        return MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < constraints->restriction_count; r++)
        if (apply_restriction(&builder, &constraints->restrictions[r], error))
            return MESO_ERR_MEMORY;
    *masks = (MesoSlotMasks){builder.interner.count, builder.interner.bits, builder.slot_mask};
    return MESO_OK;
}

static MesoStatus check_place(const MesoRestriction *restriction, uint32_t place,
                              const MesoAssignment *assignment, const MesoTileSet *set,
                              const MesoVariantSet *variants, MesoError *error)
{
    uint32_t slot = restriction->sided ? place / 4 : place;
    const MesoTile *tile = &set->tiles[assignment->tile[slot]];
    if (restriction->sided) {
        int32_t label = meso_tile_label(tile, assignment->transform[slot], place % 4);
        if (meso_bits_test(restriction->allowed, meso_label_code(label)))
            return MESO_OK;
        return meso_fail(error, MESO_ERR_INPUT, "%s does not hold: slot %u, side %u shows '%s%s'",
                         restriction->name, slot, place % 4,
                         set->interfaces[meso_label_interface(label)].name, meso_label_mark(label));
    }
    uint32_t variant = meso_variant_find(variants, set, assignment->tile[slot], assignment->transform[slot]);
    if (variant != MESO_NO_INDEX && meso_bits_test(restriction->allowed, variant))
        return MESO_OK;
    return meso_fail(error, MESO_ERR_INPUT, "%s does not hold: slot %u has tile '%s' under transform %u",
                     restriction->name, slot, tile->name, assignment->transform[slot]);
}

static MesoStatus check_quota(const MesoQuota *quota, const MesoAssignment *assignment,
                              const MesoTileSet *set, const MesoVariantSet *variants, MesoError *error)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < assignment->slot_count; s++) {
        uint32_t variant = meso_variant_find(variants, set, assignment->tile[s], assignment->transform[s]);
        count += variant != MESO_NO_INDEX && meso_bits_test(quota->variants, variant);
    }
    if (count >= quota->least && count <= quota->most)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_INPUT, "%s does not hold: used in %u slots, not %u to %u",
                     quota->name, count, quota->least, quota->most);
}

MesoStatus meso_constraints_check(const MesoConstraints *constraints,
                                  const MesoAssignment *assignment, const MesoTileSet *set,
                                  const MesoVariantSet *variants, const MesoSlotGraph *graph,
                                  MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t r = 0; r < constraints->restriction_count; r++) {
        const MesoRestriction *restriction = &constraints->restrictions[r];
        for (uint32_t i = 0; i < restriction->place_count && !status; i++)
            status = check_place(restriction, restriction->places[i], assignment, set, variants, error);
    }
    for (uint32_t q = 0; q < constraints->quota_count && !status; q++)
        status = check_quota(&constraints->quotas[q], assignment, set, variants, error);
    if (!status && meso_strand_rule_given(&constraints->strands))
        status = meso_strands_check(&constraints->strands, assignment, set, graph, error);
    return status;
}

uint32_t meso_constraints_changed(const MesoConstraints *constraints,
                                  const MesoAssignment *assignment,
                                  const MesoVariantSet *variants)
{
    uint32_t changed = 0;
    for (uint32_t s = 0; constraints->keep && s < assignment->slot_count; s++) {
        uint32_t variant = constraints->keep[s];
        changed += variant != MESO_NO_INDEX && (variants->tile[variant] != assignment->tile[s] ||
                                                variants->transform[variant] != assignment->transform[s]);
    }
    return changed;
}
