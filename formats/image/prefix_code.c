#include "formats/image/prefix_code.h"

enum { KEY_BITS = 9, KEY_MASK = (1 << KEY_BITS) - 1 };      /* of a symbol, below its count */

/* Those that come, from the rarest on, and where they are as many by symbol. Returns how many. */
static uint32_t sort_symbols(uint64_t *keys, uint64_t *other, const uint32_t *counts, uint32_t symbol_count)
{
    uint32_t used = 0, most = 0;
    for (uint32_t s = 0; s < symbol_count; s++)
        if (counts[s]) {
            keys[used++] = (uint64_t)counts[s] << KEY_BITS | s;
            most = counts[s] > most ? counts[s] : most;
        }
    for (uint32_t s = 0; used < 2; s++)     /* stand in for others */
        if (!counts[s])
            keys[used++] = (uint64_t)1 << KEY_BITS | s;
    for (uint32_t shift = KEY_BITS; most; shift += 8, most >>= 8) {
        uint32_t begin[257] = {0};
        for (uint32_t i = 0; i < used; i++)
            begin[(keys[i] >> shift & 255) + 1]++;
        for (uint32_t k = 0; k < 256; k++)
            begin[k + 1] += begin[k];
        for (uint32_t i = 0; i < used; i++)
            other[begin[keys[i] >> shift & 255]++] = keys[i];
        memcpy(keys, other, used * sizeof *keys);
    }
    return used;
}

/* Huffman's tree over sorted leaves: `of_length` gets how many of them lie how deep, those below `longest` there. */
static void count_lengths(uint32_t *of_length, const uint64_t *keys, uint32_t used, uint32_t longest)
{
    uint32_t weights[MESO_CODE_SYMBOLS], parents[2 * MESO_CODE_SYMBOLS], depths[MESO_CODE_SYMBOLS];
    uint32_t leaf = 0, joined = 0;
    for (uint32_t node = 0; node + 1 < used; node++) {
        weights[node] = 0;
        for (int k = 0; k < 2; k++) {
            bool from_leaves = leaf < used && (joined == node || (keys[leaf] >> KEY_BITS) <= weights[joined]);
            weights[node] += from_leaves ? (uint32_t)(keys[leaf] >> KEY_BITS) : weights[joined];
            parents[from_leaves ? leaf++ : MESO_CODE_SYMBOLS + joined++] = node;
        }
    }
    depths[used - 2] = 0;
    for (uint32_t node = used - 2; node-- > 0;)
        depths[node] = depths[parents[MESO_CODE_SYMBOLS + node]] + 1;
    for (uint32_t i = 0; i < used; i++) {
        uint32_t depth = depths[parents[i]] + 1;
        of_length[depth < longest ? depth : longest]++;
    }
}

/* Where lengths were cut, longer ones for others until there is room for all; and none is left over. */
static void even_out(uint32_t *of_length, uint32_t longest)
{
    int64_t over = -((int64_t)1 << longest);
    for (uint32_t l = 1; l <= longest; l++)
        over += (int64_t)of_length[l] << (longest - l);
    while (over > 0) {
        uint32_t l = longest - 1;
        while (!of_length[l])
            l--;
        of_length[l]--;
        of_length[l + 1]++;
        over -= (int64_t)1 << (longest - l - 1);
    }
    for (; over < 0; over++) {
        of_length[longest]--;
        of_length[longest - 1]++;
    }
}

static uint16_t reversed(uint32_t bits, uint32_t count)
{
    uint32_t out = 0;
    for (uint32_t i = 0; i < count; i++)
        out |= (bits >> i & 1) << (count - 1 - i);
    return (uint16_t)out;
}

static void number_codes(MesoPrefixCode *code, const uint32_t *of_length, uint32_t symbol_count)
{
    uint32_t next[MESO_CODE_LENGTH + 2] = {0};
    for (uint32_t l = 1; l <= MESO_CODE_LENGTH; l++)
        next[l + 1] = (next[l] + of_length[l]) << 1;
    for (uint32_t s = 0; s < symbol_count; s++)
        code->bits[s] = code->lengths[s] ? reversed(next[code->lengths[s]]++, code->lengths[s]) : 0;
}

void meso_prefix_code(MesoPrefixCode *code, const uint32_t *counts, uint32_t symbol_count, uint32_t longest)
{
    uint64_t keys[MESO_CODE_SYMBOLS], other[MESO_CODE_SYMBOLS];
    uint32_t of_length[MESO_CODE_LENGTH + 1] = {0}, next = 0;
    uint32_t used = sort_symbols(keys, other, counts, symbol_count);
    count_lengths(of_length, keys, used, longest);
    even_out(of_length, longest);
    memset(code->lengths, 0, sizeof code->lengths);
    for (uint32_t l = longest; l > 0; l--)          /* the rarest have the longest */
        for (uint32_t i = 0; i < of_length[l]; i++)
            code->lengths[keys[next++] & KEY_MASK] = (uint8_t)l;
    number_codes(code, of_length, symbol_count);
}
