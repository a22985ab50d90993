#include "libcore/base/check.h"
#include "libcore/math/noise.h"

/* 0 at the corners of cells, within [-1, 1], of mean near 0, and different for different seeds. */
static void test_range(void)
{
    double sum = 0, apart = 0, largest = 0;
    for (int i = 0; i < 100000; i++) {
        MesoVec3 p = {0.0137f * (float)i - 700, 0.0071f * (float)i, 0.0193f * (float)(i % 777)};
        float n = meso_noise(p, 1), m = meso_noise(p, 2);
        CHECK(n >= -1 && n <= 1);
        sum += n;
        apart += fabsf(n - m);
        largest = fmax(largest, fabs((double)n));
    }
    CHECK(fabs(sum / 100000) < 0.01 && apart / 100000 > 0.1 && largest > 0.6);
    for (int i = -3; i < 4; i++)
        CHECK(meso_noise((MesoVec3){(float)i, 2, (float)-i}, 7) == 0);
}

/* Continuous across cells, and flat where numbers end. */
static void test_smooth(void)
{
    for (int i = 0; i < 4000; i++) {
        float x = -2 + 0.001f * (float)i;
        float a = meso_noise((MesoVec3){x, 0.3f, 0.6f}, 3), b = meso_noise((MesoVec3){x + 0.001f, 0.3f, 0.6f}, 3);
        CHECK(fabsf(a - b) < 0.004f);
    }
    CHECK(meso_noise((MesoVec3){1e30f, 0, 0}, 1) == 0 && meso_noise((MesoVec3){NAN, 0, 0}, 1) == 0);
}

int main(void)
{
    test_range();
    test_smooth();
    return 0;
}
