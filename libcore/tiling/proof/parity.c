#include "libcore/tiling/proof/parity.h"

#include <assert.h>
#include <string.h>

#include "libcore/mesh/slot_flood.h"

static const uint64_t word_limit = (uint64_t)1 << 27;

/* Sums modulo 2 that all patterns of a list agree on: rows over the constant (column 0) and the codes shown. */
typedef struct Relations {
    uint32_t count, words;
    uint32_t column_count;
    uint32_t *side, *code;      /* [column_count] of columns from 1 on */
    uint64_t *rows;             /* [count * words] */
} Relations;

/* The equations on the front; each has a pivot column that no other has. */
typedef struct Sweep {
    MesoLabelPatternTable *table;
    MesoArena *arena;
    Relations **relations;      /* [lists of the table] */
    uint32_t *order;            /* [slot_count] */
    uint32_t *block;            /* [4 * slot_count] of an edge's unknowns, at its lower half-edge */
    uint32_t block_count, block_size;
    uint32_t *free_blocks;
    uint32_t free_count;
    uint32_t words, row_count;
    uint64_t **rows;            /* [block_count * block_size + 1] those in use come first */
    uint32_t *row_pivot;        /* column of each row */
    uint32_t *pivot_row;        /* [columns] row, or MESO_NO_INDEX */
    uint64_t work, work_limit;
    bool contradiction;
} Sweep;

static uint32_t find_column(const Relations *relations, uint32_t side, uint32_t code)
{
    for (uint32_t c = 1; c < relations->column_count; c++)
        if (relations->side[c] == side && relations->code[c] == code)
            return c;
    return relations->column_count;
}

static void add_row(uint64_t *to, const uint64_t *from, uint32_t words)
{
    for (uint32_t w = 0; w < words; w++)
        to[w] ^= from[w];
}

/*
 * The patterns as rows in reduced form; returns how many independent ones there are.
 * `pivot` [columns] gets the row of each pivot column, MESO_NO_INDEX for the free ones.
 */
static uint32_t reduce_patterns(const Relations *relations, const MesoLabelPatternList *list, uint64_t *rows,
                                uint32_t *pivot)
{
    uint32_t words = relations->words, rank = 0;
    memset(pivot, 0xff, relations->column_count * sizeof *pivot);
    for (uint32_t p = 0; p < list->count; p++) {
        uint64_t *row = rows + (size_t)rank * words;
        memset(row, 0, words * sizeof *row);
        meso_bits_set(row, 0);
        for (uint32_t k = 0; k < 4; k++)
            if (list->codes[4 * (size_t)p + k] != MESO_LABEL_PATTERN_BORDER)
                meso_bits_set(row, find_column(relations, k, list->codes[4 * (size_t)p + k]));
        for (uint32_t c = 0; c < relations->column_count; c++)
            if (pivot[c] != MESO_NO_INDEX && meso_bits_test(row, c))
                add_row(row, rows + (size_t)pivot[c] * words, words);
        uint32_t first = meso_bits_first(row, words);
        if (first == 64 * words)
            continue;
        for (uint32_t r = 0; r < rank; r++)
            if (meso_bits_test(rows + (size_t)r * words, first))
                add_row(rows + (size_t)r * words, row, words);
        pivot[first] = rank++;
    }
    return rank;
}

/* For each free column, the vector that has it, and all pivots whose rows have it. */
static void fill_null_space(Relations *relations, const uint64_t *patterns, const uint32_t *pivot)
{
    for (uint32_t f = 0; f < relations->column_count; f++) {
        if (pivot[f] != MESO_NO_INDEX)
            continue;
        uint64_t *row = relations->rows + (size_t)relations->count++ * relations->words;
        meso_bits_set(row, f);
        for (uint32_t c = 0; c < relations->column_count; c++)
            if (pivot[c] != MESO_NO_INDEX && meso_bits_test(patterns + (size_t)pivot[c] * relations->words, f))
                meso_bits_set(row, c);
    }
}

