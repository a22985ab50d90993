#include "libcore/geodesic/geodesic.h"
#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/geodesic/isoline.h"
#include "libcore/geodesic/regions_fixture.h"
#include "libcore/geodesic/streamline.h"
#include "libcore/mesh/cut/border_loops.h"
#include "libcore/mesh/cut/chain_samples.h"

enum { SIDE = 8, WIDTH = SIDE + 1 };

static MesoArena arena;

static MesoCutLines trace(const MesoTriangulation *mesh, MesoStreamQuery query, MesoStreamReport *report)
{
    MesoCutLines lines = {0};
    CHECK(meso_streamlines_trace(&lines, report, &arena, mesh, &query, NULL) == MESO_OK);
    uint32_t stopped = 0;
    for (uint32_t i = 0; i < MESO_STREAM_STOPS; i++)
        stopped += report->counts[i];
    CHECK(stopped == query.start_count);
    return lines;
}

static MesoVec3 end_of(const MesoTriangulation *mesh, const MesoCutLines *lines, uint32_t segment, uint32_t end)
{
    return meso_cut_node_position(mesh, &lines->nodes[lines->segments[segment].node[end]]);
}

/* A point of the half-edge `h`. */
static MesoMeshPoint on_edge(uint32_t h, float share)
{
    MesoMeshPoint point = {h / 3, {0, 0, 0}};
    point.weight[h % 3] = 1 - share;
    point.weight[meso_next_corner(h) % 3] = share;
    return point;
}

static MesoMeshPoint at_vertex(const MesoTriangulation *mesh, uint32_t vertex)
{
    return on_edge(mesh->vertex_corner[vertex], 0);
}

/* Straight across a sheet, from its left border to its right one: by 2 segments a square. */
static void test_straight(void)
{
    float field[WIDTH * WIDTH];
    MesoMeshPoint starts[2 * SIDE];
    MesoStreamReport report;
    MesoTriangulation mesh = meso_fixture_sheet(SIDE, SIDE, 1);
    for (uint32_t v = 0; v < WIDTH * WIDTH; v++)
        field[v] = (float)(v % WIDTH);
    for (uint32_t r = 0; r < SIDE; r++) {
        starts[r] = on_edge(6 * SIDE * r + 5, 0.75f);       /* downwards along the left border */
        starts[SIDE + r] = at_vertex(&mesh, WIDTH * (r + 1) + 3);
    }
    MesoStreamQuery query = {.field = field, .start_count = 2 * SIDE, .starts = starts};
    MesoCutLines lines = trace(&mesh, query, &report);
    /* the last is on the upper border */
    CHECK(report.counts[MESO_STREAM_BORDER] == 2 * SIDE - 1 && report.counts[MESO_STREAM_BLOCKED] == 1);
    CHECK(lines.segment_count == 2 * SIDE * SIDE + 5 * (SIDE - 1));
    for (uint32_t s = 0; s < lines.segment_count; s++) {
        MesoVec3 a = end_of(&mesh, &lines, s, 0), b = end_of(&mesh, &lines, s, 1);
        uint32_t line = lines.segments[s].line;
        CHECK(a.x < b.x && a.y == b.y && a.y == (line < SIDE ? (float)line + 0.25f : (float)(line - SIDE + 1)));
    }
    query.down = true;
    lines = trace(&mesh, query, &report);
    CHECK(report.counts[MESO_STREAM_BLOCKED] == SIDE + 1 && report.counts[MESO_STREAM_BORDER] == SIDE - 1);
    CHECK(lines.segment_count == 3 * (SIDE - 1));
    meso_triangulation_release(&mesh);
}

/*
 * A ridge along row 4 that rises to the right: lines come to it aslant, then follow its edges, and where they join end
 * at the first vertex that is known.
 */
static void test_ridge(void)
{
    float field[WIDTH * WIDTH];
    MesoMeshPoint starts[3];
    MesoStreamReport report;
    MesoTriangulation mesh = meso_fixture_sheet(SIDE, SIDE, 1);
    for (uint32_t v = 0; v < WIDTH * WIDTH; v++)
        field[v] = 0.25f * (float)(v % WIDTH) - fabsf((float)(v / WIDTH) - 4);
    starts[0] = on_edge(3 * 2 * SIDE * 1 + 0, 0.5f);
    starts[1] = on_edge(3 * 2 * (SIDE * 6 + 2) + 0, 0.5f);
    starts[2] = (MesoMeshPoint){2 * (SIDE * 2 + 5), {0.25f, 0.25f, 0.5f}};
    MesoStreamQuery query = {.field = field, .start_count = 3, .starts = starts};
    for (uint32_t round = 0; round < 2; round++) {
        query.join = round;
        MesoCutLines lines = trace(&mesh, query, &report);
        CHECK(report.counts[MESO_STREAM_BORDER] == (round ? 1 : 3));
        CHECK(report.counts[MESO_STREAM_JOINED] == (round ? 2 : 0));
        uint32_t along = 0;
        for (uint32_t s = 0; s < lines.segment_count; s++) {
            MesoVec3 a = end_of(&mesh, &lines, s, 0), b = end_of(&mesh, &lines, s, 1);
            bool on_ridge = a.y == 4 && b.y == 4;
            CHECK(on_ridge ? a.x < b.x : fabsf(fabsf(a.y - b.y) - 4 * (b.x - a.x)) < 1e-5f);
            along += on_ridge;
        }
        CHECK(round ? along > 7 && along < 10 : along > 12);
    }
    meso_triangulation_release(&mesh);
}

