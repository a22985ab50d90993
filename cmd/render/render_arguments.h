/* What meso-render is told. */
#ifndef MESO_RENDER_ARGUMENTS_H
#define MESO_RENDER_ARGUMENTS_H

#include "cmd/common/camera_options.h"
#include "cmd/common/tool.h"

typedef struct MesoRenderArguments {
    MesoTool tool;
    MesoCameraOptions camera;
    const char *png;            /* --png */
    const char *to;             /* --to */
    const char *background_text;
    const char *samples_text;
    const char *context, *visibility, *ground;
    bool context_given;
    const char *devices;        /* --devices: for tests, and hidden: where GPUs have their nodes */
    const char *frames;         /* --frames; NULL: one picture, or all frames of a turntable or of a pattern MODEL */
    uint32_t turntable;         /* --turntable: frames of a full turn; 0: none */
    const char *keys;           /* --keys: a file of cameras */
    bool resume;                /* --resume */
    const char *aov;            /* --aov; NULL: none beside the usual ones */
    unsigned extras;            /* MesoImageExtra */
    float vary;                 /* --vary */
    bool multipart;             /* --multipart */
    const char *data_window;    /* --data-window */
    const char *detail;         /* --detail */
    const char *fps_text;       /* --fps */
    uint32_t rate[2];           /* frames in so many seconds */
    uint32_t band_rows;         /* --band-rows: for tests, and hidden */
    uint32_t stored_sweeps;     /* --stored-sweeps: of more, none is (sweep_maker.h); the same */
    const char *light, *tone;   /* --light, --tone */
    float light_turn, light_strength;
    bool light_turn_given, light_strength_given;

    const char *tiles;          /* --tiles: a sheet of them */
    const char *show, *report;  /* --show, --report */
    const char *mesh_path;      /* --mesh-path */

    const char *model;          /* the operand, which may be a pattern; NULL: none */
    bool exr_product;           /* of -o */
} MesoRenderArguments;

#endif
