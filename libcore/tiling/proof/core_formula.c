#include "libcore/tiling/proof/core_formula.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/arena.h"
#include "libcore/sat/sorting_network.h"

/* Constraints of one slot by which its variants are sorted; where there are more, each variant stands alone. */
enum { MOST_TOLD_APART = 64 };

/* Comparators of all quotas together; the first that would be over it is left out, and so are all after it. */
enum { MOST_COMPARATORS = 1 << 18 };

/* What a variant shows that matters at a slot. */
typedef struct Pattern {
    uint32_t sides[4];          /* inner: label code; border or towards a slot left out: interface with a
                                   border rule that it breaks there, plus 1; 0: none */
    uint64_t allowed;           /* by the slot's restrictions; counted by the quotas */
    uint32_t variant;           /* the smallest that shows this */
} Pattern;

typedef struct Place {
    uint32_t restriction, place;
} Place;

typedef struct Builder {
    MesoCoreFormula *formula;
    const MesoTilingProblem *problem;
    MesoArena *arena;
    uint32_t code_count;        /* label codes that variants show, or whose opposite they do */
    uint32_t *code_rank;        /* [label codes] among these */
    uint32_t *codes;            /* [code_count] */
    uint32_t bit_count;         /* to tell them apart */
    int32_t *edge_first;        /* [4 * slots] first variable of what the edge's lower half-edge shows;
                                   0: the half-edge is upper, or not inner */
    uint32_t *place_begin;      /* [slots + 1] into `places` */
    Place *places;              /* that restrictions have in the slots */
    uint32_t quota_count;
    int32_t *counted_first;     /* [quota_count] first variable of whether a slot counts; 0: the part cannot break it */
    Pattern *patterns;          /* [variants] of the slot at hand */
    int32_t *literals;          /* [variants + 4] */
    int32_t variable_count;
} Builder;

static MesoStatus add(Builder *builder, const int32_t *literals, uint32_t count, MesoError *error)
{
    builder->formula->size += count;
    return meso_sat_add(builder->formula->sat, literals, count, error);
}

static MesoStatus add_two(Builder *builder, int32_t a, int32_t b, MesoError *error)
{
    int32_t literals[2] = {a, b};
    return add(builder, literals, 2, error);
}

/* Item literals come first: the formula's slots by rank, then rules and constraints as items are numbered. */
int32_t meso_core_formula_literal(const MesoCoreFormula *formula, uint32_t item)
{
    uint32_t slots = formula->problem->graph->slot_count;
    return (int32_t)(1 + (item < slots ? formula->rank[item] : formula->slot_count + item - slots));
}

bool meso_core_allows(const MesoTilingProblem *problem, const MesoRestriction *restriction, uint32_t place,
                      uint32_t variant)
{
    uint32_t bit = restriction->sided
                       ? meso_label_code(problem->variants->labels[4 * (size_t)variant + place % 4])
                       : variant;
    return meso_bits_test(restriction->allowed, bit);
}

static bool is_inside(const Builder *builder, uint32_t twin)
{
    return twin != MESO_NO_INDEX && builder->formula->rank[twin / 4] != MESO_NO_INDEX;
}

/* Negated literal of the border rule that `interface` has for a side; 0: none. */
static int32_t against_rule(const Builder *builder, uint32_t interface, bool border)
{
    const MesoInterface *rules = &builder->problem->set->interfaces[interface];
    if (border ? !rules->border_exempt : !rules->border_only)
        return 0;
    return -meso_core_formula_literal(builder->formula,
                                      meso_core_rule_item(builder->problem, interface, !border));
}

/* --- tables --- */

static MesoStatus rank_codes(Builder *builder, MesoError *error)
{
    const MesoVariantSet *variants = builder->problem->variants;
    uint32_t all = 2 * builder->problem->set->interface_count;
    builder->code_rank = MESO_NEW(builder->arena, uint32_t, all, error);
    builder->codes = MESO_NEW(builder->arena, uint32_t, all, error);
    if (!builder->code_rank || !builder->codes)
        return MESO_ERR_MEMORY;
    for (size_t i = 0; i < 4 * (size_t)variants->count; i++) {
        uint32_t code = meso_label_code(variants->labels[i]);
        builder->code_rank[code] = builder->code_rank[code ^ 1] = 1;
    }
    for (uint32_t code = 0; code < all; code++)
        if (builder->code_rank[code]) {
            builder->code_rank[code] = builder->code_count;
            builder->codes[builder->code_count++] = code;
        }
    while ((1u << builder->bit_count) < builder->code_count)
        builder->bit_count++;
    return MESO_OK;
}

