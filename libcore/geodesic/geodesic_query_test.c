/* Domains, limits, targets, what stands already, and meshes that change: for the engines that do not say otherwise. */
#include <string.h>

#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/geodesic/geodesic_solver.h"
#include "libcore/mesh/cut/mesh_cut_fixture.h"

static MesoGeodesicSolver *new_solver(const MesoTriangulation *mesh, MesoGeodesicEngine engine, bool plain)
{
    MesoGeodesicSolver *solver;
    CHECK(meso_geodesic_init(&solver, mesh, engine, NULL) == MESO_OK);
    solver->plain = plain;
    return solver;
}

static float *new_field(const MesoTriangulation *mesh, float value)
{
    float *distance = malloc((mesh->vertex_count + 1) * sizeof *distance);
    CHECK(distance);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        distance[v] = value;
    return distance;
}

static void solve(MesoGeodesicSolver *solver, const MesoGeodesicQuery *query, float *distance)
{
    CHECK(meso_geodesic_solve(solver, query, distance, NULL, NULL, NULL) == MESO_OK);
}

/* ---- domains ---- */

/* Gives triangles their labels, and walls between those that differ. */
static void put_labels(MesoTriangulation *mesh, uint32_t (*label)(float x, float y))
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        MesoVec3 sum = {0, 0, 0};
        for (uint32_t k = 0; k < 3; k++)
            sum = meso_vec3_add(sum, mesh->positions[mesh->corners[3 * t + k]]);
        mesh->labels[t] = label(sum.x / 3, sum.y / 3);
    }
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->twins[h] != MESO_NO_INDEX && mesh->labels[h / 3] != mesh->labels[mesh->twins[h] / 3])
            mesh->walls[h / 3] |= (uint8_t)(1u << h % 3);
    CHECK(meso_triangulation_check(mesh, NULL) == MESO_OK);
}

/* Region 1 is a U open above, 20 wide, with a gap of 4 that region 2 fills. */
static uint32_t label_of_u(float x, float y)
{
    return x > 8 && x < 12 && y > 5 ? 2 : 1;
}

/* From (2, 20): straight where that is free, and around (8, 5) and (12, 5). */
static double distance_in_u(float x, float y)
{
    double to_first = hypot(6, 15), along = 4;
    if (x < 8 || (x == 8 && y >= 5))
        return hypot((double)x - 2, 20 - (double)y);
    double edge = 5 - 15.0 / 6 * ((double)x - 8);       /* what is seen beside the first corner */
    if (y <= edge)
        return hypot((double)x - 2, 20 - (double)y);
    return y > 5 ? to_first + along + hypot((double)x - 12, (double)y - 5) : to_first + hypot((double)x - 8, 5 - (double)y);
}

static void test_domain(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(20, 20, 1);
    put_labels(&mesh, label_of_u);
    const uint8_t member[3] = {0, 1, 0};
    uint32_t triangles[800], count = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        if (mesh.labels[t] == 1)
            triangles[count++] = t;
    MesoGeodesicSeed seed = {20 * 21 + 2, 0, false};
    for (int round = 0; round < 7; round++) {
        MesoDomain domain = {member, count, round % 2 ? triangles : NULL};
        MesoGeodesicEngine engine = round < 4 ? MESO_GEODESIC_FRONTS
                                    : round < 6 ? MESO_GEODESIC_GRAPH : MESO_GEODESIC_EXACT;
        MesoGeodesicSolver *solver = new_solver(&mesh, engine, round < 2);
        float *distance = new_field(&mesh, -7);
        solve(solver, &(MesoGeodesicQuery){&domain, &seed, 1, 0, MESO_NO_INDEX, false}, distance);
        for (uint32_t v = 0; v < mesh.vertex_count; v++) {
            float x = mesh.positions[v].x, y = mesh.positions[v].y;
            if (x > 8 && x < 12 && y > 5) {
                CHECK(distance[v] == -7);
                continue;
            }
            double exact = distance_in_u(x, y);
            CHECK(distance[v] >= exact * (1 - 1e-5));
            /* behind a corner that it bends around, a front counts as flatter than it is */
            CHECK(distance[v] <= (round < 4 ? exact + 0.6 : exact * (round < 6 ? 1.1 : 1 + 1e-6)));
        }
        free(distance);
        meso_geodesic_release(solver);
    }
    meso_triangulation_release(&mesh);
}

