/*
 * Rates and errors of the distances from one vertex of an irregular sphere, whose vertices and triangles come in random
 * order. Times are of the process, of one core, but for those of two fields at once; the best of some. Errors are
 * relative, against r times the angle.
 *
 *   geodesic_bench [--exact] [DIVISIONS...]    spheres of 20 n^2 triangles; with the exact engine, too
 */
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "libcore/base/clock.h"
#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/geodesic/geodesic_solver.h"
#include "libcore/mesh/cut/mesh_cut.h"

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---- the mesh ---- */

static uint32_t *random_order(uint32_t count, uint64_t stream)
{
    MesoRandom random;
    uint32_t *order = malloc(((size_t)count + 1) * sizeof *order);
    CHECK(order);
    meso_random_init(&random, 11, stream);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = meso_random_below(&random, i + 1);
        order[i] = order[j];
        order[j] = i;
    }
    return order;
}

/* The same surface, with its vertices and triangles in random order where asked. */
static void copy_polygons(const MesoTriangulation *mesh, bool shuffled, MesoArena *arena, MesoPolygonMesh *polygons)
{
    uint32_t *vertex = random_order(shuffled ? mesh->vertex_count : 0, 0);
    uint32_t *triangle = random_order(shuffled ? mesh->triangle_count : 0, 1);
    *polygons = (MesoPolygonMesh){.vertex_count = mesh->vertex_count, .face_count = mesh->triangle_count,
                                  .corner_count = 3 * mesh->triangle_count, .side_count = 3};
    polygons->positions = MESO_NEW(arena, MesoVec3, mesh->vertex_count, NULL);
    polygons->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)mesh->triangle_count, NULL);
    CHECK(polygons->positions && polygons->corners);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        polygons->positions[shuffled ? vertex[v] : v] = mesh->positions[v];
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = mesh->corners[3 * (size_t)t + k];
            polygons->corners[3 * (size_t)(shuffled ? triangle[t] : t) + k] = shuffled ? vertex[v] : v;
        }
    free(vertex);
    free(triangle);
}

/* A triangulation of the same surface, as from a file. */
static MesoTriangulation reload(const MesoTriangulation *from, bool shuffled, const char *name)
{
    MesoArena arena;
    MesoSurface surface;
    MesoPolygonMesh polygons;
    MesoTriangulation mesh;
    meso_arena_init(&arena);
    copy_polygons(from, shuffled, &arena, &polygons);
    CHECK(meso_polygon_mesh_check(&polygons, 1, NULL, NULL) == MESO_OK);
    CHECK(meso_surface_build(&surface, &arena, &polygons, 1, NULL) == MESO_OK);
    double start = cpu_seconds();
    CHECK(meso_triangulation_init(&mesh, &surface, 0, 0, NULL) == MESO_OK);
    printf("  triangulation, %s: %.3f s\n", name, cpu_seconds() - start);
    meso_arena_release(&arena);
    return mesh;
}

static MesoTriangulation load(uint32_t divisions)
{
    MesoTriangulation made = meso_fixture_sphere(divisions, 0.3f, 7);
    MesoTriangulation ordered = reload(&made, false, "from a file in some order");
    meso_triangulation_release(&ordered);
    MesoTriangulation mesh = reload(&made, true, "from a shuffled file");
    meso_triangulation_release(&made);
    return mesh;
}

/* ---- solving ---- */

static void print_error(const MesoTriangulation *mesh, uint32_t seed, const float *distance)
{
    double sum = 0, worst = 0;
    MesoVec3 s = mesh->positions[seed];
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 p = mesh->positions[v];
        double x = (double)s.y * p.z - (double)s.z * p.y, y = (double)s.z * p.x - (double)s.x * p.z;
        double z = (double)s.x * p.y - (double)s.y * p.x;
        double exact = atan2(sqrt(x * x + y * y + z * z), (double)meso_vec3_dot(s, p));
        double off = exact > 0 ? distance[v] / exact - 1 : 0;
        sum += off * off;
        if (exact > 0.02 * MESO_PI)
            worst = fabs(off) > worst ? fabs(off) : worst;
    }
    printf("RMS %.4f %%, largest %.3f %% beyond 2 %% of the farthest\n", 100 * sqrt(sum / mesh->vertex_count),
           100 * worst);
}

