#include "libcore/tiling/exact/exact.h"

#include <assert.h>
#include <string.h>

/*
 * One of `count` choices whose variables begin at `first`: none is needed for
 * one choice, one for two.
 */
static int32_t choice_literal(uint32_t first, uint32_t count, uint32_t rank)
{
    if (count == 1)
        return MESO_LITERAL_TRUE;
    if (count == 2)
        return rank == 0 ? (int32_t)first : -(int32_t)first;
    return (int32_t)(first + rank);
}

static uint32_t choice_variables(uint32_t count)
{
    return count < 3 ? count - 1 : count;
}

int32_t meso_exact_label_literal(const MesoExact *exact, uint32_t slot, uint32_t side, uint32_t code)
{
    uint32_t half_edge = 4 * slot + side;
    uint32_t twin = exact->propagation->graph->twin[half_edge];
    assert(twin != MESO_NO_INDEX);
    /* The edge is known by its lower half-edge and by what the far side shows. */
    uint32_t lower = half_edge < twin ? half_edge : twin;
    uint32_t far_code = half_edge < twin ? code ^ 1 : code;
    const uint64_t *labels = meso_propagation_labels(exact->propagation, lower);
    if (!meso_bits_test(labels, far_code))
        return -MESO_LITERAL_TRUE;
    uint32_t count = meso_bits_count(labels, exact->propagation->domains.sets.word_count);
    return choice_literal(exact->edge_first[lower], count, meso_bits_rank(labels, far_code));
}

int32_t meso_exact_new_variable(MesoExact *exact)
{
    return (int32_t)++exact->variable_count;
}

MesoStatus meso_exact_add(MesoExact *exact, int32_t *literals, uint32_t count, MesoError *error)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (literals[i] == MESO_LITERAL_TRUE)
            return MESO_OK;
        if (literals[i] != -MESO_LITERAL_TRUE)
            literals[kept++] = literals[i];
    }
    exact->clause_count++;
    if (exact->clause)
        exact->clause(exact->context, literals, kept);
    return meso_sat_add(exact->sat, literals, kept, error);
}

/* Exactly one of `count` choices; with two, their variable says so already. */
static MesoStatus add_one_of(MesoExact *exact, uint32_t first, uint32_t count, bool at_most,
                             int32_t *literals, MesoError *error)
{
    if (count < 3)
        return MESO_OK;
    for (uint32_t i = 0; i < count; i++)
        literals[i] = choice_literal(first, count, i);
    MesoStatus status = meso_exact_add(exact, literals, count, error);
    for (uint32_t i = 0; at_most && i < count && !status; i++)
        for (uint32_t j = i + 1; j < count && !status; j++) {
            int32_t pair[2] = {-choice_literal(first, count, i), -choice_literal(first, count, j)};
            status = meso_exact_add(exact, pair, 2, error);
        }
    return status;
}

static MesoStatus number_variables(MesoExact *exact, MesoError *error)
{
    const MesoPropagation *propagation = exact->propagation;
    uint64_t next = 1;
    for (uint32_t s = 0; s < propagation->graph->slot_count; s++) {
        const MesoLabelPatternList *list = meso_label_pattern_list(&exact->patterns, s, error);
        if (!list)
            return MESO_ERR_MEMORY;
        assert(list->count > 0);
        exact->slot_first[s] = (uint32_t)next;
        next += choice_variables(list->count);
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t h = 4 * s + k, twin = propagation->graph->twin[h];
            if (twin == MESO_NO_INDEX || twin < h)
                continue;
            exact->edge_first[h] = (uint32_t)next;
            next += choice_variables(meso_propagation_label_count(propagation, h));
        }
        if (next > MESO_EXACT_MOST_VARIABLES)
            return meso_fail(error, MESO_ERR_LIMIT, "too many slots and tiles for the exact engine");
    }
    exact->variable_count = (uint32_t)(next - 1);
    return MESO_OK;
}