static uint32_t label_one(float x, float y)
{
    (void)x;
    (void)y;
    return 1;
}

/* Walls inside a region, and a domain of all regions, change nothing but the way that is taken through the memory. */
static void test_walls_inside(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(20, 20, 1), slit = meso_fixture_copy_mesh(&mesh);
    put_labels(&slit, label_of_u);
    const uint8_t member[3] = {0, 1, 1}, one[2] = {0, 1};
    MesoDomain all = {member, 0, NULL}, region = {one, 0, NULL};
    MesoGeodesicSeed seeds[2] = {{3, 0, true}, {4, 0, true}};
    for (MesoGeodesicEngine engine = MESO_GEODESIC_FRONTS; engine <= MESO_GEODESIC_GRAPH; engine++) {
        MesoGeodesicSolver *solver = new_solver(&mesh, engine, false), *other = new_solver(&slit, engine, false);
        float *distance = new_field(&mesh, 0), *through = new_field(&mesh, 0);
        solve(solver, &(MesoGeodesicQuery){NULL, seeds, 2, 0, MESO_NO_INDEX, false}, distance);
        solve(other, &(MesoGeodesicQuery){&all, seeds, 2, 0, MESO_NO_INDEX, false}, through);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            CHECK(fabsf(distance[v] - through[v]) <= 1e-5f * distance[v]);
        put_labels(&slit, label_one);
        solve(other, &(MesoGeodesicQuery){&region, seeds, 2, 0, MESO_NO_INDEX, false}, through);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            CHECK(fabsf(distance[v] - through[v]) <= 1e-5f * distance[v]);
        put_labels(&slit, label_of_u);
        free(distance);
        free(through);
        meso_geodesic_release(solver);
        meso_geodesic_release(other);
    }
    meso_triangulation_release(&mesh);
    meso_triangulation_release(&slit);
}

/* ---- ends ---- */

static void test_limit_and_target(void)
{
    MesoTriangulation mesh = meso_fixture_sphere(40, 0.3f, 1);
    MesoGeodesicSeed seed = {100, 0.125f, false};
    for (MesoGeodesicEngine engine = MESO_GEODESIC_FRONTS; engine <= MESO_GEODESIC_GRAPH; engine++) {
        MesoGeodesicSolver *solver = new_solver(&mesh, engine, false);
        float *whole = new_field(&mesh, 0), *part = new_field(&mesh, 0);
        const uint32_t *touched;
        uint32_t count, near = 0, target = 5000;
        MesoGeodesicQuery query = {NULL, &seed, 1, 0, MESO_NO_INDEX, false};
        solve(solver, &query, whole);
        query.limit = 0.6f;
        CHECK(meso_geodesic_solve(solver, &query, part, &touched, &count, NULL) == MESO_OK);
        for (uint32_t v = 0; v < mesh.vertex_count; v++) {
            CHECK(whole[v] <= 0.6f ? part[v] == whole[v] : part[v] == INFINITY);
            near += whole[v] <= 0.6f;
        }
        CHECK(count == near);
        query.limit = 0;
        query.target = target;
        CHECK(meso_geodesic_solve(solver, &query, part, &touched, &count, NULL) == MESO_OK);
        CHECK(count < mesh.vertex_count * 3 / 4);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            CHECK(whole[v] <= whole[target] ? part[v] == whole[v] : part[v] >= whole[v]);
        MesoOneRing ring = meso_one_ring(&solver->rings, target);
        for (uint32_t k = 0; k < ring.count; k++)
            CHECK(part[ring.spokes[k]] == whole[ring.spokes[k]]);
        /* nothing is left behind by a solve that ended early */
        query.target = MESO_NO_INDEX;
        solve(solver, &query, part);
        CHECK(memcmp(part, whole, mesh.vertex_count * sizeof *part) == 0);
        free(whole);
        free(part);
        meso_geodesic_release(solver);
    }
    meso_triangulation_release(&mesh);
}

