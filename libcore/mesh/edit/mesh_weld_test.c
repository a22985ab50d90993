/* Welding against brute force; seams; faces that collapse. */
#include "libcore/mesh/edit/mesh_weld.h"

#include "libcore/base/disjoint_sets.h"
#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;

static void brute_force(uint32_t *first, const MesoPolygonMesh *mesh, double distance)
{
    meso_sets_init(first, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (uint32_t j = 0; j < i; j++) {
            MesoVec3 p = mesh->positions[i], q = mesh->positions[j];
            double x = (double)p.x - q.x, y = (double)p.y - q.y, z = (double)p.z - q.z;
            if (x * x + y * y + z * z <= distance * distance)
                meso_sets_join(first, i, j);
        }
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        first[i] = meso_sets_root(first, i);
}

static void test_map(void)
{
    MesoRandom random;
    MesoVec3 positions[60];
    for (uint32_t seed = 0; seed < 400; seed++) {
        uint32_t found[60], expected[60];
        meso_random_init(&random, seed, 0);
        MesoPolygonMesh mesh = {.vertex_count = 1 + meso_random_below(&random, 60), .positions = positions};
        double grid = 1 + meso_random_below(&random, 8);    /* so that many are at the same place, or at the distance */
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            positions[v] = (MesoVec3){(float)(round(grid * random_unit(&random)) / grid),
                                      (float)(round(grid * random_unit(&random)) / grid),
                                      (float)(seed % 3 ? random_unit(&random) / 100 : seed % 2 ? -0.0 : 0.0)};
        double distance = seed % 4 == 0 ? 0 : seed % 4 == 1 ? 1 / grid : random_unit(&random) / 4;
        CHECK(meso_mesh_weld_map(found, &mesh, distance, &error) == MESO_OK);
        brute_force(expected, &mesh, distance);
        CHECK(memcmp(found, expected, mesh.vertex_count * sizeof *found) == 0);
    }
}

/*
 * A torus taken apart into faces with vertices of their own, which know the old ones: the old torus comes back,
 * and what differs between vertices that are one now goes to corners.
 */
static void test_soup(void)
{
    MesoPolygonMesh torus = make_torus(&arena, 6, 5, NULL), soup = torus, mesh;
    soup.vertex_count = torus.corner_count;
    soup.positions = MESO_NEW(&arena, MesoVec3, soup.vertex_count, &error);
    soup.corners = MESO_NEW(&arena, uint32_t, soup.vertex_count, &error);
    float *same = MESO_NEW(&arena, float, soup.vertex_count, &error);
    int32_t *own = MESO_NEW(&arena, int32_t, soup.vertex_count, &error);
    for (uint32_t c = 0; c < torus.corner_count; c++) {
        soup.positions[c] = torus.positions[torus.corners[c]];
        soup.corners[c] = c;
        same[c] = soup.positions[c].x;
        own[c] = (int32_t)c;
    }
    MesoAttribute attributes[2] = {{.name = "same", .width = 1, .entry_count = soup.vertex_count, .values = same},
                                   {.name = "own", .scalar = MESO_SCALAR_INT32, .width = 1,
                                    .entry_count = soup.vertex_count, .values = own}};
    soup.attributes = attributes;
    soup.attribute_count = 2;
    MesoWeldCounts counts;
    CHECK(meso_mesh_weld(&mesh, &arena, &soup, 0, &counts, &error) == MESO_OK && is_checked(&mesh));
    CHECK(mesh.vertex_count == 30 && counts.vertices_gone == 90 && counts.faces_gone == 0 &&
          counts.attributes_moved == 1);
    CHECK(mesh.side_count == 4 && euler(&arena, &mesh) == 0 && fabs(volume(&mesh) - volume(&torus)) < 1e-6);
    CHECK(mesh.attributes[0].domain == MESO_ON_VERTICES && mesh.attributes[1].domain == MESO_ON_CORNERS);
    for (uint32_t c = 0; c < mesh.corner_count; c++)
        CHECK(((const int32_t *)mesh.attributes[1].values)[mesh.attributes[1].entry_of[c]] == (int32_t)c);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(((const float *)mesh.attributes[0].values)[v] == mesh.positions[v].x);
}

/*
 *     4-----3      4 and 5 become one: of the triangle 0 5 4 nothing is left, of the polygon
 *     5     |      0 1 2 3 4 5 a pentagon; where 1 and 4 become one, it falls into 1 2 3
 *     0--1--2      and a spur to 0
 */
static void test_collapse(void)
{
    MesoVec3 positions[6] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, .9f, 0}};
    uint32_t face_begin[3] = {0, 6, 9}, corners[9] = {0, 1, 2, 3, 4, 5, 0, 5, 4};
    MesoPolygonMesh mesh, from = {.vertex_count = 6, .face_count = 2, .corner_count = 9, .positions = positions,
                                  .face_begin = face_begin, .corners = corners};
    MesoWeldCounts counts;
    CHECK(meso_mesh_weld(&mesh, &arena, &from, 0.2, &counts, &error) == MESO_OK && is_checked(&mesh));
    CHECK(mesh.face_count == 1 && mesh.side_count == 5 && counts.faces_gone == 1 && mesh.vertex_count == 5);
    positions[4] = positions[5] = positions[1];
    CHECK(meso_mesh_weld(&mesh, &arena, &from, 0, &counts, &error) == MESO_OK && is_checked(&mesh));
    CHECK(mesh.face_count == 1 && mesh.side_count == 3 && mesh.corners[0] == 1 && mesh.corners[1] == 2 &&
          mesh.corners[2] == 3);
}

int main(void)
{
    meso_arena_init(&arena);
    test_map();
    test_soup();
    test_collapse();
    meso_arena_release(&arena);
    return 0;
}
