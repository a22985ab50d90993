/* A clip of a plate that becomes three times as long, and details on it that replicate. */
#ifndef MESO_REPLICA_FILE_FIXTURE_H
#define MESO_REPLICA_FILE_FIXTURE_H

#include <stdlib.h>

#include "formats/replicate/replica_file.h"
#include "libcore/base/check.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

enum { REPLICA_ORIGINALS = 24, REPLICA_FRAMES = 6 };

typedef struct ReplicaFixture {
    MesoTriangulation mesh;
    MesoVec3 *moved;
    MesoClip clip;
    MesoDetail originals[REPLICA_ORIGINALS];
    MesoReplication *replication;
    uint32_t count;             /* of details */
    MesoReplicaLife *lives;
    int32_t history[REPLICA_FRAMES];
    uint32_t history_count;
} ReplicaFixture;

static inline const MesoVec3 *replica_fixture_positions(void *context, uint32_t frame, MesoError *error)
{
    ReplicaFixture *f = context;
    (void)error;
    for (uint32_t v = 0; v < f->mesh.vertex_count; v++) {
        f->moved[v] = f->mesh.positions[v];
        f->moved[v].x *= 1 + 2 * (float)frame / REPLICA_FRAMES;
    }
    return f->moved;
}

static inline void replica_fixture_begin(ReplicaFixture *f)
{
    *f = (ReplicaFixture){.mesh = meso_fixture_sheet(6, 6, 1)};
    f->moved = calloc(f->mesh.vertex_count, sizeof *f->moved);
    CHECK(f->moved);
    f->clip = (MesoClip){&f->mesh, REPLICA_FRAMES, replica_fixture_positions, f};
    for (uint32_t i = 0; i < REPLICA_ORIGINALS; i++)
        f->originals[i] = (MesoDetail){.point = {3 * i, {0.3f, 0.4f, 0.3f}}, .angle = 0.1f * (float)i, .size = 0.5f,
                                       .width = 0.25f, .kind = i % 2};
    const MesoReplicateOptions options = {.clip = &f->clip, .originals = f->originals,
                                          .original_count = REPLICA_ORIGINALS, .mode = MESO_REPLICATE_LIVE,
                                          .thread_count = 1};
    CHECK(meso_replicate_begin(&f->replication, &options, NULL) == MESO_OK);
}

/* Goes through the next frame. */
static inline void replica_fixture_step(ReplicaFixture *f)
{
    CHECK(meso_replicate_step(f->replication, f->history_count, NULL) == MESO_OK);
    f->history[f->history_count] = (int32_t)f->history_count;
    f->history_count++;
    meso_replicate_details(f->replication, &f->count);
    f->lives = realloc(f->lives, f->count * sizeof *f->lives);
    CHECK(f->lives);
    for (uint32_t i = 0; i < f->count; i++)
        f->lives[i] = (MesoReplicaLife){(int32_t)i, MESO_NEVER, MESO_NO_INDEX};
}

static inline MesoReplicaStateFile replica_fixture_state(const ReplicaFixture *f)
{
    return (MesoReplicaStateFile){
        .mark = meso_replica_mark(&f->mesh, f->originals, REPLICA_ORIGINALS), .settings = {.substeps = 1, .mu = 0.5},
        .state = meso_replicate_state(f->replication), .lives = f->lives,
        .history_count = f->history_count, .history = f->history, .vertex_count = f->mesh.vertex_count,
        .positions = f->moved};
}

static inline void replica_fixture_end(ReplicaFixture *f)
{
    meso_replicate_release(f->replication);
    meso_triangulation_release(&f->mesh);
    free(f->moved);
    free(f->lives);
}

#endif
