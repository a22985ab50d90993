/*
 * Scene: what every method ends in, and all that writers and the renderer
 * read: materials, channels of ids with their names, tubes, and bodies where
 * they are placed. It knows no method and no adjacency.
 */
#ifndef MESO_SCENE_H
#define MESO_SCENE_H

#include "libcore/base/arena.h"
#include "libcore/base/vec.h"

/*
 * What tells the parts of a scene apart: "slot" and "tile", "region", "element". Each part has one id in every
 * channel, and so has each pixel of a picture. Ids of channels with names fit in 16 bits in files.
 */
enum { MESO_ID_CHANNELS = 4 };

typedef struct MesoIdChannel {
    const char *name;
    uint32_t count;             /* ids are below it */
    const char **names;         /* [count], or NULL: numbers are their own names */
} MesoIdChannel;

#endif
