#include "formats/image/quick_deflate.h"

#include <string.h>

#include <libdeflate.h>

#include "formats/image/prefix_code.h"

enum {
    FARTHEST = 32768, LEAST_MATCH = 4, LONGEST_MATCH = 258,
    BLOCK_SYMBOLS = 1 << 14,        /* literals and matches of a block, whose code fits them */
    SKIP = 32,                      /* after so many places from which on nothing comes again, fewer are looked at */
    END_OF_BLOCK = 256, LITERAL_CODES = 286, DISTANCE_CODES = 30, RUN_CODES = 19, RUN_LENGTH = 7,
    MOST_STORED = 65535, STORED_HEAD = 5, SPARE = 16
};

static uint32_t read_four(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static uint64_t read_eight(const uint8_t *at)
{
    return read_four(at) | (uint64_t)read_four(at + 4) << 32;
}

/* ---- sequences ---- */

/* Part of the input as sequences, of which the last has no match where the block ends. */
typedef struct Block {
    size_t begin, end;
    uint32_t sequence_count;
    uint32_t literal_counts[LITERAL_CODES], distance_counts[DISTANCE_CODES];
} Block;

static uint32_t *head_of(MesoQuickDeflate *scratch, uint32_t bytes)
{
    return &scratch->heads[bytes * 0x9e3779b1u >> (32 - MESO_DEFLATE_HEAD_BITS)];
}

/* How many bytes from `a` on are those from `b` on, before it; up to `end`. */
static size_t match_length(const uint8_t *b, const uint8_t *a, const uint8_t *end)
{
    const uint8_t *begin = a;
    for (; end - a >= 8; a += 8, b += 8) {
        uint64_t differ = read_eight(a) ^ read_eight(b);
        if (differ)
            return (size_t)(a - begin) + (size_t)__builtin_ctzll(differ) / 8;
    }
    while (a < end && *a == *b) {
        a++;
        b++;
    }
    return (size_t)(a - begin);
}

/* As long ones as there are, and none that is too short. */
static void put_match(MesoQuickDeflate *scratch, Block *block, uint32_t literals, size_t length, uint32_t distance)
{
    while (length >= LEAST_MATCH && block->sequence_count < MESO_DEFLATE_SEQUENCES - 1) {
        uint32_t part = length < LONGEST_MATCH ? (uint32_t)length : LONGEST_MATCH;
        scratch->sequences[block->sequence_count++] = (MesoDeflateSequence){literals, (uint16_t)part,
                                                                            (uint16_t)distance};
        literals = 0;
        length -= part;
        block->end += part;
    }
}

/* `heads` are places and FARTHEST + 1 more: 0 is too far from anywhere. */
static void find_sequences(MesoQuickDeflate *scratch, const uint8_t *in, size_t size, Block *block)
{
    size_t at = block->begin, anchor = at, last = size < LEAST_MATCH ? 0 : size - LEAST_MATCH + 1;
    size_t stop = last - at < BLOCK_SYMBOLS ? last : at + BLOCK_SYMBOLS;
    block->sequence_count = 0;
    while (at < stop) {
        uint32_t bytes = read_four(in + at), here = (uint32_t)at + FARTHEST + 1, *head = head_of(scratch, bytes);
        uint32_t distance = here - *head;
        *head = here;
        if (distance > FARTHEST || read_four(in + at - distance) != bytes) {
            at += 1 + (at - anchor) / SKIP;
            continue;
        }
        uint32_t literals = (uint32_t)(at - anchor), before = block->sequence_count;
        block->end = at;
        put_match(scratch, block, literals, match_length(in + at - distance, in + at, in + size), distance);
        stop += block->end - at - (block->sequence_count - before);
        anchor = at = block->end;
        stop = block->sequence_count == MESO_DEFLATE_SEQUENCES - 1 ? at : stop < last ? stop : last;
        if (at < last)
            *head_of(scratch, read_four(in + at - 1)) = (uint32_t)at + FARTHEST;
    }
    if (at >= last)
        at = size;
    scratch->sequences[block->sequence_count++] = (MesoDeflateSequence){.literals = (uint32_t)(at - anchor)};
    block->end = at;
}

/* ---- symbols ---- */

/* A length or distance: its symbol, and what follows it. */
typedef struct Symbol {
    uint32_t symbol, bits, bit_count;
} Symbol;

static Symbol length_symbol(uint32_t length)
{
    uint32_t more = length - 3;
    if (length == LONGEST_MATCH)
        return (Symbol){END_OF_BLOCK + 29, 0, 0};
    if (more < 8)
        return (Symbol){END_OF_BLOCK + 1 + more, 0, 0};
    uint32_t bit_count = 29 - (uint32_t)__builtin_clz(more);
    return (Symbol){END_OF_BLOCK + 1 + 4 * (bit_count + 1) + (more >> bit_count & 3), more & ((1u << bit_count) - 1),
                    bit_count};
}

static Symbol distance_symbol(uint32_t distance)
{
    uint32_t more = distance - 1;
    if (more < 4)
        return (Symbol){more, 0, 0};
    uint32_t bit_count = 30 - (uint32_t)__builtin_clz(more);
    return (Symbol){2 * (bit_count + 1) + (more >> bit_count & 1), more & ((1u << bit_count) - 1), bit_count};
}

static void count_symbols(const MesoQuickDeflate *scratch, const uint8_t *in, Block *block)
{
    uint32_t counts[4][256] = {{0}};        /* one after the other: the same byte may come again soon */
    const uint8_t *at = in + block->begin;
    memset(block->literal_counts, 0, sizeof block->literal_counts);
    memset(block->distance_counts, 0, sizeof block->distance_counts);
    for (uint32_t i = 0; i < block->sequence_count; i++) {
        MesoDeflateSequence s = scratch->sequences[i];
        for (uint32_t k = 0; k < s.literals; k++)
            counts[k % 4][at[k]]++;
        at += s.literals + s.length;
        if (s.length) {
            block->literal_counts[length_symbol(s.length).symbol]++;
            block->distance_counts[distance_symbol(s.distance).symbol]++;
        }
    }
    for (uint32_t b = 0; b < 256; b++)
        block->literal_counts[b] = counts[0][b] + counts[1][b] + counts[2][b] + counts[3][b];
    block->literal_counts[END_OF_BLOCK] = 1;
}

/* ---- lengths of codes ---- */

/* Lengths of both codes, one after the other, with what stands for runs of them. */
typedef struct Lengths {
    uint32_t literal_codes, distance_codes, count;
    Symbol runs[LITERAL_CODES + DISTANCE_CODES];
    uint32_t run_codes;             /* in their order that are written */
    MesoPrefixCode code;
} Lengths;

static const uint8_t RUN_ORDER[RUN_CODES] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};

