#include "libcore/tiling/exact/edge_chains.h"

#include <assert.h>
#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/grow.h"

/* What patterns of a list carry between sides `from` and `to`. */
typedef struct Pair {
    uint32_t from, to;
    uint32_t value_count;
    uint32_t *from_value, *to_value;    /* [labels] value that a code stands for; MESO_NO_INDEX: not shown */
} Pair;

typedef struct PairList {
    bool known;
    uint32_t count;
    Pair pairs[6];
} PairList;

/* A bit of an edge; chains are trees of them. */
typedef struct Bit {
    uint32_t edge, parent;
    uint32_t size;              /* of its tree, at a root */
    bool negated;               /* against its parent */
    bool wide;                  /* at a root: some bit of the tree is more than one label */
    uint64_t ranks;             /* without rank 0 */
} Bit;

typedef struct Finder {
    MesoLabelPatternTable *table;
    MesoArena *arena;
    uint32_t label_count;
    PairList *pair_lists;       /* [lists of the table] */
    Bit *bits;
    uint32_t bit_count, bit_capacity;
    uint32_t *index;            /* [index_mask + 1] number of a bit + 1, or 0; open addressing */
    uint32_t index_mask;
} Finder;

/*
 * The labels of the two sides, joined where a pattern shows both: each connected
 * piece is one value that the slot carries.
 */
static MesoStatus find_values(Finder *finder, const MesoLabelPatternList *list, Pair *pair, MesoError *error)
{
    uint32_t count = finder->label_count;
    uint32_t *parent = MESO_NEW(finder->arena, uint32_t, 2 * (size_t)count, error);
    pair->from_value = MESO_NEW(finder->arena, uint32_t, 2 * (size_t)count, error);
    if (!parent || !pair->from_value)
        return MESO_ERR_MEMORY;
    pair->to_value = pair->from_value + count;
    memset(pair->from_value, 0xff, 2 * (size_t)count * sizeof *parent);
    meso_sets_init(parent, 2 * count);
    for (uint32_t p = 0; p < list->count; p++) {
        const uint32_t *codes = list->codes + 4 * (size_t)p;
        meso_sets_join(parent, codes[pair->from], count + codes[pair->to]);
    }
    /* Roots are codes of `from`, so that a value has its number before it is asked for. */
    for (uint32_t p = 0; p < list->count; p++) {
        const uint32_t *codes = list->codes + 4 * (size_t)p;
        uint32_t root = meso_sets_root(parent, codes[pair->from]);
        if (pair->from_value[root] == MESO_NO_INDEX)
            pair->from_value[root] = pair->value_count++;
        pair->from_value[codes[pair->from]] = pair->to_value[codes[pair->to]] = pair->from_value[root];
    }
    return MESO_OK;
}

static MesoStatus find_pairs(Finder *finder, const MesoLabelPatternList *list, PairList *pairs, MesoError *error)
{
    pairs->known = true;
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t j = i + 1; j < 4; j++) {
            if (list->codes[i] == MESO_LABEL_PATTERN_BORDER || list->codes[j] == MESO_LABEL_PATTERN_BORDER)
                continue;
            Pair pair = {.from = i, .to = j};
            if (find_values(finder, list, &pair, error))
                return MESO_ERR_MEMORY;
            if (pair.value_count > 1)
                pairs->pairs[pairs->count++] = pair;
        }
    return MESO_OK;
}

/* Ranks at the edge of side `side` of `slot` of the codes there whose value is in `values`. */
static uint64_t edge_ranks(const Finder *finder, uint32_t slot, uint32_t side, const uint32_t *code_value,
                           uint64_t values, uint32_t *edge)
{
    uint32_t half_edge = 4 * slot + side, twin = finder->table->propagation->graph->twin[half_edge];
    uint64_t ranks = 0;
    uint32_t rank = 0;
    *edge = half_edge < twin ? half_edge : twin;
    const uint64_t *labels = meso_propagation_labels(finder->table->propagation, *edge);
    for (uint32_t far_code = 0; far_code < finder->label_count; far_code++) {
        if (!meso_bits_test(labels, far_code))
            continue;
        uint32_t value = code_value[half_edge < twin ? far_code ^ 1 : far_code];
        if (rank < 64 && value < 64 && (values >> value & 1))
            ranks |= (uint64_t)1 << rank;
        rank++;
    }
    return rank > 64 ? 0 : ranks;
}

