#include "libcore/tiling/exact/exact_control.h"

#include <string.h>

enum { MOST_COUNTED = 1 << 14, MOST_CUTS = 1 << 12 };

MesoStatus meso_exact_groups(const uint32_t **group, MesoArena *arena, const MesoConstraints *constraints,
                             uint32_t variant_count, MesoError *error)
{
    bool strands = meso_strand_rule_given(&constraints->strands);
    *group = NULL;
    if (!strands && constraints->quota_count == 0)
        return MESO_OK;
    uint32_t words = meso_bits_words(constraints->quota_count);
    uint32_t *groups = MESO_NEW(arena, uint32_t, variant_count, error);
    uint64_t *membership = MESO_NEW(arena, uint64_t, words + (size_t)1, error);
    MesoInterner interner = {.word_count = words};
    if (!groups || !membership)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < variant_count; v++) {
        memset(membership, 0, words * sizeof *membership);
        for (uint32_t q = 0; q < constraints->quota_count; q++)
            if (meso_bits_test(constraints->quotas[q].variants, v))
                meso_bits_set(membership, q);
        groups[v] = strands ? v : meso_interner_add(&interner, arena, membership, error);
        if (groups[v] == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
    }
    *group = groups;
    return MESO_OK;
}

static MesoStatus add_two(MesoExact *exact, int32_t a, int32_t b, MesoError *error)
{
    int32_t literals[2] = {a, b};
    return meso_exact_add(exact, literals, 2, error);
}

/* Literals of variables are what the formula leaves open. */
static bool is_open(int32_t literal)
{
    return literal != MESO_LITERAL_TRUE && literal != -MESO_LITERAL_TRUE;
}

/*
 * Literal that holds where `slot` holds one of `variants`: a pattern's own, or a new one that is
 * equivalent to any of them. `literals` has room for all variants, and one more.
 */
static MesoStatus membership_literal(MesoExact *exact, uint32_t slot, const uint64_t *variants,
                                     int32_t *literals, int32_t *literal, MesoError *error)
{
    const MesoPropagation *propagation = exact->propagation;
    const uint64_t *bits = meso_domain_bits(&propagation->domains, propagation->initial[slot]);
    uint32_t count = 0, outside = 0;
    for (uint32_t v = 0; v < propagation->domains.variant_count; v++) {
        if (!meso_bits_test(bits, v))
            continue;
        outside += !meso_bits_test(variants, v);
        if (!meso_bits_test(variants, v))
            continue;
        int32_t own = meso_exact_literal(exact, slot, v);
        bool known = false;
        for (uint32_t i = 0; i < count; i++)
            known |= literals[i] == own;
        if (!known)
            literals[count++] = own;
    }
    *literal = count == 0 ? -MESO_LITERAL_TRUE : outside == 0 ? MESO_LITERAL_TRUE : literals[0];
    if (count <= 1 || outside == 0)
        return MESO_OK;
    *literal = meso_exact_new_variable(exact);
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++)
        status = add_two(exact, -literals[i], *literal, error);
    literals[count++] = -*literal;
    return status ? status : meso_exact_add(exact, literals, count, error);
}

static MesoStatus add_to_exact(void *context, int32_t *literals, uint32_t count, MesoError *error)
{
    return meso_exact_add(context, literals, count, error);
}

static int32_t new_in_exact(void *context)
{
    return meso_exact_new_variable(context);
}

MesoClauses meso_exact_clauses(MesoExact *exact)
{
    return (MesoClauses){add_to_exact, new_in_exact, exact};
}

