#include "libcore/tiling/propagate/label_pattern.h"

#include <string.h>

uint32_t meso_slot_border_sides(const MesoSlotGraph *graph, uint32_t slot)
{
    uint32_t sides = 0;
    for (uint32_t k = 0; k < 4; k++)
        sides |= (uint32_t)(graph->twin[4 * (size_t)slot + k] == MESO_NO_INDEX) << k;
    return sides;
}

MesoStatus meso_label_pattern_table_init(MesoLabelPatternTable *table, MesoArena *arena,
                                   const MesoPropagation *propagation, const uint32_t *group,
                                   MesoError *error)
{
    *table = (MesoLabelPatternTable){.propagation = propagation, .group = group, .arena = arena};
    table->lists = MESO_NEW(arena, MesoLabelPatternList *, 16 * (size_t)propagation->domains.states.count,
                            error);
    return table->lists ? MESO_OK : MESO_ERR_MEMORY;
}

static void visible_codes(const MesoLabelPatternTable *table, uint32_t variant, uint32_t border,
                          uint32_t codes[4])
{
    for (uint32_t k = 0; k < 4; k++)
        codes[k] = (border >> k) & 1 ? MESO_LABEL_PATTERN_BORDER
                                     : table->propagation->codes[4 * (size_t)variant + k];
}

static bool same_pattern(const MesoLabelPatternTable *table, uint32_t a, uint32_t b, uint32_t border)
{
    uint32_t a_codes[4], b_codes[4];
    if (table->group && table->group[a] != table->group[b])
        return false;
    visible_codes(table, a, border, a_codes);
    visible_codes(table, b, border, b_codes);
    return memcmp(a_codes, b_codes, sizeof a_codes) == 0;
}

/* Pattern [size] of each of the variants [size], numbered by first appearance; returns how many. */
static uint32_t sort_out(const MesoLabelPatternTable *table, const uint32_t *variants, uint32_t size,
                         uint32_t border, uint32_t *pattern, uint32_t *first)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < size; i++) {
        uint32_t p = 0;
        while (p < count && !same_pattern(table, variants[first[p]], variants[i], border))
            p++;
        if (p == count)
            first[count++] = i;
        pattern[i] = p;
    }
    return count;
}

static MesoStatus fill(const MesoLabelPatternTable *table, MesoLabelPatternList *list, const uint32_t *variants,
                       uint32_t size, uint32_t border, uint32_t *scratch, MesoError *error)
{
    uint32_t *pattern = scratch, *first = scratch + size;
    list->count = sort_out(table, variants, size, border, pattern, first);
    list->codes = MESO_NEW(table->arena, uint32_t, 4 * (size_t)list->count, error);
    list->begin = MESO_NEW(table->arena, uint32_t, list->count + (size_t)1, error);
    list->variants = MESO_NEW(table->arena, uint32_t, size, error);
    if (!list->codes || !list->begin || !list->variants)
        return MESO_ERR_MEMORY;
    uint32_t at = 0;
    for (uint32_t p = 0; p < list->count; p++) {
        visible_codes(table, variants[first[p]], border, list->codes + 4 * (size_t)p);
        list->begin[p] = at;
        for (uint32_t i = 0; i < size; i++)
            if (pattern[i] == p)
                list->variants[at++] = variants[i];
    }
    list->begin[list->count] = at;
    return MESO_OK;
}

static MesoLabelPatternList *make_list(const MesoLabelPatternTable *table, uint32_t state, uint32_t border,
                                  MesoError *error)
{
    const MesoDomainTable *domains = &table->propagation->domains;
    uint32_t size = domains->domains[state].size;
    MesoLabelPatternList *list = MESO_NEW(table->arena, MesoLabelPatternList, 1, error);
    uint32_t *scratch = MESO_NEW(table->arena, uint32_t, 3 * (size_t)size, error);
    if (!list || !scratch)
        return NULL;
    for (uint32_t i = 0; i < size; i++)
        scratch[2 * (size_t)size + i] = meso_domain_variant(domains, state, i);
    if (fill(table, list, scratch + 2 * (size_t)size, size, border, scratch, error))
        return NULL;
    return list;
}

const MesoLabelPatternList *meso_label_pattern_list(MesoLabelPatternTable *table, uint32_t slot, MesoError *error)
{
    uint32_t state = table->propagation->initial[slot];
    uint32_t border = meso_slot_border_sides(table->propagation->graph, slot);
    MesoLabelPatternList **list = &table->lists[16 * (size_t)state + border];
    if (!*list) {
        *list = make_list(table, state, border, error);
        if (*list)
            (*list)->index = table->list_count++;
    }
    return *list;
}