/* A label on a side implies that one of the patterns with it is there. */
static MesoStatus add_supports(MesoExact *exact, uint32_t slot, uint32_t side,
                               const MesoLabelPatternList *list, int32_t *literals, bool *told,
                               MesoError *error)
{
    memset(told, 0, list->count * sizeof *told);
    for (uint32_t p = 0; p < list->count; p++) {
        if (told[p])
            continue;
        uint32_t code = list->codes[4 * (size_t)p + side], count = 0;
        literals[count++] = -meso_exact_label_literal(exact, slot, side, code);
        for (uint32_t q = p; q < list->count; q++)
            if (list->codes[4 * (size_t)q + side] == code) {
                told[q] = true;
                literals[count++] = choice_literal(exact->slot_first[slot], list->count, q);
            }
        MesoStatus status = meso_exact_add(exact, literals, count, error);
        if (status)
            return status;
    }
    return MESO_OK;
}

static MesoStatus add_slot(MesoExact *exact, uint32_t slot, int32_t *literals, bool *told,
                           MesoError *error)
{
    const MesoLabelPatternList *list = meso_label_pattern_list(&exact->patterns, slot, error);
    if (!list)
        return MESO_ERR_MEMORY;
    if (list->count == 1)
        return MESO_OK;
    uint32_t first = exact->slot_first[slot];
    /* That no two patterns hold follows from their labels, unless a group tells them apart. */
    MesoStatus status = add_one_of(exact, first, list->count, exact->patterns.group != NULL, literals, error);
    for (uint32_t k = 0; k < 4 && !status; k++) {
        if (list->codes[k] == MESO_LABEL_PATTERN_BORDER)
            continue;
        for (uint32_t p = 0; p < list->count && !status; p++) {
            int32_t implies[2] = {-choice_literal(first, list->count, p),
                                  meso_exact_label_literal(exact, slot, k, list->codes[4 * (size_t)p + k])};
            status = meso_exact_add(exact, implies, 2, error);
        }
        if (!status)
            status = add_supports(exact, slot, k, list, literals, told, error);
    }
    return status;
}

static MesoStatus add_clauses(MesoExact *exact, MesoError *error)
{
    const MesoPropagation *propagation = exact->propagation;
    uint32_t most = propagation->domains.variant_count + 1;
    uint32_t label_count = 2 * propagation->set->interface_count;
    most = most > label_count ? most : label_count;
    int32_t *literals = MESO_NEW(exact->arena, int32_t, most, error);
    bool *told = MESO_NEW(exact->arena, bool, most, error);
    if (!literals || !told)
        return MESO_ERR_MEMORY;
    MesoStatus status = MESO_OK;
    for (uint32_t s = 0; s < propagation->graph->slot_count && !status; s++) {
        status = add_slot(exact, s, literals, told, error);
        for (uint32_t k = 0; k < 4 && !status; k++) {
            uint32_t h = 4 * s + k, twin = propagation->graph->twin[h];
            if (twin == MESO_NO_INDEX || twin < h)
                continue;
            uint32_t count = meso_propagation_label_count(propagation, h);
            status = add_one_of(exact, exact->edge_first[h], count, true, literals, error);
        }
    }
    return status;
}

/* The chain's bit is equivalent to a set of labels on each of its edges. */
static MesoStatus add_link(MesoExact *exact, const MesoChainLink *link, MesoError *error)
{
    uint32_t count = meso_propagation_label_count(exact->propagation, link->edge);
    int32_t bit = (int32_t)(exact->chain_first + link->chain);
    MesoStatus status = MESO_OK;
    for (uint32_t r = 0; r < count && !status; r++) {
        bool holds = (link->ranks >> r & 1) != link->negated;
        int32_t implies[2] = {-choice_literal(exact->edge_first[link->edge], count, r), holds ? bit : -bit};
        status = meso_exact_add(exact, implies, 2, error);
    }
    return status;
}

