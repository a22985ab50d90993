/*
 * What details that replicate leave between frames: states (.state), from which a run goes on with the same bytes, and
 * plans (.plan), from which any frame is played. Both, version 1.0, begin alike:
 *
 *     prov      provenance, JSON text
 *     mark      u64[2] hash of the surface at rest, u64[2] of the details that there were
 *     setting   u32 mode, steps a frame, births, 0; u64 seed; f64 alpha, beta, gamma, mu, ramp
 *     detail    a detail: u32 triangle; f32[3] weights; f32 angle, size, width; u32 kind, copied, rank; f32 radius;
 *               i32 born
 *
 * a state goes on with
 *
 *     head      u32[8]: steps, nodes and triangles of the web, pairs of 'near', frames, vertices, mergings, 0;
 *               f64 power of the tolerance; i64 last frame
 *     block     u32 a detail              nearbeg   u32 a detail, and the end
 *     near      {u32 detail; f32 distance} a pair
 *     node      u32 a node: a corner there          corner, twin   u32[3] a triangle of the web
 *     grown     f32 a detail: share of its size     life      {i32 first, i32 died; u32 merged} a detail
 *     fate      {i32 died; u32 into} a detail       merging   u32[2] a merging
 *     frames    i32: numbers of the frames that were gone through
 *     places    f32[3] a vertex of the surface, in the last of these
 *
 * and a plan with
 *
 *     pairbeg   u32 a detail, and the end
 *     pair      {u32 other; f32 from, to} a pair
 *     room      {u32 block; f32 from, to} a detail
 */
#ifndef MESO_REPLICA_FILE_H
#define MESO_REPLICA_FILE_H

#include "formats/file/container.h"
#include "formats/product/provenance.h"
#include "libcore/replicate/plan/replicate_state.h"

enum { MESO_REPLICA_MAJOR = 1 };

/* What a state or plan is of. */
typedef struct MesoReplicaMark {
    uint64_t surface[2], details[2];
} MesoReplicaMark;

MesoReplicaMark meso_replica_mark(const MesoTriangulation *rest, const MesoDetail *originals, uint32_t count);

typedef struct MesoReplicaSettings {
    uint32_t mode, substeps, births, reserved;
    uint64_t seed;
    double alpha, beta, gamma, mu, ramp;
} MesoReplicaSettings;

/* Numbers of frames; MESO_NEVER: of none. */
typedef struct MesoReplicaLife {
    int32_t first;          /* the first one in which it is there */
    int32_t died;           /* from this one on it is not there any more */
    uint32_t merged;        /* the detail that has taken its place; MESO_NO_INDEX: none */
} MesoReplicaLife;

#define MESO_NEVER INT32_MIN

typedef struct MesoReplicaStateFile {
    MesoReplicaMark mark;
    MesoReplicaSettings settings;
    MesoReplicaState state;
    const MesoReplicaLife *lives;   /* [state.detail_count] */
    uint32_t history_count, vertex_count;
    const int32_t *history;         /* [history_count] at least one */
    const MesoVec3 *positions;      /* [vertex_count] */
} MesoReplicaStateFile;

typedef struct MesoReplicaPlanFile {
    MesoReplicaMark mark;
    MesoReplicaSettings settings;
    MesoReplicaPlan plan;
} MesoReplicaPlanFile;

MesoStatus meso_replica_state_write(const MesoReplicaStateFile *file, const MesoProvenance *provenance,
                                    MesoOutput *output, MesoError *error);
MesoStatus meso_replica_plan_write(const MesoReplicaPlanFile *file, const MesoProvenance *provenance,
                                   MesoOutput *output, MesoError *error);

/*
 * Reads to `arena`; `input` may be closed then. What belongs to the surface is checked by whoever has it
 * (meso_replicate_resume(), meso_player_build()); here sizes, ranges of lists and that numbers are finite.
 * MESO_ERR_INPUT, MESO_ERR_MEMORY. O(size).
 */
MesoStatus meso_replica_state_read(MesoReplicaStateFile *file, MesoArena *arena, const MesoInput *input,
                                   MesoError *error);
MesoStatus meso_replica_plan_read(MesoReplicaPlanFile *file, MesoArena *arena, const MesoInput *input,
                                  MesoError *error);

/* MESO_ERR_INPUT, with what differs, where a file is of another surface, other details or other options. */
MesoStatus meso_replica_compare(const char *path, const MesoReplicaMark *mark, const MesoReplicaSettings *settings,
                                const MesoReplicaMark *wanted, const MesoReplicaSettings *wanted_settings,
                                MesoError *error);

/* True where `input` begins as a state, or as a plan. */
bool meso_replica_is_state(const MesoInput *input);
bool meso_replica_is_plan(const MesoInput *input);

#endif
