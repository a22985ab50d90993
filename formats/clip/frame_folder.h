/* The frames that there are: numbers of the files whose names follow a pattern. */
#ifndef MESO_FRAME_FOLDER_H
#define MESO_FRAME_FOLDER_H

#include "formats/clip/frame_list.h"

/*
 * Numbers of the files that a pattern names, ascending. They must be evenly spaced: MESO_ERR_INPUT names the first one
 * that is missing, and where there are none. The pattern's number stands in the last part of its path, or else
 * MESO_ERR_USAGE. O(files of the folder).
 */
MesoStatus meso_frame_folder_list(MesoFrameList *list, MesoArena *arena, const char *pattern, MesoError *error);

#endif
