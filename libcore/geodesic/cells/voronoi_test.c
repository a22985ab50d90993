#include "libcore/geodesic/cells/voronoi.h"

#include <string.h>

#include "libcore/geodesic/cells/voronoi_fixture.h"
#include "libcore/geodesic/exact/exact_geodesic.h"
#include "libcore/geodesic/regions_fixture.h"

static MesoArena arena;

/* A solve of its own for a seed: as the fronts plant it. */
static void solve_alone(MesoGeodesicSolver *solver, const MesoDomain *domain, const MesoMeshPoint *point,
                        float *distance)
{
    const uint32_t *corners = solver->mesh->corners + 3 * (size_t)point->triangle;
    MesoGeodesicSeed seeds[3];
    MesoGeodesicQuery query = {.domain = domain, .seeds = seeds, .target = MESO_NO_INDEX};
    MesoVec3 place = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        place = meso_vec3_mad(place, point->weight[k], solver->mesh->positions[corners[k]]);
    for (uint32_t k = 0; k < 3; k++)
        if (point->weight[k] == 1) {
            seeds[0] = (MesoGeodesicSeed){corners[k], 0, false};
            query.seed_count = 1;
        }
    for (uint32_t k = 0; k < 3 && query.seed_count != 1; k++)
        seeds[k] = (MesoGeodesicSeed){
            corners[k], meso_vec3_length(meso_vec3_sub(solver->mesh->positions[corners[k]], place)), false};
    query.seed_count = query.seed_count ? 1 : 3;
    CHECK(meso_geodesic_solve(solver, &query, distance, NULL, NULL, NULL) == MESO_OK);
}

/* Cells and distances are those of separate solves, to the last bit. */
static void check_cells(MesoGeodesicSolver *solver, const MesoDomain *domain, const MesoMeshPoint *seeds,
                        uint32_t seed_count, const uint32_t *cell, const float *distance)
{
    uint32_t n = solver->mesh->vertex_count;
    float *alone = malloc(n * sizeof *alone), *least = malloc(n * sizeof *least);
    uint32_t *nearest = malloc(n * sizeof *nearest);
    CHECK(alone && least && nearest);
    for (uint32_t v = 0; v < n; v++) {
        alone[v] = least[v] = INFINITY;
        nearest[v] = MESO_NO_INDEX;
    }
    for (uint32_t i = 0; i < seed_count; i++) {
        solve_alone(solver, domain, &seeds[i], alone);
        for (uint32_t v = 0; v < n; v++)
            if (alone[v] < least[v]) {
                least[v] = alone[v];
                nearest[v] = i;
            }
    }
    for (uint32_t v = 0; v < n; v++)
        CHECK(nearest[v] == cell[v] && least[v] == distance[v]);
    free(alone);
    free(least);
    free(nearest);
}

