/* Codes are complete and as short as can be; whatever is compressed, zlib gives back. */
#include "formats/image/quick_deflate.h"

#include <zlib.h>

#include "formats/image/prefix_code.h"
#include "libcore/base/check.h"

enum { MOST = 1 << 20 };

static uint8_t input[MOST], packed[2 * MOST], unpacked[MOST + 1];
static MesoQuickDeflate scratch;
static uint64_t state = 1;

static uint32_t random_below(uint32_t limit)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((state >> 33) % limit);
}

/* ---- codes ---- */

/* Bits of all symbols by Huffman's rule: the two rarest become one, again and again. */
static uint64_t best_bits(const uint32_t *counts, uint32_t count)
{
    uint64_t weights[MESO_CODE_SYMBOLS], bits = 0;
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; i++)
        if (counts[i])
            weights[left++] = counts[i];
    for (; left > 1; left--) {
        for (uint32_t k = 0; k < 2; k++)
            for (uint32_t i = 0; i < left - 1 - k; i++)
                if (weights[i] < weights[i + 1]) {
                    uint64_t w = weights[i];
                    weights[i] = weights[i + 1];
                    weights[i + 1] = w;
                }
        weights[left - 2] += weights[left - 1];
        bits += weights[left - 2];
    }
    return bits;
}

/* Complete, none a beginning of another, and not above the limit. Returns the bits of all symbols. */
static uint64_t check_code(const uint32_t *counts, uint32_t count, uint32_t longest)
{
    static uint8_t taken[1 << MESO_CODE_LENGTH];
    MesoPrefixCode code;
    uint64_t bits = 0;
    uint32_t places = 0;
    memset(taken, 0, sizeof taken);
    meso_prefix_code(&code, counts, count, longest);
    for (uint32_t s = 0; s < count; s++) {
        uint32_t length = code.lengths[s];
        CHECK(length <= longest && (length > 0 || counts[s] == 0));
        bits += (uint64_t)counts[s] * length;
        for (uint32_t i = code.bits[s]; length && i < 1u << MESO_CODE_LENGTH; i += 1u << length, places++)
            CHECK(!taken[i]++);
    }
    CHECK(places == 1u << MESO_CODE_LENGTH);
    return bits;
}

static void test_codes(void)
{
    uint32_t counts[MESO_CODE_SYMBOLS] = {0};
    CHECK(check_code(counts, 30, 15) == 0);
    counts[7] = 5;
    CHECK(check_code(counts, 30, 15) == 5);
    for (uint32_t round = 0; round < 500; round++) {
        uint32_t count = 2 + random_below(MESO_CODE_SYMBOLS - 1), range = 1u << random_below(10);
        for (uint32_t i = 0; i < count; i++)
            counts[i] = random_below(3) ? random_below(range) : 0;
        counts[0] = counts[1] = 1;
        CHECK(check_code(counts, count, 15) == best_bits(counts, count));
    }
    /* Each as many as all before it: a tree as deep as there are symbols, which is cut. */
    uint32_t before = 0;
    for (uint32_t i = 0; i < 22; i++, before += counts[i - 1])
        counts[i] = before ? before : 1;
    CHECK(check_code(counts, 14, 15) == best_bits(counts, 14));
    uint64_t cut = check_code(counts, 22, 15), least = best_bits(counts, 22);
    CHECK(cut > least && cut < least + least / 100);
    for (uint32_t i = 0; i < 19; i++)
        counts[i] = 1u << i;
    check_code(counts, 19, 7);
    check_code(counts, 19, 5);
}

/* ---- streams ---- */

/* There and back; returns the length between. */
static size_t check_bytes(size_t size)
{
    size_t bound = meso_quick_deflate_bound(size);
    uLongf length = MOST + 1;
    CHECK(bound < sizeof packed);
    memset(packed + bound, 0x5a, 64);
    size_t whole = meso_quick_deflate(&scratch, input, size, packed);
    CHECK(whole <= bound);
    for (uint32_t i = 0; i < 64; i++)
        CHECK(packed[bound + i] == 0x5a);
    CHECK(uncompress(unpacked, &length, packed, (uLong)whole) == Z_OK);
    CHECK(length == size && memcmp(unpacked, input, size) == 0);
    return whole;
}

static void test_few(void)
{
    for (size_t size = 0; size < 600; size++) {
        memset(input, 7, size);
        check_bytes(size);
        for (size_t i = 0; i < size; i++)
            input[i] = (uint8_t)random_below(3);
        check_bytes(size);
        for (size_t i = 0; i < size; i++)
            input[i] = (uint8_t)random_below(256);
        check_bytes(size);
    }
}

static void test_noise(void)
{
    for (size_t i = 0; i < MOST; i++)
        input[i] = (uint8_t)random_below(256);
    CHECK(check_bytes(MOST) < MOST + MOST / 500);
    check_bytes(65535);
    check_bytes(65536);
    check_bytes(MOST - 3);
}

static void test_runs(void)
{
    memset(input, 128, MOST);
    CHECK(check_bytes(MOST) < MOST / 800);
    for (size_t i = 0; i < MOST;) {             /* of all lengths that matches have, and their neighbours */
        size_t run = 1 + random_below(300);
        memset(input + i, (int)random_below(256), run < MOST - i ? run : MOST - i);
        i += run;
    }
    CHECK(check_bytes(MOST) < MOST / 20);
}

/* A block of noise again, as far behind as can be, and farther. */
static void test_distance(void)
{
    for (size_t i = 0; i < 1000; i++)
        input[i] = (uint8_t)random_below(256);
    memset(input + 1000, 0, 40000);
    memcpy(input + 32768, input, 1000);
    CHECK(check_bytes(33768) < 1400);
    memmove(input + 32769, input + 32768, 1000);
    CHECK(check_bytes(33769) > 2000);
}

/* Sequences that fill a block, and symbols that do; and bytes each half as often as another. */
static void test_blocks(void)
{
    for (size_t i = 0; i < MOST; i++)
        input[i] = i % 5 == 4 ? (uint8_t)random_below(256) : (uint8_t)"abcd"[i % 5];
    CHECK(check_bytes(MOST) < MOST / 2);
    for (size_t i = 0; i < MOST; i++)
        input[i] = (uint8_t)(random_below(16) * random_below(16));
    CHECK(check_bytes(MOST) < MOST);
    for (size_t i = 0; i < MOST; i++) {
        uint32_t bits = random_below(1u << 20) | 1u << 20;
        input[i] = (uint8_t)(3 * __builtin_ctz(bits));
    }
    CHECK(check_bytes(MOST) < MOST / 2);
}

int main(void)
{
    test_codes();
    test_few();
    test_noise();
    test_runs();
    test_distance();
    test_blocks();
    return 0;
}
