/*
 * Rates and errors of the distances from one vertex of an irregular surface, whose vertices and triangles come in random
 * order. Times are of the process, of one core, but for those of two fields at once; the best of some.
 *
 *   geodesic_bench [DIVISIONS...]      spheres of 20 n^2 triangles; errors against r times the angle
 *   geodesic_bench --exact [MILLIONS]  a table of the engines: spheres up to 7.2 M triangles, a bumpy sphere and a rough
 *                                      torus; errors against the exact engine, in the disc of so many triangles around
 *                                      the source (2) where the surface has more. `anew`: an update is a build
 */
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "libcore/base/clock.h"
#include "libcore/geodesic/exact/exact_geodesic.h"
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

/* A triangulation of the same surface, as from a file; says how long that takes if it has a name. */
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
    if (name)
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

static uint32_t source_of(const MesoTriangulation *mesh)
{
    return (uint32_t)(0.37 * mesh->vertex_count);
}

/* Seconds of the best round. */
static double solve(MesoGeodesicSolver *solver, int rounds, float *distance)
{
    MesoGeodesicSeed seed = {source_of(solver->mesh), 0, false};
    MesoGeodesicQuery query = {.seeds = &seed, .seed_count = 1, .target = MESO_NO_INDEX};
    double best = 1e9;
    for (int round = 0; round < rounds; round++) {
        double start = cpu_seconds();
        CHECK(meso_geodesic_solve(solver, &query, distance, NULL, NULL, NULL) == MESO_OK);
        double took = cpu_seconds() - start;
        best = took < best ? took : best;
    }
    return best;
}

static void time_solver(const MesoTriangulation *mesh, MesoGeodesicSolver *solver, const char *name, int rounds)
{
    float *distance = malloc(mesh->vertex_count * sizeof *distance);
    CHECK(distance);
    printf("  %-14s %.4f s, ", name, solve(solver, rounds, distance));
    print_error(mesh, source_of(mesh), distance);
    free(distance);
}

/* From two ends, as blends need it, by the clock on the wall. */
static void time_pair(const MesoTriangulation *mesh, MesoGeodesicSolver *solver)
{
    const MesoGeodesicSeed seeds[2] = {{source_of(mesh), 0, false}, {0, 0, false}};
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

/* Seconds to follow a cut into halves. */
static double update(MesoTriangulation *mesh, MesoGeodesicSolver *solver, uint32_t *part_count)
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
    *part_count = report.part_count;
    meso_arena_release(&arena);
    return took;
}

static void time_update(MesoTriangulation *mesh, MesoGeodesicSolver *solver)
{
    uint32_t part_count;
    double took = update(mesh, solver, &part_count);
    printf("  update after a cut into halves, %u parts: %.2f ms\n", part_count, 1e3 * took);
    time_solver(mesh, solver, "after the cut", 3);
}

static void measure(uint32_t divisions)
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

    time_update(&mesh, solver);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

/* ---- the table ---- */

/* In MB: what is resident now, or what was at most since `forget_peak`. 0 where the system does not say. */
static double resident(const char *what)
{
    char line[128];
    double kilobytes = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, what, strlen(what)) == 0)
            kilobytes = strtod(line + strlen(what), NULL);
    if (file)
        fclose(file);
    return kilobytes / 1024;
}

static void forget_peak(void)
{
    malloc_trim(0);
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (!file)
        return;
    fputs("5", file);
    fclose(file);
}

/* Exact distances within `limit`; INFINITY beyond. Prints its row. */
static void solve_exactly(const MesoTriangulation *mesh, double limit, double *exact)
{
    MesoArena arena;
    MesoError error;
    MesoExactGeodesicField field;
    MesoExactGeodesicSeed seed = {source_of(mesh), 0, false};
    MesoExactGeodesicQuery query = {.seeds = &seed, .seed_count = 1, .limit = limit, .target = MESO_NO_INDEX};
    forget_peak();
    double before = resident("VmRSS:"), start = cpu_seconds();
    meso_arena_init(&arena);
    CHECK(meso_exact_geodesic(mesh, NULL, &query, &arena, exact, &field, &error) == MESO_OK);
    printf("  exact  %9.3f s %9s %12s %6.0f MB %10s %11s   %.0f M windows\n", cpu_seconds() - start, "-", "-",
           resident("VmHWM:") - before, "-", "-", 1e-6 * (double)field.window_count);
    meso_arena_release(&arena);
}

/* RMS, and the largest beyond 2 % of the farthest, in hundredths. */
static void compare(const float *distance, const double *exact, uint32_t count, double *rms, double *largest)
{
    double farthest = 0, sum = 0;
    uint32_t compared = 0;
    *largest = 0;
    for (uint32_t v = 0; v < count; v++)
        farthest = isfinite(exact[v]) ? fmax(farthest, exact[v]) : farthest;
    for (uint32_t v = 0; v < count; v++) {
        if (!(exact[v] > 0) || !isfinite(exact[v]))
            continue;
        double off = 100 * (distance[v] / exact[v] - 1);
        sum += off * off;
        compared++;
        *largest = exact[v] > 0.02 * farthest ? fmax(*largest, fabs(off)) : *largest;
    }
    *rms = sqrt(sum / compared);
}