static uint32_t used_codes(const MesoPrefixCode *code, uint32_t count, uint32_t least)
{
    while (count > least && !code->lengths[count - 1])
        count--;
    return count;
}

/* One run, or part of it; returns how long that is. */
static uint32_t take_run(Lengths *l, uint32_t length, uint32_t run, bool begun)
{
    Symbol *out = &l->runs[l->count++];
    if (length == 0 && run >= 11) {
        run = run < 138 ? run : 138;
        *out = (Symbol){18, run - 11, 7};
    } else if (length == 0 && run >= 3) {
        *out = (Symbol){17, run - 3, 3};
    } else if (length != 0 && begun && run >= 3) {
        run = run < 6 ? run : 6;
        *out = (Symbol){16, run - 3, 2};
    } else {
        run = 1;
        *out = (Symbol){length, 0, 0};
    }
    return run;
}

static void describe_codes(Lengths *l, const MesoPrefixCode *literals, const MesoPrefixCode *distances)
{
    uint8_t all[LITERAL_CODES + DISTANCE_CODES];
    uint32_t counts[RUN_CODES] = {0}, count;
    l->literal_codes = used_codes(literals, LITERAL_CODES, 257);
    l->distance_codes = used_codes(distances, DISTANCE_CODES, 1);
    l->count = 0;
    memcpy(all, literals->lengths, l->literal_codes);
    memcpy(all + l->literal_codes, distances->lengths, l->distance_codes);
    count = l->literal_codes + l->distance_codes;
    for (uint32_t i = 0; i < count;) {
        uint32_t run = 1;
        while (i + run < count && all[i + run] == all[i])
            run++;
        i += take_run(l, all[i], run, i > 0 && all[i - 1] == all[i]);
    }
    for (uint32_t i = 0; i < l->count; i++)
        counts[l->runs[i].symbol]++;
    meso_prefix_code(&l->code, counts, RUN_CODES, RUN_LENGTH);
    l->run_codes = RUN_CODES;
    while (l->run_codes > 4 && !l->code.lengths[RUN_ORDER[l->run_codes - 1]])
        l->run_codes--;
}

/* ---- blocks ---- */

static uint64_t bits_of(const Block *block, const Lengths *l, const MesoPrefixCode *literals,
                        const MesoPrefixCode *distances)
{
    uint64_t bits = 17 + 3 * l->run_codes;
    for (uint32_t i = 0; i < l->count; i++)
        bits += l->code.lengths[l->runs[i].symbol] + l->runs[i].bit_count;
    for (uint32_t s = 0; s < LITERAL_CODES; s++) {
        uint32_t more = s < END_OF_BLOCK + 9 || s == END_OF_BLOCK + 29 ? 0 : (s - END_OF_BLOCK - 5) / 4;
        bits += (uint64_t)block->literal_counts[s] * (literals->lengths[s] + more);
    }
    for (uint32_t s = 0; s < DISTANCE_CODES; s++)
        bits += (uint64_t)block->distance_counts[s] * (distances->lengths[s] + (s < 4 ? 0 : s / 2 - 1));
    return bits;
}