static Relations *find_relations(MesoArena *arena, const MesoLabelPatternList *list, MesoError *error)
{
    Relations *relations = MESO_NEW(arena, Relations, 1, error);
    size_t most = 4 * (size_t)list->count + 1;
    uint32_t *side = MESO_NEW(arena, uint32_t, most, error), *code = MESO_NEW(arena, uint32_t, most, error);
    if (!relations || !side || !code)
        return NULL;
    *relations = (Relations){.column_count = 1, .side = side, .code = code};
    for (uint32_t i = 0; i < 4 * list->count; i++) {
        uint32_t c = relations->column_count;
        if (list->codes[i] == MESO_LABEL_PATTERN_BORDER || find_column(relations, i % 4, list->codes[i]) < c)
            continue;
        side[c] = i % 4;
        code[c] = list->codes[i];
        relations->column_count++;
    }
    uint32_t words = relations->words = meso_bits_words(relations->column_count);
    uint32_t most_rank = list->count < relations->column_count ? list->count : relations->column_count;
    uint64_t *patterns = MESO_NEW(arena, uint64_t, (most_rank + (size_t)1) * words, error);
    uint32_t *pivot = MESO_NEW(arena, uint32_t, relations->column_count, error);
    if (!patterns || !pivot)
        return NULL;
    uint32_t rank = reduce_patterns(relations, list, patterns, pivot);
    relations->rows = MESO_NEW(arena, uint64_t, (relations->column_count - rank) * (size_t)words, error);
    if (!relations->rows)
        return NULL;
    fill_null_space(relations, patterns, pivot);
    return relations;
}

/* Each piece breadth first from a slot far off: the last one of a first round. */
static MesoStatus order_slots(Sweep *sweep, MesoError *error)
{
    const MesoSlotGraph *graph = sweep->table->propagation->graph;
    sweep->order = MESO_NEW(sweep->arena, uint32_t, graph->slot_count, error);
    MesoSlotFlood flood = {.graph = graph, .slots = sweep->order, .most = graph->slot_count,
                           .met = MESO_NEW(sweep->arena, bool, graph->slot_count, error)};
    if (!flood.met || !sweep->order)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < graph->slot_count; s++) {
        if (flood.met[s])
            continue;
        uint32_t begin = flood.count;
        meso_slot_flood_meet(&flood, s);
        meso_slot_flood_all(&flood);
        uint32_t last = flood.slots[flood.count - 1];
        for (uint32_t i = begin; i < flood.count; i++)
            flood.met[flood.slots[i]] = false;
        flood.count = flood.followed = begin;
        meso_slot_flood_meet(&flood, last);
        meso_slot_flood_all(&flood);
    }
    return MESO_OK;
}

/* Half-edge that stands for the edge of side `side` of `slot`; MESO_NO_INDEX where there is nothing unknown. */
static uint32_t unknown_edge(const Sweep *sweep, uint32_t slot, uint32_t side)
{
    uint32_t half_edge = 4 * slot + side;
    uint32_t twin = sweep->table->propagation->graph->twin[half_edge];
    if (twin == MESO_NO_INDEX)
        return MESO_NO_INDEX;
    uint32_t lower = half_edge < twin ? half_edge : twin;
    return meso_propagation_label_count(sweep->table->propagation, lower) < 2 ? MESO_NO_INDEX : lower;
}

/* Most edges with unknowns on the front at a time, and most labels of one. */
static MesoStatus measure_front(Sweep *sweep, MesoError *error)
{
    const MesoSlotGraph *graph = sweep->table->propagation->graph;
    uint32_t open = 0;
    sweep->block = MESO_NEW(sweep->arena, uint32_t, 4 * (size_t)graph->slot_count, error);
    if (!sweep->block)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < graph->slot_count; i++) {
        uint32_t closing = 0;
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t edge = unknown_edge(sweep, sweep->order[i], k);
            if (edge == MESO_NO_INDEX)
                continue;
            uint32_t count = meso_propagation_label_count(sweep->table->propagation, edge);
            sweep->block_size = count > sweep->block_size ? count : sweep->block_size;
            open += sweep->block[edge] == 0;
            closing += sweep->block[edge] == 1;
            sweep->block[edge]++;
        }
        sweep->block_count = open > sweep->block_count ? open : sweep->block_count;
        open -= closing;
    }
    return MESO_OK;
}

/* False where it would take too much. */
static bool affordable(const Sweep *sweep)
{
    uint64_t columns = (uint64_t)sweep->block_count * sweep->block_size + 1;
    return columns < UINT32_MAX && columns / 64 + 1 <= word_limit / columns;
}

