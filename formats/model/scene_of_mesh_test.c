/*
 * Meshes to scenes: a pentagon, a quad and a triangle, and what splits their vertices.
 *
 *         6
 *        / \
 *     3-+---+-2---5      0: the pentagon 0 1 2 6 3; 1: the quad 1 4 5 2; 2: the triangle 4 7 5
 *     |   0   | 1 | \
 *     0-------1---4--7   8 belongs to no face
 */
#include "formats/model/scene_of_mesh.h"

#include <math.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/scene/parts.h"

static MesoArena arena;
static MesoError error;

static MesoVec3 positions[9] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {3, 0, 0},
                                {3, 1, 0}, {1, 2, 0}, {4, 0, 1}, {9, 9, 9}};
static uint32_t corners[12] = {0, 1, 2, 6, 3, 1, 4, 5, 2, 4, 7, 5}, face_begin[4] = {0, 5, 9, 12};

static MesoPolygonMesh make_mesh(uint32_t attribute_count, MesoAttribute *attributes)
{
    MesoPolygonMesh mesh = {.vertex_count = 9, .face_count = 3, .corner_count = 12, .positions = positions,
                            .face_begin = face_begin, .corners = corners, .attribute_count = attribute_count,
                            .attributes = attributes};
    CHECK(meso_polygon_mesh_check(&mesh, 1, NULL, &error) == MESO_OK);
    return mesh;
}

static MesoScene expect_scene(uint32_t attribute_count, MesoAttribute *attributes)
{
    MesoScene scene;
    MesoPolygonMesh mesh = make_mesh(attribute_count, attributes);
    CHECK(meso_scene_of_mesh(&scene, &arena, &mesh, &error) == MESO_OK);
    return scene;
}

/* Nothing but polygons: one grey body, the vertices as they were but for the one without a face. */
static void test_plain(void)
{
    static const uint32_t faces[20] = {0, 1, 2, MESO_NO_INDEX, 0, 2, 6, MESO_NO_INDEX, 0, 6, 3, MESO_NO_INDEX,
                                       1, 4, 5, 2, 4, 7, 5, MESO_NO_INDEX};
    MesoScene scene = expect_scene(0, NULL);
    const MesoBody *body = scene.bodies;
    CHECK(scene.body_count == 1 && scene.placed_count == 1 && scene.channel_count == 0 && scene.material_count == 1);
    CHECK(strcmp(scene.material_names[0], "none") == 0 && scene.materials[0].albedo[0] == 0.8f);
    CHECK(body->vertex_count == 8 && memcmp(body->positions, positions, 8 * sizeof *positions) == 0);
    CHECK(body->face_count == 5 && memcmp(body->corners, faces, sizeof faces) == 0);
    CHECK(!body->uvs && !body->colors && scene.box.high.x == 4 && scene.box.high.y == 2);
    CHECK(body->normals[0].z == 1 && body->normals[7].x < -0.5f);      /* the triangle looks up and to the left */
    for (uint32_t v = 0; v < 8; v++)
        CHECK(fabsf(meso_vec3_length(body->normals[v]) - 1) < 1e-6f);
}

