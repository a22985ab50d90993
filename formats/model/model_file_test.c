/* Model files: round trip to the bit, every kind of wrong chunk, every damaged byte. */
#include "formats/model/model_file.h"

#include "formats/file/container_fixture.h"
#include "formats/file/packed_chunk.h"
#include "formats/model/model_fixture.h"
#include "libcore/tiling/relax/relax.h"

static MesoArena arena;
static TestFolder folder;

static void write_file(const MesoModel *model, const char *path)
{
    MesoProvenance provenance = model_fixture_provenance();
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_model_write(model, &provenance, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
}

static void check_same_surface(const MesoQuadMesh *a, const MesoQuadMesh *b)
{
    CHECK(a->vertex_count == b->vertex_count && a->face_count == b->face_count);
    CHECK(a->normal_count == b->normal_count && a->mean_edge_length == b->mean_edge_length);
    CHECK(memcmp(a->positions, b->positions, a->vertex_count * sizeof(MesoVec3)) == 0);
    CHECK(memcmp(a->normals, b->normals, a->normal_count * sizeof(MesoVec3)) == 0);
    CHECK(memcmp(a->face_vertices, b->face_vertices, 16 * (size_t)a->face_count) == 0);
    CHECK(memcmp(a->face_normals, b->face_normals, 16 * (size_t)a->face_count) == 0);
}

static void test_round_trip(void)
{
    MesoModel model = model_fixture(&arena), back;
    const char *path = test_path(&folder, "a.meso"), *provenance;
    MesoInput input;
    MesoError error;
    write_file(&model, path);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_model_read(&back, &provenance, &arena, &input, &error) == MESO_OK);
    meso_input_close(&input);

    check_same_surface(&model.surface, &back.surface);
    CHECK(back.assignment.slot_count == 2);
    CHECK(back.assignment.tile[0] == 1 && back.assignment.tile[1] == 0);
    CHECK(back.assignment.transform[0] == 0 && back.assignment.transform[1] == 0);
    json_t *before = meso_tiles_to_json(&model.tile_set), *after = meso_tiles_to_json(&back.tile_set);
    CHECK(before && json_equal(before, after));
    json_decref(before);
    json_decref(after);

    MesoMapOptions resolved = meso_map_options_resolve(model.options, model.surface.mean_edge_length);
    CHECK(memcmp(&back.options, &resolved, sizeof resolved) == 0);
    CHECK(back.options.offset == 0.25f && back.options.divisions == 7);
    CHECK(back.inner_meshes[0].vertex_count == 3 && back.inner_meshes[0].triangle_count == 1);
    CHECK(memcmp(back.inner_meshes[0].positions, model.inner_meshes[0].positions, 36) == 0);
    CHECK(memcmp(back.inner_meshes[0].normals, model.inner_meshes[0].normals, 36) == 0);
    CHECK(memcmp(back.inner_meshes[0].triangles, model.inner_meshes[0].triangles, 12) == 0);
    CHECK(strstr(provenance, "\"command\":\"meso-try 'a b'\",\"seed\":5"));

    /* A model of the model has the same bytes. */
    const char *again = test_path(&folder, "b.meso");
    write_file(&back, again);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(test_file_is(again, input.data, input.size));
    meso_input_close(&input);
}

static MesoStatus read_quietly(const MesoInput *input, MesoError *error)
{
    MesoModel model;
    MesoArenaMark mark = meso_arena_mark(&arena);
    MesoStatus status = meso_model_read(&model, NULL, &arena, input, error);
    meso_arena_rewind(&arena, mark);
    return status;
}

static const ContainerFixture fixture = {&folder, "a.meso", "model", 1, read_quietly};

static void expect(const char *chunk, const void *data, uint64_t size, const char *message)
{
    container_fixture_expect(&fixture, chunk, data, size, message);
}

static void test_missing_chunks(void)
{
    static const char *const names[] = {"prov", "tiles", "options", "position", "normal", "face",
                                        "facenorm", "tile", "xform", "inner", "innerpos",
                                        "innernrm", "innertri"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char message[64];
        snprintf(message, sizeof message, "file: chunk '%s' is missing", names[i]);
        expect(names[i], NULL, UINT64_MAX, message);
    }
}

