/* Edges beside those at rest: what is told of a node that comes or goes is what becomes of its coming or going. */
#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/mesh/point/vertex_normals.h"
#include "libcore/replicate/statistics/points_fixture.h"
#include "libcore/replicate/web/detail_web.h"
#include "libcore/replicate/web/edge_balance.h"
#include "libcore/replicate/web/web_edit.h"

typedef struct Stage {
    MesoArena arena;
    MesoTriangulation mesh;
    MesoWeb web;
    MesoEdgeRest rest;
    uint32_t count;
} Stage;

static Stage start(MesoTriangulation mesh, uint32_t count)
{
    Stage s = {.mesh = mesh, .count = count};
    meso_arena_init(&s.arena);
    MesoVec3 *normals = MESO_NEW(&s.arena, MesoVec3, mesh.vertex_count, NULL);
    MesoMeshPoint *points = meso_strew_freely(&mesh, count, 9);
    meso_vertex_normals(normals, &mesh);
    CHECK(meso_web_build(&s.web, &s.arena, &mesh, normals, points, count, NULL) == MESO_OK);
    s.rest = meso_edge_rest(&s.web);
    free(points);
    return s;
}

static void end(Stage *s)
{
    meso_triangulation_release(&s->mesh);
    meso_arena_release(&s->arena);
}

static bool is_change(MesoEdgeBalance before, MesoEdgeBalance change, MesoEdgeBalance after)
{
    return fabs(before.excess + change.excess - after.excess) < 1e-6
           && fabs(before.spread + change.spread - after.spread) < 1e-6;
}

/* 0 at rest; and the sums of lengths that are told of it. */
static void test_rest(void)
{
    Stage s = start(meso_fixture_sheet(10, 10, 0.1f), 300);
    MesoEdgeBalance balance = meso_edge_balance(&s.web, &s.rest, NULL);
    CHECK(s.rest.mean > 0 && s.rest.variance > 0);
    CHECK(fabs(balance.excess) < 1e-9 && fabs(balance.spread) < 1e-9);
    for (uint32_t n = 0; n < s.web.node_count; n++)
        s.web.positions[n].x *= 2;
    MesoWebEdges edges = meso_web_edges(&s.web);
    balance = meso_edge_balance(&s.web, &s.rest, NULL);
    CHECK(fabs(balance.excess - edges.count * (edges.mean / s.rest.mean - 1)) < 1e-6 * edges.count);
    end(&s);
}

/* Edges of what is left out do not count: of all but two that are joined, one edge does. */
static void test_left_out(void)
{
    Stage s = start(meso_fixture_ball(8), 60);
    uint8_t left_out[60];
    CHECK(s.web.fixed_count == 0 && s.web.node_count == 60);
    memset(left_out, 1, sizeof left_out);
    uint32_t a = s.web.corners[0], b = s.web.corners[1];
    left_out[a] = left_out[b] = 0;
    double over = sqrt(meso_web_length2(&s.web, a, b)) / s.rest.mean - 1;
    CHECK(fabs(meso_edge_balance(&s.web, &s.rest, left_out).excess - over) < 1e-12);
    end(&s);
}

/* In a sheet, also at its border, and on a ball. */
static void test_with(void)
{
    for (int ball = 0; ball < 2; ball++) {
        Stage s = start(ball ? meso_fixture_ball(12) : meso_fixture_sheet(10, 10, 0.1f), 400);
        MesoRandom random;
        uint32_t as_told = 0;
        meso_random_init(&random, 5, 1);
        for (int i = 0; i < 200; i++) {
            uint32_t t = meso_random_below(&random, s.web.triangle_count);
            const uint32_t *c = s.web.corners + 3 * (size_t)t;
            MesoVec3 p = {0, 0, 0}, normal = s.web.normals[c[0]];
            for (uint32_t k = 0; k < 3; k++)
                p = meso_vec3_mad(p, k ? 0.3f : 0.4f, s.web.positions[c[k]]);
            double nearest2, least = INFINITY;
            MesoEdgeBalance before = meso_edge_balance(&s.web, &s.rest, NULL);
            MesoEdgeBalance change = meso_edge_balance_with(&s.web, &s.rest, t, p, normal, &nearest2);
            for (uint32_t n = s.web.fixed_count; n < s.web.node_count; n++) {
                MesoVec3 d = meso_vec3_sub(s.web.positions[n], p);
                least = fmin(least, (double)meso_vec3_dot(d, d));
            }
            CHECK(ball || fabs(nearest2 - least) < 1e-6 * least);
            CHECK(meso_web_insert(&s.web, t, (MesoMeshPoint){0, {1, 0, 0}}, p, normal, NULL) == MESO_OK);
            as_told += is_change(before, change, meso_edge_balance(&s.web, &s.rest, NULL));
        }
        CHECK(as_told >= (ball ? 190u : 200u));     /* on a ball what is Delaunay depends on the way there */
        end(&s);
    }
}

static void test_without(void)
{
    Stage s = start(meso_fixture_sheet(10, 10, 0.1f), 900);
    uint32_t as_told = 0, gone = 0;
    for (uint32_t n = s.web.fixed_count; n < s.web.node_count; n += 5) {
        uint32_t ring[64], count = meso_web_ring(&s.web, n, ring, 64);
        MesoEdgeBalance before = meso_edge_balance(&s.web, &s.rest, NULL);
        MesoEdgeBalance change = meso_edge_balance_without(&s.web, &s.rest, n);
        bool went = false;
        for (uint32_t i = 0; i < count && i < 64 && !went; i++)
            went = meso_web_remove(&s.web, n, ring[i]);
        gone += went;
        as_told += went && is_change(before, change, meso_edge_balance(&s.web, &s.rest, NULL));
    }
    CHECK(gone > 170 && as_told == gone);
    MesoEdgeBalance none = meso_edge_balance_without(&s.web, &s.rest, 0);     /* at the border */
    CHECK(none.excess == 0 && none.spread == 0);
    end(&s);
}

/* Of no edges, nothing is told. */
static void test_none(void)
{
    Stage s = start(meso_fixture_sheet(4, 4, 0.25f), 1);
    double nearest2;
    MesoEdgeBalance change = meso_edge_balance_with(&s.web, &s.rest, 0, (MesoVec3){0.1f, 0.1f, 0},
                                                    (MesoVec3){0, 0, 1}, &nearest2);
    CHECK(s.rest.mean == 0 && change.excess == 0 && change.spread == 0 && nearest2 == INFINITY);
    CHECK(meso_edge_balance(&s.web, &s.rest, NULL).spread == 0);
    end(&s);
}

int main(void)
{
    test_rest();
    test_left_out();
    test_with();
    test_without();
    test_none();
    return 0;
}