/* Corners that say the same share a vertex, whatever entries they have; a normal without length is none. */
static void test_splits(void)
{
    float uvs[12][2] = {{0}}, normals[9][3] = {{0, 0, 2}, {0, 0, 0}, {0, NAN, 1}};
    uint8_t colors[9][4];
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 4; k++)
            colors[i][k] = (uint8_t)(20 * i + k);
    uvs[6][0] = 0.5f;       /* corner 6 is vertex 4 in the quad */
    uvs[9][1] = INFINITY;   /* corner 9 is vertex 4 in the triangle */
    MesoAttribute attributes[3] = {
        {.name = "uv", .domain = MESO_ON_CORNERS, .width = 2, .entry_count = 12, .values = uvs},
        {.name = "normal", .domain = MESO_ON_VERTICES, .width = 3, .entry_count = 9, .values = normals},
        {.name = "color", .domain = MESO_ON_VERTICES, .scalar = MESO_SCALAR_UINT8, .width = 4, .entry_count = 9,
         .values = colors},
    };
    MesoScene scene = expect_scene(3, attributes);
    const MesoBody *body = scene.bodies;
    CHECK(scene.body_count == 1 && body->vertex_count == 9 && scene.materials[0].albedo[0] == 1);
    CHECK(body->positions[4].x == 3 && body->positions[5].x == 3 && body->positions[5].y == 0);
    CHECK(body->uvs[4].x == 0.5f && body->uvs[5].x == 0 && body->uvs[5].y == 0);
    CHECK(body->normals[0].z == 1 && body->normals[1].z == 1 && body->normals[2].z == 1);
    CHECK(body->colors[6].r == 100 && body->colors[6].b == 102 && meso_scene_is_colored(&scene));
    CHECK(body->corners[13] == 4 && body->corners[16] == 5);

    /* The same colours as shares of one, and on faces. */
    attributes[2].normalized = true;
    scene = expect_scene(3, attributes);
    CHECK(scene.bodies[0].colors[6].r == 100 && scene.bodies[0].colors[6].b == 102);
    float shares[3][3] = {{0, 0.2f, 1}, {-1, NAN, 2}, {0, 0.2f, 1}};
    attributes[2] = (MesoAttribute){.name = "color", .domain = MESO_ON_FACES, .width = 3, .entry_count = 3, .values = shares};
    scene = expect_scene(1, attributes + 2);
    body = scene.bodies;
    CHECK(body->vertex_count == 12);        /* 1, 2, 4 and 5 differ between the quad and its neighbours */
    CHECK(body->colors[0].g == 51 && body->colors[0].b == 255);
    CHECK(body->colors[2].r == 0 && body->colors[2].g == 0 && body->colors[2].b == 255);
}

/* Bodies by material and ids; a vertex between two of them belongs to both. */
static void test_bodies(void)
{
    const char *names[3] = {"gold", "unused", "red paint"};
    uint32_t material_of[3] = {2, MESO_NO_INDEX, 0};
    uint16_t regions[3] = {7, 7, 9};
    int32_t heat[3] = {1, 2, 3};
    MesoAttribute attributes[3] = {
        {.name = "material", .domain = MESO_ON_FACES, .entry_count = 3, .names = names, .entry_of = material_of},
        {.name = "region", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_UINT16, .width = 1, .entry_count = 3, .values = regions},
        {.name = "heat", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_INT32, .width = 1, .entry_count = 3, .values = heat},
    };
    MesoScene scene = expect_scene(3, attributes);
    CHECK(scene.body_count == 3 && scene.material_count == 3 && scene.channel_count == 1);
    CHECK(strcmp(scene.material_names[0], "gold") == 0 && strcmp(scene.material_names[1], "red paint") == 0 &&
          strcmp(scene.material_names[2], "none") == 0);
    CHECK(strcmp(scene.channels[0].name, "region") == 0 && scene.channels[0].count == 10 && !scene.channels[0].names);
    static const struct {
        uint32_t material, region, vertices, faces;
    } expected[3] = {{0, 9, 3, 1}, {1, 7, 5, 3}, {2, 7, 4, 1}};
    for (uint32_t i = 0; i < 3; i++) {
        const MesoPlacedBody *placed = &scene.placed[i];
        CHECK(placed->material == expected[i].material && meso_scene_id(&scene, placed->ids, 0) == expected[i].region);
        CHECK(scene.bodies[placed->body].vertex_count == expected[i].vertices);
        CHECK(scene.bodies[placed->body].face_count == expected[i].faces);
    }
    CHECK(memcmp(&scene.bodies[1].normals[1], &(MesoVec3){0, 0, 1}, 12) == 0);
    CHECK(scene.bodies[0].normals[0].x < 0 && scene.bodies[2].normals[2].x == scene.bodies[0].normals[0].x);

    /* Numbers of materials, as our own PLY has them. */
    uint16_t numbers[3] = {4, 4, 1};
    attributes[0] = (MesoAttribute){.name = "material", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_UINT16, .width = 1,
                                    .entry_count = 3, .values = numbers};
    scene = expect_scene(1, attributes);
    CHECK(scene.body_count == 2 && strcmp(scene.material_names[0], "material 1") == 0 &&
          strcmp(scene.material_names[1], "material 4") == 0);
    CHECK(scene.bodies[1].vertex_count == 7);
}

