/* Cut faces: the area of random polygons, hollow quads, what is carried. */
#include "libcore/mesh/edit/ear_clip.h"

#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;

/* Stars around 0 in a random plane, which turn left all the way but are far from convex. */
static void test_stars(void)
{
    MesoRandom random;
    for (uint32_t seed = 0; seed < 200; seed++) {
        meso_random_init(&random, seed, 0);
        uint32_t n = 3 + meso_random_below(&random, 30), corners[33], face_begin[2] = {0, n};
        MesoVec3 positions[33];
        double u[3], w[3];
        for (int k = 0; k < 3; k++) {
            u[k] = random_unit(&random) - 0.5;
            w[k] = random_unit(&random) - 0.5;
        }
        for (uint32_t i = 0; i < n; i++) {
            double a = 2 * MESO_PI * i / n, r = 0.1 + random_unit(&random), x = r * cos(a), y = r * sin(a);
            positions[i] = (MesoVec3){(float)(x * u[0] + y * w[0]), (float)(x * u[1] + y * w[1]),
                                      (float)(x * u[2] + y * w[2])};
            corners[i] = i;
        }
        MesoPolygonMesh mesh, star = {.vertex_count = n, .face_count = 1, .corner_count = n, .positions = positions,
                                      .face_begin = face_begin, .corners = corners};
        CHECK(meso_mesh_cut_faces(&mesh, &arena, &star, &error) == MESO_OK && is_checked(&mesh));
        CHECK(mesh.face_count == n - 2 && mesh.side_count == 3);
        CHECK(fabs(area(&mesh) - area(&star)) < 1e-5);      /* no triangle is wound the other way */
        MesoHalfEdges edges = join(&arena, &mesh);
        CHECK(edges.border_count == n && edges.crowded_count == 0 && edges.reversed_count == 0);
    }
}

/*
 *     3        3           of the hollow quad, the diagonal through the dent at 2 is the only one; of the
 *     |\       |\ 2        other one, the shorter one
 *     | 2__    |  /
 *     0----1   0-1
 */
static void test_quads(void)
{
    MesoVec3 positions[4] = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
    uint32_t corners[4] = {0, 1, 2, 3};
    MesoPolygonMesh mesh, quad = {.vertex_count = 4, .face_count = 1, .corner_count = 4, .side_count = 4,
                                  .positions = positions, .corners = corners};
    CHECK(meso_mesh_cut_faces(&mesh, &arena, &quad, &error) == MESO_OK);
    CHECK(mesh.corners[2] == 2 && fabs(area(&mesh) - 4) < 1e-6);
    positions[1] = (MesoVec3){1, 0, 0};
    positions[2] = (MesoVec3){3, 3, 0};
    positions[3] = (MesoVec3){0, 1, 0};
    CHECK(meso_mesh_cut_faces(&mesh, &arena, &quad, &error) == MESO_OK && mesh.corners[2] == 3);
    memset(positions, 0, sizeof positions);     /* without area: cut all the same */
    CHECK(meso_mesh_cut_faces(&mesh, &arena, &quad, &error) == MESO_OK && mesh.face_count == 2);
}

static void test_carried(void)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    MesoPolygonMesh mesh, torus = make_torus(&arena, 7, 5, &random);
    add_attributes(&torus, &arena);
    CHECK(meso_mesh_cut_faces(&mesh, &arena, &torus, &error) == MESO_OK && is_checked(&mesh));
    check_attributes(&mesh, torus.face_count);
    CHECK(mesh.side_count == 3 && euler(&arena, &mesh) == 0 && join(&arena, &mesh).reversed_count == 0);
}

int main(void)
{
    meso_arena_init(&arena);
    test_stars();
    test_quads();
    test_carried();
    meso_arena_release(&arena);
    return 0;
}