static void put_code(MesoBitWriter *w, const MesoPrefixCode *code, uint32_t symbol)
{
    meso_bits_put(w, code->bits[symbol], code->lengths[symbol]);
}

static void put_symbol(MesoBitWriter *w, const MesoPrefixCode *code, Symbol s)
{
    put_code(w, code, s.symbol);
    meso_bits_put(w, s.bits, s.bit_count);
}

static void put_lengths(MesoBitWriter *w, const Lengths *l)
{
    meso_bits_put(w, l->literal_codes - 257, 5);
    meso_bits_put(w, l->distance_codes - 1, 5);
    meso_bits_put(w, l->run_codes - 4, 4);
    meso_bits_flush(w);
    for (uint32_t i = 0; i < l->run_codes; i++) {
        meso_bits_put(w, l->code.lengths[RUN_ORDER[i]], 3);
        meso_bits_flush(w);
    }
    for (uint32_t i = 0; i < l->count; i++) {
        put_symbol(w, &l->code, l->runs[i]);
        meso_bits_flush(w);
    }
}

static void put_literals(MesoBitWriter *w, const MesoPrefixCode *code, const uint8_t *at, uint32_t count)
{
    for (; count >= 3; count -= 3, at += 3) {
        put_code(w, code, at[0]);
        put_code(w, code, at[1]);
        put_code(w, code, at[2]);
        meso_bits_flush(w);
    }
    for (uint32_t i = 0; i < count; i++)
        put_code(w, code, at[i]);
    meso_bits_flush(w);
}

static void put_sequences(MesoBitWriter *writer, const MesoQuickDeflate *scratch, const uint8_t *at,
                          const Block *block, const MesoPrefixCode *literals, const MesoPrefixCode *distances)
{
    MesoBitWriter w = *writer;
    for (uint32_t i = 0; i < block->sequence_count; i++) {
        MesoDeflateSequence s = scratch->sequences[i];
        put_literals(&w, literals, at, s.literals);
        at += s.literals + s.length;
        if (!s.length)
            continue;
        put_symbol(&w, literals, length_symbol(s.length));
        put_symbol(&w, distances, distance_symbol(s.distance));
        meso_bits_flush(&w);
    }
    put_code(&w, literals, END_OF_BLOCK);
    meso_bits_flush(&w);
    *writer = w;
}

static void put_stored(MesoBitWriter *w, const uint8_t *at, size_t count, bool last)
{
    do {
        uint32_t part = count < MOST_STORED ? (uint32_t)count : MOST_STORED;
        count -= part;
        meso_bits_put(w, last && count == 0, 3);
        meso_bits_put(w, 0, (8 - w->count % 8) % 8);
        meso_bits_flush(w);
        meso_bits_put(w, part, 16);
        meso_bits_put(w, part ^ MOST_STORED, 16);
        meso_bits_flush(w);
        memcpy(w->out, at, part);
        w->out += part;
        at += part;
    } while (count > 0);
}

static uint64_t stored_bits(const Block *block)
{
    uint64_t bytes = block->end - block->begin;
    return 8 * (bytes + STORED_HEAD * (bytes / MOST_STORED + 1));
}

static void put_block(MesoBitWriter *w, const MesoQuickDeflate *scratch, const uint8_t *in, Block *block, bool last)
{
    MesoPrefixCode literals, distances;
    Lengths lengths;
    count_symbols(scratch, in, block);
    meso_prefix_code(&literals, block->literal_counts, LITERAL_CODES, MESO_CODE_LENGTH);
    meso_prefix_code(&distances, block->distance_counts, DISTANCE_CODES, MESO_CODE_LENGTH);
    describe_codes(&lengths, &literals, &distances);
    if (bits_of(block, &lengths, &literals, &distances) > stored_bits(block)) {
        put_stored(w, in + block->begin, block->end - block->begin, last);
        return;
    }
    meso_bits_put(w, last | 2 << 1, 3);
    put_lengths(w, &lengths);
    put_sequences(w, scratch, in + block->begin, block, &literals, &distances);
}

size_t meso_quick_deflate_bound(size_t size)
{
    return size + STORED_HEAD * (size / (MESO_DEFLATE_SEQUENCES - 1) + size / MOST_STORED + 2) + SPARE;
}

size_t meso_quick_deflate(MesoQuickDeflate *scratch, const uint8_t *in, size_t size, uint8_t *out)
{
    Block block = {0};
    MesoBitWriter w = {.out = out};
    uint32_t sum = libdeflate_adler32(1, in, size);
    memset(scratch->heads, 0, sizeof scratch->heads);
    meso_bits_put(&w, 0x0178, 16);
    do {
        block.begin = block.end;
        find_sequences(scratch, in, size, &block);
        put_block(&w, scratch, in, &block, block.end == size);
    } while (block.end < size);
    meso_bits_put(&w, 0, (8 - w.count) % 8);
    for (int shift = 24; shift >= 0; shift -= 8)
        meso_bits_put(&w, sum >> shift & 255, 8);
    meso_bits_flush(&w);
    return (size_t)(w.out - out);
}
