/* Prefix codes of DEFLATE (RFC 1951, 3.2), by how often their symbols come; and bits one after another. */
#ifndef MESO_PREFIX_CODE_H
#define MESO_PREFIX_CODE_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { MESO_CODE_SYMBOLS = 288, MESO_CODE_LENGTH = 15 };

/* Canonical: `bits` begin with the first, at the lowest. Of symbols that do not come, the length is 0. */
typedef struct MesoPrefixCode {
    uint8_t lengths[MESO_CODE_SYMBOLS];
    uint16_t bits[MESO_CODE_SYMBOLS];
} MesoPrefixCode;

/*
 * The best code, but for the limit: Huffman's, whose lengths are cut to `longest` (15 at most) and evened out until
 * the code is complete again. counts [symbol_count], whose sum is below 2^24: how often each comes; where fewer than
 * two do, others stand in, as decoders want a complete code. 2^longest >= symbol_count. O(symbols).
 */
void meso_prefix_code(MesoPrefixCode *code, const uint32_t *counts, uint32_t symbol_count, uint32_t longest);

/* Bits on their way into bytes. */
typedef struct MesoBitWriter {
    uint64_t bits;
    uint32_t count;             /* of bits, at most 7 after meso_bits_flush() */
    uint8_t *out;
} MesoBitWriter;

/* Up to 57 between two flushes. `bits` has no more than `count`. */
static inline void meso_bits_put(MesoBitWriter *w, uint64_t bits, uint32_t count)
{
    w->bits |= bits << w->count;
    w->count += count;
}

/* Whole bytes go out; it writes to eight bytes, of which what follows the last whole one is anything. */
static inline void meso_bits_flush(MesoBitWriter *w)
{
    uint8_t bytes[8];
    for (uint32_t i = 0; i < 8; i++)
        bytes[i] = (uint8_t)(w->bits >> (8 * i));
    memcpy(w->out, bytes, sizeof bytes);
    w->out += w->count / 8;
    w->bits >>= w->count & ~7u;
    w->count &= 7;
}

#endif
