/* Swatches of tubes that wave over and under each other, for tests and benchmarks. */
#ifndef MESO_MATCH_FIXTURE_H
#define MESO_MATCH_FIXTURE_H

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/quilt/swatch/swatch.h"

static inline float meso_fixture_float(MesoRandom *random, float low, float high)
{
    return low + (high - low) * (float)meso_random_below(random, 1u << 24) * 0x1p-24f;
}

/* One tube of `rings` rings of `sides` along x or y at place `at`, open at both ends. */
static inline void meso_fixture_tube(MesoSwatch *swatch, bool along_x, float at, float length, float radius,
                                     float wave, float phase, uint32_t rings, uint32_t sides)
{
    uint32_t first = swatch->vertex_count;
    for (uint32_t r = 0; r < rings; r++) {
        double s = (double)r / (rings - 1), angle = MESO_PI * ((double)length * s + (double)phase);
        float z = radius + wave + wave * (float)sin(angle), slope = wave * (float)(MESO_PI * cos(angle));
        float norm = 1 / sqrtf(1 + slope * slope);
        for (uint32_t k = 0; k < sides; k++) {
            float c = (float)cos(2 * MESO_PI * k / sides), d = (float)sin(2 * MESO_PI * k / sides);
            MesoVec3 n = {-slope * norm * d, c, norm * d};
            MesoVec3 p = {length * (float)s + radius * n.x, at + radius * n.y, z + radius * n.z};
            if (!along_x) {
                p = (MesoVec3){p.y, p.x, p.z};
                n = (MesoVec3){n.y, n.x, n.z};
            }
            swatch->positions[swatch->vertex_count] = p;
            swatch->normals[swatch->vertex_count++] = n;
        }
    }
    for (uint32_t r = 0; r + 1 < rings; r++)
        for (uint32_t k = 0; k < sides; k++) {
            uint32_t a = first + r * sides + k, b = first + r * sides + (k + 1) % sides, c = a + sides, d = b + sides;
            uint32_t faces[6] = {a, c, d, a, d, b};
            for (uint32_t i = 0; i < 6; i++)
                swatch->corners[3 * swatch->triangle_count + (along_x ? i / 3 * 3 + 2 - i % 3 : i)] = faces[i];
            swatch->triangle_count += 2;
        }
}

static inline uint32_t meso_fixture_twin(const uint32_t *corners, uint32_t count, uint32_t side, uint32_t sides)
{
    uint32_t a = corners[side], b = corners[side % 3 == 2 ? side - 2 : side + 1];
    uint32_t reach = 12 * sides, begin = side > reach ? side - reach : 0;
    uint32_t end = side + reach < count ? side + reach : count;
    for (uint32_t h = begin; h < end; h++)
        if (corners[h] == b && corners[h % 3 == 2 ? h - 2 : h + 1] == a)
            return h;
    return MESO_NO_INDEX;
}

/* `count` tubes each way with a pitch of 1, shifted at random by up to `jitter`; what the table of costs needs of a
 * swatch and no more. */
static inline void meso_fixture_weave(MesoSwatch *swatch, MesoArena *arena, uint32_t count, uint32_t rings,
                                      uint32_t sides, float jitter, uint64_t seed)
{
    MesoRandom random;
    float size = (float)count, radius = 0.2f, wave = 0.2f;
    size_t vertices = 2 * (size_t)count * rings * sides, faces = 4 * (size_t)count * (rings - 1) * sides;
    meso_random_init(&random, seed, 0);
    *swatch = (MesoSwatch){.positions = MESO_NEW(arena, MesoVec3, vertices, NULL),
                           .normals = MESO_NEW(arena, MesoVec3, vertices, NULL),
                           .corners = MESO_NEW(arena, uint32_t, 3 * faces, NULL),
                           .twins = MESO_NEW(arena, uint32_t, 3 * faces, NULL),
                           .size = {size, size, 2 * (radius + wave)},
                           .mean_edge = size / (float)(rings - 1)};
    CHECK(swatch->positions && swatch->normals && swatch->corners && swatch->twins);
    for (uint32_t i = 0; i < 2 * count; i++) {
        float at = (float)(i / 2) + 0.5f + meso_fixture_float(&random, -jitter, jitter);
        float phase = (float)((i / 2 + i) % 2) + 0.5f + meso_fixture_float(&random, -jitter, jitter);
        meso_fixture_tube(swatch, i % 2 == 0, at, size, radius, wave, phase, rings, sides);
    }
    for (uint32_t h = 0; h < 3 * swatch->triangle_count; h++)
        swatch->twins[h] = meso_fixture_twin(swatch->corners, 3 * swatch->triangle_count, h, sides);
}

#endif