static MesoStatus add_chains(MesoExact *exact, MesoError *error)
{
    MesoEdgeChains *chains = &exact->chains;
    MesoStatus status = meso_edge_chains_find(chains, exact->arena, &exact->patterns, error);
    if (status)
        return status;
    exact->chain_first = exact->variable_count + 1;
    exact->chain_count = chains->chain_count;
    exact->variable_count += chains->chain_count;
    exact->chain_length = MESO_NEW(exact->arena, uint32_t, chains->chain_count, error);
    if (!exact->chain_length)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < chains->link_count && !status; i++) {
        exact->chain_length[chains->links[i].chain]++;
        status = add_link(exact, &chains->links[i], error);
    }
    for (uint32_t c = 0; c < chains->chain_count && !status; c++)
        status = meso_sat_freeze(exact->sat, (int32_t)(exact->chain_first + c), error);
    return status;
}

MesoStatus meso_exact_init(MesoExact *exact, MesoArena *arena, const MesoPropagation *propagation,
                           const MesoExactOptions *options, MesoError *error)
{
    uint32_t slot_count = propagation->graph->slot_count;
    *exact = (MesoExact){.propagation = propagation,
                         .constraints = options->constraints, .arena = arena,
                         .clause = options->clause, .context = options->context};
    MesoStatus status = meso_sat_init(&exact->sat, options->proof, options->context, error);
    if (!status && options->proof && options->grows)
        status = meso_sat_expect_clauses(exact->sat, error);
    if (!status)
        status = meso_label_pattern_table_init(&exact->patterns, arena, propagation, options->group, error);
    if (status)
        return status;
    exact->edge_first = MESO_NEW(arena, uint32_t, 4 * (size_t)slot_count, error);
    exact->slot_first = MESO_NEW(arena, uint32_t, slot_count, error);
    if (!exact->edge_first || !exact->slot_first)
        return MESO_ERR_MEMORY;
    status = number_variables(exact, error);
    if (!status)
        status = add_clauses(exact, error);
    return status || !options->chains ? status : add_chains(exact, error);
}

void meso_exact_release(MesoExact *exact)
{
    meso_sat_release(exact->sat);
}

static uint32_t pattern_of_variant(const MesoLabelPatternList *list, uint32_t variant)
{
    for (uint32_t p = 0; p < list->count; p++)
        for (uint32_t i = list->begin[p]; i < list->begin[p + 1]; i++)
            if (list->variants[i] == variant)
                return p;
    return MESO_NO_INDEX;
}

int32_t meso_exact_literal(MesoExact *exact, uint32_t slot, uint32_t variant)
{
    /* Every list was made when the variables were numbered. */
    const MesoLabelPatternList *list = meso_label_pattern_list(&exact->patterns, slot, NULL);
    assert(list);
    uint32_t pattern = pattern_of_variant(list, variant);
    if (pattern == MESO_NO_INDEX)
        return -MESO_LITERAL_TRUE;
    return choice_literal(exact->slot_first[slot], list->count, pattern);
}

/* Prefers choice `rank` of `count`. */
static MesoStatus prefer(MesoExact *exact, uint32_t first, uint32_t count, uint32_t rank, MesoError *error)
{
    MesoStatus status = MESO_OK;
    if (count == 2)
        return meso_sat_phase(exact->sat, choice_literal(first, 2, rank), error);
    for (uint32_t i = 0; count > 2 && i < count && !status; i++) {
        int32_t literal = choice_literal(first, count, i);
        status = meso_sat_phase(exact->sat, i == rank ? literal : -literal, error);
    }
    return status;
}