static MesoStatus number_edges(Builder *builder, MesoError *error)
{
    const MesoCoreFormula *formula = builder->formula;
    builder->edge_first = MESO_NEW(builder->arena, int32_t, 4 * (size_t)formula->slot_count, error);
    if (!builder->edge_first)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < formula->slot_count; i++)
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t h = 4 * formula->slots[i] + k, twin = builder->problem->graph->twin[h];
            if (!is_inside(builder, twin) || twin < h)
                continue;
            builder->edge_first[4 * i + k] = builder->variable_count + 1;
            builder->variable_count += (int32_t)(builder->code_count + builder->bit_count);
        }
    return MESO_OK;
}

/* One pass counts the places by slot; the second, where `begin` says where each slot's go, keeps them. */
static void walk_places(Builder *builder, uint32_t *begin, Place *places)
{
    const MesoConstraints *constraints = builder->problem->constraints;
    for (uint32_t r = 0; constraints && r < constraints->restriction_count; r++) {
        const MesoRestriction *restriction = &constraints->restrictions[r];
        for (uint32_t i = 0; i < restriction->place_count; i++) {
            uint32_t place = restriction->places[i];
            uint32_t rank = builder->formula->rank[restriction->sided ? place / 4 : place];
            if (rank != MESO_NO_INDEX && places)
                places[begin[rank]] = (Place){r, place};
            if (rank != MESO_NO_INDEX)
                begin[rank]++;
        }
    }
}

static MesoStatus collect_places(Builder *builder, MesoError *error)
{
    uint32_t count = builder->formula->slot_count, sum = 0;
    uint32_t *begin = builder->place_begin = MESO_NEW(builder->arena, uint32_t, count + (size_t)1, error);
    if (!begin)
        return MESO_ERR_MEMORY;
    walk_places(builder, begin, NULL);
    for (uint32_t i = 0; i <= count; i++) {
        uint32_t own = begin[i];
        begin[i] = sum;
        sum += own;
    }
    builder->places = MESO_NEW(builder->arena, Place, sum, error);
    if (!builder->places)
        return MESO_ERR_MEMORY;
    /* What were the beginnings are the ends after this. */
    walk_places(builder, begin, builder->places);
    memmove(begin + 1, begin, count * sizeof *begin);
    begin[0] = 0;
    return MESO_OK;
}

/* --- clauses --- */

static int compare_patterns(const void *a, const void *b)
{
    const Pattern *x = a, *y = b;
    for (uint32_t k = 0; k < 4; k++)
        if (x->sides[k] != y->sides[k])
            return x->sides[k] < y->sides[k] ? -1 : 1;
    if (x->allowed != y->allowed)
        return x->allowed < y->allowed ? -1 : 1;
    return x->variant < y->variant ? -1 : x->variant > y->variant;
}

static bool same_pattern(const Pattern *a, const Pattern *b)
{
    return memcmp(a->sides, b->sides, sizeof a->sides) == 0 && a->allowed == b->allowed;
}

static Pattern pattern_of(const Builder *builder, uint32_t rank, uint32_t variant)
{
    const MesoTilingProblem *problem = builder->problem;
    uint32_t begin = builder->place_begin[rank], end = builder->place_begin[rank + 1];
    Pattern pattern = {.allowed = variant, .variant = variant};
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t twin = problem->graph->twin[4 * (size_t)builder->formula->slots[rank] + k];
        uint32_t code = meso_label_code(problem->variants->labels[4 * (size_t)variant + k]);
        if (is_inside(builder, twin))
            pattern.sides[k] = code;
        else
            pattern.sides[k] = against_rule(builder, code / 2, twin == MESO_NO_INDEX) ? code / 2 + 1 : 0;
    }
    if (end - begin + builder->quota_count > MOST_TOLD_APART)
        return pattern;
    pattern.allowed = 0;
    for (uint32_t i = begin; i < end; i++) {
        const Place *place = &builder->places[i];
        if (meso_core_allows(problem, &problem->constraints->restrictions[place->restriction], place->place, variant))
            pattern.allowed |= (uint64_t)1 << (i - begin);
    }
    for (uint32_t q = 0; q < builder->quota_count; q++)
        if (builder->counted_first[q] && meso_bits_test(problem->constraints->quotas[q].variants, variant))
            pattern.allowed |= (uint64_t)1 << (end - begin + q);
    return pattern;
}

/* The patterns of a slot, in `patterns`; returns how many. */
static uint32_t sort_out(Builder *builder, uint32_t rank)
{
    uint32_t count = 0, all = builder->problem->variants->count;
    Pattern *patterns = builder->patterns;
    for (uint32_t v = 0; v < all; v++)
        patterns[v] = pattern_of(builder, rank, v);
    qsort(patterns, all, sizeof *patterns, compare_patterns);
    for (uint32_t v = 0; v < all; v++)
        if (count == 0 || !same_pattern(&patterns[count - 1], &patterns[v]))
            patterns[count++] = patterns[v];
    return count;
}

