/* The scene of a picture, and where its colours come from. */
#ifndef MESO_RENDERED_SCENE_H
#define MESO_RENDERED_SCENE_H

#include "formats/file/input.h"
#include "libcore/scene/scene.h"

typedef struct MesoRenderSource {
    MesoScene scene;
    MesoInput input;            /* of a model, which the scene points into */
    bool open;
    uint32_t color_channel;     /* whose ids give the colours, or MESO_NO_INDEX */
} MesoRenderSource;

#endif