static MesoStatus prefer_labels(MesoExact *exact, uint32_t slot, const uint32_t *codes, MesoError *error)
{
    const MesoPropagation *propagation = exact->propagation;
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 4 && !status; k++) {
        uint32_t h = 4 * slot + k, twin = propagation->graph->twin[h];
        if (twin == MESO_NO_INDEX || twin < h)
            continue;
        const uint64_t *labels = meso_propagation_labels(propagation, h);
        uint32_t count = meso_bits_count(labels, propagation->domains.sets.word_count);
        status = prefer(exact, exact->edge_first[h], count, meso_bits_rank(labels, codes[k] ^ 1), error);
    }
    return status;
}

/* A variant of `bits`, by weight. */
static uint32_t draw(const MesoExact *exact, uint32_t slot, const uint64_t *bits, MesoRandom *random)
{
    return meso_weights_draw(exact->constraints ? &exact->constraints->weights : NULL, slot, bits, NULL,
                             exact->propagation->domains.states.word_count, random);
}

/* Leaves of `fitting` the variants that match what neighbours show, `shown` [4 * slots]; false where there is none. */
static bool keep_fitting(const MesoExact *exact, uint32_t slot, const uint32_t *shown, uint64_t *fitting)
{
    const MesoPropagation *propagation = exact->propagation;
    uint32_t words = propagation->domains.states.word_count;
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t twin = propagation->graph->twin[4 * (size_t)slot + k];
        if (twin == MESO_NO_INDEX || shown[twin] == MESO_NO_INDEX)
            continue;
        for (uint32_t w = 0; w < words; w++)
            for (uint64_t rest = fitting[w]; rest; rest &= rest - 1) {
                uint32_t variant = 64 * w + (uint32_t)__builtin_ctzll(rest);
                if (propagation->codes[4 * (size_t)variant + k] != (shown[twin] ^ 1))
                    meso_bits_clear(fitting, variant);
            }
    }
    return meso_bits_count(fitting, words) > 0;
}

static void show_pattern(MesoExact *exact, uint32_t slot, uint32_t pattern, uint32_t *shown)
{
    const MesoLabelPatternList *list = meso_label_pattern_list(&exact->patterns, slot, NULL);
    memcpy(shown + 4 * (size_t)slot, list->codes + 4 * (size_t)pattern, 4 * sizeof *shown);
}

/* Pattern of the one variant of state hint[slot]; MESO_NO_INDEX where there are others, or it is not possible. */
static uint32_t hinted_pattern(MesoExact *exact, uint32_t slot, const uint32_t *hint, MesoRandom *random)
{
    const MesoDomainTable *domains = &exact->propagation->domains;
    if (!hint || domains->domains[hint[slot]].size != 1)
        return MESO_NO_INDEX;
    return pattern_of_variant(meso_label_pattern_list(&exact->patterns, slot, NULL),
                              draw(exact, slot, meso_domain_bits(domains, hint[slot]), random));
}

/*
 * A pattern for each slot: the hinted ones, and random ones. Without hints, or where weights or variants to keep
 * speak, these come last, slot by slot, and fit what is there, as far as that is possible: so every assignment may come
 * out, and what the engine has to change of its phases, regardless of what they say, is little. The order is
 * random, but where wishes are to be met: along the surface more of them are.
 */