static void time_solver(const MesoTriangulation *mesh, MesoGeodesicSolver *solver, const char *name, int rounds)
{
    MesoGeodesicSeed seed = {(uint32_t)(0.37 * mesh->vertex_count), 0, false};
    MesoGeodesicQuery query = {.seeds = &seed, .seed_count = 1, .target = MESO_NO_INDEX};
    float *distance = malloc(mesh->vertex_count * sizeof *distance);
    double best = 1e9;
    CHECK(distance);
    for (int round = 0; round < rounds; round++) {
        double start = cpu_seconds();
        CHECK(meso_geodesic_solve(solver, &query, distance, NULL, NULL, NULL) == MESO_OK);
        double took = cpu_seconds() - start;
        best = took < best ? took : best;
    }
    printf("  %-14s %.4f s, ", name, best);
    print_error(mesh, seed.vertex, distance);
    free(distance);
}

/* From two ends, as blends need it, by the clock on the wall. */
static void time_pair(const MesoTriangulation *mesh, MesoGeodesicSolver *solver)
{
    const MesoGeodesicSeed seeds[2] = {{(uint32_t)(0.37 * mesh->vertex_count), 0, false}, {0, 0, false}};
    MesoGeodesicQuery queries[2];
    float *distances[2];
    for (int i = 0; i < 2; i++) {
        queries[i] = (MesoGeodesicQuery){.seeds = &seeds[i], .seed_count = 1, .target = MESO_NO_INDEX};
        distances[i] = malloc(mesh->vertex_count * sizeof(float));
        CHECK(distances[i]);
    }
    for (uint32_t threads = 1; threads <= 2; threads++) {
        double best = 1e9;
        for (int round = 0; round < 7; round++) {
            double start = meso_seconds();
            CHECK(meso_geodesic_solve_pair(solver, queries, distances, threads, NULL) == MESO_OK);
            best = fmin(best, meso_seconds() - start);
        }
        printf("  two at once, %u thread%s: %.4f s\n", threads, threads > 1 ? "s" : "", best);
    }
    free(distances[0]);
    free(distances[1]);
}

/* What cannot be done without: reading each ring and the distances in it once. */
static void time_limit(const MesoGeodesicSolver *solver)
{
    double best = 1e9;
    volatile float kept = 0;
    for (int round = 0; round < 5; round++) {
        double start = cpu_seconds();
        float sum = 0;
        for (uint32_t v = 0; v < solver->vertex_count; v++) {
            MesoOneRing ring = meso_one_ring(&solver->rings, v);
            for (uint32_t k = 0; k < ring.count; k++)
                sum += solver->rows[ring.spokes[k]].x;
        }
        kept = sum;
        double took = cpu_seconds() - start;
        best = took < best ? took : best;
    }
    (void)kept;
    printf("  %-14s %.4f s\n", "rings once", best);
}

static double bytes_a_vertex(const MesoGeodesicSolver *solver)
{
    double bytes = (double)solver->vertex_room * (sizeof *solver->rows + sizeof *solver->states + sizeof *solver->touched);
    bytes += (double)solver->rings.vertex_room * (sizeof *solver->rings.begins + sizeof *solver->rings.sizes);
    bytes += (double)solver->rings.pool_room * sizeof *solver->rings.pool + sizeof *solver;
    for (uint32_t b = 0; b < MESO_BUCKET_COUNT; b++)
        bytes += (double)solver->buckets.open[b].room * sizeof(uint32_t);
    return bytes / solver->vertex_count;
}

/* ---- a cut ---- */

static float height(MesoVec3 p)
{
    return 0.6f * p.x + 0.5f * p.y + 0.62f * p.z - 0.01f;
}

static uint32_t node_on(const MesoTriangulation *mesh, uint32_t side, uint32_t *nodes, MesoCutLines *lines,
                        MesoArena *arena)
{
    uint32_t twin = mesh->twins[side];
    if (twin != MESO_NO_INDEX && nodes[twin] != MESO_NO_INDEX)
        return nodes[twin];
    float a = height(mesh->positions[mesh->corners[side]]);
    float b = height(mesh->positions[mesh->corners[meso_next_corner(side)]]);
    CHECK(meso_cut_add_node(lines, arena, (MesoCutNode){MESO_ON_EDGE, side, {a / (a - b), 0}}, &nodes[side], NULL) ==
          MESO_OK);
    return nodes[side];
}

