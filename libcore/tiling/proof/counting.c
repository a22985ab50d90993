#include "libcore/tiling/proof/counting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Steps towards weights of a balance. Those that exist were found within a few dozen. */
enum { BALANCE_STEPS = 1000 };

/* Slots of a piece that have the same patterns. */
typedef struct Class {
    const MesoLabelPatternList *list;
    uint32_t component, first_slot;
    uint64_t count;
} Class;

typedef struct Key {
    uint32_t component, list, slot;
} Key;

static int compare_keys(const void *a, const void *b)
{
    const Key *x = a, *y = b;
    if (x->component != y->component)
        return x->component < y->component ? -1 : 1;
    if (x->list != y->list)
        return x->list < y->list ? -1 : 1;
    return (x->slot > y->slot) - (x->slot < y->slot);
}

/* Classes by component; NULL when memory is out. */
static Class *sort_slots(MesoArena *arena, MesoLabelPatternTable *table, uint32_t *class_count, MesoError *error)
{
    const MesoSlotGraph *graph = table->propagation->graph;
    uint32_t *component = MESO_NEW(arena, uint32_t, graph->slot_count, error);
    Key *keys = MESO_NEW(arena, Key, graph->slot_count, error);
    if (!component || !keys)
        return NULL;
    meso_slot_graph_components(graph, component);
    for (uint32_t s = 0; s < graph->slot_count; s++) {
        const MesoLabelPatternList *list = meso_label_pattern_list(table, s, error);
        if (!list)
            return NULL;
        keys[s] = (Key){component[s], list->index, s};
    }
    qsort(keys, graph->slot_count, sizeof *keys, compare_keys);

    uint32_t count = 0;
    for (uint32_t s = 0; s < graph->slot_count; s++)
        count += s == 0 || keys[s].component != keys[s - 1].component || keys[s].list != keys[s - 1].list;
    Class *classes = MESO_NEW(arena, Class, count, error);
    *class_count = 0;
    for (uint32_t s = 0; classes && s < graph->slot_count; s++) {
        if (s == 0 || keys[s].component != keys[s - 1].component || keys[s].list != keys[s - 1].list)
            classes[(*class_count)++] = (Class){meso_label_pattern_list(table, keys[s].slot, error),
                                                keys[s].component, keys[s].slot, 0};
        classes[*class_count - 1].count++;
    }
    return classes;
}

/* Which interfaces a pattern shows an odd number of times. */
static void pattern_parity(const MesoLabelPatternList *list, uint32_t pattern, uint64_t *bits, uint32_t words)
{
    memset(bits, 0, words * sizeof *bits);
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t code = list->codes[4 * (size_t)pattern + k];
        if (code != MESO_LABEL_PATTERN_BORDER)
            bits[code / 2 / 64] ^= (uint64_t)1 << (code / 2 % 64);
    }
}

static void add_bits(uint64_t *to, const uint64_t *from, uint32_t words)
{
    for (uint32_t w = 0; w < words; w++)
        to[w] ^= from[w];
}

/* Rows modulo 2 in reduced form: the column `pivot` of each is 0 in all others. */
typedef struct Basis {
    uint32_t words, count;
    uint64_t *rows;             /* [interfaces * words] */
    uint32_t *pivot;            /* [interfaces] */
} Basis;

static void reduce(const Basis *basis, uint64_t *bits)
{
    for (uint32_t r = 0; r < basis->count; r++)
        if (meso_bits_test(bits, basis->pivot[r]))
            add_bits(bits, basis->rows + (size_t)r * basis->words, basis->words);
}

static void basis_add(Basis *basis, uint64_t *bits)
{
    reduce(basis, bits);
    uint32_t pivot = meso_bits_first(bits, basis->words);
    if (pivot == 64 * basis->words)
        return;
    for (uint32_t r = 0; r < basis->count; r++) {
        uint64_t *row = basis->rows + (size_t)r * basis->words;
        if (meso_bits_test(row, pivot))
            add_bits(row, bits, basis->words);
    }
    memcpy(basis->rows + (size_t)basis->count * basis->words, bits, basis->words * sizeof *bits);
    basis->pivot[basis->count++] = pivot;
}

/*
 * A set c of interfaces with c.d = 0 for all differences d of two patterns of one
 * slot, and c.t = 1 for the total t: there is one where t is not in the space of the d.
 */