static MesoStatus choose_patterns(MesoExact *exact, const uint32_t *hint, uint32_t *pattern, MesoRandom *random,
                                  MesoError *error)
{
    const MesoPropagation *propagation = exact->propagation;
    const MesoConstraints *constraints = exact->constraints;
    bool wishes = constraints && (constraints->keep || constraints->weights.table_count), fits = wishes || !hint;
    uint32_t slots = propagation->graph->slot_count, words = propagation->domains.states.word_count, count = 0;
    uint32_t *shown = MESO_NEW(exact->arena, uint32_t, 4 * (size_t)slots, error);
    uint32_t *order = MESO_NEW(exact->arena, uint32_t, slots, error);
    uint64_t *fitting = MESO_NEW(exact->arena, uint64_t, words, error);
    if (!shown || !order || !fitting)
        return MESO_ERR_MEMORY;
    memset(shown, 0xff, 4 * (size_t)slots * sizeof *shown);
    for (uint32_t s = 0; s < slots; s++) {
        const uint64_t *bits = meso_domain_bits(&propagation->domains, propagation->initial[s]);
        pattern[s] = hinted_pattern(exact, s, hint, random);
        if (pattern[s] == MESO_NO_INDEX && !fits)
            pattern[s] = pattern_of_variant(meso_label_pattern_list(&exact->patterns, s, NULL),
                                            draw(exact, s, bits, random));
        if (pattern[s] == MESO_NO_INDEX)
            order[count++] = s;
        else
            show_pattern(exact, s, pattern[s], shown);
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t other = wishes ? i : i + meso_random_below(random, count - i), s = order[other];
        const uint64_t *bits = meso_domain_bits(&propagation->domains, propagation->initial[s]);
        order[other] = order[i];
        memcpy(fitting, bits, words * sizeof *bits);
        bool any = keep_fitting(exact, s, shown, fitting);
        pattern[s] = pattern_of_variant(meso_label_pattern_list(&exact->patterns, s, NULL),
                                        draw(exact, s, any ? fitting : bits, random));
        show_pattern(exact, s, pattern[s], shown);
    }
    return MESO_OK;
}

MesoStatus meso_exact_choose_phases(MesoExact *exact, const uint32_t *hint, MesoRandom *random,
                                    MesoError *error)
{
    uint32_t slots = exact->propagation->graph->slot_count;
    MesoArenaMark mark = meso_arena_mark(exact->arena);
    uint32_t *pattern = MESO_NEW(exact->arena, uint32_t, slots, error);
    MesoStatus status = pattern ? choose_patterns(exact, hint, pattern, random, error) : MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < slots && !status; s++) {
        /* Every list was made when the variables were numbered. */
        const MesoLabelPatternList *list = meso_label_pattern_list(&exact->patterns, s, NULL);
        status = prefer(exact, exact->slot_first[s], list->count, pattern[s], error);
        if (!status)
            status = prefer_labels(exact, s, list->codes + 4 * (size_t)pattern[s], error);
    }
    for (uint32_t c = 0; c < exact->chain_count && !status; c++) {
        int32_t bit = (int32_t)(exact->chain_first + c);
        status = meso_sat_phase(exact->sat, meso_random_below(random, 2) ? bit : -bit, error);
    }
    meso_arena_rewind(exact->arena, mark);
    return status;
}

/* One of the variants of a pattern of `slot`. */
static uint32_t choose_listed(const MesoExact *exact, uint32_t slot, const uint32_t *variants, uint32_t count,
                              MesoRandom *random)
{
    const MesoConstraints *constraints = exact->constraints;
    for (uint32_t i = 0; constraints && constraints->keep && i < count; i++)
        if (variants[i] == constraints->keep[slot])
            return variants[i];
    return meso_weights_draw_listed(constraints ? &constraints->weights : NULL, slot, variants, count, random);
}

MesoStatus meso_exact_extract(MesoExact *exact, uint32_t *variant, MesoRandom *random, MesoError *error)
{
    for (uint32_t s = 0; s < exact->propagation->graph->slot_count; s++) {
        const MesoLabelPatternList *list = meso_label_pattern_list(&exact->patterns, s, error);
        uint32_t p = 0;
        if (!list)
            return MESO_ERR_MEMORY;
        while (list->count > 1 && p < list->count &&
               !meso_sat_value(exact->sat, choice_literal(exact->slot_first[s], list->count, p)))
            p++;
        if (p == list->count)
            return meso_fail(error, MESO_ERR_INTERNAL, "the exact engine left slot %u without a tile", s);
        variant[s] = choose_listed(exact, s, list->variants + list->begin[p], list->begin[p + 1] - list->begin[p],
                                   random);
    }
    return MESO_OK;
}
