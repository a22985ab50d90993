#include "libcore/render/light/vary.h"

#include <math.h>
#include <string.h>

#include "libcore/base/index.h"
#include "libcore/base/random.h"

static const float HUE_RADIANS = 0.25f;

uint32_t meso_vary_channel(const MesoScene *scene)
{
    static const char *const finest[] = {"strand", "element", "detail", "branch", "slot"};
    for (uint32_t k = 0; k < sizeof finest / sizeof *finest; k++)
        for (uint32_t c = 0; c < scene->channel_count; c++)
            if (strcmp(scene->channels[c].name, finest[k]) == 0)
                return c;
    return MESO_NO_INDEX;
}

/* From -1 to 1. */
static float spread(MesoRandom *random)
{
    return (float)meso_random_below(random, 1 << 20) / (float)(1 << 19) - 1;
}

void meso_vary(float albedo[3], uint32_t id, float amount)
{
    MesoRandom random;
    if (amount == 0)
        return;
    meso_random_init(&random, id, 0);
    float factor = exp2f(amount * spread(&random)), angle = HUE_RADIANS * amount * spread(&random);
    /* About the axis of greys, which leaves the sum of the three as it is. */
    float c = cosf(angle), s = sinf(angle) / sqrtf(3), grey = (albedo[0] + albedo[1] + albedo[2]) / 3;
    float turned[3];
    for (int k = 0; k < 3; k++)
        turned[k] = grey + c * (albedo[k] - grey) + s * (albedo[(k + 2) % 3] - albedo[(k + 1) % 3]);
    for (int k = 0; k < 3; k++)
        albedo[k] = fminf(fmaxf(factor * turned[k], 0), 1);
}
