/* A small tile set on small surfaces, expanded and cut into polygons, for the tests of strands. */
#ifndef MESO_EXPANSION_FIXTURE_H
#define MESO_EXPANSION_FIXTURE_H

#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/scene/parts.h"
#include "libcore/tiling/strand/expansion.h"

/* ---- a tile set: two interfaces of lopsided drawings, a straight and a bent sweep, a cap ----
 *
 *            side 1 (b)
 *        +------|------+
 *        |      |      |
 *  a' -->+------+      +--> a      a has a second cross-section that only a cap closes
 *        |      |      |
 *        +------|------+
 *            side 3 (b')
 */
typedef struct Case {
    MesoCsgNode csg[6];
    MesoSection sections[4];
    MesoInterface interfaces[2];
    MesoSweep sweeps[3];
    MesoTile tiles[1];
    MesoInnerMesh inners[1];
    MesoTriangleMesh inner_mesh;
    MesoVec3 inner_positions[4], inner_normals[4];
    uint32_t inner_triangles[12];
    MesoModel model;
    MesoTileSet set;
} Case;

static const MesoMaterial GREY = {{0.5f, 0.5f, 0.5f}, 0.5f, 0};

static inline void make_tile_set(Case *s)
{
    s->csg[0] = (MesoCsgNode){MESO_CSG_BOX, 0, 0, {0.3f, 0.6f}, {0.2f, 0.1f}, 0.4f};
    s->csg[1] = (MesoCsgNode){MESO_CSG_DISC, 0, 0, {0.35f, 0.6f}, {0.1f, 0.08f}, 0};
    s->csg[2] = (MesoCsgNode){MESO_CSG_UNION, 0, 1, {0, 0}, {0, 0}, 0};
    s->csg[3] = (MesoCsgNode){MESO_CSG_DISC, 0, 0, {0.6f, 0.3f}, {0.1f, 0.2f}, 0.2f};
    s->csg[4] = (MesoCsgNode){MESO_CSG_BOX, 0, 0, {0.8f, 0.4f}, {0.1f, 0.1f}, 0};
    s->csg[5] = (MesoCsgNode){MESO_CSG_DISC, 0, 0, {0.4f, 0.55f}, {0.1f, 0.1f}, 0};
    s->sections[0] = (MesoSection){"1", 0, 2, GREY};
    s->sections[1] = (MesoSection){"2", 0, 4, GREY};
    s->sections[2] = (MesoSection){"1", 1, 3, GREY};
    s->sections[3] = (MesoSection){"2", 1, 5, GREY};
    s->interfaces[0] = (MesoInterface){"a", 0, 2, {0, 0, 0}, false, false};
    s->interfaces[1] = (MesoInterface){"b", 2, 2, {0, 0, 0}, false, false};
    s->sweeps[0] = (MesoSweep){.from_side = 0, .to_side = 2};
    s->sweeps[1] = (MesoSweep){.from_side = 1, .to_side = 0, .from_section = 2, .to_section = 1, .turn = 0.13f};
    s->sweeps[2] = (MesoSweep){.from_side = 3, .to_side = 1, .from_section = 3, .to_section = 3, .half_turn = true};
    s->tiles[0] = (MesoTile){.name = "t", .side_count = 4, .labels = {1, 2, -1, -2}, .sweep_count = 3,
                             .inner_count = 1, .flip_x = true, .flip_y = true, .rotation = true};
    s->inners[0] = (MesoInnerMesh){"x", {0.2f, 0, 0.1f, 0.4f, 0, 0.3f, 0, 0.3f, 0, 0, 0.4f, 0.2f}, GREY};
    s->set = (MesoTileSet){.interface_count = 2, .section_count = 4, .csg_count = 6, .tile_count = 1,
                           .sweep_count = 3, .inner_count = 1, .interfaces = s->interfaces,
                           .sections = s->sections, .csg = s->csg, .tiles = s->tiles,
                           .sweeps = s->sweeps, .inners = s->inners};

    /* A tetrahedron, faces outward. */
    static const uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    static const MesoVec3 positions[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memcpy(s->inner_triangles, triangles, sizeof triangles);
    memcpy(s->inner_positions, positions, sizeof positions);
    for (int i = 0; i < 4; i++)
        s->inner_normals[i] = meso_vec3_unit(meso_vec3_sub(positions[i], (MesoVec3){0.25f, 0.25f, 0.25f}),
                                             (MesoVec3){0, 0, 1});
    s->inner_mesh = (MesoTriangleMesh){4, 4, s->inner_positions, s->inner_normals, s->inner_triangles};
}

/* A bumpy n x n grid, shared corners and normals; side 0 of each face looks to +x. */
static inline void make_grid(Case *s, MesoArena *arena, uint32_t n, uint32_t *tile, MesoTransform *transform)
{
    MesoError error;
    MesoRandom random;
    meso_random_init(&random, 7, 0);
    uint32_t w = n + 1;
    MesoVec3 positions[64];
    uint32_t corners[4 * 49];
    CHECK(w * w <= 64);
    for (uint32_t i = 0; i < w * w; i++) {
        float jitter[3];
        for (int k = 0; k < 3; k++)
            jitter[k] = ((float)meso_random_below(&random, 1000) / 1000 - 0.5f) * 0.3f;
        positions[i] = (MesoVec3){(float)(i % w) + jitter[0], (float)(i / w) + jitter[1], jitter[2]};
    }
    for (uint32_t f = 0; f < n * n; f++) {
        uint32_t at = f % n + f / n * w;
        uint32_t face[4] = {at + 1, at + 1 + w, at + w, at};
        memcpy(corners + 4 * f, face, sizeof face);
    }
    CHECK(meso_quad_mesh_build(&s->model.surface, arena, w * w, positions, 0, NULL, n * n, corners, NULL,
                               &error) == MESO_OK);
    CHECK(meso_slot_graph_build(&s->model.graph, arena, &s->model.surface, NULL) == MESO_OK);
    s->model.tile_set = s->set;
    s->model.assignment = (MesoAssignment){n * n, tile, transform};
    s->model.inner_meshes = &s->inner_mesh;
    s->model.options = (MesoMapOptions){.divisions = 9, .section_step = 0.02f};
}

static inline MesoScene expand(const MesoModel *model, MesoExpansion *expansion, MesoArena *arena)
{
    MesoScene scene;
    MesoError error;
    CHECK(meso_model_expand(&scene, expansion, arena, model, 2, &error) == MESO_OK);
    return scene;
}

static inline MesoMeshVertex *make_polygons(const MesoScene *scene, MesoArena *arena, MesoSceneParts *t,
                                     MesoMeshFace **faces)
{
    MesoError error;
    CHECK(meso_scene_parts_init(t, arena, scene, &error) == MESO_OK);
    MesoMeshVertex *vertices = MESO_NEW(arena, MesoMeshVertex, t->vertex_begin[t->part_count], &error);
    *faces = MESO_NEW(arena, MesoMeshFace, t->face_begin[t->part_count], &error);
    meso_scene_vertices(t, 0, t->part_count, vertices);
    meso_scene_faces(t, 0, t->part_count, 0, *faces);
    return vertices;
}

/* Ring of part `part` at its start or end. */
static inline const MesoMeshVertex *ring(const MesoSceneParts *t, const MesoMeshVertex *vertices, uint32_t part,
                                  bool end, uint32_t *count)
{
    const MesoSweptKind *kind = &t->scene->kinds[meso_scene_kind(t->scene, part)];
    *count = kind->column_count - kind->absent[end];
    return vertices + (end ? t->vertex_begin[part + 1] - *count : t->vertex_begin[part]);
}

#endif