/* Lines end at a peak that is a vertex; flat ground stops them, or lets none start; a value missing is a border. */
static void test_stops(void)
{
    float field[WIDTH * WIDTH];
    MesoMeshPoint starts[3];
    MesoStreamReport report;
    MesoTriangulation mesh = meso_fixture_sheet(SIDE, SIDE, 1);
    MesoStreamQuery query = {.field = field, .start_count = 3, .starts = starts};
    starts[0] = at_vertex(&mesh, 0);
    starts[1] = (MesoMeshPoint){7, {0.2f, 0.3f, 0.5f}};
    starts[2] = at_vertex(&mesh, 4 * WIDTH + 4);
    for (uint32_t v = 0; v < WIDTH * WIDTH; v++)
        field[v] = -hypotf((float)(v % WIDTH) - 4, (float)(v / WIDTH) - 4);
    MesoCutLines lines = trace(&mesh, query, &report);
    CHECK(report.counts[MESO_STREAM_EXTREMUM] == 2 && report.stops[2] == MESO_STREAM_BLOCKED);
    MesoVec3 end = end_of(&mesh, &lines, lines.segment_count - 1, 1);
    CHECK(end.x == 4 && end.y == 4);
    query.step_limit = 2;
    trace(&mesh, query, &report);
    CHECK(report.counts[MESO_STREAM_LONG] == 2);
    query.step_limit = 0;
    for (uint32_t v = 0; v < WIDTH * WIDTH; v++)
        field[v] = fmaxf(field[v], -2.5f);
    trace(&mesh, query, &report);
    CHECK(report.counts[MESO_STREAM_BLOCKED] == 3);
    for (uint32_t v = 0; v < WIDTH * WIDTH; v++)
        field[v] = v % WIDTH > 6 ? INFINITY : (float)(v % WIDTH);
    lines = trace(&mesh, query, &report);
    CHECK(report.counts[MESO_STREAM_BORDER] == 2 && report.stops[0] == MESO_STREAM_BLOCKED);
    CHECK(end_of(&mesh, &lines, lines.segment_count - 1, 1).x == 6);
    meso_triangulation_release(&mesh);
}

/* On random heights the field rises from node to node, whatever vertices, ridges and plateaus are met. */
static void test_rising(void)
{
    float field[12 * 10];
    MesoMeshPoint starts[240];
    MesoStreamReport report;
    uint64_t random = 1;
    MesoTriangulation mesh = meso_fixture_torus(12, 10, 0.4f);
    for (uint32_t t = 0; t < 240; t++)
        starts[t] = (MesoMeshPoint){t, {0.3f, t % 3 ? 0.3f : 0, t % 3 ? 0.4f : 0.7f}};
    for (uint32_t round = 0; round < 200; round++) {
        for (uint32_t v = 0; v < 120; v++) {
            random = random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            field[v] = round % 2 ? (float)(random >> 62) : (float)(random >> 40);
        }
        MesoStreamQuery query = {.field = field, .down = round % 4 > 1, .join = round % 8 > 3, .start_count = 240,
                                 .starts = starts};
        MesoCutLines lines = trace(&mesh, query, &report);
        CHECK(report.counts[MESO_STREAM_BORDER] == 0 && report.counts[MESO_STREAM_LONG] == 0);
        CHECK(query.join || report.counts[MESO_STREAM_JOINED] == 0);
        for (uint32_t s = 0; s < lines.segment_count; s++) {
            double height[2];
            for (uint32_t k = 0; k < 2; k++) {
                const MesoCutNode *node = &lines.nodes[lines.segments[s].node[k]];
                const uint32_t *corners = mesh.corners;
                uint32_t begin = node->kind == MESO_IN_TRIANGLE ? 3 * node->element : node->element;
                height[k] = node->kind == MESO_AT_VERTEX ? field[node->element] : field[corners[begin]];
                if (node->kind != MESO_AT_VERTEX)
                    height[k] += node->share[0] * (field[corners[meso_next_corner(begin)]] - field[corners[begin]]);
                if (node->kind == MESO_IN_TRIANGLE)
                    height[k] += node->share[1] * (field[corners[begin + 2]] - field[corners[begin]]);
            }
            double rise = query.down ? height[0] - height[1] : height[1] - height[0];
            CHECK(rise > (round % 2 ? -1e-5 : -100));   /* shares are floats: of 4, and of 16 million */
            CHECK(s == 0 || lines.segments[s].line != lines.segments[s - 1].line ||
                  lines.segments[s].node[0] == lines.segments[s - 1].node[1]);
        }
    }
    meso_triangulation_release(&mesh);
}

