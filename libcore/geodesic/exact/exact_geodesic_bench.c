/* Exact distances from one vertex of bumpy tori. */
#include <stdio.h>

#include "libcore/base/clock.h"
#include "libcore/base/random.h"
#include "libcore/geodesic/exact/exact_geodesic.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

/* Bumps, and vertices off their grid: half of them are saddles, and no two triangles alike. */
static void disturb(MesoTriangulation *mesh, float step)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 *p = &mesh->positions[v];
        float bump = 1 + 0.05f * sinf(11 * p->x) * cosf(13 * p->y) * sinf(9 * p->z);
        for (float *x = &p->x; x <= &p->z; x++)
            *x = *x * bump + step * ((float)meso_random_below(&random, 1 << 16) / 65536 - 0.5f);
    }
}

static void measure(uint32_t columns, uint32_t rows)
{
    MesoTriangulation mesh = meso_fixture_torus(columns, rows, 0.4f);
    MesoArena arena;
    MesoError error;
    MesoExactGeodesicField field;
    MesoExactGeodesicSeed seed = {mesh.vertex_count / 3, 0, false};
    MesoExactGeodesicQuery query = {.seeds = &seed, .seed_count = 1, .target = MESO_NO_INDEX};
    double *distance = malloc(mesh.vertex_count * sizeof *distance), best = INFINITY;
    CHECK(distance);
    disturb(&mesh, 0.3f * 6.28f / (float)columns);
    meso_arena_init(&arena);
    for (int round = 0; round < 2; round++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        double start = meso_seconds();
        CHECK(meso_exact_geodesic(&mesh, NULL, &query, &arena, distance, &field, &error) == MESO_OK);
        best = fmin(best, meso_seconds() - start);
        meso_arena_rewind(&arena, mark);
    }
    printf("exact distances, %u triangles: %.2f s, %.1f million windows, at most %.2f million at a time\n",
           mesh.triangle_count, best, 1e-6 * (double)field.window_count, 1e-6 * field.window_peak);
    free(distance);
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    measure(250, 100);
    measure(600, 250);
    return 0;
}
