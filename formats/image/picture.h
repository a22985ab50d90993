/* Picture: channels of numbers, by name. */
#ifndef MESO_PICTURE_H
#define MESO_PICTURE_H

#include <stdbool.h>

#include "formats/file/input.h"
#include "libcore/base/arena.h"

/* Of all channels together: a gibibyte. */
enum { MESO_PICTURE_VALUES = 1 << 28 };

typedef struct MesoPicture {
    uint32_t width, height, channel_count;      /* none is 0 */
    const char **channel_names;     /* [channel_count] as in the file, with its layers: "R", "albedo.R" */
    float *values;                  /* [channel_count * height * width] channel by channel, rows from the top */
} MesoPicture;

/* The values of R, G and B of the picture itself, or of Y for all three; false where there are neither. */
bool meso_picture_colors(const MesoPicture *picture, const float *channels[3]);

/* Room for the names and values of a picture of that size, if it has one within the limit. */
MesoStatus meso_picture_alloc(MesoPicture *out, MesoArena *arena, const MesoInput *input, uint64_t width,
                              uint64_t height, uint32_t channel_count, MesoError *error);

#endif