/* The great circle that halves the sphere. */
static void half_lines(const MesoTriangulation *mesh, MesoCutLines *lines, MesoArena *arena)
{
    uint32_t *nodes = malloc(3 * (size_t)mesh->triangle_count * sizeof *nodes);
    CHECK(nodes);
    for (size_t h = 0; h < 3 * (size_t)mesh->triangle_count; h++)
        nodes[h] = MESO_NO_INDEX;
    *lines = (MesoCutLines){0};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        MesoCutSegment segment = {.triangle = t};
        uint32_t found = 0;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t side = 3 * t + k;
            bool above = height(mesh->positions[mesh->corners[side]]) > 0;
            if (above != (height(mesh->positions[mesh->corners[meso_next_corner(side)]]) > 0))
                segment.node[found++] = node_on(mesh, side, nodes, lines, arena);
        }
        if (found == 2)
            CHECK(meso_cut_add_segment(lines, arena, segment, NULL) == MESO_OK);
    }
    free(nodes);
}

static void time_update(MesoTriangulation *mesh, MesoGeodesicSolver *solver)
{
    MesoArena arena;
    MesoCutLines lines;
    MesoCutReport report;
    meso_arena_init(&arena);
    half_lines(mesh, &lines, &arena);
    CHECK(meso_mesh_cut(mesh, &lines, &report, &arena, NULL) == MESO_OK);
    double start = cpu_seconds();
    CHECK(meso_geodesic_update(solver, &report, NULL) == MESO_OK);
    double took = cpu_seconds() - start;
    printf("  update after a cut into halves, %u parts: %.2f ms\n", report.part_count, 1e3 * took);
    time_solver(mesh, solver, "after the cut", 3);
    meso_arena_release(&arena);
}

static void measure(uint32_t divisions, bool with_exact)
{
    printf("sphere of %.2f M triangles\n", 20e-6 * divisions * divisions);
    MesoTriangulation mesh = load(divisions);
    MesoGeodesicSolver *solver;
    double start = cpu_seconds();
    CHECK(meso_geodesic_init(&solver, &mesh, MESO_GEODESIC_FRONTS, NULL) == MESO_OK);
    printf("  rings: %.3f s\n", cpu_seconds() - start);
    time_limit(solver);
    time_solver(&mesh, solver, "fronts", 7);
    solver->plain = true;
    time_solver(&mesh, solver, "fronts, plain", 3);
    solver->plain = false;
    time_pair(&mesh, solver);
    printf("  memory: %.1f bytes a vertex, and 4 for its distance\n", bytes_a_vertex(solver));

    MesoGeodesicSolver *graph;
    CHECK(meso_geodesic_init(&graph, &mesh, MESO_GEODESIC_GRAPH, NULL) == MESO_OK);
    start = cpu_seconds();
    CHECK(meso_geodesic_graph_make(graph, NULL) == MESO_OK);
    printf("  arcs: %.3f s\n", cpu_seconds() - start);
    time_solver(&mesh, graph, "graph", 3);
    meso_geodesic_release(graph);

    if (with_exact) {
        MesoGeodesicSolver *exact;
        CHECK(meso_geodesic_init(&exact, &mesh, MESO_GEODESIC_EXACT, NULL) == MESO_OK);
        time_solver(&mesh, exact, "exact", 1);
        meso_geodesic_release(exact);
    }
    time_update(&mesh, solver);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

int main(int argc, char **argv)
{
    const uint32_t divisions[4] = {122, 224, 316, 600};
    bool with_exact = argc > 1 && strcmp(argv[1], "--exact") == 0;
    for (int i = 1 + with_exact; i < argc; i++)
        measure((uint32_t)atoi(argv[i]), with_exact);
    for (int i = 0; i < 4 && argc == 1 + with_exact; i++)
        measure(divisions[i], with_exact);
    return 0;
}