/* Two seeds at the ends of a strip: one straight border half-way, its nodes one a side. */
static void test_two(void)
{
    uint32_t cell[7 * 3];
    float distance[7 * 3];
    MesoCutLines lines = {0};
    MesoTriangulation mesh = meso_fixture_sheet(6, 2, 1);
    MesoGeodesicSolver *solver = solver_of(&mesh);
    MesoMeshPoint seeds[2] = {vertex_point(&mesh, 8), vertex_point(&mesh, 13)};
    MesoVoronoiQuery query = {.seed_count = 2, .seeds = seeds};
    CHECK(meso_voronoi_trace(&lines, cell, distance, &arena, &mesh, solver, &query, NULL) == MESO_OK);
    for (uint32_t v = 0; v < 21; v++)
        CHECK(cell[v] == (v % 7 > 3));
    CHECK(distance[8] == 0 && distance[13] == 0 && fabsf(distance[10] - 2) < 1e-6f);
    CHECK(lines.node_count == 5 && lines.segment_count == 4);
    for (uint32_t n = 0; n < 5; n++) {
        MesoVec3 p = meso_cut_node_position(&mesh, &lines.nodes[n]);
        CHECK(lines.nodes[n].kind == MESO_ON_EDGE && fabsf(p.x - 3.5f) < 0.05f);
    }
    for (uint32_t s = 0; s < 4; s++)
        CHECK(lines.segments[s].line == 0);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

/* Three cells of a triangle meet in the middle; no seed, no cell. */
static void test_three(void)
{
    const MesoVec3 positions[3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    const uint32_t corners[3] = {0, 1, 2};
    uint32_t cell[3];
    MesoCutLines lines = {0};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 3, corners, 1);
    MesoGeodesicSolver *solver = solver_of(&mesh);
    MesoMeshPoint seeds[3] = {{0, {1, 0, 0}}, {0, {0, 1, 0}}, {0, {0, 0, 1}}};
    MesoVoronoiQuery query = {.seed_count = 3, .seeds = seeds};
    CHECK(meso_voronoi_trace(&lines, cell, NULL, &arena, &mesh, solver, &query, NULL) == MESO_OK);
    CHECK(cell[0] == 0 && cell[1] == 1 && cell[2] == 2);
    CHECK(lines.node_count == 4 && lines.segment_count == 3 && lines.nodes[3].kind == MESO_IN_TRIANGLE);
    for (uint32_t n = 0; n < 3; n++)
        CHECK(lines.nodes[n].kind == MESO_ON_EDGE && fabsf(lines.nodes[n].share[0] - 0.5f) < 1e-6f);
    query.seed_count = 0;
    CHECK(meso_voronoi_trace(&lines, cell, NULL, &arena, &mesh, solver, &query, NULL) == MESO_OK);
    CHECK(lines.segment_count == 3 && cell[0] == MESO_NO_INDEX);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

/* Every node of a side is no nearer to its ends than the cut allows. */
static void check_shares(const MesoCutLines *lines)
{
    for (uint32_t n = 0; n < lines->node_count; n++)
        if (lines->nodes[n].kind == MESO_ON_EDGE)
            CHECK(lines->nodes[n].share[0] >= MESO_CUT_SNAP && lines->nodes[n].share[0] <= 1 - MESO_CUT_SNAP);
}

/* Nowhere two triangles disagree, and nothing is written outside of the domain. */
static void check_round(MesoGeodesicSolver *solver, const MesoDomain *domain, const MesoMeshPoint *seeds,
                        uint32_t seed_count)
{
    const MesoTriangulation *mesh = solver->mesh;
    uint32_t *cell = malloc(mesh->vertex_count * sizeof *cell);
    float *distance = malloc(mesh->vertex_count * sizeof *distance);
    MesoVoronoiQuery query = {domain, seed_count, seeds, 0};
    MesoCutLines lines = {0};
    CHECK(cell && distance);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        cell[v] = MESO_NO_INDEX;
        distance[v] = INFINITY;
    }
    CHECK(meso_voronoi_trace(&lines, cell, distance, &arena, mesh, solver, &query, NULL) == MESO_OK);
    check_no_gaps(mesh, domain, &lines);
    check_shares(&lines);
    check_cells(solver, domain, seeds, seed_count, cell, distance);
    free(cell);
    free(distance);
}

/* Against separate solves on a sphere: at vertices and inside triangles, down to few triangles a cell. */
static void test_brute_force(void)
{
    const uint32_t counts[4] = {2, 20, 100, 400};
    MesoRandom random;
    MesoMeshPoint seeds[400];
    MesoTriangulation mesh = meso_fixture_sphere(16, 0.3f, 3);
    MesoGeodesicSolver *solver = solver_of(&mesh);
    meso_random_init(&random, 5, 0);
    for (uint32_t round = 0; round < 8; round++) {
        solver->plain = round % 4 > 1;
        for (uint32_t i = 0; i < counts[round / 2]; i++)
            seeds[i] = round % 2 ? random_point(&mesh, &random)
                                 : vertex_point(&mesh, meso_random_below(&random, mesh.vertex_count));
        check_round(solver, NULL, seeds, counts[round / 2]);
    }
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

/* In a domain of two pieces, in one of which there is no seed, and one that is small. */
static void test_domain(void)
{
    MesoRandom random;
    const uint8_t member[3] = {0, 1, 1};
    MesoMeshPoint seeds[60];
    uint32_t count = 0;
    MesoTriangulation mesh = meso_fixture_sphere(24, 0.3f, 3);
    uint32_t *triangles = malloc(mesh.triangle_count * sizeof *triangles);
    MesoDomain domain = {member, 0, triangles};
    CHECK(triangles);
    meso_random_init(&random, 6, 0);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        MesoVec3 p = mesh.positions[mesh.corners[3 * t]];
        mesh.labels[t] = p.z > 0.9f ? 1 : p.z < -0.2f && p.z > -0.6f && p.x > -0.3f ? 2 : 0;
        if (mesh.labels[t])
            triangles[domain.triangle_count++] = t;
        if (mesh.labels[t] == 2 && count < 60 && meso_random_below(&random, 20) == 0)
            seeds[count++] = (MesoMeshPoint){t, {0.25f, 0.25f, 0.5f}};
    }
    for (uint32_t h = 0; h < 3 * mesh.triangle_count; h++)
        if (mesh.labels[h / 3] != mesh.labels[mesh.twins[h] / 3])
            mesh.walls[h / 3] |= (uint8_t)(1u << h % 3);
    CHECK(meso_triangulation_check(&mesh, NULL) == MESO_OK && count > 20);
    MesoGeodesicSolver *solver = solver_of(&mesh);
    check_round(solver, &domain, seeds, count);
    domain.member = (const uint8_t[3]){0, 1, 0};
    domain.triangle_count = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        if (mesh.labels[t] == 1)
            triangles[domain.triangle_count++] = t;
    seeds[0].triangle = triangles[0];
    seeds[1].triangle = triangles[domain.triangle_count / 2];
    check_round(solver, &domain, seeds, 2);
    free(triangles);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

/* Vertices of a cell hang together, also where fronts pass between vertices of others: many cells, one part each. */
static void test_whole_cells(void)
{
    enum { SEEDS = 3000, ROOM = 1000000 };
    MesoRandom random;
    MesoMeshPoint seeds[SEEDS];
    MesoNearestSeeds nearest = {.seed_count = SEEDS, .seeds = seeds, .threads = 1};
    MesoCutLines lines = {0};
    uint32_t cells = 0, parts = 0;
    uint8_t has_vertex[SEEDS] = {0};
    MesoTriangulation mesh = meso_fixture_sphere(60, 0.3f, 3);
    MesoGeodesicSolver *solver = solver_of(&mesh);
    uint32_t *region = MESO_NEW(&arena, uint32_t, ROOM, NULL), *part = MESO_NEW(&arena, uint32_t, ROOM, NULL);
    meso_random_init(&random, 8, 0);
    for (uint32_t i = 0; i < SEEDS; i++)
        seeds[i] = random_point(&mesh, &random);
    MesoVoronoiQuery query = {.seed_count = SEEDS, .seeds = seeds};
    CHECK(meso_nearest_seeds_find(&nearest, &arena, &mesh, solver, NULL) == MESO_OK);
    CHECK(meso_nearest_seeds_settle(&nearest, &arena, &mesh, NULL) == MESO_OK);
    meso_sets_init(part, mesh.vertex_count);
    for (uint32_t h = 0; h < 3 * mesh.triangle_count; h++) {
        uint32_t a = mesh.corners[h], b = mesh.corners[meso_next_corner(h)];
        if (meso_seed_slots(&nearest, a)->seed[0] == meso_seed_slots(&nearest, b)->seed[0])
            meso_sets_join(part, a, b);
    }
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        uint8_t *has = &has_vertex[meso_seed_slots(&nearest, v)->seed[0]];
        parts += meso_sets_root(part, v) == v;
        cells += !*has;
        *has = 1;
    }
    CHECK(parts == cells);
    /* what is left more: between borders that go through the same vertices */
    CHECK(meso_voronoi_trace(&lines, NULL, NULL, &arena, &mesh, solver, &query, NULL) == MESO_OK);
    meso_geodesic_release(solver);
    uint32_t count = meso_fixture_cut(&mesh, &lines, region, ROOM);
    CHECK(count >= cells && count - cells < cells / 200);
    meso_triangulation_release(&mesh);
}

static uint32_t nearest_pole(const MesoVec3 *poles, uint32_t count, MesoVec3 point)
{
    uint32_t nearest = 0;
    for (uint32_t i = 1; i < count; i++)
        if (meso_vec3_dot(poles[i], point) > meso_vec3_dot(poles[nearest], point))
            nearest = i;
    return nearest;
}

/* Cut along the borders, a sphere falls into one region a seed; 99.9 % of its area is in the right one. */
static void test_area(void)
{
    enum { SEEDS = 30, ROOM = 200000 };
    MesoRandom random;
    MesoMeshPoint seeds[SEEDS];
    MesoVec3 poles[SEEDS];
    double area[SEEDS][SEEDS] = {0}, right = 0, all = 0;
    MesoCutLines lines = {0};
    MesoTriangulation mesh = meso_fixture_sphere(60, 0.3f, 3);
    MesoGeodesicSolver *solver = solver_of(&mesh);
    uint32_t *region = MESO_NEW(&arena, uint32_t, ROOM, NULL);
    meso_random_init(&random, 9, 0);
    for (uint32_t i = 0; i < SEEDS; i++) {
        seeds[i] = random_point(&mesh, &random);
        poles[i] = (MesoVec3){0, 0, 0};
        for (uint32_t k = 0; k < 3; k++)
            poles[i] = meso_vec3_mad(poles[i], seeds[i].weight[k],
                                     mesh.positions[mesh.corners[3 * seeds[i].triangle + k]]);
        poles[i] = meso_vec3_unit(poles[i], poles[i]);
    }
    MesoVoronoiQuery query = {.seed_count = SEEDS, .seeds = seeds};
    CHECK(meso_voronoi_trace(&lines, NULL, NULL, &arena, &mesh, solver, &query, NULL) == MESO_OK);
    meso_geodesic_release(solver);
    CHECK(meso_fixture_cut(&mesh, &lines, region, ROOM) == SEEDS);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        const uint32_t *corners = mesh.corners + 3 * (size_t)t;
        MesoVec3 sum = meso_vec3_add(mesh.positions[corners[0]], mesh.positions[corners[1]]);
        uint32_t pole = nearest_pole(poles, SEEDS, meso_vec3_add(sum, mesh.positions[corners[2]]));
        area[region[t]][pole] += meso_fixture_area(&mesh, t);
    }
    for (uint32_t r = 0; r < SEEDS; r++) {
        double most = 0;
        for (uint32_t i = 0; i < SEEDS; i++) {
            most = fmax(most, area[r][i]);
            all += area[r][i];
        }
        right += most;
    }
    CHECK(right > 0.999 * all);
    meso_triangulation_release(&mesh);
}