static MesoStatus prove_parity(MesoCountingProof *proof, MesoArena *arena, const Class *classes,
                               uint32_t class_count, uint32_t interface_count, MesoError *error)
{
    uint32_t words = meso_bits_words(interface_count);
    Basis basis = {.words = words, .rows = MESO_NEW(arena, uint64_t, (size_t)interface_count * words, error),
                   .pivot = MESO_NEW(arena, uint32_t, interface_count, error)};
    uint64_t *bits = MESO_NEW(arena, uint64_t, 3 * (size_t)words, error);
    if (!basis.rows || !basis.pivot || !bits)
        return MESO_ERR_MEMORY;
    uint64_t *first = bits + words, *total = bits + 2 * (size_t)words;
    for (uint32_t c = 0; c < class_count; c++) {
        pattern_parity(classes[c].list, 0, first, words);
        if (classes[c].count % 2)
            add_bits(total, first, words);
        for (uint32_t p = 1; p < classes[c].list->count; p++) {
            pattern_parity(classes[c].list, p, bits, words);
            add_bits(bits, first, words);
            basis_add(&basis, bits);
        }
    }
    reduce(&basis, total);
    uint32_t free_column = meso_bits_first(total, words);
    if (free_column == 64 * words)
        return MESO_OK;
    proof->found = proof->parity = true;
    proof->weights[free_column] = 1;
    for (uint32_t r = 0; r < basis.count; r++)
        proof->weights[basis.pivot[r]] = meso_bits_test(basis.rows + (size_t)r * words, free_column);
    return MESO_OK;
}

static double pattern_sum(const MesoLabelPatternList *list, uint32_t pattern, const double *weights)
{
    double sum = 0;
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t code = list->codes[4 * (size_t)pattern + k];
        if (code != MESO_LABEL_PATTERN_BORDER)
            sum += code % 2 ? -weights[code / 2] : weights[code / 2];
    }
    return sum;
}

static uint32_t lightest_pattern(const MesoLabelPatternList *list, const double *weights, double *least)
{
    uint32_t lightest = 0;
    *least = pattern_sum(list, 0, weights);
    for (uint32_t p = 1; p < list->count; p++) {
        double sum = pattern_sum(list, p, weights);
        if (sum < *least) {
            *least = sum;
            lightest = p;
        }
    }
    return lightest;
}

static int64_t whole_pattern_sum(const MesoLabelPatternList *list, uint32_t pattern, const int64_t *weights)
{
    int64_t sum = 0;
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t code = list->codes[4 * (size_t)pattern + k];
        if (code != MESO_LABEL_PATTERN_BORDER)
            sum += code % 2 ? -weights[code / 2] : weights[code / 2];
    }
    return sum;
}

/* The proof itself: the least sum over all slots, in whole numbers. Weights are below 2^21, slots below 2^32. */
static bool balance_holds(const Class *classes, uint32_t class_count, const int64_t *weights)
{
    int64_t total = 0;
    for (uint32_t c = 0; c < class_count; c++) {
        const MesoLabelPatternList *list = classes[c].list;
        int64_t least = whole_pattern_sum(list, 0, weights);
        for (uint32_t p = 1; p < list->count; p++) {
            int64_t sum = whole_pattern_sum(list, p, weights);
            least = sum < least ? sum : least;
        }
        total += least * (int64_t)classes[c].count;
    }
    return total > 0;
}

/* Whole weights in the same proportions, as small as will do. */
static bool round_weights(MesoCountingProof *proof, const Class *classes, uint32_t class_count,
                          const double *weights, uint32_t interface_count)
{
    double largest = 0;
    for (uint32_t i = 0; i < interface_count; i++)
        largest = fmax(largest, fabs(weights[i]));
    for (double scale = 1; scale < 2e6 && largest > 0; scale *= 2) {
        for (uint32_t i = 0; i < interface_count; i++)
            proof->weights[i] = (int64_t)floor(weights[i] / largest * scale + 0.5);
        if (balance_holds(classes, class_count, proof->weights))
            return true;
    }
    memset(proof->weights, 0, interface_count * sizeof *proof->weights);
    return false;
}

/*
 * The perceptron's rule: the lightest patterns under the weights make a sum of labels;
 * where that is not above 0, the weights move along it.
 */
static MesoStatus prove_balance(MesoCountingProof *proof, MesoArena *arena, const Class *classes,
                                uint32_t class_count, uint32_t interface_count, MesoError *error)
{
    double *weights = MESO_NEW(arena, double, 2 * (size_t)interface_count, error);
    if (!weights)
        return MESO_ERR_MEMORY;
    double *sum = weights + interface_count;
    for (uint32_t step = 0; step < BALANCE_STEPS; step++) {
        double total = 0, largest = 0, least;
        memset(sum, 0, interface_count * sizeof *sum);
        for (uint32_t c = 0; c < class_count; c++) {
            const MesoLabelPatternList *list = classes[c].list;
            uint32_t p = lightest_pattern(list, weights, &least);
            total += least * (double)classes[c].count;
            for (uint32_t k = 0; k < 4; k++) {
                uint32_t code = list->codes[4 * (size_t)p + k];
                if (code != MESO_LABEL_PATTERN_BORDER)
                    sum[code / 2] += (code % 2 ? -1 : 1) * (double)classes[c].count;
            }
        }
        if (total > 0 && round_weights(proof, classes, class_count, weights, interface_count)) {
            proof->found = true;
            return MESO_OK;
        }
        for (uint32_t i = 0; i < interface_count; i++)
            largest = fmax(largest, fabs(sum[i]));
        if (largest == 0)
            return MESO_OK;
        for (uint32_t i = 0; i < interface_count; i++)
            weights[i] += sum[i] / largest;
    }
    return MESO_OK;
}

