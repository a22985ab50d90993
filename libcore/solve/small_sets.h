/* Small tile sets by number, all of them: for the tests of this folder. */
#ifndef MESO_SMALL_SETS_H
#define MESO_SMALL_SETS_H

#include "libcore/solve/solve_fixture.h"

/*
 * Over one interface (labels a, a') there are 16 tiles, over two (a, a', b, b') 256;
 * sets of one to three of them, each with no transforms, with rotations, with all.
 */
enum {
    SMALL_SETS_ONE = (16 + 16 * 15 / 2 + 16 * 15 * 14 / 6) * 3,
    SMALL_SETS_TWO = (256 + 256 * 255 / 2 + 256 * 255 * 254 / 6) * 3
};

/* Tile `number`: each side takes one bit for the sign and, of two interfaces, one for the interface. */
static inline void small_tile(uint32_t interfaces, uint32_t number, int32_t labels[4])
{
    for (uint32_t k = 0; k < 4; k++) {
        int32_t label = interfaces == 2 && (number >> (4 + k)) & 1 ? 2 : 1;
        labels[k] = (number >> k) & 1 ? -label : label;
    }
}

/* The `number`-th way to choose one, two or three of `count`: the choice goes to `chosen`, its size is returned. */
static inline uint32_t small_choice(uint32_t count, uint32_t number, uint32_t chosen[3])
{
    uint32_t size = 1, ways = count;
    while (number >= ways) {
        number -= ways;
        ways = size++ == 1 ? count * (count - 1) / 2 : count * (count - 1) / 2 * (count - 2) / 3;
    }
    for (uint32_t i = 0, next = 0; i < size; i++, next++) {
        for (;; next++) {
            uint32_t rest = count - 1 - next, left = size - 1 - i;
            ways = left == 0 ? 1 : left == 1 ? rest : rest * (rest - 1) / 2;
            if (number < ways)
                break;
            number -= ways;
        }
        chosen[i] = next;
    }
    return size;
}

static inline MesoTileSet small_set(MesoArena *arena, uint32_t interfaces, uint32_t number)
{
    int32_t labels[3][4];
    uint32_t chosen[3], permissions = number % 3;
    uint32_t count = small_choice(interfaces == 2 ? 256 : 16, number / 3, chosen);
    for (uint32_t t = 0; t < count; t++)
        small_tile(interfaces, chosen[t], labels[t]);
    return fixture_set(arena, interfaces, count, (const int32_t (*)[4])labels, permissions >= 1,
                       permissions == 2, false);
}

/* Bit set of the tiles over one interface that the variants of a set look like. */
static inline uint32_t small_set_looks(MesoArena *arena, const MesoTileSet *set)
{
    MesoVariantSet variants;
    uint32_t looks = 0;
    CHECK(set->interface_count == 1 && meso_variant_set_build(&variants, arena, set, NULL) == MESO_OK);
    for (uint32_t v = 0; v < variants.count; v++) {
        uint32_t number = 0;
        for (uint32_t k = 0; k < 4; k++)
            number |= (uint32_t)(variants.labels[4 * v + k] < 0) << k;
        looks |= 1u << number;
    }
    return looks;
}

/* Those sets over one interface of which no other before looks the same to its neighbours; their number is returned. */
static inline uint32_t small_sets_unlike(MesoArena *arena, uint32_t unlike[SMALL_SETS_ONE])
{
    bool *met = MESO_NEW(arena, bool, 1u << 16, NULL);
    uint32_t count = 0;
    CHECK(met);
    for (uint32_t i = 0; i < SMALL_SETS_ONE; i++) {
        MesoArenaMark mark = meso_arena_mark(arena);
        MesoTileSet set = small_set(arena, 1, i);
        uint32_t looks = small_set_looks(arena, &set);
        if (!met[looks])
            unlike[count++] = i;
        met[looks] = true;
        meso_arena_rewind(arena, mark);
    }
    return count;
}

#endif
