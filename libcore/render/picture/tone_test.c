/* Curves: from black to white, never down, grey to grey; and numbers that their makers give. */
#include "libcore/render/picture/tone.h"

#include <math.h>

#include "libcore/base/check.h"

static void test_greys(MesoTone tone)
{
    float before = -1;
    for (int i = -200; i <= 200; i++) {
        float x = exp2f((float)i / 10), grey[3] = {x, x, x}, out[3];
        meso_tone(tone, grey, out);
        CHECK(out[0] >= before && out[0] >= 0 && out[0] <= 1);
        CHECK(fabsf(out[0] - out[1]) < 2e-3f && fabsf(out[1] - out[2]) < 2e-3f);
        before = out[0] - 1e-4f;        /* fits waver */
        if (i == -200)
            CHECK(out[0] < 2e-3f);
        if (i == 200)
            CHECK(out[0] > 0.97f);
    }
    const float odd[3] = {-1, INFINITY, 0};
    float out[3];
    meso_tone(tone, odd, out);
    for (int c = 0; c < 3; c++)
        CHECK(out[c] >= 0 && out[c] <= 1);
}

static void check_at(MesoTone tone, float r, float g, float b, float red, float green, float blue)
{
    float color[3] = {r, g, b};
    meso_tone(tone, color, color);
    CHECK(fabsf(color[0] - red) < 2e-3f && fabsf(color[1] - green) < 2e-3f && fabsf(color[2] - blue) < 2e-3f);
}

int main(void)
{
    for (MesoTone tone = MESO_TONE_SHOULDER; tone <= MESO_TONE_FILMIC; tone++)
        test_greys(tone);
    check_at(MESO_TONE_NONE, 0.25f, 0.5f, 7, 0.25f, 0.5f, 1);
    check_at(MESO_TONE_SHOULDER, 0.75f, 0.5f, 1, 0.75f, 0.5f, 0.875f);
    /* A base colour that white light of 1 shows, with 4 percent of reflection, comes out as itself. */
    check_at(MESO_TONE_NEUTRAL, 0.54f, 0.24f, 0.12f, 0.5f, 0.2f, 0.08f);
    check_at(MESO_TONE_NEUTRAL, 0.04f, 0.04f, 0.04f, 0.01f, 0.01f, 0.01f);      /* 6.25 times its square */
    /* Middle grey stays about there on a screen. */
    float grey[3] = {0.18f, 0.18f, 0.18f};
    meso_tone(MESO_TONE_AGX, grey, grey);
    CHECK(grey[0] > 0.15f && grey[0] < 0.22f);
    check_at(MESO_TONE_FILMIC, 1, 1, 1, 0.6191f, 0.6191f, 0.6191f);     /* 1.0244882 / 1.654761: its rows sum to 1 */
    return 0;
}