static uint64_t all_ranks(const Finder *finder, uint32_t edge)
{
    uint32_t count = meso_propagation_label_count(finder->table->propagation, edge);
    return count >= 64 ? UINT64_MAX : ((uint64_t)1 << count) - 1;
}

static uint32_t *index_place(const Finder *finder, uint32_t edge, uint64_t ranks)
{
    uint64_t hash = (ranks ^ ((uint64_t)edge << 32 | edge)) * 0x9e3779b97f4a7c15u;
    for (uint32_t i = (uint32_t)(hash >> 32);; i++) {
        uint32_t *place = &finder->index[i & finder->index_mask];
        if (*place == 0 || (finder->bits[*place - 1].edge == edge && finder->bits[*place - 1].ranks == ranks))
            return place;
    }
}

static MesoStatus grow(Finder *finder, MesoError *error)
{
    uint32_t capacity = finder->bit_capacity ? 2 * finder->bit_capacity : 1024;
    Bit *bits = meso_arena_enlarge(finder->arena, finder->bits, finder->bit_count, capacity, sizeof *bits, error);
    uint32_t *index = MESO_NEW(finder->arena, uint32_t, 2 * (size_t)capacity, error);
    if (!bits || !index)
        return MESO_ERR_MEMORY;
    finder->bits = bits;
    finder->bit_capacity = capacity;
    finder->index = index;
    finder->index_mask = 2 * capacity - 1;
    for (uint32_t i = 0; i < finder->bit_count; i++)
        *index_place(finder, bits[i].edge, bits[i].ranks) = i + 1;
    return MESO_OK;
}

/* The bit "one of `ranks`"; `*negated` where it is kept as its opposite. MESO_NO_INDEX: out of memory. */
static uint32_t get_bit(Finder *finder, uint32_t edge, uint64_t ranks, bool *negated, MesoError *error)
{
    *negated = ranks & 1;
    uint64_t all = all_ranks(finder, edge);
    if (*negated)
        ranks = all & ~ranks;
    if (finder->bit_count == finder->bit_capacity && grow(finder, error))
        return MESO_NO_INDEX;
    uint32_t *place = index_place(finder, edge, ranks);
    if (*place == 0) {
        bool one_label = (ranks & (ranks - 1)) == 0 || ((all & ~ranks) & ((all & ~ranks) - 1)) == 0;
        finder->bits[finder->bit_count] = (Bit){.edge = edge, .parent = finder->bit_count, .size = 1,
                                                .wide = !one_label, .ranks = ranks};
        *place = ++finder->bit_count;
    }
    return *place - 1;
}

/* Root of the tree of `bit`; `*negated` is turned as often as the way there turns the bit. Halves the way. */
static uint32_t bit_root(Finder *finder, uint32_t bit, bool *negated)
{
    Bit *bits = finder->bits;
    while (bits[bit].parent != bit) {
        Bit *parent = &bits[bits[bit].parent];
        if (parent->parent != bits[bit].parent) {
            bits[bit].negated ^= parent->negated;
            bits[bit].parent = parent->parent;
        }
        *negated ^= bits[bit].negated;
        bit = bits[bit].parent;
    }
    return bit;
}

/* Says that two bits are equal, but for their negations. */
static void join(Finder *finder, uint32_t a, uint32_t b, bool negated)
{
    a = bit_root(finder, a, &negated);
    b = bit_root(finder, b, &negated);
    if (a == b)
        return;     /* a contradiction, perhaps: both clauses of the chain tell */
    if (finder->bits[a].size < finder->bits[b].size) {
        uint32_t swap = a;
        a = b;
        b = swap;
    }
    finder->bits[b].parent = a;
    finder->bits[b].negated = negated;
    finder->bits[a].size += finder->bits[b].size;
    finder->bits[a].wide |= finder->bits[b].wide;
}

