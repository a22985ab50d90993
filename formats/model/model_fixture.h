/* A small model made in memory, for the tests and fuzzers of the files that hold one. */
#ifndef MESO_MODEL_FIXTURE_H
#define MESO_MODEL_FIXTURE_H

#include "formats/json/json_text.h"
#include "formats/model/model_file.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/base/check.h"

static const char model_fixture_tiles[] =
    "{\"format\": \"meso-tiles\", \"version\": 1, \"defaults\": {\"rotation\": true},"
    " \"interfaces\": [{\"name\": \"a\", \"border\": \"any\", \"sections\": [{\"name\": \"1\","
    "   \"albedo\": [0.5, 0.25, 0.1], \"shape\": {\"disc\": {\"center\": [0.5, 0.5], \"size\": [0.1, 0.2]}}}]}],"
    " \"tiles\": [{\"name\": \"plain\", \"sides\": [\"a\", \"a\", \"a'\", \"a'\"], \"sweeps\":"
    "   [{\"from\": \"0/1\", \"to\": \"2/1\"}, {\"from\": \"1/1\", \"to\": \"3/1\", \"turn\": 0.3}]},"
    "  {\"name\": \"bead\", \"sides\": [\"a\", \"a\", \"a'\", \"a'\"], \"inner\": [{\"mesh\": \"bead.obj\"}]}]}";

/* Two faces side by side, the second higher at its far end:
 *
 *     3---4---5
 *     |   |   |
 *     0---1---2
 */
static inline void model_fixture_surface(MesoQuadMesh *mesh, MesoArena *arena)
{
    static const MesoVec3 positions[6] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0.3f},
                                          {0, 1, 0}, {1, 1, 0}, {2, 1, 0.7f}};
    static const uint32_t faces[8] = {0, 1, 4, 3, 1, 2, 5, 4};
    CHECK(meso_quad_mesh_build(mesh, arena, 6, positions, 0, NULL, 2, faces, NULL, NULL) == MESO_OK);
}

static inline void model_fixture_tile_set(MesoTileSet *set, MesoArena *arena)
{
    MesoInput input;
    MesoError error;
    meso_input_wrap(&input, "fixture", model_fixture_tiles, sizeof model_fixture_tiles - 1);
    if (meso_tiles_read(set, arena, &input, &error) != MESO_OK) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
}

static inline MesoModel model_fixture(MesoArena *arena)
{
    static const MesoVec3 points[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const MesoVec3 normals[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    static const uint32_t triangle[3] = {0, 1, 2};
    static uint32_t tiles[2] = {1, 0};
    static MesoTransform transforms[2] = {0, 0};
    MesoModel model = {.options = {.offset = 0.25f, .divisions = 7}};
    model_fixture_tile_set(&model.tile_set, arena);
    model_fixture_surface(&model.surface, arena);
    CHECK(meso_slot_graph_build(&model.graph, arena, &model.surface, NULL) == MESO_OK);
    model.assignment = (MesoAssignment){2, tiles, transforms};
    model.inner_meshes = MESO_NEW(arena, MesoTriangleMesh, 1, NULL);
    CHECK(model.inner_meshes);
    *model.inner_meshes = (MesoTriangleMesh){
        3, 1, (MesoVec3 *)(uintptr_t)points, (MesoVec3 *)(uintptr_t)normals,
        (uint32_t *)(uintptr_t)triangle};
    return model;
}

static inline MesoProvenance model_fixture_provenance(void)
{
    return (MesoProvenance){
        .tool = "meso-try", .command_line = "meso-try 'a b'", .seed = 5,
        .input_count = 1, .inputs = {{.role = "tiles", .hash = {1, 2}, .name = "xyz"}},
    };
}

#endif
