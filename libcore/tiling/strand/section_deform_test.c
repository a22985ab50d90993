/*
 * Sections that deform with their slots: volumes in slots that are boxes, sheared and tapered, against formulas; what
 * lies in a side of two slots, to the bit; faces and boxes. (Rings and tolerances: the tests of these.)
 */
#include <math.h>

#include "libcore/tiling/strand/expansion_fixture.h"

typedef struct Meshed {
    MesoExpansion expansion;
    MesoScene scene;
    MesoSceneParts parts;
    MesoMeshFace *faces;
    const MesoMeshVertex *vertices;
} Meshed;

static void mesh(Meshed *m, const MesoModel *model, MesoArena *arena)
{
    m->scene = expand(model, &m->expansion, arena);
    m->vertices = make_polygons(&m->scene, arena, &m->parts, &m->faces);
}

/* One slot over these corners, along whose x axis a disc of radius 0.2 is swept through the middle. */
static void make_slot(Case *s, MesoArena *arena, const MesoVec3 corners[4], float height)
{
    static uint32_t tile[1];
    static MesoTransform transform[1];
    const MesoVec3 up = {0, 0, 1};
    const uint32_t numbers[4] = {0, 1, 2, 3}, normals[4] = {0, 0, 0, 0};
    make_tile_set(s);
    s->csg[2] = (MesoCsgNode){MESO_CSG_DISC, 0, 0, {0.5f, 0.5f}, {0.4f, 0.4f}, 0};
    s->tiles[0].sweep_count = 1;
    make_grid(s, arena, 1, tile, transform);
    CHECK(meso_quad_mesh_build(&s->model.surface, arena, 4, corners, 1, &up, 1, numbers, normals, NULL) == MESO_OK);
    CHECK(meso_slot_graph_build(&s->model.graph, arena, &s->model.surface, NULL) == MESO_OK);
    s->model.options = (MesoMapOptions){.deform = MESO_SWEEP_SHAPE, .thickness = 2 * height, .section_step = 0.01f,
                                        .divisions = 9};
}

/* Of the first sweep, whose ends are closed by fans. */
static double sweep_volume(const Meshed *m)
{
    double sum = 0;
    for (uint64_t f = 0; f < m->parts.face_begin[1]; f++)
        for (int k = 2; k < 4 && m->faces[f].v[k] != MESO_NO_INDEX; k++)
            sum += (double)meso_vec3_dot(m->vertices[m->faces[f].v[0]].position,
                                         meso_vec3_cross(m->vertices[m->faces[f].v[k - 1]].position,
                                                         m->vertices[m->faces[f].v[k]].position));
    for (uint32_t end = 0; end < 2; end++) {
        uint32_t count;
        const MesoMeshVertex *r = ring(&m->parts, m->vertices, 0, end, &count);
        for (uint32_t i = 1; i + 1 < count; i++)
            sum += (end ? -1 : 1) * (double)meso_vec3_dot(r[0].position,
                                                           meso_vec3_cross(r[i].position, r[i + 1].position));
    }
    return fabs(sum) / 6;
}