/* Mean angle in degrees between segments and the true gradient, which leads from `pole`. */
static double mean_angle(const MesoTriangulation *mesh, const MesoCutLines *lines, MesoVec3 pole, bool sphere)
{
    double sum = 0, length = 0;
    for (uint32_t s = 0; s < lines->segment_count; s++) {
        MesoVec3 a = end_of(mesh, lines, s, 0), b = end_of(mesh, lines, s, 1), step = meso_vec3_sub(b, a);
        MesoVec3 middle = meso_vec3_lerp(a, b, 0.5f), away = meso_vec3_sub(middle, pole);
        if (sphere) {
            middle = meso_vec3_unit(middle, middle);
            away = meso_vec3_mad(away, -meso_vec3_dot(away, middle), middle);
        }
        double cross = meso_vec3_length(meso_vec3_cross(step, away));
        sum += meso_vec3_length(step) * atan2(cross, meso_vec3_dot(step, away)) * 180 / MESO_PI;
        length += meso_vec3_length(step);
    }
    return sum / length;
}

/* From points around a pole that is no vertex, away from it: at right angles to circles. */
static void test_right_angles(void)
{
    enum { COUNT = 200 };
    MesoMeshPoint starts[COUNT];
    MesoStreamReport report;
    for (uint32_t sphere = 0; sphere < 2; sphere++) {
        MesoTriangulation mesh = sphere ? meso_fixture_sphere(40, 0.3f, 1) : meso_fixture_sheet(100, 100, 0.02f);
        MesoVec3 pole = sphere ? (MesoVec3){0.48f, 0.6f, 0.64f} : (MesoVec3){0.9731f, 1.0617f, 0};
        float *field = MESO_NEW(&arena, float, mesh.vertex_count, NULL);
        uint32_t count = 0;
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            field[v] = sphere ? acosf(meso_vec3_dot(mesh.positions[v], pole))
                              : meso_vec3_length(meso_vec3_sub(mesh.positions[v], pole));
        for (uint32_t t = 0; t < mesh.triangle_count && count < COUNT; t++) {
            float distance = field[mesh.corners[3 * t]];
            if (distance > 0.2f && distance < 0.22f)
                starts[count++] = (MesoMeshPoint){t, {0.3f, 0.3f, 0.4f}};
        }
        MesoStreamQuery query = {.field = field, .start_count = count, .starts = starts};
        MesoCutLines lines = trace(&mesh, query, &report);
        CHECK(count > 20 && mean_angle(&mesh, &lines, pole, sphere) < 2);
        CHECK(report.counts[sphere ? MESO_STREAM_EXTREMUM : MESO_STREAM_BORDER] == count);
        meso_triangulation_release(&mesh);
    }
}

/* A blend from the left side of a sheet to its right side, in a domain: all starts along one arrive at the other. */
static void test_blend(void)
{
    enum { COUNT = 24 };
    static float field[33 * 33];
    static uint32_t triangles[2 * 32 * 32];
    const uint8_t member[2] = {0, 1};
    MesoBorderLoops loops;
    MesoMeshPoint starts[COUNT];
    MesoStreamReport report;
    MesoDomain domain = {member, 0, triangles};
    MesoTriangulation mesh = meso_fixture_sheet(32, 32, 1);
    for (uint32_t v = 0; v < 33 * 33; v++) {
        float x = (float)(v % 33), y = (float)(v / 33), left = x - 8 + cosf(y * (float)MESO_PI / 16), right = 24 - x;
        field[v] = left / (left + right);
    }
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        mesh.labels[t] = t / 2 % 32 >= 8 && t / 2 % 32 < 24;
        if (mesh.labels[t])
            triangles[domain.triangle_count++] = t;
    }
    CHECK(meso_border_loops_find(&loops, &arena, &mesh, &domain, false, NULL) == MESO_OK);
    uint32_t first = 0;     /* of the left side, which is walked downwards */
    while (mesh.positions[loops.vertices[first]].x != 8 || mesh.positions[loops.vertices[first]].y != 32)
        first++;
    MesoEdgeChain chain = {32, false, loops.half_edges + first, loops.vertices + first};
    meso_chain_sample(&mesh, &chain, COUNT, 0.5, false, starts);
    MesoStreamQuery query = {.domain = &domain, .field = field, .start_count = COUNT, .starts = starts};
    MesoCutLines lines = trace(&mesh, query, &report);
    CHECK(report.counts[MESO_STREAM_BORDER] == COUNT);
    for (uint32_t s = 0; s < lines.segment_count; s++)
        if (s + 1 == lines.segment_count || lines.segments[s + 1].line != lines.segments[s].line)
            CHECK(end_of(&mesh, &lines, s, 1).x == 24);
    meso_triangulation_release(&mesh);
}

