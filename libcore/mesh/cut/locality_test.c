#include <string.h>

#include "libcore/base/random.h"
#include "libcore/mesh/cut/locality.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

/* Cells of a cube that are passed one after the other touch each other: the curve is a curve. */
static void test_curve(void)
{
    enum { SIDE = 16, COUNT = SIDE * SIDE * SIDE };
    MesoVec3 *positions = malloc(COUNT * sizeof *positions);
    uint32_t *order = malloc(COUNT * sizeof *order), *places = malloc(COUNT * sizeof *places);
    CHECK(positions && order && places);
    for (uint32_t v = 0; v < COUNT; v++)
        positions[v] = (MesoVec3){(float)(v % SIDE), (float)(v / SIDE % SIDE), (float)(v / SIDE / SIDE)};
    const MesoLocality both = {.old_vertex = order, .new_vertex = places};
    CHECK(meso_locality_order(positions, COUNT, NULL, 0, &both, NULL) == MESO_OK);
    for (uint32_t i = 0; i + 1 < COUNT; i++)
        CHECK(meso_vec3_length(meso_vec3_sub(positions[order[i]], positions[order[i + 1]])) == 1);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK(places[order[i]] == i);
    free(positions);
    free(order);
    free(places);
}

/* Nothing, and all in one place: the order of before. */
static void test_no_size(void)
{
    MesoVec3 positions[4] = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    uint32_t corners[6] = {2, 1, 3, 0, 1, 2}, vertices[4], triangles[2];
    uint32_t vertex_places[4], triangle_places[2];
    const MesoLocality order = {vertices, vertex_places, triangles, triangle_places};
    CHECK(meso_locality_order(positions, 4, corners, 2, &order, NULL) == MESO_OK);
    for (uint32_t v = 0; v < 4; v++)
        CHECK(vertices[v] == v && vertex_places[v] == v);
    CHECK(triangles[0] == 1 && triangles[1] == 0);
    CHECK(triangle_places[0] == 1 && triangle_places[1] == 0);
    CHECK(meso_locality_order(positions, 0, corners, 0, &order, NULL) == MESO_OK);
}

/* A triangulation that is large enough is numbered again, says how, and has its neighbours near. */
static void test_triangulation(void)
{
    enum { SIDE = 300, WIDTH = SIDE + 1, VERTICES = WIDTH * WIDTH, TRIANGLES = 2 * SIDE * SIDE };
    MesoVec3 *positions = malloc(VERTICES * sizeof *positions);
    uint32_t *corners = malloc(3 * TRIANGLES * sizeof *corners), *number = malloc(VERTICES * sizeof *number), n = 0;
    CHECK(positions && corners && number);
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t v = 0; v < VERTICES; v++) {
        uint32_t other = meso_random_below(&random, v + 1);
        number[v] = number[other];
        number[other] = v;
    }
    for (uint32_t v = 0; v < VERTICES; v++)
        positions[number[v]] = (MesoVec3){(float)(v % WIDTH), (float)(v / WIDTH), 0};
    for (uint32_t v = 0; v < VERTICES; v++)
        if (v % WIDTH < SIDE && v / WIDTH < SIDE) {
            const uint32_t quad[6] = {v, v + 1, v + WIDTH + 1, v, v + WIDTH + 1, v + WIDTH};
            for (uint32_t k = 0; k < 6; k++)
                corners[n++] = number[quad[k]];
        }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, VERTICES, corners, TRIANGLES);
    uint32_t near = 0;
    for (uint32_t t = 0; t < TRIANGLES; t++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = mesh.corners[3 * t + k], next = mesh.corners[3 * t + (k + 1) % 3];
            CHECK(mesh.origins[v] == corners[3 * mesh.faces[t] + k]);
            near += (v > next ? v - next : next - v) < 512;
        }
    for (uint32_t v = 0; v < VERTICES; v++)
        CHECK(memcmp(&mesh.positions[v], &positions[mesh.origins[v]], sizeof *positions) == 0);
    CHECK(near > 3 * TRIANGLES / 100 * 85);
    CHECK(meso_triangulation_reserve(&mesh, 2 * VERTICES, TRIANGLES, NULL) == MESO_OK);
    CHECK(mesh.origins[VERTICES] == MESO_NO_INDEX && mesh.origins[2 * VERTICES - 1] == MESO_NO_INDEX);
    meso_triangulation_release(&mesh);
    free(positions);
    free(corners);
    free(number);
}

int main(void)
{
    test_curve();
    test_no_size();
    test_triangulation();
    return 0;
}
