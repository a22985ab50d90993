/* States and plans: round trips to the bit, a run that goes on, every kind of wrong chunk, every damaged byte. */
#include "formats/file/container_fixture.h"
#include "formats/replicate/replica_file_fixture.h"

static MesoArena arena;
static TestFolder folder;
static const MesoProvenance provenance = {.tool = "meso-try", .command_line = "meso-try"};

static void write_state(const ReplicaFixture *f, const char *path)
{
    MesoReplicaStateFile file = replica_fixture_state(f);
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_replica_state_write(&file, &provenance, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
}

/* A run that goes on from a file has the same state in the end as one that was not interrupted. */
static void test_state(void)
{
    ReplicaFixture whole, cut;
    MesoReplicaStateFile back;
    MesoInput input;
    MesoError error;
    replica_fixture_begin(&whole);
    replica_fixture_begin(&cut);
    for (uint32_t i = 0; i < 3; i++)
        replica_fixture_step(&whole);
    CHECK(whole.count > REPLICA_ORIGINALS);
    write_state(&whole, test_path(&folder, "a.state"));
    CHECK(meso_input_open(&input, test_path(&folder, "a.state"), &error) == MESO_OK);
    CHECK(meso_replica_is_state(&input) && !meso_replica_is_plan(&input));
    CHECK(meso_replica_state_read(&back, &arena, &input, &error) == MESO_OK);
    meso_input_close(&input);
    CHECK(back.history_count == 3 && back.history[2] == 2 && back.settings.mu == 0.5 && back.settings.substeps == 1);
    CHECK(memcmp(back.state.grown, meso_replicate_grown(whole.replication),
                 whole.count * sizeof *back.state.grown) == 0);
    CHECK(memcmp(back.lives, whole.lives, whole.count * sizeof *back.lives) == 0);
    CHECK(memcmp(back.positions, whole.moved, whole.mesh.vertex_count * sizeof *back.positions) == 0);
    CHECK(meso_replicate_resume(cut.replication, &back.state, &error) == MESO_OK);
    for (uint32_t i = 0; i < 3; i++)
        cut.history[cut.history_count++] = (int32_t)i;
    for (uint32_t i = 3; i < REPLICA_FRAMES; i++) {
        replica_fixture_step(&whole);
        replica_fixture_step(&cut);
    }
    write_state(&whole, test_path(&folder, "whole.state"));
    write_state(&cut, test_path(&folder, "cut.state"));
    CHECK(meso_input_open(&input, test_path(&folder, "whole.state"), &error) == MESO_OK);
    CHECK(test_file_is(test_path(&folder, "cut.state"), input.data, input.size));
    meso_input_close(&input);
    replica_fixture_end(&whole);
    replica_fixture_end(&cut);
}

static void test_plan(void)
{
    ReplicaFixture f;
    MesoReplicaPlanFile file = {.settings = {.mode = 1}}, back;
    MesoOutput *output;
    MesoInput input;
    MesoError error;
    replica_fixture_begin(&f);
    for (uint32_t i = 0; i < 4; i++)
        replica_fixture_step(&f);
    CHECK(meso_replicate_plan(&file.plan, &arena, f.replication, &error) == MESO_OK);
    CHECK(meso_output_open(&output, test_path(&folder, "a.plan"), &error) == MESO_OK);
    CHECK(meso_replica_plan_write(&file, &provenance, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, test_path(&folder, "a.plan"), &error) == MESO_OK);
    CHECK(meso_replica_is_plan(&input) && !meso_replica_is_state(&input));
    CHECK(meso_replica_plan_read(&back, &arena, &input, &error) == MESO_OK);
    meso_input_close(&input);
    uint32_t n = file.plan.detail_count, pairs = file.plan.pair_begin[n];
    CHECK(back.plan.detail_count == n && pairs > 0 && back.settings.mode == 1);
    CHECK(memcmp(back.plan.details, file.plan.details, n * sizeof *back.plan.details) == 0);
    CHECK(memcmp(back.plan.pair_begin, file.plan.pair_begin, (n + 1) * sizeof *back.plan.pair_begin) == 0);
    for (uint32_t i = 0; i < pairs; i++) {
        const MesoReplicaPair *a = &back.plan.pairs[i], *b = &file.plan.pairs[i];
        CHECK(a->other == b->other && a->from == b->from && a->to == b->to);
    }
    CHECK(memcmp(back.plan.rooms, file.plan.rooms, n * sizeof *back.plan.rooms) == 0);
    replica_fixture_end(&f);
}

/* ---- what is wrong ---- */

static MesoStatus read_state(const MesoInput *input, MesoError *error)
{
    MesoReplicaStateFile file;
    MesoArenaMark mark = meso_arena_mark(&arena);
    MesoStatus status = meso_replica_state_read(&file, &arena, input, error);
    meso_arena_rewind(&arena, mark);
    return status;
}

static MesoStatus read_plan(const MesoInput *input, MesoError *error)
{
    MesoReplicaPlanFile file;
    MesoArenaMark mark = meso_arena_mark(&arena);
    MesoStatus status = meso_replica_plan_read(&file, &arena, input, error);
    meso_arena_rewind(&arena, mark);
    return status;
}

static const ContainerFixture state = {&folder, "a.state", "state", 1, read_state};
static const ContainerFixture plan = {&folder, "a.plan", "plan", 1, read_plan};

static void test_missing_chunks(void)
{
    static const char *const names[] = {"prov", "mark", "setting", "detail", "head", "block", "nearbeg", "near",
                                        "node", "corner", "twin", "grown", "fate", "merging",
                                        "life", "frames", "places"};
    static const char *const plans[] = {"prov", "mark", "setting", "detail", "pairbeg", "pair", "room"};
    char message[64];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(message, sizeof message, "file: chunk '%s' is missing", names[i]);
        container_fixture_expect(&state, names[i], NULL, UINT64_MAX, message);
    }
    for (size_t i = 0; i < sizeof plans / sizeof *plans; i++) {
        snprintf(message, sizeof message, "file: chunk '%s' is missing", plans[i]);
        container_fixture_expect(&plan, plans[i], NULL, UINT64_MAX, message);
    }
    container_fixture_expect(&state, "detail", "", 0, "file: chunk 'detail' is broken");
    container_fixture_expect(&state, "detail", "1234", 4, "file: chunk 'detail' is broken");
    container_fixture_expect(&plan, "pair", "1234", 4, "file: chunk 'pair' is broken");
}