/* Fields of one seed after the other, kept, are the field of all; what is told as lowered is that, and nothing else. */
static void test_keep(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(40, 40, 1);
    const uint32_t vertices[4] = {0, 40, 20 * 41 + 13, 35 * 41 + 30};
    for (MesoGeodesicEngine engine = MESO_GEODESIC_FRONTS; engine <= MESO_GEODESIC_EXACT; engine++) {
        MesoGeodesicSolver *solver = new_solver(&mesh, engine, false);
        float *kept = new_field(&mesh, INFINITY), *before = new_field(&mesh, 0);
        MesoGeodesicSeed seeds[4];
        for (uint32_t s = 0; s < 4; s++) {
            const uint32_t *touched;
            uint32_t count, lowered = 0;
            seeds[s] = (MesoGeodesicSeed){vertices[s], 0, false};
            memcpy(before, kept, mesh.vertex_count * sizeof *kept);
            MesoGeodesicQuery query = {NULL, &seeds[s], 1, 0, MESO_NO_INDEX, true};
            CHECK(meso_geodesic_solve(solver, &query, kept, &touched, &count, NULL) == MESO_OK);
            for (uint32_t i = 0; i < count; i++) {
                CHECK(kept[touched[i]] < before[touched[i]]);
                before[touched[i]] = kept[touched[i]];
            }
            for (uint32_t v = 0; v < mesh.vertex_count; v++)
                CHECK(kept[v] == before[v]);
            /* the same again lowers nothing */
            CHECK(meso_geodesic_solve(solver, &query, kept, &touched, &lowered, NULL) == MESO_OK);
            CHECK(lowered == 0 && count > 0);
        }
        for (uint32_t v = 0; v < mesh.vertex_count; v++) {
            MesoVec3 p = mesh.positions[v];
            float exact = INFINITY;
            for (uint32_t s = 0; s < 4; s++)
                exact = fminf(exact, meso_vec3_length(meso_vec3_sub(p, mesh.positions[vertices[s]])));
            CHECK(kept[v] >= exact * (1 - 1e-5f));
            /* fronts that meet do not help each other */
            CHECK(kept[v] <= (engine == MESO_GEODESIC_GRAPH ? exact * 1.1f : exact + 0.1f));
        }
        free(kept);
        free(before);
        meso_geodesic_release(solver);
    }
    meso_triangulation_release(&mesh);
}

/* ---- change ---- */

static void compare_rings(const MesoGeodesicSolver *solver, const MesoGeodesicSolver *fresh)
{
    CHECK(solver->vertex_count == fresh->vertex_count);
    for (uint32_t v = 0; v < solver->vertex_count; v++) {
        MesoOneRing a = meso_one_ring(&solver->rings, v), b = meso_one_ring(&fresh->rings, v);
        uint32_t turn = 0;
        CHECK(a.count == b.count && a.closed == b.closed);
        CHECK((fresh->states[v] & ~solver->states[v]) == 0);    /* a cut may move a wall away from a vertex */
        while (turn < a.count && a.spokes[turn] != b.spokes[0])
            turn++;
        CHECK(a.count == 0 || turn < a.count);
        CHECK(a.closed || turn == 0);
        for (uint32_t k = 0; k < a.count; k++)
            CHECK(a.spokes[(turn + k) % a.count] == b.spokes[k]);
    }
}

