/* Frames: which there are, where each one's model, camera and pictures are, and which are done already. */
#ifndef MESO_RENDER_FRAMES_H
#define MESO_RENDER_FRAMES_H

#include "cmd/render/render_arguments.h"
#include "formats/clip/frame_list.h"
#include "libcore/render/camera_path.h"

typedef struct MesoRenderFrames {
    const MesoRenderArguments *a;
    MesoFrameList list;         /* of one, without a number, where there are no frames */
    bool numbered;              /* names are patterns */
    bool many_models;           /* MODEL is one */
    MesoCameraKey *keys;
    uint32_t key_count;
} MesoRenderFrames;

/* Reads lists and keys. MESO_ERR_USAGE where names and frames do not fit. */
MesoStatus meso_render_frames_init(MesoRenderFrames *frames, MesoRenderArguments *a, MesoError *error);

typedef struct MesoRenderFrame {
    int32_t number;
    const char *model, *output, *png;   /* paths; NULL: none */
    const char *command;                /* that makes this frame alone */
} MesoRenderFrame;

/* Of frame `i` of the list, in `arena`. MESO_ERR_MEMORY alone. */
MesoStatus meso_render_frame(MesoRenderFrame *frame, const MesoRenderFrames *frames, uint32_t i, MesoArena *arena,
                             MesoError *error);

/*
 * The command that makes it by a GPU which is not asked for by name: what its pictures say then, so that another run
 * does not take them for those of tiles. NULL when memory is out.
 */
char *meso_render_frame_gpu_command(const MesoRenderFrames *frames, const MesoRenderFrame *frame, MesoArena *arena,
                                    MesoError *error);

/* Its camera for a scene. */
MesoCamera meso_render_frame_camera(const MesoRenderFrames *frames, const MesoRenderFrame *frame, const MesoScene *scene);

/*
 * Whether the frame's pictures are there and were made as `provenance` says. A picture is there whole or not at
 * all. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_render_frame_is_done(bool *done, const MesoRenderFrame *frame, const MesoProvenance *provenance,
                                     MesoError *error);

#endif