static MesoGeodesicSeed *seeds_of(const MesoBorderLoops *loops, uint32_t loop)
{
    MesoGeodesicSeed *seeds = MESO_NEW(&arena, MesoGeodesicSeed, loops->loops[loop].count, NULL);
    for (uint32_t i = 0; i < loops->loops[loop].count; i++)
        seeds[i] = (MesoGeodesicSeed){loops->vertices[loops->loops[loop].first + i], 0, true};
    return seeds;
}

/*
 * A band around a sphere between two borders: lines of the blend of their distances lead from one to the other, and cut
 * it into as many stripes of the same area.
 */
static void test_band(void)
{
    enum { COUNT = 16, ROOM = 200000 };
    MesoBorderLoops loops;
    MesoMeshPoint starts[COUNT];
    MesoStreamReport report;
    double area[COUNT + 2] = {0};
    MesoTriangulation mesh = meso_fixture_sphere(48, 0.3f, 5);
    uint32_t *triangles = MESO_NEW(&arena, uint32_t, ROOM, NULL), *region = MESO_NEW(&arena, uint32_t, ROOM, NULL);
    float *height = MESO_NEW(&arena, float, mesh.vertex_count, NULL);
    MesoDomain domain = {(const uint8_t[2]){0, 1}, 0, triangles};
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        height[v] = mesh.positions[v].z;
    MesoIsolineQuery sides = {NULL, height, (const float[2]){-0.5f, 0.7f}, 2};
    MesoCutLines lines = {0};
    CHECK(meso_isolines_trace(&lines, &arena, &mesh, &sides, NULL) == MESO_OK);
    CHECK(meso_fixture_cut(&mesh, &lines, region, ROOM) == 3);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        const uint32_t *corners = mesh.corners + 3 * (size_t)t;
        float z = mesh.positions[corners[0]].z + mesh.positions[corners[1]].z + mesh.positions[corners[2]].z;
        mesh.labels[t] = z > -1.5f && z < 2.1f;
        if (mesh.labels[t])
            triangles[domain.triangle_count++] = t;
    }
    CHECK(meso_triangulation_check(&mesh, NULL) == MESO_OK);
    CHECK(meso_border_loops_find(&loops, &arena, &mesh, &domain, false, NULL) == MESO_OK && loops.loop_count == 2);
    MesoGeodesicSolver *solver;
    float *distance[2];
    CHECK(meso_geodesic_init(&solver, &mesh, MESO_GEODESIC_FRONTS, NULL) == MESO_OK);
    for (uint32_t i = 0; i < 2; i++) {
        distance[i] = MESO_NEW(&arena, float, mesh.vertex_count, NULL);
        MesoGeodesicQuery query = {.domain = &domain, .seeds = seeds_of(&loops, i), .target = MESO_NO_INDEX,
                                   .seed_count = loops.loops[i].count};
        CHECK(meso_geodesic_solve(solver, &query, distance[i], NULL, NULL, NULL) == MESO_OK);
    }
    meso_geodesic_release(solver);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        distance[0][v] = distance[0][v] / (distance[0][v] + distance[1][v]);
    MesoEdgeChain chain = {loops.loops[0].count, true, loops.half_edges, loops.vertices};
    meso_chain_sample(&mesh, &chain, COUNT, 0.25, false, starts);
    MesoStreamQuery query = {.domain = &domain, .field = distance[0], .join = true, .start_count = COUNT,
                             .starts = starts};
    lines = trace(&mesh, query, &report);
    CHECK(report.counts[MESO_STREAM_BORDER] == COUNT);
    CHECK(meso_fixture_cut(&mesh, &lines, region, ROOM) == COUNT + 2);     /* and the caps */
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        if (mesh.labels[t])
            area[region[t]] += meso_fixture_area(&mesh, t);
    for (uint32_t r = 0; r < COUNT + 2; r++)
        CHECK(area[r] == 0 || fabs(area[r] * COUNT / (2 * MESO_PI * 1.2) - 1) < 0.02);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    meso_arena_init(&arena);
    test_straight();
    test_ridge();
    test_stops();
    test_rising();
    test_right_angles();
    test_blend();
    test_band();
    meso_arena_release(&arena);
    return 0;
}