/* Literal that holds where side `side` of the slot, an inner one, shows `code`. */
static int32_t label_literal(const Builder *builder, uint32_t rank, uint32_t side, uint32_t code)
{
    int32_t first = builder->edge_first[4 * rank + side];
    if (first)
        return first + (int32_t)builder->code_rank[code];
    uint32_t twin = builder->problem->graph->twin[4 * (size_t)builder->formula->slots[rank] + side];
    first = builder->edge_first[4 * builder->formula->rank[twin / 4] + twin % 4];
    return first + (int32_t)builder->code_rank[code ^ 1];
}

/* What pattern `literal` at the slot implies: labels, that no item that it breaks is assumed, what it counts for. */
static MesoStatus add_pattern(Builder *builder, uint32_t rank, const Pattern *pattern, int32_t literal,
                              MesoError *error)
{
    const MesoTilingProblem *problem = builder->problem;
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 4 && !status; k++) {
        uint32_t twin = problem->graph->twin[4 * (size_t)builder->formula->slots[rank] + k];
        if (is_inside(builder, twin))
            status = add_two(builder, -literal, label_literal(builder, rank, k, pattern->sides[k]), error);
        else if (pattern->sides[k])
            status = add_two(builder, -literal,
                             against_rule(builder, pattern->sides[k] - 1, twin == MESO_NO_INDEX), error);
    }
    for (uint32_t i = builder->place_begin[rank]; i < builder->place_begin[rank + 1] && !status; i++) {
        const Place *place = &builder->places[i];
        const MesoRestriction *restriction = &problem->constraints->restrictions[place->restriction];
        if (meso_core_allows(problem, restriction, place->place, pattern->variant))
            continue;
        uint32_t item = meso_core_constraint_item(problem, place->restriction);
        status = add_two(builder, -literal, -meso_core_formula_literal(builder->formula, item), error);
    }
    for (uint32_t q = 0; q < builder->quota_count && !status; q++) {
        int32_t counted = builder->counted_first[q] + (int32_t)rank;
        bool counts = meso_bits_test(problem->constraints->quotas[q].variants, pattern->variant);
        if (builder->counted_first[q])
            status = add_two(builder, -literal, counts ? counted : -counted, error);
    }
    return status;
}

/* Where the slot has a tile, what an inner side shows is a pattern's. Follows from the rest, and speeds it up. */
static MesoStatus add_supports(Builder *builder, uint32_t rank, uint32_t side, uint32_t count, int32_t first,
                               MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t c = 0; c < builder->code_count && !status; c++) {
        uint32_t length = 0;
        builder->literals[length++] = -(int32_t)(1 + rank);
        builder->literals[length++] = -label_literal(builder, rank, side, builder->codes[c]);
        for (uint32_t p = 0; p < count; p++)
            if (builder->patterns[p].sides[side] == builder->codes[c])
                builder->literals[length++] = first + (int32_t)p;
        status = add(builder, builder->literals, length, error);
    }
    return status;
}

static MesoStatus add_slot(Builder *builder, uint32_t rank, MesoError *error)
{
    uint32_t count = sort_out(builder, rank), length = 0;
    int32_t first = builder->variable_count + 1;
    MesoStatus status = MESO_OK;
    builder->variable_count += (int32_t)count;
    for (uint32_t p = 0; p < count && !status; p++)
        status = add_pattern(builder, rank, &builder->patterns[p], first + (int32_t)p, error);
    for (uint32_t k = 0; k < 4 && !status; k++)
        if (is_inside(builder, builder->problem->graph->twin[4 * (size_t)builder->formula->slots[rank] + k]))
            status = add_supports(builder, rank, k, count, first, error);
    builder->literals[length++] = -(int32_t)(1 + rank);
    for (uint32_t p = 0; p < count; p++)
        builder->literals[length++] = first + (int32_t)p;
    return status ? status : add(builder, builder->literals, length, error);
}

/*
 * An edge shows at most one label, by the label's number in binary (Frisch et
 * al., "Modelling and solving the stable marriage problem using constraint
 * programming", 2005), and one that may lie inside.
 */
static MesoStatus add_edge(Builder *builder, int32_t first, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t c = 0; c < builder->code_count && !status; c++) {
        int32_t label = first + (int32_t)c, against = against_rule(builder, builder->codes[c] / 2, false);
        if (against)
            status = add_two(builder, -label, against, error);
        for (uint32_t b = 0; b < builder->bit_count && !status; b++) {
            int32_t bit = first + (int32_t)(builder->code_count + b);
            status = add_two(builder, -label, (c >> b) & 1 ? bit : -bit, error);
        }
    }
    return status;
}

