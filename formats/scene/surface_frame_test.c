/* Lengths of a straight tube against its formula; tangents that run as u does; both in the rows of a GLB. */
#include <jansson.h>

#include "formats/scene/mesh_file_fixture.h"
#include "formats/scene/surface_frame.h"

/* A quad patch over [0,2] x [0,3] whose u runs along +y and v along +x, or -x. */
static void test_patch(float sign)
{
    const MesoVec3 up = {0, 0, 1};
    const MesoMeshVertex vertices[4] = {{{0, 0, 0}, up, {0, 0}}, {{2, 0, 0}, up, {0, sign}},
                                        {{2, 3, 0}, up, {1, sign}}, {{0, 3, 0}, up, {1, 0}}};
    const MesoMeshFace face = {{0, 1, 2, 3}};
    MesoTangent tangents[4];
    meso_surface_tangents(4, vertices, 1, &face, tangents);
    for (int i = 0; i < 4; i++) {
        CHECK(fabsf(tangents[i].x) < 1e-6f && fabsf(tangents[i].y - 1) < 1e-6f && fabsf(tangents[i].z) < 1e-6f);
        CHECK(tangents[i].w == -sign);      /* cross(z, y) is -x */
    }
}

/* Without texture coordinates. */
static void test_blank(void)
{
    const MesoMeshVertex vertices[3] = {{{0, 0, 0}, {1, 0, 0}, {0, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0}},
                                        {{0, 0, 1}, {1, 0, 0}, {0, 0}}};
    const MesoMeshFace face = {{0, 1, 2, MESO_NO_INDEX}};
    MesoTangent t[3];
    meso_surface_tangents(3, vertices, 1, &face, t);
    CHECK(fabsf(t[0].x) < 1e-6f && fabsf(t[0].y * t[0].y + t[0].z * t[0].z - 1) < 1e-6f && t[0].w == 1);
}

static void check_sweep(const SceneFixture *fixture, uint32_t part, const MesoMeshVertex *vertices,
                        const MesoVec2 *lengths, const MesoTangent *tangents)
{
    const MesoSweptKind *kind = &fixture->scene.kinds[meso_scene_kind(&fixture->scene, part)];
    const MesoSweepColumn *columns = fixture->scene.columns + kind->column_begin;
    const uint32_t width = kind->column_count, count = width * kind->division_count;
    for (uint32_t i = 0; i < count; i++) {
        const MesoTangent *t = &tangents[i];
        MesoVec3 along = {t->x, t->y, t->z};
        CHECK(fabsf(meso_vec3_length(along) - 1) < 1e-5f && fabsf(t->w) == 1);
        CHECK(fabsf(meso_vec3_dot(along, vertices[i].normal)) < 1e-5f);
        CHECK(i < width ? lengths[i].y == 0 : lengths[i].y >= lengths[i - width].y);
        if (i % width + 1 == width || !columns[i % width].joins_next || kind->cap)
            continue;
        MesoVec3 step = meso_vec3_sub(vertices[i + 1].position, vertices[i].position);
        CHECK(meso_vec3_dot(step, along) > 0);
        CHECK(fabsf(lengths[i + 1].x - lengths[i].x - meso_vec3_length(step)) < 1e-5f);
    }
}

static void test_sweeps(SceneFixture *fixture)
{
    const MesoSceneParts *t = &fixture->parts;
    MesoMeshVertex *vertices = MESO_NEW(&fixture->arena, MesoMeshVertex, 1 << 14, NULL);
    MesoMeshFace *faces = MESO_NEW(&fixture->arena, MesoMeshFace, 1 << 14, NULL);
    MesoVec2 *lengths = MESO_NEW(&fixture->arena, MesoVec2, 1 << 14, NULL);
    MesoTangent *tangents = MESO_NEW(&fixture->arena, MesoTangent, 1 << 14, NULL);
    CHECK(vertices && faces && lengths && tangents);
    for (uint32_t part = 0; part < t->part_count; part++) {
        uint64_t count = t->vertex_begin[part + 1] - t->vertex_begin[part];
        CHECK(count < 1 << 14);
        meso_scene_vertices(t, part, part + 1, vertices);
        meso_scene_faces(t, part, part + 1, 0, faces);
        meso_surface_lengths(t, part, vertices, lengths);
        meso_surface_tangents(count, vertices, t->face_begin[part + 1] - t->face_begin[part], faces, tangents);
        if (part < fixture->scene.sweep_count)
            check_sweep(fixture, part, vertices, lengths, tangents);
        else
            CHECK(memcmp(lengths, &(MesoVec2){0, 0}, sizeof *lengths) == 0);
    }
}

