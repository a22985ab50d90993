/* What meso-quilt is told. */
#ifndef MESO_QUILT_ARGUMENTS_H
#define MESO_QUILT_ARGUMENTS_H

#include "cmd/common/scene_output.h"
#include "libcore/quilt/embed/quilt_lay.h"

typedef struct MesoQuiltArguments {
    MesoTool tool;
    MesoSceneOutput output;
    const char *swatch;         /* --swatch: a recipe, NULL: the first operand */
    uint32_t columns, rows, sides;
    float jitter, thickness;
    const char *up;             /* --swatch-up: auto, x, y, z */
    const char *periodic;       /* --periodic: auto, none, x, y, xy */
    const char *plane;          /* --plane; NULL: the last operand */
    float scale, height, offset;    /* 0: the default, of scale and height */
    const char *guide;
    uint32_t turns;
    float patch, lambda, mu;    /* 0: the default */
    uint32_t until;             /* 0: all */
    const char *seeds;          /* --seeds */
    const char *embedding;      /* --embed, of MESO_QUILT_EMBEDDING_NAMES */
    const char *under;          /* --surface: a material; NULL: the surface is not shown */
    bool check;                 /* --check */
    struct {
        bool columns, rows, sides, jitter, thickness;
    } given;
} MesoQuiltArguments;

#endif