/* What the slots of the part have to hold of a quota at least, if all others hold what they can. */
static uint32_t least_inside(const Builder *builder, const MesoQuota *quota)
{
    uint32_t outside = builder->problem->graph->slot_count - builder->formula->slot_count;
    return quota->least > outside ? quota->least - outside : 0;
}

/* Variables of whether a slot counts for a quota. */
static MesoStatus number_counts(Builder *builder, MesoError *error)
{
    const MesoConstraints *constraints = builder->problem->constraints;
    uint32_t slots = builder->formula->slot_count;
    builder->quota_count = constraints ? constraints->quota_count : 0;
    builder->counted_first = MESO_NEW(builder->arena, int32_t, builder->quota_count, error);
    if (!builder->counted_first)
        return MESO_ERR_MEMORY;
    uint64_t comparators = 0;
    for (uint32_t q = 0; q < builder->quota_count; q++) {
        const MesoQuota *quota = &constraints->quotas[q];
        if (quota->most >= slots && least_inside(builder, quota) == 0)
            continue;
        comparators += meso_sort_comparators(slots);
        if (comparators > MOST_COMPARATORS)
            break;
        builder->counted_first[q] = builder->variable_count + 1;
        builder->variable_count += (int32_t)slots;
    }
    return MESO_OK;
}

static MesoStatus add_sorting(void *context, int32_t *literals, uint32_t count, MesoError *error)
{
    return add(context, literals, count, error);
}

static int32_t new_variable(void *context)
{
    Builder *builder = context;
    return ++builder->variable_count;
}

static MesoStatus add_quota(Builder *builder, uint32_t number, MesoError *error)
{
    const MesoClauses clauses = {add_sorting, new_variable, builder};
    const MesoConstraints *constraints = builder->problem->constraints;
    const MesoQuota *quota = &constraints->quotas[number];
    uint32_t slots = builder->formula->slot_count, least = least_inside(builder, quota);
    uint32_t item = meso_core_constraint_item(builder->problem, constraints->restriction_count + number);
    int32_t broken = -meso_core_formula_literal(builder->formula, item);
    if (least > slots)
        return add(builder, &broken, 1, error);
    int32_t *items = MESO_NEW(builder->arena, int32_t, 2 * (size_t)slots, error);
    if (!items)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < slots; i++)
        items[i] = builder->counted_first[number] + (int32_t)i;
    MesoStatus status = meso_sort_literals(&clauses, items, slots, error);
    if (!status && least > 0)
        status = add_two(builder, broken, items[least - 1], error);
    return status || quota->most >= slots ? status : add_two(builder, broken, -items[quota->most], error);
}

static MesoStatus build(Builder *builder, MesoError *error)
{
    const MesoCoreFormula *formula = builder->formula;
    const MesoConstraints *constraints = builder->problem->constraints;
    builder->variable_count = (int32_t)(formula->slot_count + 2 * builder->problem->set->interface_count +
                                        (constraints ? constraints->restriction_count + constraints->quota_count : 0));
    builder->patterns = MESO_NEW(builder->arena, Pattern, builder->problem->variants->count, error);
    builder->literals = MESO_NEW(builder->arena, int32_t, builder->problem->variants->count + (size_t)4, error);
    if (!builder->patterns || !builder->literals || rank_codes(builder, error) || number_edges(builder, error) ||
        collect_places(builder, error) || number_counts(builder, error))
        return MESO_ERR_MEMORY;
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < 4 * formula->slot_count && !status; i++)
        if (builder->edge_first[i])
            status = add_edge(builder, builder->edge_first[i], error);
    for (uint32_t i = 0; i < formula->slot_count && !status; i++)
        status = add_slot(builder, i, error);
    for (uint32_t q = 0; q < builder->quota_count && !status; q++)
        if (builder->counted_first[q])
            status = add_quota(builder, q, error);
    return status;
}

MesoStatus meso_core_formula_init(MesoCoreFormula *formula, const MesoTilingProblem *problem,
                                  const uint32_t *slots, uint32_t slot_count, uint32_t *rank,
                                  MesoError *error)
{
    MesoArena arena;
    *formula = (MesoCoreFormula){.problem = problem, .slots = slots, .slot_count = slot_count, .rank = rank};
    for (uint32_t i = 0; i < slot_count; i++)
        rank[slots[i]] = i;
    meso_arena_init(&arena);
    Builder builder = {.formula = formula, .problem = problem, .arena = &arena};
    MesoStatus status = meso_sat_init(&formula->sat, NULL, NULL, error);
    if (!status)
        status = build(&builder, error);
    meso_arena_release(&arena);
    return status;
}

void meso_core_formula_release(MesoCoreFormula *formula)
{
    for (uint32_t i = 0; i < formula->slot_count; i++)
        formula->rank[formula->slots[i]] = MESO_NO_INDEX;
    meso_sat_release(formula->sat);
}