/* Cut after cut, the solver that is told is like one that is made anew. */
static void test_update(void)
{
    MesoTriangulation meshes[3] = {meso_fixture_sheet(25, 25, 1), meso_fixture_torus(20, 12, 0.3f),
                                   meso_fixture_moebius(30)};
    for (uint32_t m = 0; m < 3; m++) {
        MesoTriangulation *mesh = &meshes[m];
        MesoChoices choices = {0};
        MesoGeodesicSolver *solver = new_solver(mesh, MESO_GEODESIC_FRONTS, false);
        MesoGeodesicSolver *graph = new_solver(mesh, MESO_GEODESIC_GRAPH, false);
        meso_random_init(&choices.random, m, 0);
        for (uint32_t round = 0; round < 12; round++) {
            MesoArena arena;
            MesoCutLines lines;
            MesoCutReport report;
            meso_arena_init(&arena);
            meso_choose_lines(&lines, &arena, &choices, mesh, 40);
            CHECK(meso_mesh_cut(mesh, &lines, &report, &arena, NULL) == MESO_OK);
            CHECK(meso_geodesic_update(solver, &report, NULL) == MESO_OK);
            CHECK(meso_geodesic_update(graph, &report, NULL) == MESO_OK);
            MesoGeodesicSolver *fresh = new_solver(mesh, MESO_GEODESIC_FRONTS, false);
            compare_rings(solver, fresh);
            float *a = new_field(mesh, 0), *b = new_field(mesh, 0), *c = new_field(mesh, 0);
            MesoGeodesicSeed seed = {mesh->vertex_count / 2, 0, false};
            MesoGeodesicQuery query = {NULL, &seed, 1, 0, MESO_NO_INDEX, false};
            solve(solver, &query, a);
            solve(fresh, &query, b);
            solve(graph, &query, c);
            for (uint32_t v = 0; v < mesh->vertex_count; v++)
                CHECK(fabsf(a[v] - b[v]) <= 1e-4f * b[v] && c[v] < INFINITY);
            free(a);
            free(b);
            free(c);
            meso_geodesic_release(fresh);
            meso_arena_release(&arena);
        }
        meso_geodesic_release(solver);
        meso_geodesic_release(graph);
        meso_triangulation_release(mesh);
    }
}

/* A sheet that is drawn out to twice its length. */
static void test_positions(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(20, 20, 1);
    MesoVec3 *moved = malloc(mesh.vertex_count * sizeof *moved);
    CHECK(moved);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        moved[v] = (MesoVec3){2 * mesh.positions[v].x, mesh.positions[v].y, 0};
    MesoGeodesicSeed seed = {7, 0, false};
    MesoGeodesicQuery query = {NULL, &seed, 1, 0, MESO_NO_INDEX, false};
    for (MesoGeodesicEngine engine = MESO_GEODESIC_FRONTS; engine <= MESO_GEODESIC_EXACT; engine++) {
        MesoGeodesicSolver *solver = new_solver(&mesh, engine, false);
        float *distance = new_field(&mesh, 0);
        solve(solver, &query, distance);
        CHECK(meso_geodesic_set_positions(solver, moved, NULL) == MESO_OK);
        solve(solver, &query, distance);
        for (uint32_t v = 0; v < mesh.vertex_count; v++) {
            float exact = meso_vec3_length(meso_vec3_sub(moved[v], moved[7]));
            CHECK(distance[v] >= exact * (1 - 1e-5f));
            CHECK(distance[v] <= exact * (engine == MESO_GEODESIC_GRAPH ? 1.3f : 1 + 1e-5f));
        }
        free(distance);
        meso_geodesic_release(solver);
    }
    free(moved);
    meso_triangulation_release(&mesh);
}

/* ---- two at once ---- */

/* What a pair finds is what its queries find one by one, to the bit. */
static void check_pair(MesoGeodesicSolver *solver, const MesoGeodesicQuery *queries)
{
    const MesoTriangulation *mesh = solver->mesh;
    float *one[2], *both[2];
    for (int i = 0; i < 2; i++) {
        one[i] = new_field(mesh, -1);
        both[i] = new_field(mesh, -1);
        solve(solver, &queries[i], one[i]);
    }
    for (uint32_t threads = 1; threads <= 2; threads++) {
        CHECK(meso_geodesic_solve_pair(solver, queries, both, threads, NULL) == MESO_OK);
        for (int i = 0; i < 2; i++)
            CHECK(memcmp(one[i], both[i], mesh->vertex_count * sizeof(float)) == 0);
    }
    CHECK(solver->twins[0] && solver->twins[0]->is_like);
    for (int i = 0; i < 2; i++) {
        free(one[i]);
        free(both[i]);
    }
}