static MesoStatus allocate(Sweep *sweep, MesoError *error)
{
    uint32_t columns = sweep->block_count * sweep->block_size + 1;
    sweep->words = meso_bits_words(columns);
    sweep->free_blocks = MESO_NEW(sweep->arena, uint32_t, sweep->block_count, error);
    sweep->rows = MESO_NEW(sweep->arena, uint64_t *, (size_t)columns + 1, error);
    sweep->row_pivot = MESO_NEW(sweep->arena, uint32_t, (size_t)columns + 1, error);
    sweep->pivot_row = MESO_NEW(sweep->arena, uint32_t, columns, error);
    sweep->relations = MESO_NEW(sweep->arena, Relations *, sweep->table->list_count, error);
    uint64_t *words = MESO_NEW(sweep->arena, uint64_t, ((size_t)columns + 1) * sweep->words, error);
    if (!sweep->free_blocks || !sweep->rows || !sweep->row_pivot || !sweep->pivot_row ||
        !sweep->relations || !words)
        return MESO_ERR_MEMORY;
    for (uint32_t b = sweep->block_count; b-- > 0;)
        sweep->free_blocks[sweep->free_count++] = b;
    for (uint32_t r = 0; r <= columns; r++)
        sweep->rows[r] = words + (size_t)r * sweep->words;
    memset(sweep->pivot_row, 0xff, columns * sizeof *sweep->pivot_row);
    memset(sweep->block, 0xff, 4 * (size_t)sweep->table->propagation->graph->slot_count * sizeof *sweep->block);
    return MESO_OK;
}

/* Adds row `from` to all others that have `column`. */
static void eliminate(Sweep *sweep, uint32_t column, uint32_t from)
{
    for (uint32_t r = 0; r < sweep->row_count; r++)
        if (r != from && meso_bits_test(sweep->rows[r], column)) {
            add_row(sweep->rows[r], sweep->rows[from], sweep->words);
            sweep->work += sweep->words;
        }
    sweep->work += sweep->row_count;
}

static void remove_row(Sweep *sweep, uint32_t row)
{
    uint32_t last = --sweep->row_count;
    uint64_t *words = sweep->rows[row];
    sweep->pivot_row[sweep->row_pivot[row]] = MESO_NO_INDEX;
    if (row == last)
        return;
    sweep->rows[row] = sweep->rows[last];
    sweep->rows[last] = words;
    sweep->row_pivot[row] = sweep->row_pivot[last];
    sweep->pivot_row[sweep->row_pivot[row]] = row;
}

/* Column of the unknown "side `side` of `slot` shows `code`"; 0, the constant, where that is all it can show. */
static uint32_t unknown_column(const Sweep *sweep, uint32_t slot, uint32_t side, uint32_t code)
{
    uint32_t edge = unknown_edge(sweep, slot, side);
    if (edge == MESO_NO_INDEX)
        return 0;
    uint32_t far_code = edge == 4 * slot + side ? code ^ 1 : code;
    uint32_t rank = meso_bits_rank(meso_propagation_labels(sweep->table->propagation, edge), far_code);
    return 1 + sweep->block[edge] * sweep->block_size + rank;
}

/* The first column of a row but the constant, or 0. */
static uint32_t first_unknown(const uint64_t *row, uint32_t words)
{
    uint64_t first = row[0] & ~(uint64_t)1;
    if (first)
        return (uint32_t)__builtin_ctzll(first);
    uint32_t column = 64 + meso_bits_first(row + 1, words - 1);
    return column == 64 * words ? 0 : column;
}

/* Adds one equation, of the relation's columns as they are numbered on the front. */
static void add_equation(Sweep *sweep, const Relations *relations, const uint64_t *relation,
                         const uint32_t *columns)
{
    uint64_t *row = sweep->rows[sweep->row_count];
    memset(row, 0, sweep->words * sizeof *row);
    for (uint32_t c = 0; c < relations->column_count; c++)
        if (meso_bits_test(relation, c))
            row[columns[c] / 64] ^= (uint64_t)1 << (columns[c] % 64);
    for (uint32_t c = 1; c < relations->column_count; c++)
        if (sweep->pivot_row[columns[c]] != MESO_NO_INDEX && meso_bits_test(row, columns[c])) {
            add_row(row, sweep->rows[sweep->pivot_row[columns[c]]], sweep->words);
            sweep->work += sweep->words;
        }
    uint32_t pivot = first_unknown(row, sweep->words);
    if (pivot == 0) {
        sweep->contradiction |= meso_bits_test(row, 0);
        return;
    }
    uint32_t number = sweep->row_count++;
    sweep->row_pivot[number] = pivot;
    sweep->pivot_row[pivot] = number;
    eliminate(sweep, pivot, number);
}

