/* Bodies in frames and cages, of which some lie rigidly: which ones, where, and what the file says of them. */
#include <jansson.h>

#include "formats/scene/mesh_file_fixture.h"
#include "formats/scene/glb/glb_instances.h"
#include "libcore/scene/placed.h"

enum { PLACED = 7 };

/* A wedge, which no symmetry takes to itself. */
static const MesoVec3 positions[4] = {{0, 0, 0}, {0.4f, 0, 0}, {0.1f, 0.3f, 0}, {0, 0.1f, 0.2f}};
static const MesoVec3 normals[4] = {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const uint32_t corners[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

typedef struct Placing {
    MesoScene scene;
    MesoBody bodies[2];
    MesoFrame frames[5];
    MesoCage cages[2];
    MesoPlacedBody placed[PLACED];
    MesoMaterial materials[1];
    const char *names[1];
    uint32_t ids[PLACED];
} Placing;

/*
 * Rigid: 0 turned, 1 stretched along the body's axes, 2 in a cage that is a box, 5 the same turned by a quarter. Not
 * rigid: 3 mirrored, 4 in a cage that widens, 6 sheared.
 */
static void make(Placing *p)
{
    const float c = 0.6f, s = 0.8f;
    *p = (Placing){
        .frames = {{{c, -s, 0, 5, s, c, 0, -2, 0, 0, 1, 1}}, {{2, 0, 0, 1, 0, 0, -1, 2, 0, 3, 0, 3}},
                   {{1, 0, 0, 0.1f, 0, 1, 0, 0.1f, 0, 0, 1, 0.1f}}, {{-1, 0, 0, 9, 0, 1, 0, 0, 0, 0, 1, 0}},
                   {{1, 0.2f, 0, 0, 0, 1, 0, 7, 0, 0, 1, 0}}},
        .names = {"wedge"}};
    const MesoVec3 square[4] = {{12, 0, 0}, {12, 2, 0}, {10, 2, 0}, {10, 0, 0}};
    for (uint32_t i = 0; i < 2; i++) {
        p->cages[i] = (MesoCage){.low = 0, .high = 1};
        memcpy(p->cages[i].base, square, sizeof square);
        for (uint32_t k = 0; k < 4; k++)
            p->cages[i].rise[k] = (MesoVec3){i && k == 0 ? 0.5f : 0, 0, 1};
    }
    p->bodies[0] = p->bodies[1] = (MesoBody){.vertex_count = 4, .face_count = 4, .face_width = 3,
                                             .positions = positions, .normals = normals, .corners = corners};
    const MesoTransform turned = 1;
    for (uint32_t i = 0; i < PLACED; i++) {
        p->ids[i] = i;
        p->placed[i] = (MesoPlacedBody){.ids = i, .frame = i < 4 ? i : i == 6 ? 4 : 2, .place = MESO_PLACED_IN_FRAME};
    }
    p->placed[2].place = p->placed[4].place = p->placed[5].place = MESO_PLACED_IN_CAGE;
    p->placed[4].cage = 1;
    p->placed[5].turn = turned;
    p->scene = (MesoScene){.channel_count = 1, .material_count = 1, .channels = {{"slot", PLACED, NULL}},
                           .materials = p->materials, .material_names = p->names, .id_row_count = PLACED, .ids = p->ids,
                           .section_scale = 1, .body_count = 2, .placed_count = PLACED, .frame_count = 5,
                           .cage_count = 2, .bodies = p->bodies, .placed = p->placed, .frames = p->frames,
                           .cages = p->cages};
    meso_scene_measure(&p->scene);
}

/* v + 2 w (q x v) + 2 q x (q x v) */
static MesoVec3 posed(const MesoGlbPose *pose, MesoVec3 p)
{
    MesoVec3 v = {pose->scale.x * p.x, pose->scale.y * p.y, pose->scale.z * p.z};
    MesoVec3 q = {pose->rotation[0], pose->rotation[1], pose->rotation[2]}, t = meso_vec3_cross(q, v);
    v = meso_vec3_add(meso_vec3_mad(v, 2 * pose->rotation[3], t), meso_vec3_scale(meso_vec3_cross(q, t), 2));
    return meso_vec3_add(v, pose->translation);
}

static void test_sets(MesoArena *arena)
{
    static const uint32_t rigid[] = {0, 1, 2, 5};
    Placing p;
    MesoGlbInstances found;
    MesoError error;
    make(&p);
    CHECK(meso_glb_instances_find(&found, &p.scene, arena, &error) == MESO_OK);
    CHECK(found.set_count == 1 && found.first == 3 && found.parts.part_count == 4 && found.sets[0].count == 4);
    for (uint32_t i = 0; i < 4; i++) {
        CHECK(found.sets[0].rows[i] == rigid[i]);
        for (uint32_t v = 0; v < 4; v++)
            check_near(posed(&found.sets[0].poses[i], positions[v]),
                       meso_placed_point(&p.scene, &p.placed[rigid[i]], positions[v]), 1e-5f);
    }
    p.placed[1].body = 1;       /* one alone is none */
    CHECK(meso_glb_instances_find(&found, &p.scene, arena, &error) == MESO_OK && found.sets[0].count == 3);
    CHECK(found.set_count == 1 && found.parts.part_count == 5);
}

static const json_t *get(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    CHECK(value);
    return value;
}

static void test_file(MesoArena *arena)
{
    const MesoMeshWriteOptions instances = {.instances = true};
    Placing p;
    MesoSceneParts parts;
    MesoError error;
    make(&p);
    CHECK(meso_scene_parts_init(&parts, arena, &p.scene, &error) == MESO_OK);
    MesoInput input = write_mesh_as(meso_glb_write, &parts, &instances, 2, path_of("x.glb"));
    uint32_t json_size, slots[4];
    memcpy(&json_size, input.data + 12, sizeof json_size);
    json_t *root = json_loadb((const char *)input.data + 20, json_size, 0, NULL);
    CHECK(root && json_array_size(get(root, "meshes")) == 2 && json_array_size(get(root, "materials")) == 1);
    const json_t *node = json_array_get(get(root, "nodes"), 2);
    const json_t *attributes = get(get(get(node, "extensions"), "EXT_mesh_gpu_instancing"), "attributes");
    const json_t *slot = json_array_get(get(root, "accessors"), (size_t)json_integer_value(get(attributes, "_SLOT")));
    const json_t *view = json_array_get(get(root, "bufferViews"), (size_t)json_integer_value(get(slot, "bufferView")));
    CHECK(json_object_size(attributes) == 4 && json_integer_value(get(slot, "count")) == 4);
    memcpy(slots, input.data + 28 + json_size + json_integer_value(get(view, "byteOffset")), sizeof slots);
    CHECK(slots[0] == 0 && slots[1] == 1 && slots[2] == 2 && slots[3] == 5);
    json_decref(root);
    check_threads_as(meso_glb_write, &parts, &instances, &input);
    meso_input_close(&input);
}

int main(int argc, char **argv)
{
    MesoArena arena;
    (void)argv;
    CHECK(mkdtemp(folder));
    meso_arena_init(&arena);
    test_sets(&arena);
    test_file(&arena);
    meso_arena_release(&arena);
    static const char *const products[] = {"x.glb", "again"};
    if (argc == 1)
        remove_products(products, 2);
    else
        puts(folder);
    return 0;
}
