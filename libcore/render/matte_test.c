/* Hashes as the specification and others have them; ranks by coverage, whatever the order; at most six; sums. */
#include "libcore/render/matte.h"

#include <math.h>
#include <string.h>

#include "libcore/base/bits.h"
#include "libcore/base/check.h"
#include "libcore/base/index.h"
#include "libcore/base/random.h"

static void test_hashes(void)
{
    CHECK(meso_matte_hash("", 0) == 0 && meso_matte_hash("test", 4) == 0xba6bd213u);
    CHECK(meso_matte_hash("Hello, world!", 13) == 0xc0363e43u);
    CHECK(meso_matte_number(meso_matte_hash("torus", 5)) == -1.54943624832e+30f);
    for (uint32_t exponent = 0; exponent < 256; exponent += 255) {
        float number = meso_matte_number(exponent << 23 | 12345);
        CHECK(isfinite(number) && fabsf(number) >= 1e-38f);
    }
}

static void test_ranks(void)
{
    MesoRandom random;
    float ranks[2 * MESO_MATTE_RANKS * 2];
    float hashes[200];
    uint64_t bits[4] = {0};
    MesoMatte matte = {.name = "tile", .count = 200, .hashes = hashes, .seen = bits, .ranks = ranks};
    meso_matte_init(&matte);
    meso_random_init(&random, 5, 0);
    for (uint32_t turn = 0; turn < 2000; turn++) {
        uint32_t things[16], counts[200] = {0}, n = turn % 3 == 0 ? 1 : turn % 3 == 1 ? 4 : 16, kinds = 1 + turn % 12;
        for (uint32_t i = 0; i < n; i++) {
            uint32_t t = meso_random_below(&random, kinds + 1);
            things[i] = t == kinds ? MESO_NO_INDEX : 7 * t;
            if (t < kinds)
                counts[7 * t]++;
        }
        meso_matte_put(&matte, 1, things, n);
        const float *r = ranks + 2 * MESO_MATTE_RANKS;
        double sum = 0, whole = 0;
        uint32_t different = 0;
        for (uint32_t t = 0; t < 200; t++) {
            whole += counts[t];
            different += counts[t] > 0;
        }
        for (uint32_t k = 0; k < MESO_MATTE_RANKS; k++) {
            CHECK(k == 0 || r[2 * k + 1] <= r[2 * k - 1]);
            CHECK((r[2 * k] == 0) == (r[2 * k + 1] == 0) && (r[2 * k] != 0) == (k < different));
            for (uint32_t t = 0; t < 200 && r[2 * k] != 0; t++)
                if (matte.hashes[t] == r[2 * k]) {
                    CHECK(fabs((double)r[2 * k + 1] - (double)counts[t] / n) < 1e-6 && meso_bits_test(matte.seen, t));
                    sum += (double)r[2 * k + 1];
                }
        }
        CHECK(different > MESO_MATTE_RANKS || fabs(sum - whole / n) < 1e-6);
    }
    CHECK(!meso_bits_test(matte.seen, 1) && meso_bits_test(matte.seen, 7));
}

int main(void)
{
    test_hashes();
    test_ranks();
    return 0;
}
