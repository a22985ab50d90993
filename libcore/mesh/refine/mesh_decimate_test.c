/* Decimation: topology, shape and borders stay; vertices keep what they have. */
#include "libcore/mesh/refine/mesh_decimate.h"

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
    test_refusals();
    meso_arena_release(&arena);
    return 0;
}