static void test_options(void)
{
    typedef struct Stored {
        float f[5];
        uint32_t divisions;
    } Stored;
    static const struct {
        Stored stored;
        const char *what;
    } cases[] = {
        {{{0, 0, 1, 1, 0.1f}, 5}, "thickness"},       {{{NAN, 0, 1, 1, 0.1f}, 5}, "thickness"},
        {{{INFINITY, 0, 1, 1, 0.1f}, 5}, "thickness"}, {{{1, NAN, 1, 1, 0.1f}, 5}, "offset"},
        {{{1, 0, 0, 1, 0.1f}, 5}, "section scale"},   {{{1, 0, -1, 1, 0.1f}, 5}, "section scale"},
        {{{1, 0, 1, -1, 0.1f}, 5}, "tangent scale"},  {{{1, 0, 1, INFINITY, 0.1f}, 5}, "tangent scale"},
        {{{1, 0, 1, 1, 0}, 5}, "section step"},       {{{1, 0, 1, 1, 1.5f}, 5}, "section step"},
        {{{1, 0, 1, 1, NAN}, 5}, "section step"},     {{{1, 0, 1, 1, 0.1f}, 1}, "number of divisions"},
        {{{1, 0, 1, 1, 0.1f}, 4097}, "number of divisions"},
        {{{1e30f, 0, 1, 1, 0.1f}, 5}, "thickness"},   {{{1, -1e30f, 1, 1, 0.1f}, 5}, "offset"},
        {{{1, 0, 1e30f, 1, 0.1f}, 5}, "section scale"}, {{{1, 0, 1e-30f, 1, 0.1f}, 5}, "section scale"},
        {{{1, 0, 1, 1e30f, 0.1f}, 5}, "tangent scale"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char message[80];
        snprintf(message, sizeof message, "file: chunk 'options': the %s is out of range", cases[i].what);
        expect("options", &cases[i].stored, sizeof cases[i].stored, message);
    }
    expect("options", &cases[0].stored, 20, "file: chunk 'options' has 20 bytes, not 1 times 24");
}

static void expect_joints(const char *path, const MesoModel *model)
{
    MesoModel back;
    MesoInput input;
    MesoError error;
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_model_read(&back, NULL, &arena, &input, &error) == MESO_OK);
    CHECK(back.options.relax == 3 && back.joint_count == 7);
    CHECK(memcmp(back.joints, model->joints, 7 * sizeof *model->joints) == 0);
    CHECK(memcmp(back.assignment.tile, model->assignment.tile, back.surface.face_count * sizeof(uint32_t)) == 0);
    meso_input_close(&input);
}

