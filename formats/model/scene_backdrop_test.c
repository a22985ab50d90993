/* The surface below what lies on it: one more body, material and id. */
#include <string.h>

#include "formats/mesh/mesh_read.h"
#include "formats/model/scene_backdrop.h"
#include "libcore/base/check.h"

static const char quads[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n";

static void test_backdrop(void)
{
    MesoArena arena;
    MesoError error = {0};
    MesoInput input;
    MesoPolygonMesh mesh;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "q.obj", quads, strlen(quads));
    CHECK(!meso_polygon_mesh_read(&mesh, &arena, &input, 1, &error));
    /* a scene of one body with ids of two channels, of which one has names */
    const char *names[1] = {"only"}, *materials[1] = {"red"};
    MesoMaterial looks[1] = {{{1, 0, 0}, 0.5f, 0}};
    MesoVec3 corner[3] = {{5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
    uint32_t triangle[3] = {0, 1, 2}, ids[2] = {3, 0};
    MesoBody body = {.vertex_count = 3, .face_count = 1, .face_width = 3, .positions = corner, .normals = corner,
                     .corners = triangle};
    MesoPlacedBody placed = {.place = MESO_PLACED_HERE};
    MesoScene scene = {.channel_count = 2, .material_count = 1, .materials = looks, .material_names = materials,
                       .id_row_count = 1, .ids = ids, .body_count = 1, .placed_count = 1, .bodies = &body,
                       .placed = &placed};
    scene.channels[0] = (MesoIdChannel){"branch", 4, NULL};
    scene.channels[1] = (MesoIdChannel){"rule", 1, names};
    CHECK(meso_scene_add_backdrop(&scene, &arena, &mesh, "clay #", &error) == MESO_ERR_INPUT);
    CHECK(meso_scene_check_backdrop("clay #", &error) == MESO_ERR_USAGE);
    CHECK(meso_scene_check_backdrop(NULL, NULL) == MESO_OK && meso_scene_check_backdrop("own", NULL) == MESO_OK);
    CHECK(strncmp(error.message, "--surface: material 'clay #'", 28) == 0 && scene.body_count == 1);
    CHECK(!meso_scene_add_backdrop(&scene, &arena, &mesh, "clay #ffffff 0.25", &error));
    CHECK(scene.material_count == 2 && strcmp(scene.material_names[1], "clay") == 0);
    CHECK(scene.materials[1].albedo[2] == 1 && scene.materials[1].roughness == 0.25f);
    CHECK(scene.materials[0].albedo[0] == 1 && strcmp(scene.material_names[0], "red") == 0);
    CHECK(scene.id_row_count == 2 && scene.ids[0] == 3 && scene.ids[2] == 4 && scene.ids[3] == 1);
    CHECK(scene.channels[0].count == 5 && scene.channels[1].count == 2);
    CHECK(strcmp(scene.channels[1].names[0], "only") == 0 && strcmp(scene.channels[1].names[1], "surface") == 0);
    CHECK(scene.body_count >= 2 && scene.placed_count == scene.body_count && scene.bodies[0].positions == corner);
    uint32_t faces = 0;
    for (uint32_t i = 1; i < scene.placed_count; i++) {
        CHECK(scene.placed[i].body == i && scene.placed[i].material == 1 && scene.placed[i].ids == 1);
        faces += scene.bodies[i].face_count;
    }
    CHECK(faces == 2 && scene.box.low.x == 0 && scene.box.high.y == 6);
    meso_arena_release(&arena);
}

int main(void)
{
    test_backdrop();
    return 0;
}
