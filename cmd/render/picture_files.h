/* The files of a picture, written as it comes, band by band. */
#ifndef MESO_PICTURE_FILES_H
#define MESO_PICTURE_FILES_H

#include "cmd/render/render_arguments.h"
#include "cmd/render/render_backdrop.h"
#include "cmd/render/render_frames.h"
#include "formats/image/image_file.h"

typedef struct MesoPictureFiles {
    MesoOutput *outputs[2];
    MesoExrWriter *exr;
    MesoPngWriter *pngs[2];
    MesoPngLook look;           /* of these */
    MesoBackdropRows behind;
    const MesoImage *band;
    uint64_t covered;           /* pixels that something is on */
} MesoPictureFiles;

/* Opens the frame's files; `numbered` is whether the frame's number counts. `band` is what all bands are put into,
 * `height` the picture's. The files stay where they are until their end. */
MesoStatus meso_picture_files_begin(MesoPictureFiles *files, const MesoRenderArguments *a, const MesoRenderFrame *frame,
                                    bool numbered, const MesoRenderBackdrop *backdrop, const MesoImage *band,
                                    uint32_t height, MesoError *error);

/* Writes the rows that the band has now. */
MesoStatus meso_picture_files_band(MesoPictureFiles *files, MesoError *error);

/* Ends what was begun, also where that failed: all files appear or, unless `status` is MESO_OK, none. */
MesoStatus meso_picture_files_end(MesoPictureFiles *files, MesoStatus status, MesoError *error);

#endif