MesoStatus meso_counting_prove(MesoCountingProof *proof, MesoArena *arena, MesoLabelPatternTable *table,
                               MesoError *error)
{
    uint32_t interface_count = table->propagation->set->interface_count, class_count;
    *proof = (MesoCountingProof){0};
    proof->weights = MESO_NEW(arena, int64_t, interface_count, error);
    Class *classes = sort_slots(arena, table, &class_count, error);
    if (!proof->weights || !classes)
        return MESO_ERR_MEMORY;
    for (uint32_t begin = 0, end = 0; begin < class_count && !proof->found; begin = end) {
        proof->slot_count = 0;
        proof->first_slot = MESO_NO_INDEX;
        for (; end < class_count && classes[end].component == classes[begin].component; end++) {
            proof->slot_count += classes[end].count;
            if (classes[end].first_slot < proof->first_slot)
                proof->first_slot = classes[end].first_slot;
        }
        MesoStatus status = prove_parity(proof, arena, classes + begin, end - begin, interface_count, error);
        if (!status && !proof->found)
            status = prove_balance(proof, arena, classes + begin, end - begin, interface_count, error);
        if (status)
            return status;
    }
    return MESO_OK;
}

/* "'a', 2 x 'b'' and 'c'" of the interfaces with a weight; flipped where it is below 0. */
static char *list_weights(const MesoCountingProof *proof, MesoArena *arena, const MesoTileSet *set,
                          MesoError *error)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < set->interface_count; i++)
        left += proof->weights[i] != 0;
    char *text = meso_arena_copy_text(arena, "", error);
    bool first = true;
    for (uint32_t i = 0; i < set->interface_count && text; i++) {
        int64_t weight = proof->weights[i];
        if (weight == 0)
            continue;
        left--;
        const char *joint = first ? "" : left == 0 ? " and " : ", ";
        const char *flip = weight < 0 ? "'" : "";
        long long times = weight < 0 ? -weight : weight;
        text = times == 1 ? meso_arena_print(arena, error, "%s%s'%s%s'", text, joint, set->interfaces[i].name, flip)
                          : meso_arena_print(arena, error, "%s%s%lld x '%s%s'", text, joint, times,
                                             set->interfaces[i].name, flip);
        first = false;
    }
    return text;
}

const char *meso_counting_explain(const MesoCountingProof *proof, MesoArena *arena,
                                  const MesoTileSet *set, MesoError *error)
{
    char *weights = list_weights(proof, arena, set, error);
    if (!weights)
        return NULL;
    if (proof->parity)
        return meso_arena_print(arena, error, "on the piece of the surface with slot %u (%llu slots) the "
                                "tiles show %s on an odd number of inner sides in all, however they are "
                                "chosen, but inner sides match in pairs", proof->first_slot,
                                (unsigned long long)proof->slot_count, weights);
    return meso_arena_print(arena, error, "on the piece of the surface with slot %u (%llu slots) the tiles "
                            "show %s more often than the flipped ones, however they are chosen, but inner "
                            "sides match in pairs", proof->first_slot,
                            (unsigned long long)proof->slot_count, weights);
}

/* Whether all patterns of a list show the interfaces of `weights` equally often modulo 2; `parity` gets that. */
static bool constant_parity(const MesoLabelPatternList *list, const int64_t *weights, uint32_t *parity)
{
    for (uint32_t p = 0; p < list->count; p++) {
        uint32_t odd = 0;
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t code = list->codes[4 * (size_t)p + k];
            odd ^= code != MESO_LABEL_PATTERN_BORDER && weights[code / 2] != 0;
        }
        if (p > 0 && odd != *parity)
            return false;
        *parity = odd;
    }
    return true;
}

MesoStatus meso_counting_check(const MesoCountingProof *proof, bool *holds, MesoArena *arena,
                               MesoLabelPatternTable *table, MesoError *error)
{
    const MesoSlotGraph *graph = table->propagation->graph;
    uint32_t *component = MESO_NEW(arena, uint32_t, graph->slot_count, error);
    if (!component)
        return MESO_ERR_MEMORY;
    meso_slot_graph_components(graph, component);
    *holds = proof->found;
    int64_t total = 0;
    uint32_t odd = 0, parity = 0;
    for (uint32_t s = 0; s < graph->slot_count && *holds; s++) {
        const MesoLabelPatternList *list = meso_label_pattern_list(table, s, error);
        if (!list)
            return MESO_ERR_MEMORY;
        if (component[s] != component[proof->first_slot])
            continue;
        Class alone = {.list = list, .count = 1};
        if (proof->parity)
            *holds = constant_parity(list, proof->weights, &parity);
        odd ^= parity;
        int64_t least = INT64_MAX;
        for (uint32_t p = 0; p < alone.list->count; p++) {
            int64_t sum = whole_pattern_sum(list, p, proof->weights);
            least = sum < least ? sum : least;
        }
        total += least;
    }
    *holds = *holds && (proof->parity ? odd == 1 : total > 0);
    return MESO_OK;
}
