/*
 * A model and its scene for the tests and the benchmark of the mesh writers: a wavy sheet of
 * quads, each with two crossing sweeps, a cap on a second cross-section, and
 * a tetrahedron.
 */
#ifndef MESO_SCENE_FIXTURE_H
#define MESO_SCENE_FIXTURE_H

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/scene/parts.h"
#include "libcore/tiling/strand/expansion.h"

typedef struct SceneFixture {
    MesoArena arena;
    MesoCsgNode csg[3];
    MesoSection sections[3];
    MesoInterface interfaces[2];
    MesoSweep sweeps[2];
    MesoTile tiles[2];
    MesoInnerMesh inners[1];
    MesoTriangleMesh inner_mesh;
    MesoVec3 inner_positions[4], inner_normals[4];
    uint32_t inner_triangles[12];
    MesoModel model;
    MesoScene scene;
    MesoSceneParts parts;
} SceneFixture;

static inline void scene_fixture_tiles(SceneFixture *s)
{
    s->csg[0] = (MesoCsgNode){MESO_CSG_DISC, 0, 0, {0.5f, 0.3f}, {0.25f, 0.2f}, 0};
    s->csg[1] = (MesoCsgNode){MESO_CSG_BOX, 0, 0, {0.5f, 0.8f}, {0.2f, 0.1f}, 0.3f};
    s->csg[2] = (MesoCsgNode){MESO_CSG_DISC, 0, 0, {0.2f, 0.5f}, {0.1f, 0.1f}, 0};
    s->sections[0] = (MesoSection){"strand", 0, 0, {{0.5f, 0.2f, 0.1f}, 0.5f, 0}};
    s->sections[1] = (MesoSection){"strand", 1, 1, {{0.1f, 0.3f, 0.6f}, 0.25f, 1}};
    s->sections[2] = (MesoSection){"stud", 1, 2, {{1, 1, 1}, 1, 1}};
    s->interfaces[0] = (MesoInterface){"warp", 0, 1, {0, 0, 0}, false, false};
    s->interfaces[1] = (MesoInterface){"weft", 1, 2, {0, 0, 0}, false, false};
    s->sweeps[0] = (MesoSweep){.from_side = 0, .to_side = 2};
    s->sweeps[1] = (MesoSweep){.from_side = 1, .to_side = 3, .from_section = 1, .to_section = 1};
    s->tiles[0] = (MesoTile){.name = "plain \"weave\"", .side_count = 4, .labels = {1, 2, -1, -2},
                             .sweep_begin = 0, .sweep_count = 2, .inner_count = 1};
    s->tiles[1] = (MesoTile){.name = "float", .side_count = 4, .labels = {1, 2, -1, -2},
                             .sweep_begin = 0, .sweep_count = 2, .inner_begin = 1};
    s->inners[0] = (MesoInnerMesh){"x.obj", {0.2f, 0, 0, 0.4f, 0, 0.2f, 0, 0.4f, 0, 0, 0.2f, 0.9f},
                                   {{0.2f, 0.8f, 0.2f}, 0.75f, 0}};

    static const uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    static const MesoVec3 positions[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memcpy(s->inner_triangles, triangles, sizeof triangles);
    memcpy(s->inner_positions, positions, sizeof positions);
    for (int i = 0; i < 4; i++)
        s->inner_normals[i] = meso_vec3_unit(meso_vec3_sub(positions[i], (MesoVec3){0.25f, 0.25f, 0.25f}),
                                             (MesoVec3){0, 0, 1});
    s->inner_mesh = (MesoTriangleMesh){4, 4, s->inner_positions, s->inner_normals, s->inner_triangles};
    s->model.inner_meshes = &s->inner_mesh;
    s->model.tile_set = (MesoTileSet){
        .interface_count = 2, .section_count = 3, .csg_count = 3, .tile_count = 2, .sweep_count = 2,
        .inner_count = 1, .interfaces = s->interfaces, .sections = s->sections, .csg = s->csg,
        .tiles = s->tiles, .sweeps = s->sweeps, .inners = s->inners};
}

/* Side 0 of each face looks to +x; every third slot has the second tile. */
static inline void scene_fixture_surface(SceneFixture *s, uint32_t n)
{
    MesoError error;
    uint32_t w = n + 1;
    MesoVec3 *positions = MESO_NEW(&s->arena, MesoVec3, (size_t)w * w, &error);
    uint32_t *corners = MESO_NEW(&s->arena, uint32_t, (size_t)4 * n * n, &error);
    uint32_t *tile = MESO_NEW(&s->arena, uint32_t, (size_t)n * n, &error);
    MesoTransform *transform = MESO_NEW(&s->arena, MesoTransform, (size_t)n * n, &error);
    CHECK(positions && corners && tile && transform);
    for (uint32_t i = 0; i < w * w; i++) {
        float x = (float)(i % w), y = (float)(i / w);
        positions[i] = (MesoVec3){x, y, 0.4f * sinf(0.7f * x) * cosf(0.5f * y)};
    }
    for (uint32_t f = 0; f < n * n; f++) {
        uint32_t at = f % n + f / n * w;
        uint32_t face[4] = {at + 1, at + 1 + w, at + w, at};
        memcpy(corners + 4 * (size_t)f, face, sizeof face);
        tile[f] = f % 3 == 2;
    }
    CHECK(meso_quad_mesh_build(&s->model.surface, &s->arena, w * w, positions, 0, NULL, n * n, corners,
                               NULL, &error) == MESO_OK);
    CHECK(meso_slot_graph_build(&s->model.graph, &s->arena, &s->model.surface, &error) == MESO_OK);
    s->model.assignment = (MesoAssignment){n * n, tile, transform};
}

/* n x n slots; released by scene_fixture_release(). */
static inline void scene_fixture_init(SceneFixture *s, uint32_t n, uint32_t divisions, float section_step)
{
    MesoError error;
    *s = (SceneFixture){0};
    meso_arena_init(&s->arena);
    scene_fixture_tiles(s);
    scene_fixture_surface(s, n);
    s->model.options = (MesoMapOptions){.divisions = divisions, .section_step = section_step};
    CHECK(meso_model_expand(&s->scene, NULL, &s->arena, &s->model, 2, &error) == MESO_OK);
    CHECK(meso_scene_parts_init(&s->parts, &s->arena, &s->scene, &error) == MESO_OK);
}

static inline void scene_fixture_release(SceneFixture *s)
{
    meso_arena_release(&s->arena);
}

/* A triangle with colours, in three channels: of names, of numbers, and of names again. */
typedef struct ColoredFixture {
    MesoVec3 positions[3], normals[3];
    MesoMeshColor colors[3];
    uint32_t corners[3], ids[6];
    const char *names[3][2];
    MesoMaterial material;
    MesoBody body;
    MesoPlacedBody placed;
    MesoScene scene;
} ColoredFixture;

static inline void colored_fixture_init(ColoredFixture *c)
{
    *c = (ColoredFixture){.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                   .colors = {{255, 0, 0}, {0, 51, 0}, {0, 0, 102}}, .corners = {0, 1, 2},
                   .ids = {0, 0, 0, 1, 70000, 0},
                   .material = {.albedo = {1, 1, 1}},
                   .names = {{"leaf", "stem one"}, {"green", "dry"}, {"paint", NULL}}};
    c->body = (MesoBody){3, 1, 3, c->positions, c->normals, NULL, c->colors, c->corners};
    c->placed = (MesoPlacedBody){.ids = 1};
    c->scene = (MesoScene){.channel_count = 3,
        .channels = {{"region", 2, c->names[0]}, {"element", 70001, NULL}, {"state", 2, c->names[1]}},
        .material_count = 1, .materials = &c->material, .material_names = c->names[2], .id_row_count = 2,
        .ids = c->ids, .body_count = 1, .bodies = &c->body, .placed_count = 1, .placed = &c->placed};
}

#endif
