/* Any bytes as caches of either kind: what is accepted has all of its frames. */
#include <stdlib.h>

#include "formats/clip/point_cache.h"
#include "libcore/base/check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void read_as(const MesoInput *input, MesoPointCacheKind kind)
{
    MesoPointCache cache;
    MesoError error;
    if (meso_point_cache_open(&cache, input, kind, &error))
        return;
    MesoVec3 *positions = malloc(cache.point_count * sizeof *positions);
    CHECK(positions);
    for (uint32_t f = 0; f < cache.frame_count; f++) {
        (void)meso_point_cache_time(&cache, f);
        if (meso_point_cache_frame(&cache, f, positions, &error) == MESO_OK)
            for (uint32_t v = 0; v < cache.point_count; v++)
                CHECK(meso_vec3_finite(positions[v]));
    }
    free(positions);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    MesoInput input;
    if (size == 0)
        return 0;
    meso_input_wrap(&input, "fuzz", data, size);
    read_as(&input, MESO_CACHE_PC2);
    read_as(&input, MESO_CACHE_MDD);
    return 0;
}