/* Joins the bits "the value is one of `values`" of the two edges. */
static MesoStatus join_values(Finder *finder, uint32_t slot, const Pair *pair, uint64_t values, MesoError *error)
{
    uint32_t edges[2];
    uint64_t ranks[2] = {edge_ranks(finder, slot, pair->from, pair->from_value, values, &edges[0]),
                         edge_ranks(finder, slot, pair->to, pair->to_value, values, &edges[1])};
    bool negated[2];
    if (ranks[0] == 0 || ranks[1] == 0)
        return MESO_OK;
    uint32_t a = get_bit(finder, edges[0], ranks[0], &negated[0], error);
    uint32_t b = a == MESO_NO_INDEX ? a : get_bit(finder, edges[1], ranks[1], &negated[1], error);
    if (b == MESO_NO_INDEX)
        return MESO_ERR_MEMORY;
    join(finder, a, b, negated[0] ^ negated[1]);
    return MESO_OK;
}

static MesoStatus join_pair(Finder *finder, uint32_t slot, const Pair *pair, MesoError *error)
{
    MesoStatus status = MESO_OK;
    if (pair->value_count > MESO_EDGE_CHAINS_SUMMED) {
        for (uint32_t v = 0; v < pair->value_count && v < 64 && !status; v++)
            status = join_values(finder, slot, pair, (uint64_t)1 << v, error);
        return status;
    }
    /* The sums without value 0: the others are their opposites. */
    for (uint64_t values = 2; values < (uint64_t)1 << pair->value_count && !status; values += 2)
        status = join_values(finder, slot, pair, values, error);
    return status;
}

static MesoStatus join_slots(Finder *finder, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t s = 0; s < finder->table->propagation->graph->slot_count && !status; s++) {
        const MesoLabelPatternList *list = meso_label_pattern_list(finder->table, s, error);
        if (!list)
            return MESO_ERR_MEMORY;
        PairList *pairs = &finder->pair_lists[list->index];
        if (!pairs->known && find_pairs(finder, list, pairs, error))
            return MESO_ERR_MEMORY;
        for (uint32_t i = 0; i < pairs->count && !status; i++)
            status = join_pair(finder, s, &pairs->pairs[i], error);
    }
    return status;
}

static MesoStatus number_chains(Finder *finder, MesoEdgeChains *chains, MesoError *error)
{
    uint32_t *chain = MESO_NEW(finder->arena, uint32_t, finder->bit_count, error);
    chains->links = MESO_NEW(finder->arena, MesoChainLink, finder->bit_count, error);
    if (!chain || !chains->links)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < finder->bit_count; i++) {
        bool negated = false;
        uint32_t root = bit_root(finder, i, &negated);
        if (finder->bits[root].size < 2 || !finder->bits[root].wide)
            continue;
        if (chain[root] == 0)
            chain[root] = ++chains->chain_count;
        chains->links[chains->link_count++] = (MesoChainLink){finder->bits[i].edge, chain[root] - 1,
                                                            finder->bits[i].ranks, negated};
    }
    return MESO_OK;
}

MesoStatus meso_edge_chains_find(MesoEdgeChains *chains, MesoArena *arena, MesoLabelPatternTable *table,
                                 MesoError *error)
{
    Finder finder = {.table = table, .arena = arena, .label_count = 2 * table->propagation->set->interface_count};
    *chains = (MesoEdgeChains){0};
    for (uint32_t s = 0; s < table->propagation->graph->slot_count; s++)
        if (!meso_label_pattern_list(table, s, error))
            return MESO_ERR_MEMORY;
    finder.pair_lists = MESO_NEW(arena, PairList, table->list_count, error);
    if (!finder.pair_lists || join_slots(&finder, error))
        return MESO_ERR_MEMORY;
    return number_chains(&finder, chains, error);
}
