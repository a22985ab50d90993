/* What the parts of the OpenEXR writer share. */
#ifndef MESO_EXR_WRITER_H
#define MESO_EXR_WRITER_H

#include <OpenEXR/openexr.h>

#include "formats/image/exr_deflate.h"
#include "formats/image/image_file.h"

enum {
    MESO_EXR_MATTES = MESO_ID_CHANNELS + 1,
    MESO_EXR_MATTE_CHANNELS = 2 * MESO_MATTE_RANKS,
    MESO_EXR_CHANNELS = 32 + MESO_ID_CHANNELS + MESO_EXR_MATTES * MESO_EXR_MATTE_CHANNELS,
    MESO_EXR_PARTS = 16 + MESO_EXR_MATTES,
    MESO_EXR_BATCH = 16
};

typedef struct MesoExrChannel {
    const char *name;
    exr_pixel_type_t stored;
    exr_pixel_type_t given;
    uint32_t stride;        /* values from a pixel to the next */
    const void *values;     /* of pixel 0 */
} MesoExrChannel;

/* Consecutive channels. */
typedef struct MesoExrPart {
    const char *name;
    uint32_t channel_begin, channel_count;
    uint64_t *offsets;      /* of its chunks in the file, of several parts */
} MesoExrPart;

/* What the library's callbacks get: our own record of failures, since it forgets them. */
typedef struct MesoExrStream {
    MesoOutput *output;
    uint64_t end;           /* of what was written */
    MesoStatus status;
    MesoError error;
} MesoExrStream;

struct MesoExrWriter {
    const MesoImage *image;     /* a band, whose arrays are those of all bands; NULL: numbers alone, without a camera */
    MesoExrOptions options;
    uint32_t width, height;     /* of the whole picture */
    MesoWindow window;          /* of it that has data */
    uint32_t next_row;          /* that is to be written */
    uint32_t batch;             /* chunks at once */
    uint32_t thread_count;
    MesoArena arena;
    MesoExrStream stream;
    uint64_t tables;            /* where those of the chunks are, of several parts */
    exr_context_t context;
    uint32_t channel_count, part_count;
    MesoExrChannel channels[MESO_EXR_CHANNELS];
    MesoExrPart parts[MESO_EXR_PARTS];
    const char *names_keys[MESO_ID_CHANNELS];   /* "meso:tiles" for the channel "tile"; NULL without names */
    const char *names[MESO_ID_CHANNELS];
    char matte_names[MESO_EXR_MATTES * MESO_EXR_MATTE_CHANNELS][MESO_CHANNEL_NAME + 16];
    char matte_parts[MESO_EXR_MATTES][MESO_CHANNEL_NAME + 16];
    exr_encode_pipeline_t pipelines[MESO_EXR_BATCH];
    bool ready[MESO_EXR_BATCH];         /* pipeline is initialised, for a chunk of this part: */
    uint32_t part_of[MESO_EXR_BATCH];
    exr_chunk_info_t chunks[MESO_EXR_BATCH];
    exr_result_t results[MESO_EXR_BATCH];
    uint32_t room_count;                /* threads that work at once */
    MesoExrRoom rooms[MESO_EXR_BATCH];
};

/* A part begins, of which the channels that follow are; without --multipart all are of the first. */
void meso_exr_add_part(MesoExrWriter *writer, const char *name);
void meso_exr_add_channel(MesoExrWriter *writer, const char *name, exr_pixel_type_t stored, uint32_t stride,
                          const float *values);

/* The channels of a picture, in parts where the options want them, and names of its ids. MESO_ERR_MEMORY alone. */
MesoStatus meso_exr_list(MesoExrWriter *writer, MesoError *error);

/* Writes the headers of all parts. */
exr_result_t meso_exr_describe(MesoExrWriter *writer, const char *provenance);

#endif
