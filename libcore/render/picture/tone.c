#include "libcore/render/picture/tone.h"

#include <math.h>

static float clamp(float x, float low, float high)
{
    return fminf(fmaxf(x, low), high);
}

/* The line up to SHOULDER, then a hyperbola of the same slope that ends in white. */
static float roll_off(float x)
{
    const float shoulder = 0.75f, room = 1 - shoulder;
    return x <= shoulder ? fmaxf(x, 0) : 1 - room * room / (x - shoulder + room);
}

/* Takes off what dielectrics reflect, rolls the greatest channel off and the others in proportion, fades to white. */
static void tone_neutral(float c[3])
{
    const float start = 0.8f - 0.04f, desaturation = 0.15f, room = 1 - start;
    float least = fminf(c[0], fminf(c[1], c[2])), offset = least < 0.08f ? least - 6.25f * least * least : 0.04f;
    for (int i = 0; i < 3; i++)
        c[i] -= offset;
    float peak = fmaxf(c[0], fmaxf(c[1], c[2]));
    if (peak < start)
        return;
    float rolled = 1 - room * room / (peak + room - start), white = 1 - 1 / (desaturation * (peak - rolled) + 1);
    for (int i = 0; i < 3; i++)
        c[i] = c[i] * (rolled / peak) * (1 - white) + rolled * white;
}

static void multiply(const float m[3][3], float c[3])
{
    const float x = c[0], y = c[1], z = c[2];
    for (int i = 0; i < 3; i++)
        c[i] = m[i][0] * x + m[i][1] * y + m[i][2] * z;
}

/* Stops from the darkest to the brightest that it knows, by a polynomial that has AgX's contrast. */
static float agx_contrast(float x)
{
    float x2 = x * x, x4 = x2 * x2;
    return 15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 + 0.1191f * x - 0.00232f;
}

static void tone_agx(float c[3])
{
    static const float inset[3][3] = {{0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f},
                                      {0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f},
                                      {0.0423756549057051f, 0.0784336f, 0.879142973793104f}};
    static const float outset[3][3] = {{1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f},
                                       {-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f},
                                       {-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f}};
    const float darkest = -12.47393f, brightest = 4.026069f;
    multiply(inset, c);
    for (int i = 0; i < 3; i++) {
        float stops = clamp(log2f(fmaxf(c[i], 1e-10f)), darkest, brightest);
        c[i] = agx_contrast((stops - darkest) / (brightest - darkest));
    }
    multiply(outset, c);
    for (int i = 0; i < 3; i++)         /* it is for a screen of gamma 2.2 */
        c[i] = powf(clamp(c[i], 0, 1), 2.2f);
}

static void tone_filmic(float c[3])
{
    static const float in[3][3] = {{0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f},
                                   {0.02840f, 0.13383f, 0.83777f}};
    static const float out[3][3] = {{1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f},
                                    {-0.00327f, -0.07276f, 1.07602f}};
    multiply(in, c);
    for (int i = 0; i < 3; i++)
        c[i] = (c[i] * (c[i] + 0.0245786f) - 0.000090537f) / (c[i] * (0.983729f * c[i] + 0.4329510f) + 0.238081f);
    multiply(out, c);
}

void meso_tone(MesoTone tone, const float color[3], float out[3])
{
    float c[3];
    for (int i = 0; i < 3; i++)
        c[i] = tone == MESO_TONE_SHOULDER ? roll_off(color[i]) : fminf(fmaxf(color[i], 0), 1e10f);
    if (tone == MESO_TONE_NEUTRAL)
        tone_neutral(c);
    else if (tone == MESO_TONE_AGX)
        tone_agx(c);
    else if (tone == MESO_TONE_FILMIC)
        tone_filmic(c);
    for (int i = 0; i < 3; i++)
        out[i] = tone == MESO_TONE_SHOULDER ? c[i] : clamp(c[i], 0, 1);
}
