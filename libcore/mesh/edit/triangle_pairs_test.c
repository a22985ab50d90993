/* Pairs: every way in which a quad can be cut in two comes back; what is no pair is refused. */
#include "libcore/mesh/edit/triangle_pairs.h"

#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;

/* Each quad of a torus cut along one of its diagonals, both triangles beginning at any of their corners. */
static void test_torus(void)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    MesoPolygonMesh torus = make_torus(&arena, 12, 9, NULL), cut = torus, mesh;
    add_attributes(&torus, &arena);
    uint32_t *c = cut.corners = MESO_NEW(&arena, uint32_t, 6 * torus.face_count, &error);
    cut.face_begin = NULL;
    cut.side_count = 3;
    cut.face_count = 2 * torus.face_count;
    cut.corner_count = 6 * torus.face_count;
    for (uint32_t f = 0; f < torus.face_count; f++) {
        uint32_t diagonal = meso_random_below(&random, 2);
        for (uint32_t t = 0; t < 2; t++) {
            uint32_t at[3] = {diagonal + 2 * t, diagonal + 2 * t + 1, diagonal + 2 * t + 2}, first = meso_random_below(&random, 3);
            for (uint32_t k = 0; k < 3; k++)
                *c++ = torus.corners[4 * f + at[(first + k) % 3] % 4];
        }
    }
    add_attributes(&cut, &arena);
    CHECK(meso_mesh_pair_triangles(&mesh, &arena, &cut, NULL, &error) == MESO_OK && is_checked(&mesh));
    CHECK(mesh.side_count == 4 && mesh.face_count == torus.face_count && euler(&arena, &mesh) == 0);
    CHECK(join(&arena, &mesh).reversed_count == 0 && fabs(volume(&mesh) - volume(&torus)) < 1);
    check_attributes(&mesh, cut.face_count);
    for (uint32_t f = 0; f < mesh.face_count; f++) {
        uint32_t k = 0;
        while (torus.corners[4 * f + k] != mesh.corners[4 * f])
            k++;
        CHECK(mesh.corners[4 * f] == cut.corners[6 * f]);
        for (uint32_t i = 0; i < 4; i++)
            CHECK(mesh.corners[4 * f + i] == torus.corners[4 * f + (k + i) % 4]);
    }
}

static void check_refused(const uint32_t *corners, uint32_t face_count, const MesoVec3 *positions, uint32_t face,
                          const char *part)
{
    uint32_t found;
    MesoPolygonMesh mesh, from = {.vertex_count = 5, .face_count = face_count, .corner_count = 3 * face_count,
                                  .side_count = 3, .positions = (MesoVec3 *)positions, .corners = (uint32_t *)corners};
    CHECK(meso_mesh_pair_triangles(&mesh, &arena, &from, &found, &error) == MESO_ERR_INPUT);
    CHECK(found == face && strstr(error.message, part));
}

static void test_refusals(void)
{
    MesoVec3 flat[5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {5, 5, 0}}, bent[5], hollow[5];
    memcpy(bent, flat, sizeof bent);
    memcpy(hollow, flat, sizeof hollow);
    bent[3] = (MesoVec3){.5f, .5f, 1};
    hollow[3] = (MesoVec3){.6f, .5f, 0};
    hollow[1] = (MesoVec3){.9f, .5f, 0};
    check_refused((uint32_t[]){0, 1, 2, 0, 2, 3, 0, 1, 2}, 3, flat, 2, "odd");
    check_refused((uint32_t[]){0, 1, 2, 2, 3, 4}, 2, flat, 1, "no edge in common");
    check_refused((uint32_t[]){0, 1, 2, 0, 3, 2}, 2, flat, 1, "the same way");
    check_refused((uint32_t[]){0, 1, 2, 0, 2, 1}, 2, flat, 1, "from behind");
    check_refused((uint32_t[]){0, 1, 2, 0, 2, 3}, 2, bent, 0, "fold");
    check_refused((uint32_t[]){0, 1, 2, 0, 2, 3}, 2, hollow, 0, "fold");
    hollow[1] = (MesoVec3){1, 0, 0};
    hollow[3] = (MesoVec3){-1, -.5f, 0};
    check_refused((uint32_t[]){0, 1, 2, 0, 2, 3}, 2, hollow, 0, "not convex");
    uint32_t corners[7] = {0, 1, 2, 0, 2, 3, 4}, face_begin[3] = {0, 3, 7};
    MesoPolygonMesh mesh, from = {.vertex_count = 5, .face_count = 2, .corner_count = 7, .positions = flat,
                                  .face_begin = face_begin, .corners = corners};
    CHECK(meso_mesh_pair_triangles(&mesh, &arena, &from, NULL, &error) == MESO_ERR_INPUT &&
          strstr(error.message, "face 2 is no"));
}

int main(void)
{
    meso_arena_init(&arena);
    test_torus();
    test_refusals();
    meso_arena_release(&arena);
    return 0;
}
