/* Writers of streamed meshes: a window of parts in memory, whatever the mesh. */
#ifndef MESO_MESH_WINDOW_H
#define MESO_MESH_WINDOW_H

#include <stddef.h>

#include "formats/scene/mesh_file.h"

/*
 * One pass over all parts. `format` turns the parts [begin, end) into bytes at
 * `out` and returns how many; several threads call it at once. The bytes of
 * consecutive ranges, joined, must not depend on where the ranges are cut.
 */
typedef struct MesoMeshPass {
    size_t (*format)(const void *context, const MesoSceneParts *parts, uint32_t begin,
                     uint32_t end, uint8_t *out, uint8_t *scratch);
    const void *context;
    /* The most bytes that one of them takes at `out`, and at `scratch`, which is aligned to 64. */
    uint32_t part_bytes, vertex_bytes, face_bytes;
    uint32_t vertex_scratch, face_scratch;
} MesoMeshPass;

/* Parts [begin, end). */
typedef struct MesoPartRange {
    uint32_t begin, end;
} MesoPartRange;

/* Where a writer stands, over all its passes. */
typedef struct MesoMeshStream {
    const MesoSceneParts *parts;
    const MesoMeshWriteOptions *options;
    MesoOutput *output;
    uint64_t offset;            /* of the next byte in the output */
    uint64_t done, total;       /* for the progress */
    uint32_t range_count;
    const MesoPartRange *ranges;    /* [range_count] what the passes go over, in this order; NULL: all parts */
} MesoMeshStream;

/*
 * Runs `pass` over all parts, or over those of the ranges, and writes its bytes, in order, from
 * `stream->offset` on, which is moved. A thread writes what it has formatted itself, while it is in its caches: each
 * holds MESO_WINDOW_CHUNK bytes, or the largest part where that is more. `work` is added to `stream->done` in the end.
 * O(parts + bytes).
 */
MesoStatus meso_mesh_stream_run(MesoMeshStream *stream, const MesoMeshPass *pass, uint64_t work,
                                MesoError *error);

/* What a thread formats at once stays within its caches. */
enum { MESO_WINDOW_CHUNK = 256 << 10 };

/* MESO_ERR_INPUT for a scene without faces, MESO_ERR_LIMIT where 32-bit vertex numbers,
 * or 16-bit numbers of names, do not suffice. */
MesoStatus meso_mesh_check_counts(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                                  const char *kind, MesoError *error);

/* ": " and what would make the product smaller, or two empty texts. */
#define MESO_MESH_SMALLER(options) (options)->smaller ? ": " : "", (options)->smaller ? (options)->smaller : ""

/* Name of a material, cut off where it is long, but never within a character. */
enum { MESO_MESH_NAME = 256 };
void meso_mesh_material_name(const MesoScene *scene, uint32_t material, char name[MESO_MESH_NAME]);

/* Names as a JSON array on one line; NULL with `error` filled. Those of the materials are cut off as above. */
const char *meso_mesh_names(const char *const *names, uint32_t count, MesoArena *arena, MesoError *error);
const char *meso_mesh_material_names(const MesoScene *scene, MesoArena *arena, MesoError *error);

/* What files call the names of a channel: "tiles". NULL with `error` filled. */
const char *meso_mesh_names_key(const MesoIdChannel *channel, MesoArena *arena, MesoError *error);

/* A line MARK "strand_length NUMBER LENGTH" for each strand that the options tell of; NULL with `error` filled. */
const char *meso_mesh_strand_lines(const MesoMeshWriteOptions *options, const char *mark, MesoArena *arena,
                                   MesoError *error);

/* The lengths as a JSON array on one line; "" where the options have none. */
const char *meso_mesh_strand_array(const MesoMeshWriteOptions *options, MesoArena *arena, MesoError *error);

/* The provenance as one line; "" where the options have none. */
const char *meso_mesh_provenance(const MesoMeshWriteOptions *options, MesoArena *arena,
                                 MesoError *error);

#endif
