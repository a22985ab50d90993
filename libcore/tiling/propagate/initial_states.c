#include "libcore/tiling/propagate/initial_states.h"

#include <string.h>

/* Kinds of slots by their borders: a bit a side. */
enum { BORDER_KINDS = 16 };

typedef struct Builder {
    MesoDomainTable *domains;
    const MesoSlotGraph *graph;
    const uint64_t *rules[2];   /* labels on inner sides, and on borders */
    uint64_t *bits;             /* [words of a state] scratch */
} Builder;

void meso_border_labels(const MesoTileSet *set, bool border, uint64_t *labels)
{
    for (uint32_t i = 0; i < set->interface_count; i++) {
        const MesoInterface *interface = &set->interfaces[i];
        if (border ? interface->border_exempt : interface->border_only)
            continue;
        meso_bits_set(labels, 2 * i);
        meso_bits_set(labels, 2 * i + 1);
    }
}

static bool side_allows(const Builder *b, uint32_t slot, uint32_t side, const uint32_t *codes)
{
    uint32_t twin = b->graph->twin[4 * (size_t)slot + side];
    if (!meso_bits_test(b->rules[twin == MESO_NO_INDEX], codes[side]))
        return false;
    /* A side that is glued to a side of its own slot: no choice of another variant can help. */
    return twin == MESO_NO_INDEX || twin / 4 != slot || codes[twin % 4] == (codes[side] ^ 1);
}

/* State of the variants of `mask` (NULL: all) that fit `slot`. */
static uint32_t fitting_state(const Builder *b, uint32_t slot, const uint64_t *mask, MesoError *error)
{
    uint32_t count = b->domains->variant_count;
    memset(b->bits, 0, meso_bits_words(count) * sizeof *b->bits);
    for (uint32_t v = 0; v < count; v++) {
        bool fits = !mask || meso_bits_test(mask, v);
        for (uint32_t k = 0; fits && k < 4; k++)
            fits = side_allows(b, slot, k, b->domains->codes + 4 * (size_t)v);
        if (fits)
            meso_bits_set(b->bits, v);
    }
    return meso_domain_intern(b->domains, b->bits, error);
}

/* The sides of a slot that are borders, as bits; `*glued` where one is glued to another of them. */
static uint32_t border_kind(const MesoSlotGraph *graph, uint32_t slot, bool *glued)
{
    const uint32_t *twin = graph->twin + 4 * (size_t)slot;
    uint32_t borders = 0;
    *glued = false;
    for (uint32_t k = 0; k < 4; k++) {
        borders |= (uint32_t)(twin[k] == MESO_NO_INDEX) << k;
        *glued |= twin[k] != MESO_NO_INDEX && twin[k] / 4 == slot;
    }
    return borders;
}

/* Slots alike in borders and masks, and not glued to themselves, share a state. */
static MesoStatus fill_states(const Builder *b, uint32_t *state, uint32_t *dead_count, const MesoSlotMasks *masks,
                              uint32_t *by_kind, MesoError *error)
{
    uint32_t words = b->domains->states.word_count;
    memset(by_kind, 0xff, BORDER_KINDS * (size_t)masks->mask_count * sizeof *by_kind);
    for (uint32_t s = 0; s < b->graph->slot_count; s++) {
        bool glued;
        uint32_t mask = masks->slot_mask ? masks->slot_mask[s] : 0, unshared = MESO_NO_INDEX;
        uint32_t borders = border_kind(b->graph, s, &glued);
        uint32_t *known = glued ? &unshared : &by_kind[BORDER_KINDS * (size_t)mask + borders];
        if (*known == MESO_NO_INDEX)
            *known = fitting_state(b, s, masks->masks ? masks->masks + (size_t)mask * words : NULL, error);
        if (*known == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
        state[s] = *known;
        *dead_count += *known == MESO_DOMAIN_EMPTY;
    }
    return MESO_OK;
}

MesoStatus meso_initial_states(uint32_t *state, uint32_t *dead_count, MesoDomainTable *domains, MesoArena *scratch,
                               const MesoTilingProblem *problem, MesoError *error)
{
    const MesoConstraints *constraints = problem->constraints;
    MesoSlotMasks masks = {.mask_count = 1};
    MesoArenaMark mark = meso_arena_mark(scratch);
    uint32_t label_words = domains->sets.word_count;
    *dead_count = 0;
    if (constraints && constraints->restriction_count &&
        meso_slot_masks_build(&masks, scratch, constraints, problem->variants, problem->graph->slot_count, error))
        return MESO_ERR_MEMORY;
    uint64_t *inner = MESO_NEW(scratch, uint64_t, label_words, error);
    uint64_t *border = MESO_NEW(scratch, uint64_t, label_words, error);
    uint32_t *by_kind = MESO_NEW(scratch, uint32_t, BORDER_KINDS * (size_t)masks.mask_count, error);
    Builder b = {.domains = domains, .graph = problem->graph, .rules = {inner, border},
                 .bits = MESO_NEW(scratch, uint64_t, domains->states.word_count, error)};
    if (!inner || !border || !by_kind || !b.bits)
        return MESO_ERR_MEMORY;
    meso_border_labels(problem->set, false, inner);
    meso_border_labels(problem->set, true, border);
    MesoStatus status = fill_states(&b, state, dead_count, &masks, by_kind, error);
    meso_arena_rewind(scratch, mark);
    return status;
}