/* What differs is told, the seed before the details that come of it. */
static void test_compare(void)
{
    const MesoReplicaMark mark = {{1, 2}, {3, 4}};
    const MesoReplicaSettings settings = {.mode = 1, .substeps = 2, .seed = 3, .alpha = 1, .mu = 0.5, .ramp = 0.06};
    MesoReplicaMark other = mark;
    MesoReplicaSettings changed = settings;
    MesoError error;
    CHECK(meso_replica_compare("a.plan", &mark, &settings, &other, &changed, &error) == MESO_OK);
    other.details[1] = 5;
    CHECK(meso_replica_compare("a.plan", &mark, &settings, &other, &changed, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.plan: it is of other details");
    changed.seed = 7;
    CHECK(meso_replica_compare("a.plan", &mark, &settings, &other, &changed, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.plan: it is of another --seed");
    other.surface[0] = 7;
    CHECK(meso_replica_compare("a.plan", &mark, &settings, &other, &changed, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.plan: it is of another surface");
}

int main(void)
{
    meso_arena_init(&arena);
    folder = test_folder_make();
    test_state();
    test_plan();
    test_missing_chunks();
    container_fixture_damage(&plan);
    test_compare();
    test_folder_remove(&folder);
    meso_arena_release(&arena);
    return 0;
}
