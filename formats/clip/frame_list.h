/* Lists of frames, as --frames takes them, and the names of their files. */
#ifndef MESO_FRAME_LIST_H
#define MESO_FRAME_LIST_H

#include <stdbool.h>
#include <stdint.h>

#include "libcore/base/arena.h"

enum { MESO_MOST_FRAMES = 1000000 };

typedef struct MesoFrameList {
    uint32_t count;
    int32_t *frames;        /* [count] as they are to be shown, first to last */
} MesoFrameList;

/*
 * Parts with commas between, each A, A-B or A-BxK: every K-th frame from A to B, backwards where A is larger. Numbers
 * are whole and not negative. MESO_ERR_USAGE names the part that is none of these; MESO_ERR_LIMIT over
 * MESO_MOST_FRAMES.
 */
MesoStatus meso_frame_list_parse(MesoFrameList *list, MesoArena *arena, const char *text, MesoError *error);

/* Whether a name has exactly one place for a frame's number: %d, or %04d with any width up to 9; %% is a plain %. */
bool meso_frame_path_is_pattern(const char *text);

/* The name of a frame, in the arena; NULL when memory is out. */
char *meso_frame_path(const char *pattern, int32_t frame, MesoArena *arena, MesoError *error);

#endif