/*
 * ---- brute force by exact distances ----
 *
 * The surface is cut along the borders that are traced. Then each seed's exact distances at all vertices of the pieces,
 * which are still the same polyhedron and have the borders' nodes among them, say where it is the nearest. Taken as
 * linear in the pieces, they find what is wrong to some hundredths of it: with sides half as long it is the same.
 */

enum { AREA_SEEDS = 12 };

static MesoVec3 place_of(const MesoTriangulation *mesh, const MesoMeshPoint *point)
{
    MesoVec3 place = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        place = meso_vec3_mad(place, point->weight[k], mesh->positions[mesh->corners[3 * point->triangle + k]]);
    return place;
}

/* Half of them at vertices, half inside triangles; none nearer to another than `apart`. */
static void draw_seeds(const MesoTriangulation *mesh, uint64_t stream, float apart, MesoMeshPoint seeds[AREA_SEEDS],
                       MesoVec3 places[AREA_SEEDS])
{
    MesoRandom random;
    uint32_t count = 0;
    meso_random_init(&random, 4, stream);
    while (count < AREA_SEEDS) {
        MesoMeshPoint point = count % 2 ? vertex_point(mesh, meso_random_below(&random, mesh->vertex_count))
                                        : random_point(mesh, &random);
        seeds[count] = point;
        places[count] = place_of(mesh, &point);
        bool far = true;
        for (uint32_t i = 0; i < count; i++)
            far = far && meso_vec3_length(meso_vec3_sub(places[i], places[count])) > apart;
        count += far;
    }
}

