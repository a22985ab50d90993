/* Cells by any number of threads, and ranges of triangles that are put together. */
#include <string.h>

#include "libcore/geodesic/cells/voronoi_fixture.h"

static MesoArena arena;

/* Bands around the axis, every third of which is the domain. */
static void put_bands(MesoTriangulation *mesh, MesoDomain *domain, uint32_t *triangles)
{
    static const uint8_t member[3] = {1, 0, 0};
    *domain = (MesoDomain){member, 0, triangles};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        mesh->labels[t] = (uint32_t)(10 * (mesh->positions[mesh->corners[3 * t]].z + 1)) % 3;
        if (mesh->labels[t] == 0)
            triangles[domain->triangle_count++] = t;
    }
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->labels[h / 3] != mesh->labels[mesh->twins[h] / 3])
            mesh->walls[h / 3] |= (uint8_t)(1u << h % 3);
    CHECK(meso_triangulation_check(mesh, NULL) == MESO_OK);
}

/* Lines are the same bytes for any number of threads, behind others that are there, and leave no gaps. */
static void check_threads(MesoGeodesicSolver *solver, const MesoDomain *domain, const MesoMeshPoint *seeds,
                          uint32_t seed_count)
{
    const uint32_t threads[4] = {1, 2, 7, 0};
    MesoCutLines lines[4] = {0};
    for (uint32_t i = 0; i < 4; i++) {
        MesoVoronoiQuery query = {domain, seed_count, seeds, threads[i]};
        CHECK(meso_voronoi_trace(&lines[i], NULL, NULL, &arena, solver->mesh, solver, &query, NULL) == MESO_OK);
        CHECK(lines[i].node_count > 100 && lines[i].node_count == lines[0].node_count &&
              lines[i].segment_count == lines[0].segment_count);
        CHECK(memcmp(lines[i].nodes, lines[0].nodes, lines[0].node_count * sizeof *lines[0].nodes) == 0);
        CHECK(memcmp(lines[i].segments, lines[0].segments, lines[0].segment_count * sizeof *lines[0].segments) == 0);
    }
    check_no_gaps(solver->mesh, domain, &lines[0]);
    uint32_t node_count = lines[0].node_count, segment_count = lines[0].segment_count;
    MesoVoronoiQuery query = {domain, seed_count, seeds, 2};
    CHECK(meso_voronoi_trace(&lines[0], NULL, NULL, &arena, solver->mesh, solver, &query, NULL) == MESO_OK);
    CHECK(lines[0].node_count == 2 * node_count && lines[0].segment_count == 2 * segment_count);
    CHECK(memcmp(lines[0].nodes, lines[1].nodes, node_count * sizeof *lines[0].nodes) == 0);
    for (uint32_t s = 0; s < segment_count; s++) {
        const MesoCutSegment *first = &lines[1].segments[s], *again = &lines[0].segments[segment_count + s];
        CHECK(first->triangle == again->triangle && first->line == again->line);
        CHECK(first->node[0] + node_count == again->node[0] && first->node[1] + node_count == again->node[1]);
    }
}

/* Many ranges of triangles; cells of many and of few; domains whose triangles lie apart. */
static void test_threads(void)
{
    enum { SEEDS = 6000 };
    MesoRandom random;
    MesoMeshPoint *seeds = malloc(SEEDS * sizeof *seeds), *inside = malloc(SEEDS * sizeof *inside);
    MesoTriangulation mesh = meso_fixture_sphere(60, 0.3f, 3);
    uint32_t *triangles = malloc(mesh.triangle_count * sizeof *triangles), inside_count = 0;
    MesoDomain domain;
    CHECK(seeds && inside && triangles);
    put_bands(&mesh, &domain, triangles);
    meso_random_init(&random, 11, 0);
    for (uint32_t i = 0; i < SEEDS; i++) {
        seeds[i] = random_point(&mesh, &random);
        if (mesh.labels[seeds[i].triangle] == 0)
            inside[inside_count++] = seeds[i];
    }
    MesoGeodesicSolver *solver = solver_of(&mesh);
    check_threads(solver, NULL, seeds, 20);
    check_threads(solver, NULL, seeds, SEEDS);
    check_threads(solver, &domain, inside, 20);
    check_threads(solver, &domain, inside, inside_count);
    free(triangles);
    free(inside);
    free(seeds);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    meso_arena_init(&arena);
    test_threads();
    meso_arena_release(&arena);
    return 0;
}
