/* Decimation: topology, shape and borders stay; vertices keep what they have. */
#include "libcore/mesh/refine/mesh_decimate.h"

#include "libcore/mesh/edit/mesh_clean.h"
#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;

static void test_torus(void)
{
    MesoPolygonMesh mesh, torus = make_torus(&arena, 60, 30, NULL);
    add_attributes(&torus, &arena);
    CHECK(meso_mesh_decimate(&mesh, &arena, &torus, 800, 1, &error) == MESO_OK && is_checked(&mesh));
    MesoHalfEdges edges = join(&arena, &mesh);
    CHECK(mesh.face_count <= 800 && mesh.face_count >= 798 && mesh.side_count == 3);
    CHECK(euler(&arena, &mesh) == 0 && edges.border_count == 0 && edges.reversed_count == 0);
    CHECK(fabs(volume(&mesh) / volume(&torus) - 1) < 0.03 && fabs(area(&mesh) / area(&torus) - 1) < 0.03);
    check_attributes(&mesh, torus.face_count);
}

/* Of a flat square with many faces, two triangles are enough, and its border is where it was. */
static void test_square(void)
{
    enum { N = 9 };
    MesoVec3 positions[N * N];
    uint32_t corners[4 * (N - 1) * (N - 1)], c = 0;
    for (uint32_t v = 0; v < N * N; v++)
        positions[v] = (MesoVec3){(float)(v % N), (float)(v / N), 0};
    for (uint32_t j = 0; j + 1 < N; j++)
        for (uint32_t i = 0; i + 1 < N; i++) {
            corners[c++] = j * N + i;
            corners[c++] = j * N + i + 1;
            corners[c++] = j * N + i + 1 + N;
            corners[c++] = j * N + i + N;
        }
    MesoPolygonMesh mesh, square = {.vertex_count = N * N, .face_count = c / 4, .corner_count = c, .side_count = 4,
                                    .positions = positions, .corners = corners};
    CHECK(meso_mesh_decimate(&mesh, &arena, &square, 2, 1, &error) == MESO_OK);
    CHECK(fabs(area(&mesh) - 64) < 1e-5 && mesh.face_count <= 4 && join(&arena, &mesh).border_count <= 6);
    CHECK(meso_mesh_decimate(&mesh, &arena, &square, 1000, 1, &error) == MESO_OK && mesh.face_count == 128);
}

/* As few triangles as can be are still a surface of the same kind: closed, or a sheet whose border the collapses
 * met. */
static void test_to_the_end(void)
{
    MesoRandom random;
    meso_random_init(&random, 7, 0);
    for (uint32_t round = 0; round < 40; round++) {
        MesoPolygonMesh mesh, torus = make_torus(&arena, 5 + round % 7, 5 + round % 5, &random);
        move_randomly(&torus, &random, 0.01 * round);
        MesoPolygonMesh part = round % 2 ? take_faces(torus, torus.face_count / 2) : torus;
        CHECK(meso_mesh_decimate(&mesh, &arena, &part, 1, 1, &error) == MESO_OK && is_checked(&mesh));
        MesoHalfEdges edges = join(&arena, &mesh), before = join(&arena, &part);
        uint32_t *fans = MESO_NEW(&arena, uint32_t, mesh.corner_count, &error), fan_count = 0;
        CHECK(meso_mesh_find_fans(fans, &mesh, &edges, &error) == MESO_OK);
        for (uint32_t c = 0; c < mesh.corner_count; c++)
            fan_count += fans[c] == c;
        CHECK(edges.reversed_count == 0 && edges.crowded_count == 0 && fan_count == mesh.vertex_count);
        CHECK((edges.border_count > 0) == (before.border_count > 0));
        CHECK(mesh.face_count < 2 * part.face_count && (round % 2 || euler(&arena, &mesh) == 0));
    }
}

static void test_refusals(void)
{
    MesoPolygonMesh mesh, torus = make_torus(&arena, 5, 5, NULL);
    turn_face(&torus, 3);
    CHECK(meso_mesh_decimate(&mesh, &arena, &torus, 10, 1, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "wound against"));
}

int main(void)
{
    meso_arena_init(&arena);
    test_torus();
    test_square();
    test_to_the_end();
    test_refusals();
    meso_arena_release(&arena);
    return 0;
}
