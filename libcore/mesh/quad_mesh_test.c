/* Quad mesh: checks, normals and edge length. */
#include <math.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/mesh/quad_mesh.h"

/*
 *   3-----2-----5
 *   |  0  |  1  |      face 1 stands upright: 5 and 4 lie 2 above
 *   0-----1-----4
 */
static const MesoVec3 positions[6] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {2, 0, 2}, {2, 2, 2}};
static const uint32_t faces[8] = {0, 1, 2, 3, 1, 4, 5, 2};

static MesoArena arena;
static MesoQuadMesh mesh;
static MesoError error;

static MesoStatus build(const MesoVec3 *p, const uint32_t *f)
{
    return meso_quad_mesh_build(&mesh, &arena, 6, p, 0, NULL, 2, f, NULL, &error);
}

static bool near(MesoVec3 a, float x, float y, float z)
{
    return meso_vec3_length(meso_vec3_sub(a, (MesoVec3){x, y, z})) < 1e-6f;
}

static void test_vertex_normals(void)
{
    CHECK(build(positions, faces) == MESO_OK);
    CHECK(mesh.vertex_count == 6 && mesh.face_count == 2 && mesh.normal_count == 6);
    CHECK(memcmp(mesh.positions, positions, sizeof positions) == 0);
    CHECK(memcmp(mesh.face_vertices, faces, sizeof faces) == 0);
    CHECK(mesh.mean_edge_length == 2);
    float half = sqrtf(0.5f);
    for (int h = 0; h < 8; h++) {
        MesoVec3 n = mesh.normals[mesh.face_normals[h]];
        bool shared = faces[h] == 1 || faces[h] == 2;
        CHECK(shared ? near(n, -half, 0, half) : h < 4 ? near(n, 0, 0, 1) : near(n, -1, 0, 0));
    }
}

/* Corners 0 and 1 of face 0 have normals, one of them long; corner 2 has none of length, the rest none. */
static void test_given_normals(void)
{
    const MesoVec3 normals[3] = {{0, 3e30f, 0}, {1e-30f, 0, 0}, {0, 0, 0}};
    uint32_t corners[8] = {0, 1, 2, MESO_NO_INDEX, 0, 0, 0, 0};
    CHECK(meso_quad_mesh_build(&mesh, &arena, 6, positions, 3, normals, 2, faces, corners, &error) == MESO_OK);
    CHECK(mesh.normal_count == 5);
    CHECK(mesh.face_normals[0] == 0 && near(mesh.normals[0], 0, 1, 0));
    CHECK(mesh.face_normals[1] == 1 && near(mesh.normals[1], 1, 0, 0));
    CHECK(near(mesh.normals[mesh.face_normals[2]], -sqrtf(0.5f), 0, sqrtf(0.5f)));
    CHECK(near(mesh.normals[mesh.face_normals[3]], 0, 0, 1));
    for (uint32_t n = 0; n < mesh.normal_count; n++)
        CHECK(fabsf(meso_vec3_length(mesh.normals[n]) - 1) < 1e-6f);

    corners[5] = 3;
    CHECK(meso_quad_mesh_build(&mesh, &arena, 6, positions, 3, normals, 2, faces, corners, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "face 2 uses normal 4 of 3") == 0);
    const MesoVec3 bad[1] = {{0, NAN, 0}};
    CHECK(meso_quad_mesh_build(&mesh, &arena, 6, positions, 1, bad, 2, faces, corners, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "normal 1 is not finite") == 0);
}

static void check_position(MesoVec3 p, const char *message)
{
    MesoVec3 changed[6];
    memcpy(changed, positions, sizeof positions);
    changed[3] = p;
    CHECK(build(changed, faces) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, message) == 0);
}

static void check_corner(uint32_t corner, uint32_t vertex, const char *message)
{
    uint32_t changed[8];
    memcpy(changed, faces, sizeof faces);
    changed[corner] = vertex;
    CHECK(build(positions, changed) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, message) == 0);
}

static void test_refusals(void)
{
    check_position((MesoVec3){0, INFINITY, 0}, "vertex 4 is not finite");
    check_position((MesoVec3){0, 0, NAN}, "vertex 4 is not finite");
    check_position((MesoVec3){-2e18f, 0, 0}, "vertex 4 lies beyond the largest coordinate, 1e+18");
    check_corner(5, 6, "face 2 uses vertex 7 of 6");
    check_corner(5, MESO_NO_INDEX, "face 2 uses vertex 4294967296 of 6");
    check_corner(7, 1, "face 2 uses vertex 2 twice");
    check_corner(1, 0, "face 1 uses vertex 1 twice");

    CHECK(meso_quad_mesh_build(&mesh, &arena, 6, positions, 0, NULL, 0, faces, NULL, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "mesh has no faces") == 0);
    CHECK(meso_quad_mesh_build(&mesh, &arena, 6, positions, 0, NULL, UINT32_MAX, faces, NULL, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "more than"));
    const MesoVec3 point[6] = {{0, 0, 0}};
    CHECK(build(point, faces) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "no extent"));
    const MesoVec3 speck[6] = {{0, 0, 0}, {1e-20f, 0, 0}};
    CHECK(build(speck, faces) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "too small"));
}

/* A face folded onto itself has no direction. */
static void test_no_direction(void)
{
    const MesoVec3 line[6] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}};
    CHECK(build(line, faces) == MESO_OK);
    for (uint32_t n = 0; n < mesh.normal_count; n++)
        CHECK(near(mesh.normals[n], 0, 0, 1));
}

int main(void)
{
    meso_arena_init(&arena);
    test_vertex_normals();
    test_given_normals();
    test_refusals();
    test_no_direction();
    meso_arena_release(&arena);
    return 0;
}
