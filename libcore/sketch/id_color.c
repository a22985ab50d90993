#include "libcore/sketch/id_color.h"

#include <math.h>

/* The fraction of id * step / 2^32, exact for any number. */
static float fraction(uint32_t id, uint32_t step)
{
    return (float)(uint32_t)(id * step >> 8) / (1 << 24);
}

/* Steps of the plane's most even sequence that adds the same to each next point: 2^32 over the root of x^3 = x + 1. */
void meso_id_color(float albedo[3], uint32_t id)
{
    float turn = fraction(id, 3242174889u), light = fraction(id, 2447445414u);
    for (uint32_t c = 0; c < 3; c++) {
        float hue = fmodf(turn + (float)c / 3, 1), pure = fminf(fmaxf(2 - fabsf(6 * hue - 3), 0), 1);
        float pale = 0.03f + 0.3f * light * light;
        albedo[c] = (0.4f + 0.5f * light) * (pale + (1 - pale) * pure * pure);
    }
}
