/*
 * Any bytes as a tile set that goes the whole way: variants, a solve on two small
 * surfaces, scene, polygons, a mesh file. What a tile set's reader accepts,
 * everything after takes or refuses; what is written is finite.
 */
#include <math.h>
#include <string.h>

#include "formats/scene/mesh_file.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/base/check.h"
#include "libcore/tiling/solve/solve.h"
#include "libcore/tiling/strand/expansion.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SIDE = 3, MOST_VERTICES = 1 << 18 };

/* SIDE x SIDE wavy quads; joined to a torus, or open. */
static void make_surface(MesoQuadMesh *mesh, MesoArena *arena, bool torus)
{
    uint32_t width = torus ? SIDE : SIDE + 1, faces[4 * SIDE * SIDE], *face = faces;
    MesoVec3 positions[(SIDE + 1) * (SIDE + 1)];
    MesoError error;
    for (uint32_t i = 0; i < width * width; i++) {
        float x = (float)(i % width), y = (float)(i / width), u = 2.0944f * x, v = 2.0944f * y;
        positions[i] = torus ? (MesoVec3){(2 + cosf(v)) * cosf(u), (2 + cosf(v)) * sinf(u), sinf(v)}
                             : (MesoVec3){x, y, 0.3f * sinf(x) * cosf(y)};
    }
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++, face += 4) {
            uint32_t right = (x + 1) % width, up = (y + 1) % width;
            const uint32_t corners[4] = {x + y * width, right + y * width, right + up * width, x + up * width};
            memcpy(face, corners, sizeof corners);
        }
    CHECK(meso_quad_mesh_build(mesh, arena, width * width, positions, 0, NULL, SIDE * SIDE, faces, NULL, &error) ==
          MESO_OK);
}

/* Each tile's mesh, whatever its name, is a tetrahedron. */
static void add_meshes(MesoModel *model, MesoArena *arena)
{
    static MesoVec3 positions[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static MesoVec3 normals[4] = {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    uint32_t count = model->tile_set.inner_count;
    model->inner_meshes = MESO_NEW(arena, MesoTriangleMesh, count, NULL);
    CHECK(model->inner_meshes);
    for (uint32_t i = 0; i < count; i++)
        model->inner_meshes[i] = (MesoTriangleMesh){4, 4, positions, normals, triangles};
}

static bool solve(MesoModel *model, const MesoVariantSet *variants, MesoArena *arena)
{
    const MesoSolveOptions options = {.seed = 1, .max_attempts = 2, .max_observations = 1000, .max_conflicts = 100,
                                      .max_dead_ends = 1};
    MesoSolveResult result;
    MesoError error;
    CHECK(meso_slot_graph_build(&model->graph, arena, &model->surface, &error) == MESO_OK);
    MesoStatus status = meso_solve(&result, arena,
                                   &(MesoTilingProblem){&model->tile_set, variants, &model->graph, NULL},
                                   &options, &error);
    CHECK(status == MESO_OK || status == MESO_ERR_LIMIT);
    if (status || result.verdict != MESO_VERDICT_SOLVED)
        return false;
    model->assignment = result.assignment;
    return true;
}

static void write_mesh(const MesoSceneParts *t, MesoArena *arena)
{
    const MesoProvenance provenance = {.tool = "fuzz", .command_line = "fuzz"};
    uint64_t count = t->vertex_begin[t->part_count];
    const MesoMeshWriteOptions options = {.thread_count = 1, .speed = 10, .provenance = &provenance,
                                          .compression = count % 2 ? MESO_GLB_PLAIN : MESO_GLB_DRACO};
    MesoOutput *output;
    MesoError error;
    MesoMeshVertex *vertices = MESO_NEW(arena, MesoMeshVertex, count, &error);
    CHECK(vertices);
    meso_scene_vertices(t, 0, t->part_count, vertices);
    for (uint64_t v = 0; v < count; v++)
        CHECK(meso_vec3_finite(vertices[v].position) && meso_vec3_finite(vertices[v].normal) &&
              isfinite(vertices[v].uv.x) && isfinite(vertices[v].uv.y));
    CHECK(meso_output_open(&output, "/dev/null", &error) == MESO_OK);
    MesoStatus status = meso_glb_write(t, &options, output, &error);
    CHECK(status == MESO_OK || status == MESO_ERR_INPUT || status == MESO_ERR_LIMIT);
    meso_output_discard(output);
}

static void grow(const MesoTileSet *set, const MesoVariantSet *variants, bool torus)
{
    MesoModel model = {.tile_set = *set};   /* of fine strands on the torus, of coarse ones on the sheet */
    if (!torus)
        model.options = (MesoMapOptions){.divisions = 2, .section_step = 0.4f, .tangent_scale = 3};
    MesoScene scene;
    MesoSceneParts parts;
    MesoError error;
    MesoArena arena;
    meso_arena_init(&arena);
    make_surface(&model.surface, &arena, torus);
    add_meshes(&model, &arena);
    if (solve(&model, variants, &arena)) {
        MesoStatus status = meso_model_expand(&scene, NULL, &arena, &model, 1, &error);
        CHECK(status == MESO_OK || status == MESO_ERR_INPUT || status == MESO_ERR_LIMIT);
        if (!status && meso_scene_parts_init(&parts, &arena, &scene, &error) == MESO_OK &&
            parts.vertex_begin[parts.part_count] <= MOST_VERTICES)
            write_mesh(&parts, &arena);
    }
    meso_arena_release(&arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    MesoArena arena;
    MesoInput input;
    MesoTileSet set;
    MesoVariantSet variants;
    MesoError error;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", data, size);
    if (meso_tiles_read(&set, &arena, &input, &error) == MESO_OK) {
        CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
        grow(&set, &variants, false);
        grow(&set, &variants, true);
    }
    meso_arena_release(&arena);
    return 0;
}
