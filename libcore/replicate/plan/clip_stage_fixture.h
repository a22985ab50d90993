/* A surface with details that goes through a motion, for tests. */
#ifndef MESO_CLIP_STAGE_FIXTURE_H
#define MESO_CLIP_STAGE_FIXTURE_H

#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/replicate/plan/replicate_state.h"
#include "libcore/replicate/statistics/points_fixture.h"

enum { FRAMES = 20 };

typedef MesoVec3 (*Motion)(MesoVec3 p, float time);

typedef struct Stage {
    MesoTriangulation mesh;
    MesoVec3 *moved;
    Motion motion;
    MesoClip clip;
    MesoMeshPoint *points;
    MesoDetail *originals;
    uint32_t count, frames;     /* the last one is at time 1 */
    MesoReplicateOptions options;
    MesoReplication *replication;
} Stage;

static inline const MesoVec3 *move(void *context, uint32_t frame, MesoError *error)
{
    Stage *s = context;
    (void)error;
    for (uint32_t v = 0; v < s->mesh.vertex_count; v++)
        s->moved[v] = s->motion(s->mesh.positions[v], (float)frame / (float)s->frames);
    return s->moved;
}

/* All but the replication itself. */
static inline void set_stage(Stage *s, MesoTriangulation mesh, uint32_t count, Motion motion)
{
    *s = (Stage){.mesh = mesh, .motion = motion, .count = count, .frames = FRAMES};
    s->moved = malloc(mesh.vertex_count * sizeof *s->moved);
    s->points = meso_strew_discs(&s->mesh, &s->count, 0.7, 5);
    s->originals = calloc(s->count, sizeof *s->originals);
    CHECK(s->moved && s->originals);
    for (uint32_t i = 0; i < s->count; i++)
        s->originals[i] = (MesoDetail){.point = s->points[i], .size = 1 + (float)(i % 3), .width = 1, .kind = i % 3};
    s->clip = (MesoClip){&s->mesh, FRAMES + 1, move, s};
    s->options = (MesoReplicateOptions){.clip = &s->clip, .originals = s->originals, .original_count = s->count,
                                        .mode = MESO_REPLICATE_LIVE, .thread_count = 1};
}

static inline void start_in(Stage *s, MesoReplicateMode mode, MesoTriangulation mesh, uint32_t count, Motion motion)
{
    set_stage(s, mesh, count, motion);
    s->options.mode = mode;
    CHECK(meso_replicate_begin(&s->replication, &s->options, NULL) == MESO_OK);
}

static inline void start(Stage *s, MesoTriangulation mesh, uint32_t count, Motion motion, uint32_t thread_count)
{
    set_stage(s, mesh, count, motion);
    s->options.thread_count = thread_count;
    CHECK(meso_replicate_begin(&s->replication, &s->options, NULL) == MESO_OK);
}

/* Those that live. */
static inline uint32_t living(const Stage *s)
{
    uint32_t count, lives = 0;
    meso_replicate_details(s->replication, &count);
    for (uint32_t i = 0; i < count; i++)
        lives += meso_replicate_fates(s->replication)[i].died == MESO_DETAIL_LIVES;
    return lives;
}

static inline uint32_t run(Stage *s)
{
    uint32_t count;
    for (uint32_t f = 0; f <= s->frames; f++)
        CHECK(meso_replicate_step(s->replication, f, NULL) == MESO_OK);
    meso_replicate_details(s->replication, &count);
    return count;
}

static inline void end(Stage *s)
{
    meso_replicate_release(s->replication);
    meso_triangulation_release(&s->mesh);
    free(s->moved);
    free(s->points);
    free(s->originals);
}

static inline MesoVec3 stretch(MesoVec3 p, float time)
{
    return (MesoVec3){p.x * (1 + time), p.y, p.z};
}

static inline MesoVec3 scale(MesoVec3 p, float time)
{
    return meso_vec3_scale(p, 1 + time);
}

/* The plane onto a cylinder, whose radius is that of the circle that it goes half around at the end. */
static inline MesoVec3 bend(MesoVec3 p, float time)
{
    float a = 3.14159265f * time;
    return a > 0 ? (MesoVec3){sinf(a * p.x) / a, p.y, (1 - cosf(a * p.x)) / a} : p;
}

#endif
