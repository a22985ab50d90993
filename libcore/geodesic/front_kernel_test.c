#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/geodesic/front_kernel.h"
#include "libcore/geodesic/front_kernel_avx2.h"
#include "libcore/geodesic/front_kernel_four.h"

enum { ROWS = 9 + MESO_RING_SLACK, ROUNDS = 200000 };

static float uniform(MesoRandom *random)
{
    return (float)(meso_random_next(random) >> 40) / 16777216.0f;
}

/* Around a vertex in the middle; far fewer rings than not have planar fronts, or vertices without distance. */
static void fill_rows(MesoRandom *random, uint32_t count, MesoGeodesicRow *rows)
{
    uint32_t kind = meso_random_below(random, 8);
    float angle = 6.2831853f / (float)count, source = uniform(random) * 3;
    for (uint32_t v = 0; v < ROWS; v++) {
        float turn = ((float)v + 0.8f * uniform(random)) * angle, size = v == 0 ? 0 : 0.3f + uniform(random);
        MesoGeodesicRow *row = &rows[v];
        *row = (MesoGeodesicRow){size * cosf(turn), size * sinf(turn), 0.3f * uniform(random), 0};
        row->distance = kind == 7 ? 3 * uniform(random) : hypotf(row->x - source, row->y);
        if (kind == 0 && v > 0 && meso_random_below(random, 2))
            row->distance = INFINITY;
        if (kind == 1 && meso_random_below(random, 2))
            row->distance = -row->distance;
        if (kind == 2)
            row->distance = -fabsf(row->x);
    }
    if (kind == 3)
        rows[1 + meso_random_below(random, count)] = rows[0];
}

typedef struct Told {
    float found[8];
    uint32_t lower;
} Told;

/* Of the spokes that are lower, since nothing else is looked at. */
static bool are_same(const Told *a, const Told *b)
{
    for (uint32_t i = 0; i < 8; i++)
        if (a->lower >> i & 1 && memcmp(&a->found[i], &b->found[i], sizeof a->found[i]) != 0)
            return false;
    return a->lower == b->lower;
}

#ifdef MESO_HAS_FRONT_STEP_AVX2
__attribute__((target("avx2"))) static void step_avx2(const MesoFrontStep *step, Told *told)
{
    told->lower = meso_front_step_avx2(step, told->found);
}
#endif

/* Every kernel tells the same, to the last bit. */
int main(void)
{
    MesoRandom random;
    MesoGeodesicRow rows[ROWS];
    const uint32_t spokes[8 + MESO_RING_SLACK] = {1, 2, 3, 4, 5, 6, 7, 8};
    uint64_t lowered = 0;
    meso_random_init(&random, 3, 0);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        uint32_t count = 2 + meso_random_below(&random, 7);
        fill_rows(&random, count, rows);
        MesoFrontStep step = {rows, 0, spokes, count, meso_random_below(&random, 4) > 0, 0};
        if (meso_random_below(&random, 8) == 0)
            step.floor = fabsf(rows[0].distance);
        Told plain;
        plain.lower = meso_front_step_plain(&step, plain.found);
        lowered += plain.lower != 0;
#ifdef MESO_HAS_FRONT_STEP_FOUR
        Told four;
        four.lower = meso_front_step_four(&step, four.found);
        CHECK(are_same(&plain, &four));
#endif
#ifdef MESO_HAS_FRONT_STEP_AVX2
        Told eight = plain;
        if (__builtin_cpu_supports("avx2"))
            step_avx2(&step, &eight);
        CHECK(are_same(&plain, &eight));
#endif
    }
    CHECK(lowered > ROUNDS / 4 && lowered < ROUNDS);
    return 0;
}