/* The volume is the cell's, with its disc of radius 0.2, times the determinant; or its integral along x. */
static void test_volumes(MesoArena *arena)
{
    static const struct {
        MesoVec3 corners[4];
        float height;
        double determinant;
    } slots[] = {
        {{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, 0.5f, 1},
        {{{2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 0, 0}}, 1, 4},                     /* a box: an ellipse of 0.2 by 0.4 */
        {{{2, 0, 0}, {2.7f, 1, 0}, {0.7f, 1, 0}, {0, 0, 0}}, 1, 4},               /* sheared */
        {{{2, -0.25f, 0}, {2, 0.25f, 0}, {0, 0.5f, 0}, {0, -0.5f, 0}}, 0.5f, 2 * 0.75},     /* tapered by half */
    };
    for (uint32_t i = 0; i < sizeof slots / sizeof *slots; i++) {
        Case s = {0};
        Meshed m;
        make_slot(&s, arena, slots[i].corners, slots[i].height);
        mesh(&m, &s.model, arena);
        double expected = MESO_PI * 0.04 * slots[i].determinant;
        CHECK(fabs(sweep_volume(&m) - expected) < 1e-3 * expected);
        s.model.options.deform = MESO_SWEEP_CURVES;
        mesh(&m, &s.model, arena);
        CHECK(i == 0 || fabs(sweep_volume(&m) - expected) > 0.1 * expected);
    }
}

/* Middle and radii of the sweep at its start in the box slot: an ellipse twice as high as it is wide. */
static void test_ellipse(MesoArena *arena)
{
    const MesoVec3 corners[4] = {{2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 0, 0}};
    Case s = {0};
    Meshed m;
    uint32_t count;
    make_slot(&s, arena, corners, 1);
    mesh(&m, &s.model, arena);
    const MesoMeshVertex *r = ring(&m.parts, m.vertices, 0, false, &count);
    for (uint32_t i = 0; i < count; i++) {
        double y = ((double)r[i].position.y - 0.5) / 0.2, z = ((double)r[i].position.z - 0.5) / 0.4;
        CHECK(r[i].position.x == 2 && fabs(y * y + z * z - 1) < 1e-3);
        MesoVec3 normal = meso_vec3_direction((MesoVec3){0, (float)y / 0.2f, (float)z / 0.4f}, r[i].normal);
        CHECK(meso_vec3_dot(normal, r[i].normal) > 0.999f);
    }
}

/* An inner mesh whose corners lie in the sides, where its neighbours' do: 1 - 0.3 is not 0.7 in floats. */
static void test_inner_meshes(MesoArena *arena)
{
    static const MesoVec3 corners[4] = {{0, 0.3f, 0.1f}, {1, 0.7f, 0.1f}, {1, 0.3f, 0.1f}, {0, 0.7f, 0.1f}};
    uint32_t tile[9] = {0}, met[2] = {0, 0};
    MesoTransform transform[9] = {0};
    for (uint32_t flat = 0; flat < 2; flat++) {
        Case s = {0};
        Meshed m;
        make_tile_set(&s);
        memcpy(s.inner_positions, corners, sizeof corners);
        s.inners[0] = (MesoInnerMesh){"x", {1, 0, 0, 3e-8f, 0, 1, 0, 0, 0, 0, 1, 0}, GREY};
        make_grid(&s, arena, 3, tile, transform);
        s.model.options.deform = MESO_SWEEP_SHAPE;
        s.model.options.normals = flat ? MESO_NORMALS_FLAT : MESO_NORMALS_FILE;
        mesh(&m, &s.model, arena);
        uint64_t begin = m.parts.vertex_begin[m.scene.sweep_count], end = m.parts.vertex_begin[m.parts.part_count];
        for (uint64_t i = begin; i < end; i++)
            for (uint64_t k = i + 1; k < end; k++) {
                MesoVec3 a = m.vertices[i].position, b = m.vertices[k].position;
                met[flat] += a.x == b.x && a.y == b.y && a.z == b.z;
            }
    }
    CHECK(met[0] == 2 * 6 && met[1] == 2 * 6);      /* two places on each of the six sides between columns */
}

/* Each face looks where its normals point, however the tile is turned; and each sweep lies in the scene's box. */
static void test_faces(MesoArena *arena)
{
    for (MesoTransform transform = 0; transform < MESO_TRANSFORM_COUNT; transform++) {
        Case s = {0};
        Meshed m;
        uint32_t tile[1] = {0};
        make_tile_set(&s);
        make_grid(&s, arena, 1, tile, &transform);
        s.model.options.deform = MESO_SWEEP_SHAPE;
        mesh(&m, &s.model, arena);
        for (uint64_t f = 0; f < m.parts.face_begin[m.parts.part_count]; f++) {
            const MesoMeshFace *face = &m.faces[f];
            MesoVec3 a = m.vertices[face->v[0]].position, sum = {0, 0, 0};
            MesoVec3 area = meso_vec3_cross(meso_vec3_sub(m.vertices[face->v[1]].position, a),
                                            meso_vec3_sub(m.vertices[face->v[2]].position, a));
            for (int k = 0; k < 3; k++)
                sum = meso_vec3_add(sum, m.vertices[face->v[k]].normal);
            CHECK(meso_vec3_dot(area, sum) >= 0);
        }
        for (uint64_t v = 0; v < m.parts.vertex_begin[m.scene.sweep_count]; v++) {
            MesoVec3 p = m.vertices[v].position, low = m.scene.box.low, high = m.scene.box.high;
            CHECK(p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z);
        }
    }
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_volumes(&arena);
    test_ellipse(&arena);
    test_inner_meshes(&arena);
    test_faces(&arena);
    meso_arena_release(&arena);
    return 0;
}