/* What the first face of a material says; and names of ids, in UTF-8. */
static void test_looks_and_names(void)
{
    const char *names[2] = {"same", "same"}, *tiles[3] = {"plain", "unused", "caf\xe9"};
    uint32_t material_of[3] = {1, 0, 1}, tile_of[3] = {2, 0, MESO_NO_INDEX}, look_of[3] = {0, MESO_NO_INDEX, 1};
    float albedo[2][3] = {{0.25f, 0.5f, NAN}, {1, 1, 1}}, roughness[2] = {0.125f, 0}, metallic[2] = {3, 0};
    MesoAttribute attributes[5] = {
        {.name = "material", .domain = MESO_ON_FACES, .entry_count = 2, .names = names, .entry_of = material_of},
        {.name = "tile", .domain = MESO_ON_FACES, .entry_count = 3, .names = tiles, .entry_of = tile_of},
        {.name = "albedo", .domain = MESO_ON_FACES, .width = 3, .entry_count = 2, .values = albedo, .entry_of = look_of},
        {.name = "roughness", .domain = MESO_ON_FACES, .width = 1, .entry_count = 2, .values = roughness, .entry_of = look_of},
        {.name = "metallic", .domain = MESO_ON_FACES, .width = 1, .entry_count = 2, .values = metallic, .entry_of = look_of},
    };
    MesoScene scene = expect_scene(5, attributes);
    CHECK(scene.material_count == 2 && strcmp(scene.material_names[0], "same") == 0 && strcmp(scene.material_names[1], "same") == 0);
    const MesoMaterial *bare = &scene.materials[0], *said = &scene.materials[1];
    CHECK(bare->albedo[0] == 0.8f && bare->roughness == 0.5f && bare->metallic == 0);
    CHECK(said->albedo[0] == 0.25f && said->albedo[1] == 0.5f && said->albedo[2] == 0);
    CHECK(said->roughness == 0.125f && said->metallic == 1);

    const MesoIdChannel *tile = &scene.channels[0];
    CHECK(scene.channel_count == 1 && tile->count == 3 && strcmp(tile->names[0], "plain") == 0);
    CHECK(strcmp(tile->names[2], "caf?") == 0 && tile->names[0] != tiles[0]);
    CHECK(scene.body_count == 3 && meso_scene_id(&scene, scene.placed[1].ids, 0) == 0 &&
          meso_scene_id(&scene, scene.placed[2].ids, 0) == 2);

    attributes[1].entry_count = 0;      /* no name, and no face that has one */
    tile_of[0] = tile_of[1] = MESO_NO_INDEX;
    scene = expect_scene(5, attributes);
    CHECK(scene.channels[0].count == 1 && !scene.channels[0].names);
}

static void test_refusals(void)
{
    int32_t slots[3] = {0, 5, -1};
    uint32_t numbers[3] = {0, 1, 70000};
    MesoScene scene;
    MesoAttribute slot = {.name = "slot", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_INT32, .width = 1, .entry_count = 3, .values = slots};
    MesoAttribute material = {.name = "material", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_UINT32, .width = 1, .entry_count = 3, .values = numbers};
    MesoPolygonMesh mesh = make_mesh(1, &slot);
    CHECK(meso_scene_of_mesh(&scene, &arena, &mesh, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "face 3: its slot is -1") == 0);
    mesh = make_mesh(1, &material);
    CHECK(meso_scene_of_mesh(&scene, &arena, &mesh, &error) == MESO_ERR_LIMIT);

    /* Nothing at all. */
    mesh = (MesoPolygonMesh){.side_count = 3};
    CHECK(meso_scene_of_mesh(&scene, &arena, &mesh, &error) == MESO_OK && scene.body_count == 0);
}

int main(void)
{
    meso_arena_init(&arena);
    test_plain();
    test_splits();
    test_bodies();
    test_looks_and_names();
    test_refusals();
    meso_arena_release(&arena);
    return 0;
}
