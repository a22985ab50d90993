/* Readers of states and plans: good files with chunks replaced; what is read can be gone on from, or played. */
#include "formats/file/container_memory.h"
#include "formats/replicate/replica_file_fixture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static ReplicaFixture fixture;
static MesoArena plans;
static const MesoProvenance provenance = {.tool = "meso-try", .command_line = "meso-try"};

static MesoStatus write_state(MesoOutput *output, MesoError *error)
{
    MesoReplicaStateFile file = replica_fixture_state(&fixture);
    return meso_replica_state_write(&file, &provenance, output, error);
}

static MesoStatus write_plan(MesoOutput *output, MesoError *error)
{
    MesoReplicaPlanFile file = {.mark = meso_replica_mark(&fixture.mesh, fixture.originals, REPLICA_ORIGINALS)};
    MesoStatus status = meso_replicate_plan(&file.plan, &plans, fixture.replication, error);
    return status ? status : meso_replica_plan_write(&file, &provenance, output, error);
}

static void go_on(const MesoReplicaStateFile *file)
{
    MesoReplication *replication;
    MesoError error;
    const MesoReplicateOptions options = {.clip = &fixture.clip, .originals = fixture.originals,
                                          .original_count = REPLICA_ORIGINALS, .mode = MESO_REPLICATE_LIVE,
                                          .thread_count = 1};
    CHECK(meso_replicate_begin(&replication, &options, &error) == MESO_OK);
    if (meso_replicate_resume(replication, &file->state, &error) == MESO_OK)
        meso_replicate_step(replication, REPLICA_FRAMES - 1, &error);
    meso_replicate_release(replication);
}

static void play(const MesoReplicaPlanFile *file, MesoArena *arena)
{
    MesoPlayer *player;
    MesoError error;
    float *grown = MESO_NEW(arena, float, file->plan.detail_count, &error);
    if (!grown || meso_player_build(&player, arena, &fixture.mesh, &file->plan, &error) != MESO_OK)
        return;
    meso_player_play(player, grown, fixture.mesh.positions, 1);
    for (uint32_t i = 0; i < file->plan.detail_count; i++)
        CHECK(grown[i] >= 0 && grown[i] <= 1);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static MesoContainer examples[2];
    if (examples[0].chunk_count == 0) {
        replica_fixture_begin(&fixture);
        meso_arena_init(&plans);
        for (uint32_t i = 0; i < 3; i++)
            replica_fixture_step(&fixture);
        examples[1] = container_example("plan", write_plan);
        examples[0] = container_example("state", write_state);
    }
    if (size == 0)
        return 0;
    MesoContainer container = examples[data[0] & 1];
    MesoReplicaStateFile state;
    MesoReplicaPlanFile plan;
    MesoArena arena;
    MesoInput input;
    MesoError error;
    size_t length;
    container_replace_chunks(&container, data + 1, size - 1);
    uint8_t *bytes = container_to_memory(&container, &length);
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", bytes, length);
    if (meso_replica_is_state(&input) && meso_replica_state_read(&state, &arena, &input, &error) == MESO_OK)
        go_on(&state);
    if (meso_replica_is_plan(&input) && meso_replica_plan_read(&plan, &arena, &input, &error) == MESO_OK)
        play(&plan, &arena);
    meso_arena_release(&arena);
    free(bytes);
    return 0;
}