/* Of the open `items` [count], room for twice as many, at least and at most so many must hold. */
static MesoStatus bound(MesoExact *exact, int32_t *items, uint32_t count, uint32_t least, uint32_t most,
                        MesoError *error)
{
    const MesoClauses clauses = meso_exact_clauses(exact);
    MesoStatus status = meso_sort_literals(&clauses, items, count, error);
    int32_t enough = least > 0 ? items[least - 1] : MESO_LITERAL_TRUE;
    int32_t not_too_many = most < count ? -items[most] : MESO_LITERAL_TRUE;
    if (!status)
        status = meso_exact_add(exact, &enough, 1, error);
    return status ? status : meso_exact_add(exact, &not_too_many, 1, error);
}

static MesoStatus add_quota(MesoExact *exact, const MesoQuota *quota, int32_t *literals, int32_t *items,
                            bool *complete, MesoError *error)
{
    uint32_t held = 0, count = 0;
    for (uint32_t s = 0; s < exact->propagation->graph->slot_count; s++) {
        int32_t literal;
        MesoStatus status = membership_literal(exact, s, quota->variants, literals, &literal, error);
        if (status)
            return status;
        held += literal == MESO_LITERAL_TRUE;
        if (is_open(literal) && count == MOST_COUNTED) {
            *complete = false;
            return MESO_OK;
        }
        if (is_open(literal))
            items[count++] = literal;
    }
    uint32_t least = quota->least > held ? quota->least - held : 0;
    if (quota->most < held || least > count)
        return meso_exact_add(exact, NULL, 0, error);
    uint32_t most = quota->most - held;
    if (least == 0 && most >= count)
        return MESO_OK;
    if (exact->variable_count + 2 * meso_sort_comparators(count) > MESO_EXACT_MOST_VARIABLES) {
        *complete = false;
        return MESO_OK;
    }
    return bound(exact, items, count, least, most, error);
}

MesoStatus meso_exact_add_quotas(MesoExact *exact, const MesoConstraints *constraints, bool *complete,
                                 MesoError *error)
{
    MesoArena arena;
    MesoStatus status = MESO_OK;
    meso_arena_init(&arena);
    int32_t *literals = MESO_NEW(&arena, int32_t, exact->propagation->domains.variant_count + (size_t)1, error);
    int32_t *items = MESO_NEW(&arena, int32_t, MOST_COUNTED, error);
    if (!literals || !items)
        status = MESO_ERR_MEMORY;
    for (uint32_t q = 0; q < constraints->quota_count && !status; q++)
        status = add_quota(exact, &constraints->quotas[q], literals, items, complete, error);
    meso_arena_release(&arena);
    return status;
}

MesoStatus meso_exact_cut_strands(MesoExact *exact, const MesoStrandRule *rule, const uint32_t *variant,
                                  const MesoVariantSet *variants, uint32_t *count, MesoError *error)
{
    const MesoPropagation *propagation = exact->propagation;
    uint32_t slots = propagation->graph->slot_count;
    MesoStrandCuts cuts = {0};
    MesoArena arena;
    meso_arena_init(&arena);
    uint32_t *tile = MESO_NEW(&arena, uint32_t, slots, error);
    MesoTransform *transform = MESO_NEW(&arena, MesoTransform, slots, error);
    MesoStatus status = tile && transform ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < slots && !status; s++) {
        tile[s] = variants->tile[variant[s]];
        transform[s] = variants->transform[variant[s]];
    }
    const MesoAssignment assignment = {slots, tile, transform};
    if (!status)
        status = meso_strands_cuts(&cuts, &arena, rule, &assignment, propagation->set, propagation->graph,
                                   MOST_CUTS, error);
    int32_t *literals = MESO_NEW(&arena, int32_t, slots, error);
    if (!status && !literals)
        status = MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < cuts.count && !status; c++) {
        uint32_t size = 0;
        for (uint32_t i = cuts.begin[c]; i < cuts.begin[c + 1]; i++)
            literals[size++] = -meso_exact_literal(exact, cuts.slots[i], variant[cuts.slots[i]]);
        status = meso_exact_add(exact, literals, size, error);
    }
    *count = cuts.count;
    meso_arena_release(&arena);
    return status;
}
