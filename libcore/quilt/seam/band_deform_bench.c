/* Times of bands on a tube: 16 vertices around, pulled at one section; the band is a part of it, or all. */
#include <stdio.h>
#include <time.h>

#include "libcore/base/check.h"
#include "libcore/quilt/seam/band_deform.h"

enum { AROUND = 16 };

/* Processor time: a single thread, on machines that have more to do. */
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void time_band(uint32_t along, uint32_t rings, int rounds)
{
    uint32_t count = AROUND * along, triangle_count = 0, middle = along / 2;
    MesoVec3 *positions = malloc(count * sizeof *positions);
    uint32_t *corners = malloc(6 * (size_t)count * sizeof *corners);
    MesoBandPull pulls[AROUND];
    double best = 1e9, rms = 0;
    CHECK(positions && corners);
    for (uint32_t v = 0; v < count - AROUND; v++) {
        uint32_t next = v % AROUND + 1 < AROUND ? v + 1 : v + 1 - AROUND;
        uint32_t two[6] = {v, next, v + AROUND, next, next + AROUND, v + AROUND};
        memcpy(corners + 3 * (size_t)triangle_count, two, sizeof two);
        triangle_count += 2;
    }
    for (int round = 0; round < rounds; round++) {
        MesoArena arena;
        meso_arena_init(&arena);
        for (uint32_t v = 0; v < count; v++) {
            float angle = 6.2831853f * (float)(v % AROUND) / AROUND;
            positions[v] = (MesoVec3){cosf(angle), sinf(angle), 0.4f * (float)(v / AROUND)};
        }
        for (uint32_t p = 0; p < AROUND; p++)
            pulls[p] = (MesoBandPull){{middle * AROUND + p, 0, 0}, {1, 0, 0},
                                      meso_vec3_add(positions[middle * AROUND + p], (MesoVec3){0.3f, 0.1f, 0.1f})};
        double begin = seconds();
        CHECK(!meso_band_deform(positions, &arena, count, corners, triangle_count, pulls, AROUND, rings, 1, &rms, NULL,
                                NULL));
        double took = seconds() - begin;
        best = took < best ? took : best;
        meso_arena_release(&arena);
    }
    uint32_t sections = 2 * rings + 1 < along ? 2 * rings + 1 : along;
    printf("band of %u of %u vertices: %.3f ms, %.4f left\n", AROUND * sections, count, 1e3 * best, rms);
    free(positions);
    free(corners);
}

int main(void)
{
    time_band(40, 8, 40);
    time_band(80, 31, 40);
    time_band(300, 100, 20);
    time_band(6000, 8, 10);
    return 0;
}
