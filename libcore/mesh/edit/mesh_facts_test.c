/* Facts of meshes of which they are known. */
#include "libcore/mesh/edit/mesh_facts.h"

#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;

static MesoMeshFacts facts_of(const MesoPolygonMesh *mesh)
{
    MesoMeshFacts facts;
    CHECK(meso_mesh_find_facts(&facts, mesh, 1, &error) == MESO_OK);
    return facts;
}

static void test_torus(void)
{
    MesoPolygonMesh torus = make_torus(&arena, 12, 8, NULL);
    MesoMeshFacts facts = facts_of(&torus);
    CHECK(facts.edge_count == 192 && facts.quads == 96 && facts.triangles == 0 && facts.components == 1);
    CHECK(facts.closed && facts.orientable && facts.has_genus && facts.genus == 1 && facts.euler == 0);
    CHECK(facts.valences[4] == 96 && facts.border_loops == 0 && fabs(facts.volume - volume(&torus)) < 1e-6);
    CHECK(facts.low.x == -4 && facts.high.x == 4 && facts.high.z == 1 && facts.pinched_vertices == 0);
    CHECK(facts.coinciding_vertices == 0 && facts.near_vertices == 0 && facts.flat_faces == 0 &&
          facts.double_faces == 0);
    turn_face(&torus, 5);
    facts = facts_of(&torus);
    CHECK(facts.disagreeing_edges == 4 && facts.orientable && facts.genus == 1 && isnan(facts.volume));

    torus = make_torus(&arena, 12, 8, NULL);        /* with a hole of one quad, and one of two */
    memmove(torus.corners + 4 * 60, torus.corners + 4 * 62, 4 * 34 * sizeof *torus.corners);
    memmove(torus.corners + 4 * 30, torus.corners + 4 * 31, 4 * 63 * sizeof *torus.corners);
    torus = take_faces(torus, 93);
    facts = facts_of(&torus);
    CHECK(facts.border_loops == 2 && facts.border_edges == 10 && facts.genus == 1 && !facts.closed &&
          facts.euler == -2);
}

/* Two quads and a triangle, apart in numbers but not in place, one twice, so that it has no border; one flat; one
 * vertex unused, one near. */
static void test_faults(void)
{
    MesoVec3 positions[11] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0},
                              {3, 0, 0}, {1e-4f, 0, 0}, {0, 2, 0}};
    uint32_t corners[17] = {0, 1, 2, 3, 4, 5, 6, 7, 3, 2, 1, 0, 4, 5, 8, 6, 7}, face_begin[5] = {0, 4, 8, 12, 15};
    MesoPolygonMesh mesh = {.vertex_count = 11, .face_count = 4, .corner_count = 15, .positions = positions,
                            .face_begin = face_begin, .corners = corners};
    MesoMeshFacts facts = facts_of(&mesh);
    CHECK(facts.coinciding_vertices == 2 && facts.near_vertices == 1 && facts.coinciding_borders == 0 &&
          facts.near_borders == 0 && facts.double_faces == 1 && facts.flat_faces == 1);
    CHECK(facts.valences[0] == 2 && facts.components == 2 && facts.triangles == 1 && facts.quads == 3);
}

/* Three quads at one edge, and two more at one of its ends. */
static void test_no_manifold(void)
{
    MesoVec3 positions[11] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {-1, 1, 0}, {-1, 1, 1}, {-1, -1, 0},
                              {-1, -1, 1}, {0, 0, 2}, {1, 0, 3}, {0, 1, 3}};
    uint32_t corners[15] = {0, 1, 3, 2, 0, 1, 5, 4, 0, 1, 7, 6, 1, 9, 10}, face_begin[5] = {0, 4, 8, 12, 15};
    MesoPolygonMesh mesh = {.vertex_count = 11, .face_count = 4, .corner_count = 15, .positions = positions,
                            .face_begin = face_begin, .corners = corners};
    MesoMeshFacts facts = facts_of(&mesh);
    CHECK(facts.crowded_edges == 1 && facts.pinched_vertices == 2 && !facts.has_genus && facts.valences[0] == 1);
}

static void test_empty(void)
{
    MesoPolygonMesh mesh = {.side_count = 3};
    MesoMeshFacts facts = facts_of(&mesh);
    CHECK(facts.components == 0 && facts.mean_edge == 0 && !facts.closed);
}

int main(void)
{
    meso_arena_init(&arena);
    test_torus();
    test_faults();
    test_no_manifold();
    test_empty();
    meso_arena_release(&arena);
    return 0;
}