static double span(MesoVec3 a, MesoVec3 b, MesoVec3 c)
{
    return meso_vec3_length(meso_vec3_cross(meso_vec3_sub(b, a), meso_vec3_sub(c, a)));
}

/* The triangle that a place lies in, or is nearest to doing so. */
static MesoMeshPoint find_point(const MesoTriangulation *mesh, MesoVec3 place)
{
    MesoMeshPoint found = {0};
    double least = INFINITY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->corners + 3 * (size_t)t;
        MesoVec3 a = mesh->positions[corners[0]], b = mesh->positions[corners[1]], c = mesh->positions[corners[2]];
        double wa = span(place, b, c), wb = span(a, place, c), wc = span(a, b, place), sum = wa + wb + wc;
        double excess = sum - span(a, b, c);
        if (!(sum > 0) || !(excess < least))
            continue;
        least = excess;
        float w1 = (float)(wb / sum), w2 = (float)(wc / sum);
        found = (MesoMeshPoint){t, {1 - w1 - w2, w1, w2}};
    }
    return found;
}

/* [AREA_SEEDS * vertex_count] of each seed, where they are no greater than `limit`. */
static double *exact_distances(const MesoTriangulation *mesh, const MesoVec3 *places, double limit)
{
    MesoError error;
    MesoExactGeodesicField field;
    double *distance = malloc(AREA_SEEDS * (size_t)mesh->vertex_count * sizeof *distance);
    CHECK(distance);
    for (uint32_t i = 0; i < AREA_SEEDS; i++) {
        MesoExactGeodesicPoint point = {find_point(mesh, places[i]), 0};
        MesoExactGeodesicQuery query = {.points = &point, .point_count = 1, .limit = limit, .target = MESO_NO_INDEX};
        CHECK(meso_exact_geodesic(mesh, NULL, &query, &arena, distance + i * (size_t)mesh->vertex_count, &field,
                                  &error) == MESO_OK);
    }
    return distance;
}

