#include "libcore/render/matte.h"

#include <stdio.h>
#include <string.h>

#include "libcore/base/index.h"

static uint32_t turned(uint32_t x, int by)
{
    return x << by | x >> (32 - by);
}

static uint32_t mixed(uint32_t k)
{
    return turned(k * 0xcc9e2d51u, 15) * 0x1b873593u;
}

/* MurmurHash3_x86_32 with the seed 0. */
uint32_t meso_matte_hash(const void *text, size_t length)
{
    const unsigned char *bytes = text;
    uint32_t hash = 0, tail = 0;
    size_t i = 0;
    for (; i + 4 <= length; i += 4) {
        uint32_t k = bytes[i] | (uint32_t)bytes[i + 1] << 8 | (uint32_t)bytes[i + 2] << 16 | (uint32_t)bytes[i + 3] << 24;
        hash = turned(hash ^ mixed(k), 13) * 5 + 0xe6546b64u;
    }
    for (size_t k = length; k-- > i;)
        tail = tail << 8 | bytes[k];
    hash ^= mixed(tail);
    hash ^= (uint32_t)length;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

float meso_matte_number(uint32_t hash)
{
    float number;
    uint32_t exponent = hash >> 23 & 255;
    if (exponent == 0 || exponent == 255)
        hash ^= 1u << 23;
    memcpy(&number, &hash, sizeof number);
    return number;
}

const char *meso_matte_name(const MesoMatte *matte, uint32_t i, char text[16])
{
    if (matte->names)
        return matte->names[i];
    snprintf(text, 16, "%u", i);
    return text;
}

void meso_matte_init(MesoMatte *matte)
{
    for (uint32_t i = 0; i < matte->count; i++) {
        char text[16];
        const char *name = meso_matte_name(matte, i, text);
        matte->hashes[i] = meso_matte_number(meso_matte_hash(name, strlen(name)));
    }
}

typedef struct Share {
    uint32_t thing, count;
} Share;

/* Ascending as they are put in, so that of equal shares the lower thing is first. */
static uint32_t add_thing(Share *shares, uint32_t count, uint32_t thing)
{
    uint32_t i = 0;
    while (i < count && shares[i].thing < thing)
        i++;
    if (i < count && shares[i].thing == thing) {
        shares[i].count++;
        return count;
    }
    memmove(shares + i + 1, shares + i, (count - i) * sizeof *shares);
    shares[i] = (Share){thing, 1};
    return count + 1;
}

void meso_matte_put(MesoMatte *matte, size_t pixel, const uint32_t *things, uint32_t sample_count)
{
    enum { SAMPLES = 64 };
    Share shares[SAMPLES + 1];
    uint32_t count = 0;
    float *ranks = matte->ranks + 2 * MESO_MATTE_RANKS * pixel;
    for (uint32_t i = 0; i < sample_count && i < SAMPLES; i++)
        if (things[i] != MESO_NO_INDEX)
            count = add_thing(shares, count, things[i]);
    for (uint32_t r = 0; r < MESO_MATTE_RANKS; r++) {
        uint32_t best = 0;
        ranks[2 * r] = ranks[2 * r + 1] = 0;
        for (uint32_t i = 1; i < count; i++)
            if (shares[i].count > shares[best].count)
                best = i;
        if (count == 0 || shares[best].count == 0)
            continue;
        uint32_t thing = shares[best].thing;
        ranks[2 * r] = matte->hashes[thing];
        ranks[2 * r + 1] = (float)shares[best].count / (float)sample_count;
        __atomic_fetch_or(&matte->seen[thing / 64], (uint64_t)1 << (thing % 64), __ATOMIC_RELAXED);
        shares[best].count = 0;
    }
}