/* The row of an engine; `cut` is the last use of the mesh, if there is one. */
static void measure_engine(MesoTriangulation *mesh, MesoGeodesicEngine engine, const double *exact, float *distance,
                           bool cut)
{
    bool is_graph = engine == MESO_GEODESIC_GRAPH;
    MesoGeodesicSolver *solver;
    double rms, largest, start;
    uint32_t part_count;
    forget_peak();
    double before = resident("VmRSS:");
    start = cpu_seconds();
    CHECK(meso_geodesic_init(&solver, mesh, engine, NULL) == MESO_OK);
    CHECK(!is_graph || meso_geodesic_graph_make(solver, NULL) == MESO_OK);
    double build = cpu_seconds() - start, took = solve(solver, is_graph ? 3 : 7, distance);
    double memory = resident("VmHWM:") - before;
    compare(distance, exact, mesh->vertex_count, &rms, &largest);
    printf("  %-6s %9.4f s %7.3f s ", is_graph ? "graph" : "fronts", took, build);
    if (cut)
        printf("%9.2f ms", 1e3 * update(mesh, solver, &part_count));
    else
        printf("%12s", "anew");
    printf(" %6.0f MB %8.4f %% %9.3f %%\n", memory, rms, largest);
    meso_geodesic_release(solver);
}

static int by_size(const void *a, const void *b)
{
    const float *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* What the nearest vertices are within, such that about so many triangles are; 0: all. */
static double disc_radius(const MesoTriangulation *mesh, double triangle_count)
{
    if (mesh->triangle_count <= 1.05 * triangle_count)
        return 0;
    MesoGeodesicSolver *solver;
    float *distance = malloc(mesh->vertex_count * sizeof *distance);
    CHECK(distance && meso_geodesic_init(&solver, mesh, MESO_GEODESIC_FRONTS, NULL) == MESO_OK);
    solve(solver, 1, distance);
    qsort(distance, mesh->vertex_count, sizeof *distance, by_size);
    double radius = distance[(size_t)(triangle_count / mesh->triangle_count * mesh->vertex_count)];
    meso_geodesic_release(solver);
    free(distance);
    return radius;
}

static void measure_table(const char *name, MesoTriangulation *made, double disc)
{
    MesoTriangulation mesh = reload(made, true, NULL);
    meso_triangulation_release(made);
    double limit = disc_radius(&mesh, disc), *exact = malloc(mesh.vertex_count * sizeof *exact);
    float *distance = malloc(mesh.vertex_count * sizeof *distance);
    CHECK(exact && distance);
    printf("%s of %.2f M triangles, ", name, 1e-6 * mesh.triangle_count);
    if (limit > 0)
        printf("errors within %.3f of the source, which %.1f M of them are\n", limit, 1e-6 * disc);
    else
        printf("errors everywhere\n");
    printf("  %-6s %11s %9s %12s %9s %10s %11s\n", "engine", "solve", "build", "update", "memory", "RMS", "largest");
    solve_exactly(&mesh, limit, exact);
    measure_engine(&mesh, MESO_GEODESIC_GRAPH, exact, distance, false);
    measure_engine(&mesh, MESO_GEODESIC_FRONTS, exact, distance, true);
    fflush(stdout);
    free(exact);
    free(distance);
    meso_triangulation_release(&mesh);
}

/* Bumps a twentieth of the radius high. */
static void add_bumps(MesoTriangulation *mesh)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 p = mesh->positions[v];
        mesh->positions[v] = meso_vec3_scale(p, 1 + 0.05f * sinf(11 * p.x) * cosf(13 * p.y) * sinf(9 * p.z));
    }
}

/* Each vertex off its place: half of them are saddles. */
static void roughen(MesoTriangulation *mesh, float step)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (float *x = &mesh->positions[v].x; x <= &mesh->positions[v].z; x++)
            *x += step * meso_fixture_signed(&random);
}

static void measure_exactly(double disc)
{
    const uint32_t divisions[5] = {122, 158, 224, 316, 600};
    MesoTriangulation mesh = meso_fixture_sphere(122, 0.3f, 7);
    add_bumps(&mesh);
    measure_table("bumpy sphere", &mesh, disc);
    mesh = meso_fixture_torus(600, 250, 0.4f);
    roughen(&mesh, 0.0015f);
    measure_table("rough torus", &mesh, disc);
    for (uint32_t i = 0; i < 5; i++) {
        mesh = meso_fixture_sphere(divisions[i], 0.3f, 7);
        measure_table("sphere", &mesh, disc);
    }
}

int main(int argc, char **argv)
{
    const uint32_t divisions[4] = {122, 224, 316, 600};
    if (argc > 1 && strcmp(argv[1], "--exact") == 0) {
        measure_exactly(1e6 * (argc > 2 ? strtod(argv[2], NULL) : 2));
        return 0;
    }
    for (int i = 1; i < argc; i++)
        measure((uint32_t)atoi(argv[i]));
    for (int i = 0; i < 4 && argc == 1; i++)
        measure(divisions[i]);
    return 0;
}