/* A part of a triangle, by the weights of its second and its third corner. */
typedef struct Part {
    uint32_t count;
    double at[AREA_SEEDS + 3][2];
} Part;

/* Keeps where a linear function is not below zero, given at the three corners. */
static void clip(Part *part, const double value[3])
{
    Part kept = {0};
    for (uint32_t i = 0; i < part->count; i++) {
        const double *p = part->at[i], *q = part->at[(i + 1) % part->count];
        double a = value[0] + p[0] * (value[1] - value[0]) + p[1] * (value[2] - value[0]);
        double b = value[0] + q[0] * (value[1] - value[0]) + q[1] * (value[2] - value[0]);
        if (a >= 0) {
            kept.at[kept.count][0] = p[0];
            kept.at[kept.count++][1] = p[1];
        }
        if ((a >= 0) != (b >= 0)) {
            kept.at[kept.count][0] = p[0] + a / (a - b) * (q[0] - p[0]);
            kept.at[kept.count++][1] = p[1] + a / (a - b) * (q[1] - p[1]);
        }
    }
    *part = kept;
}

/* The share of a triangle in which a seed is the nearest. */
static double share_of(const MesoTriangulation *mesh, uint32_t triangle, const double *distance, uint32_t seed)
{
    const uint32_t *corners = mesh->corners + 3 * (size_t)triangle;
    const double *own = distance + seed * (size_t)mesh->vertex_count;
    Part part = {3, {{0, 0}, {1, 0}, {0, 1}}};
    double twice = 0;
    for (uint32_t k = 0; k < 3; k++)
        if (own[corners[k]] == INFINITY)
            return 0;
    for (uint32_t i = 0; i < AREA_SEEDS; i++) {
        const double *other = distance + i * (size_t)mesh->vertex_count;
        double value[3];
        for (uint32_t k = 0; k < 3; k++)
            value[k] = fmin(other[corners[k]], 1e9) - own[corners[k]];
        if (value[0] < 0 || value[1] < 0 || value[2] < 0)
            clip(&part, value);
    }
    for (uint32_t i = 0; i < part.count; i++) {
        const double *p = part.at[i], *q = part.at[(i + 1) % part.count];
        twice += p[0] * q[1] - p[1] * q[0];
    }
    return twice;
}

static double whole_area(const MesoTriangulation *mesh)
{
    double area = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        area += meso_fixture_area(mesh, t);
    return area;
}