/* The same with the chunks plain, as version 1.3 had them. */
static void test_plain_joints(const MesoModel *model)
{
    static const char *const names[4][2] = {{"zjoint", "joint"}, {"zface", "face"}, {"zfacenrm", "facenorm"},
                                            {"ztile", "tile"}};
    MesoContainer container;
    MesoInput input;
    MesoOutput *output;
    MesoError error;
    CHECK(meso_input_open(&input, test_path(&folder, "joints.meso"), &error) == MESO_OK);
    CHECK(meso_container_read(&container, &input, "model", 1, &error) == MESO_OK && container.minor == 4);
    for (uint32_t i = 0; i < 4; i++) {
        uint64_t size;
        CHECK(meso_container_find(&container, names[i][0], &size));
        CHECK(meso_packed_open(&container, &arena, "file", names[i][0], names[i][1], &error) == MESO_OK);
    }
    container.minor = 3;
    CHECK(meso_output_open(&output, test_path(&folder, "plain.meso"), &error) == MESO_OK);
    CHECK(meso_container_write(&container, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    meso_input_close(&input);
    expect_joints(test_path(&folder, "plain.meso"), model);
}

/* A relaxed model: it needs its joints, all of them, and gives them back. */
static void test_joints(void)
{
    const int16_t short_of[4] = {1, 2, 3, 4};
    MesoModel model = model_fixture(&arena);
    MesoContainer few = {.kind = "model"};
    MesoError error;
    model.options.relax = 3;
    CHECK(meso_model_relax(&model, NULL, &arena, 1, &error) == MESO_OK && model.joint_count == 7);
    model.joints[2] = (MesoJointMove){-7, 32767, -32768, 1};
    write_file(&model, test_path(&folder, "joints.meso"));
    expect_joints(test_path(&folder, "joints.meso"), &model);
    test_plain_joints(&model);
    CHECK(meso_packed_add(&few, &arena, "zjoint", short_of, 8, (MesoPacking){2, 4, false}, &error) == MESO_OK);
    const ContainerFixture relaxed = {&folder, "joints.meso", "model", 1, read_quietly};
    container_fixture_expect(&relaxed, "zjoint", NULL, UINT64_MAX, "file: chunk 'joint' is missing");
    container_fixture_expect(&relaxed, "zjoint", short_of, 8, "file: chunk 'zjoint' cannot be unpacked");
    container_fixture_expect(&relaxed, "zjoint", few.chunks[0].data, few.chunks[0].size,
                             "file: chunk 'joint' has 8 bytes, not 7 times 8");
}

/* Numbers of the six vertices. */
static void test_heights(void)
{
    const float factors[6] = {1, 1, 0.5f, 0, 1, 1}, lifts[6] = {0, 0, -1e30f}, none[6] = {0, 0, NAN};
    expect("factor", factors, 20, "file: chunk 'factor' has 20 bytes, not 6 times 4");
    expect("factor", factors, 24, "file: chunk 'factor': vertex 3 is out of range");
    expect("lift", lifts, 24, "file: chunk 'lift': vertex 2 is out of range");
    expect("lift", none, 24, "file: chunk 'lift': vertex 2 is out of range");
}

static void test_surface(void)
{
    const float far[18] = {[7] = INFINITY};
    const uint32_t faces[8] = {0, 1, 4, 3, 1, 2, 6, 4}, tiles[2] = {0, 2};
    const uint8_t transforms[2] = {0, 2}, flipped[2] = {4, 0};
    expect("position", far, 71, "file: chunk 'position' has 71 bytes, not 5 times 12");
    expect("position", far, 72, "file: vertex 3 is not finite");
    expect("face", faces, 20, "file: chunk 'face' has 20 bytes, not 1 times 16");
    expect("face", faces, 16, "file: chunk 'facenorm' has 32 bytes, not 1 times 16");
    expect("face", faces, 32, "file: face 2 uses vertex 7 of 6");
    expect("face", faces, 0, "file: chunk 'facenorm' has 32 bytes, not 0 times 16");
    expect("tile", tiles, 4, "file: chunk 'tile' has 4 bytes, not 2 times 4");
    expect("tile", tiles, 8, "file: slot 1: no tile 2; the set has 2");
    expect("xform", transforms, 1, "file: chunk 'xform' has 1 bytes, not 2 times 1");
    expect("xform", transforms, 2,
           "file: slot 0, side 1: shows 'a', but slot 1, side 3 shows 'a'");
    expect("xform", flipped, 2, "file: slot 0: tile 'bead' does not allow transform 4");
}

static void test_tiles_and_inner(void)
{
    const float points[9] = {[4] = NAN}, far[9] = {[8] = -3e38f};
    const float no_normal[9] = {1, 0, 0, NAN}, long_normal[9] = {1, 0, 0, 0, 1, 0, 0, 0, 7};
    const uint32_t triangle[3] = {0, 3, 1}, counts[2] = {3, 2}, huge[2] = {UINT32_MAX, UINT32_MAX};
    expect("tiles", "{", 1, "file: chunk 'tiles':1:1: string or '}' expected near end of file");
    expect("tiles", "{\"format\": \"meso-tiles\", \"version\": 2}", 38,
           "file: chunk 'tiles': version 2 is newer than this program reads (1)");
    expect("inner", counts, 4, "file: chunk 'inner' has 4 bytes, not 1 times 8");
    expect("inner", counts, 8, "file: chunk 'innertri' has 12 bytes, not 2 times 12");
    expect("inner", huge, 8, "file: chunk 'innerpos' has 36 bytes, not 4294967295 times 12");
    expect("innerpos", points, 36, "file: inner mesh 0: vertex 1 is not finite");
    expect("innernrm", no_normal, 36, "file: inner mesh 0: vertex 1 is not finite");
    expect("innerpos", far, 36, "file: inner mesh 0: vertex 2 lies beyond the largest coordinate, 1e+18");
    expect("innernrm", long_normal, 36, "file: inner mesh 0: normal 2 is not of unit length");
    expect("innertri", triangle, 12, "file: inner mesh 0: no vertex 3; it has 3");
}

int main(void)
{
    folder = test_folder_make();
    meso_arena_init(&arena);
    test_round_trip();
    test_missing_chunks();
    test_options();
    test_heights();
    test_joints();
    test_surface();
    test_tiles_and_inner();
    container_fixture_damage(&fixture);
    meso_arena_release(&arena);
    test_folder_remove(&folder);
    return 0;
}
