/*
 * Times of direction fields on irregular spheres, of the process, of one core.
 *
 *   direction_field_bench [DIVISIONS...]     spheres of 20 n^2 triangles
 */
#include <stdio.h>
#include <time.h>

#include "libcore/field/direction_field.h"
#include "libcore/geodesic/geodesic_fixture.h"

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void time_fields(uint32_t divisions)
{
    MesoArena arena;
    MesoTriangulation mesh = meso_fixture_sphere(divisions, 0.3f, 7);
    meso_arena_init(&arena);
    MesoVec3 *guides = MESO_NEW(&arena, MesoVec3, mesh.triangle_count, NULL);
    float *weights = MESO_NEW(&arena, float, mesh.triangle_count, NULL);
    CHECK(guides && weights);
    double start = cpu_seconds();
    CHECK(meso_principal_directions(guides, weights, &arena, &mesh, NULL) == MESO_OK);
    printf("%6u triangles: principal directions %.3f s", mesh.triangle_count, cpu_seconds() - start);
    for (uint32_t symmetry = 1; symmetry <= 4; symmetry *= 2) {
        MesoDirectionField field;
        start = cpu_seconds();
        CHECK(meso_direction_field_smooth(&field, &arena, &mesh, symmetry, NULL, NULL, NULL) == MESO_OK);
        printf(", symmetry %u %.2f s and %u singularities", symmetry, cpu_seconds() - start, field.singularity_count);
    }
    MesoDirectionField field;
    start = cpu_seconds();
    CHECK(meso_direction_field_smooth(&field, &arena, &mesh, 2, guides, weights, NULL) == MESO_OK);
    printf(", guided %.2f s\n", cpu_seconds() - start);
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        time_fields((uint32_t)strtoul(argv[i], NULL, 10));
    if (argc == 1) {
        time_fields(16);
        time_fields(50);
    }
    return 0;
}