/* Cuts along the borders, and numbers the cells in `region` [room]. Returns how far from its seed any vertex is. */
static double cut_apart(MesoTriangulation *mesh, const MesoMeshPoint *seeds, uint32_t *region, uint32_t room)
{
    MesoCutLines lines = {0};
    MesoGeodesicSolver *solver = solver_of(mesh);
    MesoVoronoiQuery query = {.seed_count = AREA_SEEDS, .seeds = seeds};
    float *distance = malloc(mesh->vertex_count * sizeof *distance), farthest = 0;
    CHECK(distance);
    CHECK(meso_voronoi_trace(&lines, NULL, distance, &arena, mesh, solver, &query, NULL) == MESO_OK);
    meso_geodesic_release(solver);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        farthest = fmaxf(farthest, distance[v]);
    CHECK(meso_fixture_cut(mesh, &lines, region, room) == AREA_SEEDS);
    free(distance);
    return farthest;
}

/* 99.9 % of the area is in the cell of the nearest seed; a cell is that of the seed inside it. */
static void check_area(MesoTriangulation mesh, uint64_t stream)
{
    MesoMeshPoint seeds[AREA_SEEDS];
    MesoVec3 places[AREA_SEEDS];
    double right = 0, all = whole_area(&mesh);
    uint32_t room = 3 * mesh.triangle_count, *region = malloc(room * sizeof *region), owner[AREA_SEEDS];
    CHECK(region);
    draw_seeds(&mesh, stream, 0.4f * (float)sqrt(all / AREA_SEEDS), seeds, places);
    double farthest = cut_apart(&mesh, seeds, region, room);
    double *distance = exact_distances(&mesh, places, 1.2 * farthest);
    for (uint32_t i = 0; i < AREA_SEEDS; i++) {
        owner[i] = region[find_point(&mesh, places[i]).triangle];
        for (uint32_t t = 0; t < mesh.triangle_count; t++)
            if (owner[i] == region[t])
                right += meso_fixture_area(&mesh, t) * share_of(&mesh, t, distance, i);
        for (uint32_t k = 0; k < i; k++)
            CHECK(owner[k] != owner[i]);
    }
    CHECK(right > 0.999 * all && right < 1.00001 * all);
    free(distance);
    free(region);
    meso_triangulation_release(&mesh);
}

static MesoVec3 on_plane(float column, float row, const void *context)
{
    (void)context;
    return (MesoVec3){column, row, 0};
}

/* A third of the ring is its hole. */
static MesoVec3 on_ring(float column, float row, const void *context)
{
    const MesoFixtureSheet *sheet = context;
    float turn = 6.2831853f * column / (float)sheet->columns, radius = 0.5f + row / (float)sheet->rows;
    return (MesoVec3){radius * cosf(turn), radius * sinf(turn), 0};
}

static MesoTriangulation make_ring(uint32_t size)
{
    MesoFixtureSheet sheet = {.columns = 6 * size, .rows = size, .wraps = true, .jitter_x = 0.25f, .jitter_y = 0.25f,
                              .seed = 3, .place = on_ring};
    sheet.context = &sheet;
    return meso_fixture_place_sheet(&sheet);
}

static MesoTriangulation make_bumpy(uint32_t size)
{
    MesoTriangulation mesh = meso_fixture_sphere(size, 0.3f, 3);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        MesoVec3 p = mesh.positions[v];
        mesh.positions[v] = meso_vec3_scale(p, 1 + 0.2f * sinf(4 * p.x) * cosf(5 * p.y) * sinf(3 * p.z));
    }
    return mesh;
}

static MesoTriangulation make_plane(uint32_t size)
{
    MesoFixtureSheet sheet = {.columns = 3 * size, .rows = 2 * size, .jitter_x = 0.25f, .jitter_y = 0.25f, .seed = 2,
                              .place = on_plane};
    return meso_fixture_place_sheet(&sheet);
}

/*
 * Where fronts are exact, or nearly so, a few thousand triangles will do. On the bumps and the torus they are off by a
 * thousandth of the distance then, and the borders with them.
 */
static void test_exact_areas(void)
{
    check_area(make_plane(20), 0);
    check_area(make_ring(20), 1);
    check_area(meso_fixture_sphere(20, 0.3f, 3), 2);
    check_area(make_bumpy(30), 3);
    check_area(meso_fixture_torus(240, 120, 0.4f), 4);
}

int main(void)
{
    meso_arena_init(&arena);
    test_two();
    test_three();
    test_brute_force();
    test_domain();
    test_whole_cells();
    test_area();
    test_exact_areas();
    meso_arena_release(&arena);
    return 0;
}
