/*
 * ZIP chunks of OpenEXR by ISA-L, which takes a quarter of the time of libdeflate for files 2 % larger. It writes the
 * same bytes on every x86-64 processor that has SSE4.2; on others files may differ, and pictures do not.
 */
#ifndef MESO_EXR_DEFLATE_H
#define MESO_EXR_DEFLATE_H

#include <OpenEXR/openexr.h>

#include "libcore/base/arena.h"

struct MesoExrPress;

/* What a thread packs and compresses chunks in, one after the other. */
typedef struct MesoExrRoom {
    size_t size;                /* bytes of a chunk, at most */
    unsigned char *packed, *split;      /* [size] */
    unsigned char *stream;      /* what is compressed, until it is known how long it is */
    struct MesoExrPress *press;
} MesoExrRoom;

/* For chunks of up to `size` bytes; its memory is in `arena`, and takes room once it is used. False: out of memory. */
bool meso_exr_room_init(MesoExrRoom *room, MesoArena *arena, size_t size);

/*
 * Runs a pipeline of the Core library that has all but its compressor, for which `room` stands in: packed bytes go
 * there, and what is compressed stays with the pipeline. What does not shrink stays as it is. What the library returns,
 * or EXR_ERR_OUT_OF_MEMORY.
 */
exr_result_t meso_exr_deflate(exr_const_context_t context, int part, exr_encode_pipeline_t *pipeline,
                              MesoExrRoom *room);

#endif