/* What two runs in turn find is what each finds alone, to the bit. */
static void check_turns(MesoGeodesicSolver *solver, const MesoGeodesicQuery *queries)
{
    const MesoTriangulation *mesh = solver->mesh;
    MesoGeodesicSolver *team[2];
    MesoGeodesicRun runs[2];
    CHECK(meso_geodesic_team(solver, 2, team, NULL) == MESO_OK);
    for (int i = 0; i < 2; i++)
        runs[i] = (MesoGeodesicRun){team[i], &queries[i], INFINITY, NULL};
    CHECK(meso_geodesic_run_two(runs, NULL) == MESO_OK);
    for (int i = 0; i < 2; i++) {
        float *one = new_field(mesh, INFINITY), *turn = new_field(mesh, INFINITY);
        for (uint32_t k = 0; k < team[i]->touched_count; k++)
            turn[team[i]->touched[k]] = meso_geodesic_take(team[i], team[i]->touched[k], 1 / solver->scale);
        solve(solver, &queries[i], one);
        CHECK(memcmp(one, turn, mesh->vertex_count * sizeof(float)) == 0);
        free(one);
        free(turn);
    }
}

static void cut_some(MesoTriangulation *mesh, MesoGeodesicSolver *solver)
{
    MesoArena arena;
    MesoCutLines lines;
    MesoCutReport report;
    MesoChoices choices = {0};
    meso_random_init(&choices.random, 3, 0);
    meso_arena_init(&arena);
    meso_choose_lines(&lines, &arena, &choices, mesh, 40);
    CHECK(meso_mesh_cut(mesh, &lines, &report, &arena, NULL) == MESO_OK);
    CHECK(meso_geodesic_update(solver, &report, NULL) == MESO_OK);
    meso_arena_release(&arena);
}

static void test_pair(void)
{
    const MesoGeodesicSeed point = {77, 0, false}, line[3] = {{900, 0, true}, {901, 0, true}, {902, 0.5f, true}};
    const MesoGeodesicQuery queries[2] = {{NULL, &point, 1, 0, MESO_NO_INDEX, false},
                                          {NULL, line, 3, 0, MESO_NO_INDEX, false}};
    for (MesoGeodesicEngine engine = MESO_GEODESIC_FRONTS; engine <= MESO_GEODESIC_EXACT; engine++) {
        MesoTriangulation mesh = meso_fixture_torus(64, 36, 0.4f);
        MesoGeodesicSolver *solver = new_solver(&mesh, engine, false);
        check_pair(solver, queries);
        check_turns(solver, queries);
        cut_some(&mesh, solver);
        check_pair(solver, queries);
        check_turns(solver, queries);
        const MesoDomain whole = {(const uint8_t[1]){1}, 0, NULL};
        const MesoGeodesicQuery walled[2] = {{&whole, &point, 1, 0, MESO_NO_INDEX, false},
                                             {&whole, line, 3, 0, MESO_NO_INDEX, false}};
        solver->plain = true;
        check_turns(solver, walled);
        solver->plain = false;
        check_turns(solver, walled);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            mesh.positions[v].x *= 3;
        CHECK(meso_geodesic_set_positions(solver, mesh.positions, NULL) == MESO_OK);
        check_pair(solver, queries);
        meso_geodesic_release(solver);
        meso_triangulation_release(&mesh);
    }
}

int main(void)
{
    test_domain();
    test_walls_inside();
    test_limit_and_target();
    test_keep();
    test_update();
    test_positions();
    test_pair();
    return 0;
}
