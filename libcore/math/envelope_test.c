/* The envelope's factor: what it solves, put into the matrix again, is the right side. */
#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/math/envelope.h"

#include <math.h>

enum { MOST = 70, ROUNDS = 200 };

static double uniform(MesoRandom *random)
{
    return (double)meso_random_below(random, 1u << 30) / (1u << 29) - 1;
}

/* Numbers in the rows' envelopes alone, and diagonals larger than all others of their row together. */
static void fill(double dense[MOST][MOST], uint32_t *firsts, uint32_t count, MesoRandom *random)
{
    double sums[MOST] = {0};
    memset(dense, 0, sizeof(double[MOST][MOST]));
    for (uint32_t i = 0; i < count; i++) {
        firsts[i] = i - meso_random_below(random, i + 1);
        for (uint32_t j = firsts[i]; j < i; j++) {
            dense[i][j] = dense[j][i] = uniform(random);
            sums[i] += fabs(dense[i][j]);
            sums[j] += fabs(dense[i][j]);
        }
    }
    for (uint32_t i = 0; i < count; i++)
        dense[i][i] = 0.1 + sums[i];
}

static void load(MesoEnvelope *envelope, MesoArena *arena, double dense[MOST][MOST], uint32_t *firsts, uint32_t count)
{
    CHECK(!meso_envelope_new(envelope, arena, count, firsts, NULL));
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = firsts[i]; j <= i; j++)
            *meso_envelope_at(envelope, i, j) = dense[i][j];
}

static void test_random(void)
{
    static double dense[MOST][MOST];
    MesoArena arena;
    meso_arena_init(&arena);
    MesoRandom random;
    meso_random_init(&random, 5, 0);
    for (int round = 0; round < ROUNDS; round++) {
        uint32_t count = 1 + meso_random_below(&random, MOST), firsts[MOST];
        fill(dense, firsts, count, &random);
        MesoEnvelope envelope;
        load(&envelope, &arena, dense, firsts, count);
        CHECK(!meso_envelope_factor(&envelope, NULL));
        double right[3 * MOST], x[3 * MOST];
        for (uint32_t i = 0; i < 3 * count; i++)
            right[i] = x[i] = uniform(&random);
        meso_envelope_solve(&envelope, x);
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t c = 0; c < 3; c++) {
                double sum = 0;
                for (uint32_t j = 0; j < count; j++)
                    sum += dense[i][j] * x[3 * j + c];
                CHECK(fabs(sum - right[3 * i + c]) < 1e-11);
            }
        meso_arena_release(&arena);
    }
}

static void test_not_definite(void)
{
    double dense[MOST][MOST] = {{1, 2}, {2, 1}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoEnvelope envelope;
    load(&envelope, &arena, dense, (uint32_t[2]){0, 0}, 2);
    CHECK(meso_envelope_factor(&envelope, NULL) == MESO_ERR_INPUT);
    CHECK(!meso_envelope_new(&envelope, &arena, 0, NULL, NULL) && !meso_envelope_factor(&envelope, NULL));
    meso_arena_release(&arena);
}

int main(void)
{
    test_random();
    test_not_definite();
    return 0;
}