/* Eliminates the unknowns of an edge that no further slot has. */
static void close_edge(Sweep *sweep, uint32_t edge)
{
    uint32_t block = sweep->block[edge];
    for (uint32_t i = 0; i < meso_propagation_label_count(sweep->table->propagation, edge); i++) {
        uint32_t column = 1 + block * sweep->block_size + i;
        uint32_t row = sweep->pivot_row[column];
        if (row == MESO_NO_INDEX) {
            for (row = 0; row < sweep->row_count && !meso_bits_test(sweep->rows[row], column); row++)
                ;
            if (row == sweep->row_count)
                continue;
            eliminate(sweep, column, row);
        }
        remove_row(sweep, row);
    }
    sweep->free_blocks[sweep->free_count++] = block;
}

static MesoStatus add_slot(Sweep *sweep, uint32_t slot, uint32_t *columns, MesoError *error)
{
    const MesoLabelPatternList *list = meso_label_pattern_list(sweep->table, slot, error);
    if (!list)
        return MESO_ERR_MEMORY;
    Relations **relations = &sweep->relations[list->index];
    if (!*relations)
        *relations = find_relations(sweep->arena, list, error);
    if (!*relations)
        return MESO_ERR_MEMORY;

    uint32_t edges[4], closing[4], closing_count = 0;
    for (uint32_t k = 0; k < 4; k++) {
        edges[k] = unknown_edge(sweep, slot, k);
        if (edges[k] == MESO_NO_INDEX)
            continue;
        if (sweep->block[edges[k]] != MESO_NO_INDEX) {
            closing[closing_count++] = edges[k];
            continue;
        }
        assert(sweep->free_count > 0);
        sweep->block[edges[k]] = sweep->free_blocks[--sweep->free_count];
    }
    columns[0] = 0;
    for (uint32_t c = 1; c < (*relations)->column_count; c++)
        columns[c] = unknown_column(sweep, slot, (*relations)->side[c], (*relations)->code[c]);
    for (uint32_t r = 0; r < (*relations)->count && !sweep->contradiction; r++)
        add_equation(sweep, *relations, (*relations)->rows + (size_t)r * (*relations)->words, columns);
    for (uint32_t i = 0; i < closing_count && !sweep->contradiction; i++)
        close_edge(sweep, closing[i]);
    return MESO_OK;
}

/* Makes every list, so that their number is known; returns the most columns of relations, or 0 without memory. */
static size_t prepare_lists(Sweep *sweep, MesoError *error)
{
    size_t most = 1;
    for (uint32_t s = 0; s < sweep->table->propagation->graph->slot_count; s++) {
        const MesoLabelPatternList *list = meso_label_pattern_list(sweep->table, s, error);
        if (!list)
            return 0;
        most = 4 * (size_t)list->count + 1 > most ? 4 * (size_t)list->count + 1 : most;
    }
    return most;
}

MesoStatus meso_parity_prove(uint32_t *slot, MesoArena *arena, MesoLabelPatternTable *table,
                             uint64_t work_limit, MesoError *error)
{
    Sweep sweep = {.table = table, .arena = arena, .work_limit = work_limit};
    uint32_t slot_count = table->propagation->graph->slot_count;
    *slot = MESO_NO_INDEX;
    size_t most = prepare_lists(&sweep, error);
    uint32_t *columns = most ? MESO_NEW(arena, uint32_t, most, error) : NULL;
    if (!columns || order_slots(&sweep, error) || measure_front(&sweep, error))
        return MESO_ERR_MEMORY;
    if (!affordable(&sweep))
        return MESO_OK;
    if (allocate(&sweep, error))
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < slot_count && sweep.work < work_limit; i++) {
        if (add_slot(&sweep, sweep.order[i], columns, error))
            return MESO_ERR_MEMORY;
        if (sweep.contradiction) {
            *slot = sweep.order[i];
            return MESO_OK;
        }
    }
    return MESO_OK;
}