/* Columns at x 0 to 4 and rings at y 0 to 3, some of which lack some columns. */
static void test_absent(void)
{
    enum { WIDTH = 5, RINGS = 4, GUARD = 4 };
    static const uint32_t absent[WIDTH] = {0, MESO_ABSENT_BETWEEN, MESO_ABSENT_START | MESO_ABSENT_END,
                                           MESO_ABSENT_START | MESO_ABSENT_BETWEEN, 0};
    MesoSweepColumn columns[WIDTH] = {{.joins_next = 1}};
    MesoMeshVertex vertices[WIDTH * RINGS];
    MesoVec2 lengths[WIDTH * RINGS + GUARD];
    uint64_t begin[2] = {0, 0};
    for (uint32_t c = 0; c < WIDTH; c++) {
        columns[c].joins_next = c + 1 < WIDTH;
        columns[c].absent = absent[c];
    }
    for (uint32_t ring = 0; ring < RINGS; ring++)
        for (uint32_t c = 0; c < WIDTH; c++)
            if (!(absent[c] & (ring == 0 ? MESO_ABSENT_START : ring + 1 == RINGS ? MESO_ABSENT_END
                                                                                  : MESO_ABSENT_BETWEEN)))
                vertices[begin[1]++] = (MesoMeshVertex){.position = {(float)c, (float)ring, 0}};
    for (uint64_t i = 0; i < begin[1] + GUARD; i++)
        lengths[i] = (MesoVec2){-1, -1};
    MesoSweptKind kind = {.column_count = WIDTH, .division_count = RINGS, .absent = {2, 1, 2}, .instance_count = 1};
    MesoScene scene = {.kinds = &kind, .kind_count = 1, .columns = columns, .column_count = WIDTH, .sweep_count = 1};
    MesoSceneParts parts = {.scene = &scene, .part_count = 1, .vertex_begin = begin};
    meso_surface_lengths(&parts, 0, vertices, lengths);
    for (uint64_t i = 0; i < begin[1]; i++)
        CHECK(lengths[i].x == vertices[i].position.x && lengths[i].y == vertices[i].position.y);
    for (uint64_t i = begin[1]; i < begin[1] + GUARD; i++)
        CHECK(lengths[i].x == -1);
}

/* The first row of the first material: that of the first part of it. */
static void test_rows(SceneFixture *fixture)
{
    const MesoMeshWriteOptions options = {.lengths = true, .tangents = true};
    MesoMeshVertex vertices[1024], first;
    MesoMeshFace faces[1024];
    MesoTangent tangents[1024], tangent;
    MesoVec2 length[2];
    const MesoSceneParts *t = &fixture->parts;
    MesoInput input = write_mesh_as(meso_glb_write, t, &options, 2, path_of("x.glb"));
    uint32_t json_size;
    memcpy(&json_size, input.data + 12, 4);
    json_t *root = json_loadb((const char *)input.data + 20, json_size, 0, NULL);
    const json_t *view = json_array_get(json_object_get(root, "bufferViews"), 0);
    CHECK(json_integer_value(json_object_get(view, "byteStride")) == 64);
    const uint8_t *row = input.data + 28 + json_size;
    CHECK(meso_scene_part(t, 0).material == 0 && t->vertex_begin[1] <= 1024 && t->face_begin[1] <= 1024);
    meso_scene_vertices(t, 0, 1, vertices);
    meso_scene_faces(t, 0, 1, 0, faces);
    meso_surface_tangents(t->vertex_begin[1], vertices, t->face_begin[1], faces, tangents);
    for (uint64_t v = 0; v < t->vertex_begin[1]; v++, row += 64) {
        memcpy(&first, row, sizeof first);
        memcpy(length, row + 40, sizeof *length);
        memcpy(&tangent, row + 48, sizeof tangent);
        CHECK(memcmp(&first, &vertices[v], sizeof first) == 0 && memcmp(&tangent, &tangents[v], sizeof tangent) == 0);
        CHECK(length[0].x >= 0 && length[0].y >= 0);
    }
    check_threads_as(meso_glb_write, t, &options, &input);
    json_decref(root);
    meso_input_close(&input);
}

int main(void)
{
    SceneFixture fixture;
    CHECK(mkdtemp(folder));
    test_patch(1);
    test_patch(-1);
    test_blank();
    test_absent();
    scene_fixture_init(&fixture, 4, 7, 0.05f);
    test_sweeps(&fixture);
    test_rows(&fixture);
    scene_fixture_release(&fixture);
    static const char *const products[] = {"x.glb", "again"};
    remove_products(products, 2);
    return 0;
}
