/* Parts: each a file of its own; together, in any order, the bytes of the whole; what is not all of it is refused. */
#include "formats/scene/mesh_file_fixture.h"
#include "formats/scene/part/ply_join.h"

static MesoInput write_part(const SceneFixture *fixture, const MesoSelectionRule *rule, MesoSelection *selection,
                            const char *path)
{
    MesoArena arena;
    MesoSceneParts parts;
    meso_arena_init(&arena);
    CHECK(meso_selection_make(selection, &arena, &fixture->parts, rule, NULL) == MESO_OK);
    CHECK(meso_scene_parts_init(&parts, &arena, &selection->scene, NULL) == MESO_OK);
    const MesoMeshWriteOptions options = {.selection = selection};
    MesoInput input = write_mesh_as(meso_ply_write, &parts, &options, 2, path);
    meso_arena_release(&arena);
    return input;
}

static MesoStatus join(const MesoInput *parts, uint32_t count, const char *path)
{
    MesoOutput *output;
    MesoError error;
    MesoStatus status = meso_output_open(&output, path, &error);
    CHECK(status == MESO_OK);
    return meso_output_finish(output, meso_ply_join(parts, count, output, &error), &error);
}

static void check_joined(const MesoInput *parts, uint32_t count, const MesoInput *whole)
{
    MesoInput joined;
    CHECK(join(parts, count, path_of("joined")) == MESO_OK);
    CHECK(meso_input_open(&joined, path_of("joined"), NULL) == MESO_OK);
    CHECK(joined.size == whole->size && memcmp(joined.data, whole->data, whole->size) == 0);
    meso_input_close(&joined);
}

static void test_shards(const SceneFixture *fixture, const MesoInput *whole)
{
    for (uint32_t n = 1; n <= 5; n += 2) {
        MesoSelection selection;
        MesoInput parts[5];
        uint32_t sweeps = 0;
        for (uint32_t i = 0; i < n; i++) {
            parts[(i + 2) % n] = write_part(fixture, &(MesoSelectionRule){.shard = i, .shard_count = n}, &selection,
                                            path_of("part"));
            CHECK(selection.run_count <= 2);
            sweeps += selection.scene.sweep_count;
        }
        CHECK(sweeps == fixture->scene.sweep_count);
        check_joined(parts, n, whole);
        if (n > 1) {
            CHECK(join(parts, n - 1, path_of("refused")) == MESO_ERR_INPUT);
            parts[0] = parts[1];
            CHECK(join(parts, n, path_of("refused")) == MESO_ERR_INPUT);
        }
        CHECK(access(path_of("refused"), F_OK) != 0);
    }
}

/* Slots lie apart in the whole, once for each kind of sweep. */
static void test_slots(const SceneFixture *fixture, const MesoInput *whole)
{
    const MesoSelectionRule rules[3] = {{.low = 4, .high = 9}, {.low = 0, .high = 3}, {.low = 10, .high = 99}};
    MesoSelection selection;
    MesoInput parts[3];
    for (int i = 0; i < 3; i++)
        parts[i] = write_part(fixture, &rules[i], &selection, path_of("part"));
    CHECK(selection.run_count > 2 && selection.part_count == fixture->parts.part_count);
    check_joined(parts, 3, whole);
}

/* Each truncation, and each header with one digit that is another. */
static void test_broken(const SceneFixture *fixture)
{
    MesoSelection selection;
    MesoInput part = write_part(fixture, &(MesoSelectionRule){.high = 99}, &selection, path_of("part")), broken;
    uint8_t *bytes = malloc(part.size);
    CHECK(bytes);
    CHECK(join(&part, 1, path_of("joined")) == MESO_OK);
    const size_t header = (size_t)(after(&part, "end_header\n") - part.data);
    for (size_t size = 1; size < part.size; size += size < header ? 1 : 97) {
        meso_input_wrap(&broken, "broken", part.data, size);
        CHECK(join(&broken, 1, path_of("refused")) == MESO_ERR_INPUT);
    }
    for (size_t at = (size_t)(after(&part, "comment whole ") - part.data); at < header; at++) {
        memcpy(bytes, part.data, part.size);
        bytes[at] = bytes[at] == '9' ? '0' : '9';
        meso_input_wrap(&broken, "broken", bytes, part.size);
        MesoStatus status = join(&broken, 1, path_of("refused"));
        CHECK(status == MESO_OK || status == MESO_ERR_INPUT);
        remove(path_of("refused"));
    }
    free(bytes);
    meso_input_close(&part);
}

static void test_nothing(SceneFixture *fixture)
{
    MesoSelection selection;
    MesoError error;
    const MesoSelectionRule rule = {.low = 1000, .high = 2000};
    CHECK(meso_selection_make(&selection, &fixture->arena, &fixture->parts, &rule, &error) == MESO_ERR_INPUT);
}

int main(void)
{
    SceneFixture fixture;
    CHECK(mkdtemp(folder));
    scene_fixture_init(&fixture, 4, 5, 0.1f);
    MesoInput whole = write_mesh(meso_ply_write, &fixture.parts, 2, path_of("whole"));
    test_shards(&fixture, &whole);
    test_slots(&fixture, &whole);
    test_broken(&fixture);
    test_nothing(&fixture);
    meso_input_close(&whole);
    scene_fixture_release(&fixture);
    static const char *const products[] = {"whole", "part", "joined"};
    remove_products(products, 3);
    return 0;
}
